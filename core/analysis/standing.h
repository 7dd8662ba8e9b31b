// What a campaign's verdicts are worth after all that was flown and required before it: the verdict that
// stands, which decides the exit code. It depends on other campaigns and on the order of events, so it is no
// part of summary.json.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/results/attempt_ledger.h"
#include "core/results/result_folder.h"

namespace dispersa {

struct CampaignSummary;

enum class StandingVerdict {
  kPass,           ///< every requirement is met as it was planned
  kNothingJudged,  ///< the campaign requires nothing
  kInconclusive,   ///< more cases can decide
  kNotEvidence,    ///< what looks like a pass shows nothing: see the reasons
  kFail,
  kIncomplete,
};
/// "pass", "nothing_judged", "inconclusive", "not_evidence", "fail", "incomplete".
const char* StandingVerdictName(StandingVerdict verdict);
/// The same for people: "not evidence", "post hoc" when a requirement was changed after flights.
std::string StandingBadge(const struct Standing& standing);

/// Who flew a folder's campaign last, and when; empty where nobody noted it.
struct RunInfo {
  std::string started_utc;
  std::string user;
  std::string host;
  std::string vehicle_file;
  double flying_s = 0.0;  ///< wall clock; 0: not known
};

struct Standing {
  struct Requirement {
    std::string verdict;  ///< "pass", "fail", "inconclusive", "not_evidence"
    bool post_hoc = false;
    std::string reason;  ///< why it differs from what the campaign shows by itself; empty: it does not
    std::int64_t pool_cases = 0;  ///< of all attempts together
    std::int64_t pool_failures = 0;
  };
  /// Required before the first case and not any more.
  struct Dropped {
    std::string line;     ///< RequirementLine()
    std::string verdict;  ///< that it had last; empty: none yet
  };
  struct AttemptLine {
    std::string id;
    std::uint64_t seed = 0;
    std::int64_t cases = 0;
    std::string verdict;  ///< StandingVerdictName(); empty: it has not ended
    std::string begun_utc;
    std::string fresh;  ///< why it started anew
  };

  StandingVerdict verdict = StandingVerdict::kIncomplete;
  std::vector<Requirement> requirements;  ///< as in the summary
  std::vector<Dropped> dropped;
  bool is_post_hoc = false;
  std::vector<AttemptLine> attempts;  ///< at this design, in the order of their beginning, this one last
  std::string fresh;                  ///< why earlier attempts do not count; empty: they do
  std::int64_t earlier_designs = 0;
  std::int64_t earlier_designs_of_seed = 0;
  RunInfo run;
};

/// Of a folder whose summary is made. Reads the folder's own ledger and record of looks.
Standing StandingOf(const ResultFolder& folder, const Campaign& campaign, const CampaignSummary& summary);

/// What a reader must know of it before any number, in sentences.
std::vector<std::string> StandingNotes(const Standing& standing, const CampaignSummary& summary);

/// The attempt as it is now, for its ledger.
AttemptRecord AttemptOf(const Campaign& campaign, const CampaignSummary& summary, AttemptRecord begun);

/// Writes `standing_verdict`, `attempts` and what belongs to them into the folder's execution.json; what else
/// is there stays.
void WriteStanding(const ResultFolder& folder, const CampaignSummary& summary);
/// The same in the ledgers: of the folder and of the folder `root` that it is in. Why the latter could not be
/// written, if so.
std::optional<std::string> RecordAttempt(const std::filesystem::path& root, const ResultFolder& folder,
                                         const Campaign& campaign, const CampaignSummary& summary);

}  // namespace dispersa
