// The verdict on one requirement of a campaign, in numbers and in words.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/report/case_columns.h"

namespace dispersa {

struct RequirementSummary {
  std::string metric;  ///< without the prefix
  bool below = true;   ///< else above
  double limit = 0.0;
  double probability = 0.0;
  double consumer_risk = 0.0;
  std::int64_t n = 0;             ///< cases flown
  std::int64_t failures = 0;      ///< beyond the limit, undefined, or a lost flight whatever it measured
  std::int64_t lost_flights = 0;  ///< of the failures: any outcome but completed
  std::string verdict;            ///< "pass", "fail" or "inconclusive"
  /// One-sided confidence bounds of the probability of success; none in a design study.
  std::optional<double> success_lower;
  std::optional<double> success_upper;
  /// When inconclusive: so many cases in all at least, if no further one fails.
  std::optional<std::int64_t> cases_needed;
  std::string sentence;
};

/// `missing`: cases of the campaign without a result. They count as failed for a pass and as passed for a
/// fail.
///
/// Only independent cases give a confidence statement. An enumerated design (corners, ...) passes when the
/// share of its points that meet the limit is at least the probability, and fails otherwise; Latin hypercube
/// and Sobol designs can fail but not pass, because the binomial limits do not hold for them.
RequirementSummary Judge(const Requirement& requirement, SamplingMethod method, const CaseColumns& cases,
                         std::int64_t missing);

}  // namespace dispersa
