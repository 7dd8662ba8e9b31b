#include "core/statistics/planned_verdict.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/math/assertion.h"
#include "core/statistics/anytime.h"
#include "core/statistics/intervals.h"
#include "core/statistics/order_statistics.h"

namespace dispersa {
namespace {

/// A rest of the risk below this decides nothing: no number of cases would use it.
constexpr double kLeastRisk = 1e-12;

std::int64_t Below(const std::vector<std::int64_t>& ascending, std::int64_t n) {
  return std::lower_bound(ascending.begin(), ascending.end(), n) - ascending.begin();
}

/// Where an anytime plan looks: at every number of three significant digits. What it may decide at any time
/// it need not ask at every one.
std::vector<std::int64_t> Checkpoints(std::int64_t n) {
  std::vector<std::int64_t> counts;
  for (std::int64_t count = 1, step = 1; count <= n; count += step) {
    if (count == 1000 * step) step *= 10;
    counts.push_back(count);
  }
  return counts;
}

LookBoundary Boundary(double probability, double pass_risk, double fail_risk, std::int64_t n) {
  LookBoundary boundary =
      AnytimeBoundary(probability, std::max(pass_risk, kLeastRisk), std::max(fail_risk, kLeastRisk), n);
  if (pass_risk <= kLeastRisk) boundary.accept = -1;
  if (fail_risk <= kLeastRisk) boundary.reject = n + 1;
  return boundary;
}

}  // namespace

std::int64_t CaseTally::Failed(std::int64_t n) const { return Below(failed, n); }
std::int64_t CaseTally::Missing(std::int64_t n) const { return Below(missing, n); }

PlannedVerdict Decide(const PlannedRequirement& requirement, std::int64_t n, const CaseTally& tally,
                      const std::vector<std::int64_t>& past_looks) {
  DISPERSA_ASSERT(n >= 1, n);
  const double probability = requirement.probability;
  const double risk = requirement.risk;
  const VerdictPlan& plan = requirement.plan;
  const bool anytime = plan.kind == PlanKind::kAnytime;
  const std::vector<LookBoundary> planned = Boundaries(plan, probability, risk, requirement.planned);
  const double pass_left = risk - PassRisk(probability, planned);
  const double fail_left = risk - FailRisk(probability, planned);

  std::set<std::int64_t> counts = {n};
  for (const std::int64_t past : past_looks) {
    if (past >= 1 && past < n) counts.insert(past);
  }
  const std::set<std::int64_t> read = counts;
  for (const LookBoundary& look : planned) {
    if (look.n <= n) counts.insert(look.n);
  }
  if (anytime) {
    const std::vector<std::int64_t> checkpoints = Checkpoints(n);
    counts.insert(checkpoints.begin(), checkpoints.end());
  }

  PlannedVerdict result;
  bool passed = false;
  bool failed = false;
  for (const std::int64_t count : counts) {
    const auto planned_look = std::find_if(planned.begin(), planned.end(),
                                           [count](const LookBoundary& look) { return look.n == count; });
    const bool is_planned = anytime || planned_look != planned.end();
    const std::int64_t failures = tally.Failed(count);
    const std::int64_t most_failures = failures + tally.Missing(count);
    const bool decided = passed || failed;
    result.boundary =
        planned_look != planned.end() ? *planned_look : Boundary(probability, pass_left, fail_left, count);
    passed = passed || most_failures <= result.boundary.accept;
    failed = failed || failures >= result.boundary.reject;
    // Of an anytime plan's many looks, those that were read and the one that decided.
    const bool decides = !decided && (passed || failed);
    if (anytime && !decides && !read.contains(count)) continue;
    result.looks.push_back({.n = count,
                            .failures = failures,
                            .planned = is_planned,
                            .verdict = passed == failed ? Verdict::kInconclusive
                                       : passed         ? Verdict::kPass
                                                        : Verdict::kFail});
  }
  result.verdict = result.looks.back().verdict;
  result.contradicted = passed && failed;
  result.beyond_plan = !anytime && n > requirement.planned;
  if (result.beyond_plan) {
    std::vector<LookBoundary> naive;
    for (const std::int64_t count : read)
      naive.push_back({count, MaxFailures(probability, risk, count).value_or(-1), count + 1});
    result.naive_risk = PassRisk(probability, naive);
  }

  const std::int64_t failures = tally.Failed(n);
  const std::int64_t most_failures = failures + tally.Missing(n);
  if (plan.kind == PlanKind::kFixed && read.size() == 1 && !result.beyond_plan) {
    result.success_lower = ClopperPearsonLower(n - most_failures, n, 1.0 - risk);
    result.success_upper = ClopperPearsonUpper(n - failures, n, 1.0 - risk);
  } else {
    const Interval success = AnytimeSuccess(n, failures, most_failures, risk);
    result.success_lower = success.lower;
    result.success_upper = success.upper;
  }
  if (result.verdict == Verdict::kInconclusive) {
    result.cases_needed = anytime ? AnytimeCasesNeeded(probability, risk, most_failures)
                                  : CasesNeeded(probability, risk, most_failures);
  }
  return result;
}

std::vector<PlannedVerdict> DecideAll(const std::vector<PlannedRequirement>& requirements, bool holm,
                                      std::int64_t n, const std::vector<CaseTally>& tallies,
                                      const std::vector<std::int64_t>& past_looks) {
  DISPERSA_ASSERT(requirements.size() == tallies.size(), requirements.size(), tallies.size());
  std::vector<PlannedVerdict> verdicts(requirements.size());
  std::size_t open = requirements.size();
  for (bool again = open > 0; again;) {
    const double share = holm ? 1.0 / static_cast<double>(open) : 1.0;
    std::size_t still_open = 0;
    for (std::size_t i = 0; i < requirements.size(); ++i) {
      if (verdicts[i].verdict == Verdict::kInconclusive) {
        PlannedRequirement requirement = requirements[i];
        requirement.risk *= share;
        verdicts[i] = Decide(requirement, n, tallies[i], past_looks);
      }
      still_open += verdicts[i].verdict == Verdict::kInconclusive ? 1 : 0;
    }
    again = holm && still_open > 0 && still_open < open;
    open = still_open;
  }
  return verdicts;
}

double PassProbability(double probability, double risk, std::int64_t n, std::int64_t seen,
                       std::int64_t failures) {
  const std::optional<std::int64_t> most = MaxFailures(probability, risk, n);
  if (!most) return 0.0;
  // The sum of the beta-binomial distribution up to the most failures allowed.
  const double a = static_cast<double>(failures) + 0.5;
  const double b = static_cast<double>(seen - failures) + 0.5;
  const auto all = static_cast<double>(n);
  double term = std::lgamma(all + b) + std::lgamma(a + b) - std::lgamma(b) - std::lgamma(all + a + b);
  double sum = 0.0;
  for (std::int64_t k = 0; k <= std::min(*most, n); ++k) {
    sum += std::exp(term);
    const auto at = static_cast<double>(k);
    if (k < n) term += std::log((all - at) / (at + 1.0) * (a + at) / (b + all - at - 1.0));
  }
  return std::min(sum, 1.0);
}

}  // namespace dispersa
