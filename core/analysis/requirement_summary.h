// The verdict on one requirement of a campaign, in numbers and in words.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/results/case_columns.h"
#include "core/results/requirement_text.h"
#include "core/statistics/limits.h"
#include "core/statistics/planned_verdict.h"

namespace dispersa {

/// A case of a requirement: what it measured, as it is held against the limits (Limits::Represented()). It is
/// undefined if the flight was lost, because a loss fails every requirement.
std::vector<double> ValuesToJudge(const Requirement& requirement, const CaseColumns& cases);

struct RequirementSummary {
  std::string id, rationale, source;  ///< as the campaign gives them
  std::string metric;                 ///< without the prefix
  bool every_case = false;            ///< of a study: no probability is stated
  bool below = true;                  ///< else above; of `within` the high limit
  double limit = 0.0;
  std::optional<double> low_limit;  ///< of `within`
  double probability = 0.0;
  double consumer_risk = 0.0;
  VerdictPlan plan;
  std::int64_t planned = 0;       ///< cases that were planned before the first was flown
  std::int64_t n = 0;             ///< cases flown
  std::int64_t failures = 0;      ///< beyond the limit, undefined, or a lost flight whatever it measured
  std::int64_t lost_flights = 0;  ///< of the failures: any outcome but completed
  std::int64_t not_measured = 0;  ///< of the failures: completed flights that do not define the metric
  std::string verdict;  ///< "pass", "fail", "inconclusive", "not_evidence"; "study" of chosen points
  /// One-sided confidence bounds of the probability of success; none in a design study without replicates.
  std::optional<double> success_lower;
  std::optional<double> success_upper;
  /// When inconclusive: the least number of cases that could pass with as many failures.
  std::optional<std::int64_t> cases_needed;
  /// The probability that a design which just misses shows at most this many failures: the risk at which
  /// these cases would pass. A case without a result counts as a failure. None in a design study.
  std::optional<double> attained_risk;
  std::vector<Look> looks;  ///< at the counts, ascending; none in a design study
  std::optional<std::int64_t>
      accepts;  ///< this many failures or fewer pass at the last look; none: no number passes
  std::optional<std::int64_t> rejects;  ///< this many failures or more fail
  bool contradicted = false;
  bool beyond_plan = false;
  std::optional<double> naive_risk;  ///< see PlannedVerdict
  bool post_hoc = false;             ///< the requirement was changed after the first case was flown
  /// With confidence 1 - consumer_risk, a share `probability` of the flights stays on the good side of this
  /// value. It is the order statistic that decides the requirement. None if there are too few cases or too
  /// many lost flights.
  std::optional<double> bound;
  std::optional<double> margin;  ///< from `bound` to the limit, positive if met, in the metric's unit
  struct Worst {
    std::uint64_t case_index = 0;
    double value = 0.0;
  };
  /// The completed flight farthest outside the limits, or nearest to one if all are inside. It is no bound of
  /// anything, but says where the sample ends. None if no completed flight defines the metric.
  std::optional<Worst> worst_completed;
  /// Probability that a new campaign of `cases` cases with one look passes (PassProbability()).
  struct PassChance {
    std::int64_t cases = 0;
    double probability = 0.0;
  };
  std::vector<PassChance> pass_chances;
  /// When inconclusive: how many flights could decide.
  struct Advice {
    std::int64_t least = 0;                ///< with fewer no new campaign can pass
    PassChance likely;                     ///< more flights than these hardly help a new campaign
    std::optional<std::int64_t> extended;  ///< of this campaign in all, with no further failure
  };
  std::optional<Advice> advice;
  /// Bounds of the success probability from the first n cases with a result. n grows by about equal ratios up
  /// to all cases. Each bound is one-sided and holds for its n alone (Clopper and Pearson). A design study
  /// has none.
  struct Convergence {
    std::int64_t n = 0;
    std::int64_t failures = 0;
    double success_lower = 0.0;
    double success_upper = 1.0;
  };
  std::vector<Convergence> convergence;
  std::string sentence;  ///< what was seen, and what it shows; without the advice
};

/// "below 0.5 °", "between -1 and 1 km".
std::string LimitWords(const RequirementSummary& requirement, const std::string& unit);
/// "With 90 % confidence 99.73 % of flights stay below 0.225 ° (limit 0.5 °)."; empty without a bound.
std::string BoundSentence(const RequirementSummary& requirement, const std::string& unit);
/// The limit that a value stands beside: of a range the nearer one.
double LimitBeside(const RequirementSummary& requirement, double value);
/// "0.214": a value of its metric, with the digits that tell it from the limit.
std::string ValueText(const RequirementSummary& requirement, double value);
/// "0.225": the bound that it has, rounded so that it still holds.
std::string BoundText(const RequirementSummary& requirement);
/// "below 0.225 °"; empty without a bound.
std::string BoundWords(const RequirementSummary& requirement, const std::string& unit);
/// " A new campaign can pass with 852 flights or more. ..."; empty unless inconclusive.
std::string AdviceSentence(const RequirementSummary& requirement);
/// "pitch_error_peak_deg below 0.5 for 99.73 % of flights at 10 % risk".
std::string RequirementWords(const RequirementSummary& requirement);

/// The facts about a campaign that a verdict needs beside its cases.
struct JudgingContext {
  SamplingMethod method = SamplingMethod::kMonteCarlo;
  std::uint64_t cases = 0;  ///< of the campaign; those that are not among the rows are missing
  std::uint64_t replicates = 1;
  std::uint64_t design_points = 1;       ///< of a corner, one-at-a-time, grid or list design
  std::int64_t planned = 0;              ///< cases that were planned before the first was flown
  std::vector<std::int64_t> past_looks;  ///< numbers of cases at which verdicts were read before
  std::vector<std::string> registered;   ///< RequirementLine() before the first case; none: as they are
  bool holm = false;
  std::string no_evidence;  ///< WhyNoEvidence(): no share of flights passes by these cases; empty: it may
};

/// The verdicts on all requirements. Only independent cases give one (Decide()). The points of a design study
/// are chosen. Its verdict is "study", and its sentence counts the points that meet the limit. Independent
/// replicates of a Latin hypercube or Sobol design give bounds of the probability (ReplicateBounds()).
std::vector<RequirementSummary> JudgeAll(const std::vector<Requirement>& requirements,
                                         const JudgingContext& context, const CaseColumns& cases);

/// One requirement over the given rows. They count as a campaign that was flown as planned; `missing` further
/// cases have no result.
RequirementSummary Judge(const Requirement& requirement, SamplingMethod method, const CaseColumns& cases,
                         std::int64_t missing);

}  // namespace dispersa
