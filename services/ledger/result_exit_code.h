// The exit code for an error of a result folder.
#pragma once

#include "core/results/result_error.h"
#include "services/program/exit_code.h"

namespace dispersa {

inline ExitCode ExitCodeOf(const ResultError& error) {
  switch (error.kind()) {
    case ResultError::Kind::kDiskFull:
    case ResultError::Kind::kFewer:
      return kExitIncomplete;
    case ResultError::Kind::kFileSystem:
      return kExitBadInput;
    case ResultError::Kind::kConflict:
    case ResultError::Kind::kFile:
      break;
  }
  return kExitInternalError;
}

}  // namespace dispersa
