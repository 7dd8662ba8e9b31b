#include "services/python/errors.h"
#include "services/ledger/result_exit_code.h"

#include <string>
#include <string_view>
#include <utility>

#include "core/containment/contained.h"
#include "core/results/result_error.h"
#include "services/client/observer.h"
#include "services/program/exit_code.h"
#include "services/program/failure.h"

namespace py = pybind11;

namespace dispersa {
namespace {

// Options of the command line in Python's words.
std::string InPython(std::string text) {
  constexpr std::pair<std::string_view, std::string_view> kWords[] = {
      {"--resume", "resume=True"},     {"--no-histories", "histories=False"},
      {"--insecure", "insecure=True"}, {"--keys DIR", "keys=DIR"},
      {"--address ", "address="},      {"--keys", "keys"},
      {"--metric:", "metrics:"},       {"--out:", "out:"}};
  for (const auto& [option, argument] : kWords)
    for (std::size_t at; (at = text.find(option)) != std::string::npos;)
      text.replace(at, option.size(), argument);
  return text;
}

py::str Words(const std::string& text) { return InPython(text); }

void Raise(const char* name, const py::object& argument) {
  const py::object type = py::module_::import("dispersa.errors").attr(name);
  PyErr_SetObject(type.ptr(), argument.ptr());
}

const char* ErrorName(ExitCode code) {
  switch (code) {
    case kExitBadInput:
      return "BadInput";
    case kExitIncomplete:
      return "Incomplete";
    case kExitReplayMismatch:
      return "ReplayMismatch";
    default:
      return "InternalError";
  }
}

}  // namespace

void Translate(std::exception_ptr problem) {
  try {
    if (problem) std::rethrow_exception(problem);
  } catch (const InputError& error) {
    Raise("BadInput", ProblemsOf(error.problems()));
  } catch (const ResultError& error) {
    Raise(ErrorName(ExitCodeOf(error)), Words(error.what()));
  } catch (const PluginError& error) {
    Raise("BadInput", py::str(std::string("the control law ") + error.what()));
  } catch (const ContainedEnd& end) {
    Raise("Incomplete", py::str(std::string("the control law ") + end.what()));
  } catch (const Failure& failure) {
    Raise(ErrorName(failure.code), Words(failure.message));
  } catch (const Interrupted&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  }
}

py::list ProblemsOf(const std::vector<InputProblem>& problems) {
  py::list list;
  for (const InputProblem& p : problems)
    list.append(py::make_tuple(p.file, p.line, p.column, p.path, InPython(p.message), InPython(p.allowed)));
  return list;
}

}  // namespace dispersa
