// dispersa._core: what the Python package calls. Plain values in and out; the package gives them names.
#include "services/python/module.h"

#include <pybind11/stl.h>

#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "core/containment/contained.h"
#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/history.h"
#include "core/flight/lane_engine.h"
#include "core/flight/metrics.h"
#include "core/results/metric_catalogue.h"
#include "core/results/result_error.h"
#include "core/statistics/intervals.h"
#include "services/client/observer.h"
#include "services/client/session.h"
#include "services/log/log.h"
#include "services/program/exit_code.h"

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
    case kExitBadInput: return "BadInput";
    case kExitIncomplete: return "Incomplete";
    case kExitReplayMismatch: return "ReplayMismatch";
    default: return "InternalError";
  }
}

// What ends a command with an exit code is an exception of dispersa.errors.
void Translate(std::exception_ptr problem) {
  try {
    if (problem) std::rethrow_exception(problem);
  } catch (const InputError& error) {
    Raise("BadInput", ProblemsOf(error.problems()));
  } catch (const ResultError& error) {
    Raise(error.IsIncomplete() ? "Incomplete" : "InternalError", Words(error.what()));
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

std::vector<std::string> InputNames(std::size_t stages) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < InputCount(stages); ++i) names.push_back(InputColumns()[i].name);
  return names;
}

std::vector<std::string> VehicleMetricNames(std::size_t stages) {
  return {MetricNames().begin(), MetricNames().begin() + static_cast<std::ptrdiff_t>(MetricCount(stages))};
}

const char* WorseName(Worse worse) {
  switch (worse) {
    case Worse::kLarger: return "larger";
    case Worse::kSmaller: return "smaller";
    case Worse::kFartherFromZero: return "farther_from_zero";
    default: return "neither";
  }
}

py::tuple MetricTuple(const std::string& name) {
  const MetricInfo info = DescribeMetric(name);
  return py::make_tuple(info.title, info.unit, info.definition, WorseName(info.worse));
}

}  // namespace

py::list ProblemsOf(const std::vector<InputProblem>& problems) {
  py::list list;
  for (const InputProblem& p : problems)
    list.append(py::make_tuple(p.file, p.line, p.column, p.path, InPython(p.message), InPython(p.allowed)));
  return list;
}

}  // namespace dispersa

PYBIND11_MODULE(_core, module) {
  using namespace dispersa;
  LogForPeople(LogColor::kAuto, "dispersa: ");
  SetLogLevel(LogLevel::kWarning);
  ChosenEngine();  // what DISPERSA_LANES and DISPERSA_ISA ask for in vain is said at the import

  py::register_exception_translator(Translate);
  module.def("engine_version", &EngineVersion);
  module.def("input_names", &InputNames);
  module.def("metric_names", &VehicleMetricNames);
  module.def("history_columns", &HistoryColumns);
  module.def("describe", &MetricTuple);
  module.def("split_unit", [](const std::string& name) {
    const NameAndUnit split = SplitUnit(name);
    return py::make_tuple(split.stem, split.unit);
  });
  module.def("clopper_pearson", [](std::int64_t events, std::int64_t n, double confidence) {
    const Interval interval = ClopperPearson(events, n, confidence);
    return py::make_tuple(interval.lower, interval.upper);
  });
  AddCampaigns(module);
  AddResults(module);
}
