#include "services/program/failure.h"

#include <fmt/format.h>

#include <cstdio>

#include "services/log/log.h"
#include "services/program/error_json.h"

namespace dispersa {

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
