#include "services/program/exit_code.h"

#include <algorithm>

namespace dispersa {

const std::vector<ExitMeaning>& ExitMeanings() {
  static const std::vector<ExitMeaning> meanings = {
      {kExitInterrupted, "interrupted; what was flown is kept"},
      {kExitBadInput, "wrong usage or wrong input"},
      {kExitInternalError, "internal error, or a machine returned other bits"},
      {kExitIncomplete,
       "incomplete: no workers, no answer from the coordinator, disk full, closed standard output, "
       "quarantined cases, cancelled, cases missing in a folder"},
      {kExitReplayMismatch, "a replayed flight differs from the stored one"},
      {kExitRequirementFailed,
       "a requirement failed (one point of a study is enough), or `optimize`, `tune` or `margins` missed a "
       "target"},
      {kExitNotEvidence,
       "not evidence: a requirement was loosened, dropped or added after flights; earlier attempts used up "
       "the risk; a study states a probability; with --gate nothing is required"},
      {kExitInconclusive, "undecided: more cases can decide"},
      {kExitDone, "done: every requirement is met as planned, or the file requires nothing"},
  };
  return meanings;
}

ExitCode WorseOf(ExitCode a, ExitCode b) {
  const std::vector<ExitMeaning>& order = ExitMeanings();
  return std::find_if(order.begin(), order.end(),
                      [&](const ExitMeaning& one) { return one.code == a || one.code == b; })
      ->code;
}

}  // namespace dispersa
