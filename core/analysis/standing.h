// The verdict that stands: the campaign's own verdict after earlier attempts and earlier requirements are
// counted. It decides the exit code. It depends on other campaigns and on the order of events, so it is no
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
struct RequirementSummary;

enum class StandingVerdict {
  kPass,           ///< every requirement is met as it was planned
  kNothingJudged,  ///< the campaign requires nothing
  kInconclusive,   ///< more cases can decide
  kNotEvidence,    ///< the pass by itself is no evidence: see the reasons
  kFail,
  kIncomplete,
};
/// "pass", "nothing_judged", "inconclusive", "not_evidence", "fail", "incomplete".
const char* StandingVerdictName(StandingVerdict verdict);
/// The same for people: "not evidence", "post hoc" when a requirement was changed after flights.
std::string StandingBadge(const struct Standing& standing);

/// The last run of a folder's campaign: person, host and time. Fields that are not recorded are empty.
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
    std::string reason;  ///< why it differs from the campaign's own verdict; empty: it does not differ
    std::int64_t pool_cases = 0;  ///< of all attempts together
    std::int64_t pool_failures = 0;
  };
  /// A requirement from before the first case that is not in the file any more.
  struct Dropped {
    std::string line;     ///< RequirementLine()
    std::string words;    ///< "pitch_error_peak_deg below 0.1 for 99.73 % of flights at 10 % risk"
    std::string verdict;  ///< its last verdict; empty: none yet
  };
  struct AttemptLine {
    std::string id;
    std::uint64_t seed = 0;
    std::int64_t cases = 0;
    std::string verdict;  ///< StandingVerdictName(); empty: it has not ended
    std::string begun_utc;
    std::string fresh;        ///< reason of `--fresh`; empty: none
    bool is_evidence = true;  ///< flown by the engine that flew this campaign
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

/// The standing of a folder with this summary. Reads the folder's own ledger and its record of looks.
Standing StandingOf(const ResultFolder& folder, const Campaign& campaign, const CampaignSummary& summary);

/// The sentence of a requirement, after the one of what decided in its place: all attempts together, another
/// rule.
std::string JudgedSentence(const RequirementSummary& requirement, const Standing::Requirement& standing);

/// Sentences about the standing that a reader needs before any number: changes of requirements, and of the
/// campaign.
std::vector<std::string> StandingNotes(const Standing& standing, const CampaignSummary& summary);
/// Of the campaign alone: the rules of judgement, earlier attempts, earlier designs.
std::vector<std::string> CampaignNotes(const Standing& standing);

/// The attempt in its present state, for its ledger.
AttemptRecord AttemptOf(const Campaign& campaign, const CampaignSummary& summary, AttemptRecord begun);

/// Writes `standing_verdict`, `attempts` and their details into the folder's execution.json. Other members
/// stay.
void WriteStanding(const ResultFolder& folder, const CampaignSummary& summary);
/// Writes the attempt into the ledger of the folder and into that of `root`, the folder above it. Returns the
/// error text if the latter cannot be written.
std::optional<std::string> RecordAttempt(const std::filesystem::path& root, const ResultFolder& folder,
                                         const Campaign& campaign, const CampaignSummary& summary);

}  // namespace dispersa
