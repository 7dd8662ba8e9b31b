#include "services/coordinator/outcomes.h"

#include <algorithm>
#include <cstddef>

#include "core/analysis/load_check.h"
#include "core/analysis/requirement_summary.h"
#include "core/analysis/standing.h"
#include "services/coordinator/catalogue.h"
#include "services/program/exit_code.h"

namespace dispersa {

std::vector<RequirementOutcome> OutcomesOf(const CampaignSummary& summary) {
  std::vector<RequirementOutcome> outcomes;
  const auto& standing = summary.standing.requirements;
  for (std::size_t i = 0; i < std::min(summary.requirements.size(), kMaxOutcomes); ++i) {
    const RequirementSummary& one = summary.requirements[i];
    outcomes.push_back({one.metric, RequirementWords(one), one.probability, one.n, one.failures,
                        one.success_lower, one.success_upper,
                        i < standing.size() ? standing[i].verdict : one.verdict, one.bound,
                        one.low_limit ? std::vector{*one.low_limit, one.limit} : std::vector{one.limit}});
  }
  for (const LoadCheck& check : summary.load_checks)
    if (check.failures > 0)
      outcomes.push_back(
          {check.metric, LoadCheckSentence(check), 0.0, check.n, check.failures, {}, {}, "fail"});
  return outcomes;
}

std::string VerdictWords(const CatalogueEntry& entry) {
  if (entry.state != CampaignState::kDone) return "";
  switch (entry.code) {
    case kExitDone:
      return entry.verdict == StandingVerdictName(StandingVerdict::kNothingJudged)
                 ? "nothing is required"
                 : "every requirement is met";
    case kExitRequirementFailed:
      return "a requirement failed";
    case kExitInconclusive:
      return "undecided: more cases can decide";
    case kExitNotEvidence:
      return "not evidence";
    case kExitIncomplete:
      return "incomplete";
    default:
      return "two results of a case differ";  // CampaignExitCode
  }
}

}  // namespace dispersa
