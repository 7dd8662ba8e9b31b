#include "core/statistics/requirement.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/statistics/intervals.h"
#include "core/statistics/order_statistics.h"

namespace dispersa {

std::int64_t CountFailures(const ProbabilityRequirement& requirement, const std::vector<double>& values) {
  return std::count_if(values.begin(), values.end(), [&](double value) {
    const bool meets =
        requirement.side == Side::kBelow ? value < requirement.limit : value > requirement.limit;
    return !std::isfinite(value) || !meets;
  });
}

RequirementResult Evaluate(const ProbabilityRequirement& requirement, std::int64_t n, std::int64_t failures,
                           std::int64_t missing) {
  assert(n >= failures && failures >= 0 && missing >= 0);
  assert(requirement.consumer_risk > 0.0 && requirement.consumer_risk < 0.5);
  RequirementResult result;
  result.n = n;
  result.failures = failures;
  result.missing = missing;
  const double probability = requirement.probability;
  const double risk = requirement.consumer_risk;
  const std::int64_t all = n + missing;
  const std::int64_t most_failures = failures + missing;
  if (all > 0) {
    result.success_lower = ClopperPearsonLower(all - most_failures, all, 1.0 - risk);
    result.success_upper = ClopperPearsonUpper(all - failures, all, 1.0 - risk);
  }
  if (ConsumerRisk(probability, all, most_failures) <= risk) {
    result.verdict = Verdict::kPass;
  } else if (ProducerRisk(probability, all, failures) <= risk) {
    result.verdict = Verdict::kFail;
  } else {
    result.cases_needed = CasesNeeded(probability, risk, most_failures);
  }
  return result;
}

RequirementResult Evaluate(const ProbabilityRequirement& requirement, const std::vector<double>& values,
                           std::int64_t missing) {
  return Evaluate(requirement, static_cast<std::int64_t>(values.size()), CountFailures(requirement, values),
                  missing);
}

}  // namespace dispersa
