// Exit codes of a process, also in a coordinator's reply to its client.
#pragma once

#include <vector>

namespace dispersa {

enum ExitCode : int {
  kExitDone = 0,
  kExitInternalError = 1,
  kExitBadInput = 2,
  kExitRequirementFailed = 3,
  kExitInconclusive = 4,
  kExitIncomplete = 5,
  kExitReplayMismatch = 6,
  kExitNotEvidence = 7,
  kExitInterrupted = 130,
};

struct ExitMeaning {
  ExitCode code;
  const char* meaning;
};

/// Every code with its meaning, in the order in which one is reported where several hold. services/README.md
/// shows this table; a test holds it to it.
const std::vector<ExitMeaning>& ExitMeanings();

/// Of two that hold, the one to report.
ExitCode WorseOf(ExitCode a, ExitCode b);

}  // namespace dispersa
