// Exit codes of a process, also in a coordinator's reply to its client.
#pragma once

namespace dispersa {

enum ExitCode : int {
  kExitDone = 0,  ///< done and every requirement met
  kExitInternalError = 1,
  kExitBadInput = 2,           ///< bad usage or bad input
  kExitRequirementFailed = 3,  ///< or the optimiser's target cannot be reached
  kExitInconclusive = 4,       ///< more cases needed
  kExitIncomplete = 5,         ///< no workers, disk full, output lost, quarantined cases, cancelled
  kExitReplayMismatch = 6,
  kExitInterrupted = 130,
};

/// Of two that hold, the one to report: 130, 2, 1, 5, 6, 3, 4, 0 in that order.
ExitCode WorseOf(ExitCode a, ExitCode b);

}  // namespace dispersa
