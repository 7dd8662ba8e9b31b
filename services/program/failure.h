// The error that ends a program, in words for its user.
#pragma once

#include <exception>
#include <string>

#include "core/input/input_error.h"
#include "services/program/exit_code.h"

namespace dispersa {

struct Failure {
  ExitCode code;
  std::string message;
};

/// What ends a program unexpectedly. Memory, threads or a place on the disk that the system refuses are
/// kExitIncomplete, because the same command can go on with more of them. Everything else is
/// kExitInternalError.
Failure FailureOf(const std::exception& error);

/// Says why a program ends: to its log, and with --json to standard output as an object too. Returns the
/// code.
ExitCode EndFor(const Failure& failure, bool json);
/// The same in the words of an input's problems, without a log's time and level.
ExitCode EndFor(const InputError& error, bool json, ExitCode code = kExitBadInput);

}  // namespace dispersa
