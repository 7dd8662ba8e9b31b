#include "services/program/failure.h"

#include <fmt/format.h>

#include <cstdio>
#include <new>
#include <system_error>

#include "core/input/disk_full.h"
#include "services/log/log.h"
#include "services/program/error_json.h"

namespace dispersa {

Failure FailureOf(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
    return {
        kExitIncomplete,
        "the memory is used up; raise its limit (`ulimit -v`, a container's limit) or take fewer --threads "
        "or --workers"};
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  if (system != nullptr && system->code() == std::errc::resource_unavailable_try_again)
    return {
        kExitIncomplete,
        "the system refuses another thread; raise the limit of memory or threads (`ulimit -v`, `ulimit -u`) "
        "or take fewer --threads or --workers"};
  if (system != nullptr)
    if (const auto full = DiskFullWords(system->code().value()))
      return {kExitIncomplete, *full + " (" + error.what() + ")"};
  return {kExitInternalError, std::string("internal error: ") + error.what()};
}

ExitCode EndFor(const Failure& failure, bool json) {
  LogError("{}", failure.message);
  if (json) PrintErrorJson(failure.code, failure.message);
  std::fflush(stdout);  // some end without
  return failure.code;
}

ExitCode EndFor(const InputError& error, bool json, ExitCode code) {
  Tell("{}\n", error.what());
  if (json) PrintErrorJson(code, error.problems());
  return code;
}

}  // namespace dispersa
