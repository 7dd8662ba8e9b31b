#include "services/program/exit_code.h"

#include <algorithm>
#include <iterator>

namespace dispersa {

ExitCode WorseOf(ExitCode a, ExitCode b) {
  constexpr ExitCode kWorstFirst[] = {
      kExitInterrupted,    kExitBadInput,          kExitInternalError, kExitIncomplete,
      kExitReplayMismatch, kExitRequirementFailed, kExitInconclusive,  kExitDone};
  return *std::find_if(std::begin(kWorstFirst), std::end(kWorstFirst),
                       [&](ExitCode code) { return code == a || code == b; });
}

}  // namespace dispersa
