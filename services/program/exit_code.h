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

/// Every code with its meaning. If several hold, the first in this order is reported. The docs site shows
/// this table (services/docs/tables.cc).
const std::vector<ExitMeaning>& ExitMeanings();

/// The code to report if both hold.
ExitCode WorseOf(ExitCode a, ExitCode b);

}  // namespace dispersa
