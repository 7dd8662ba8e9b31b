// The state of a campaign while it flies: its requirements, and histograms of its key metrics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"
#include "core/statistics/limits.h"
#include "services/ledger/running_histogram.h"

namespace dispersa {

/// Counts over the cases flown so far, in any order. For display only: no verdict uses it.
struct RequirementStanding {
  std::string metric;       ///< without the prefix
  std::string requirement;  ///< in words
  std::int64_t n = 0;
  std::int64_t failures = 0;  ///< beyond the limit, undefined, or a lost flight
  /// From the exact binomial limits of these n cases alone: "pass", "fail" or "inconclusive". "study": the
  /// cases are chosen points, which give no verdict.
  std::string so_far;
};

/// A histogram of the flights completed so far.
struct MetricHistogram {
  std::string metric;
  std::size_t column = 0;
  RunningHistogram values;
  Limits limits;  ///< of its requirement: on a circle values are counted near to them
};

class RunningTally {
 public:
  explicit RunningTally(const Campaign& campaign);

  /// Each case once.
  void Add(const CaseResult& result);
  std::vector<RequirementStanding> Standings() const;
  std::int64_t n() const { return n_; }
  const std::vector<Requirement>& requirements() const { return requirements_; }
  /// The histograms of KeyMetrics().
  const std::vector<MetricHistogram>& histograms() const { return histograms_; }

 private:
  std::vector<Requirement> requirements_;
  std::vector<std::size_t> columns_;  ///< of their metrics
  std::vector<std::int64_t> failures_;
  std::vector<MetricHistogram> histograms_;
  std::size_t metric_count_ = 0;  ///< of a result
  std::int64_t n_ = 0;
  bool independent_;
};

}  // namespace dispersa
