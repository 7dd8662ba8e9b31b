// Verdicts on requirements such as "pitch error below 0.5° with probability 99.73 % at 10 % consumer risk".
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace dispersa {

enum class Verdict { kPass, kFail, kInconclusive };
enum class Side { kBelow, kAbove };

/// The metric lies below (or above) the limit, strictly, with at least this probability.
struct ProbabilityRequirement {
  Side side = Side::kBelow;
  double limit = 0.0;           ///< in the metric's unit
  double probability = 0.9973;  ///< in (0, 1)
  /// In (0, 0.5): of passing a design that just misses, and of failing one that just meets.
  double consumer_risk = 0.10;
};

struct RequirementResult {
  std::int64_t n = 0;         ///< cases flown
  std::int64_t failures = 0;  ///< beyond the limit, or undefined
  std::int64_t missing = 0;   ///< cases without a result (quarantined), not in n
  Verdict verdict = Verdict::kInconclusive;
  /// Of the success probability, one-sided, each with confidence 1 - consumer_risk; what is missing counts as
  /// failed for the lower and as passed for the upper.
  double success_lower = 0.0;
  double success_upper = 1.0;
  /// When inconclusive: the least number of cases that could pass, which needs every further case to succeed.
  std::optional<std::int64_t> cases_needed;
};

/// Values that do not meet the limit; an undefined (not finite) value does not.
std::int64_t CountFailures(const ProbabilityRequirement& requirement, const std::vector<double>& values);

/// Pass when ConsumerRisk <= consumer_risk with the missing cases counted as failures; fail when ProducerRisk
/// <= consumer_risk (the Clopper-Pearson upper limit does not exceed the probability) with the missing ones
/// counted as successes; else inconclusive. The cases are independent draws of a number fixed beforehand:
/// neither a Latin hypercube or Sobol design nor a campaign stopped because of its results.
RequirementResult Evaluate(const ProbabilityRequirement& requirement, std::int64_t n, std::int64_t failures,
                           std::int64_t missing = 0);
/// The same from one value a case, NaN for a lost flight or an undefined metric.
RequirementResult Evaluate(const ProbabilityRequirement& requirement, const std::vector<double>& values,
                           std::int64_t missing = 0);

}  // namespace dispersa
