// When a campaign that stops by itself stops: at a look at which every requirement is decided.
#pragma once

#include <cstdint>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"
#include "core/results/case_columns.h"
#include "core/statistics/planned_verdict.h"

namespace dispersa {

/// The number of cases to fly. Without `stop: when_decided` it is all of them. With it, it is the cases up to
/// a look. When each of those has a result or is quarantined, it is those up to the next look, until every
/// requirement is decided. So it depends on neither the order nor the number of workers.
class StoppingRule {
 public:
  /// `planned` and `past_looks` as for JudgingContext.
  StoppingRule(const Campaign& campaign, std::int64_t planned, std::vector<std::int64_t> past_looks);

  /// A result, in any order, each case once.
  void Add(const CaseResult& result);
  /// Results in columns.
  void Add(const CaseColumns& cases);

  /// Cases 0 ... target - 1 are to be flown.
  std::uint64_t target() const { return target_; }
  /// Whether every case below the target has a result or is among the `quarantined`.
  bool Settled(const std::vector<std::uint64_t>& quarantined) const;
  /// When settled: sets the target to the next look unless the requirements are decided or no look is left.
  /// True if it moved.
  bool Advance(const std::vector<std::uint64_t>& quarantined);

 private:
  void Add(std::uint64_t case_index, bool completed, const std::vector<double>& requirement_values);
  bool Decided(const std::vector<std::uint64_t>& quarantined) const;

  std::vector<Requirement> requirements_;
  std::vector<std::size_t> columns_;  ///< of the requirements' metrics
  bool holm_;
  bool stops_;
  std::int64_t planned_;
  std::vector<std::int64_t> past_looks_;
  std::vector<std::uint64_t> looks_;  ///< ascending; the last is the number of cases
  std::uint64_t target_;
  std::vector<std::uint64_t> present_;             ///< in the order of arrival
  std::vector<std::vector<std::int64_t>> failed_;  ///< of each requirement, in the order of arrival
};

}  // namespace dispersa
