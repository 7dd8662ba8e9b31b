// How the requirements of a campaign that is being flown stand.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/case_result.h"

namespace dispersa {

/// Of the cases flown so far, in whatever order they came: a figure to watch, on which no verdict rests.
struct RequirementStanding {
  std::string metric;       ///< without the prefix
  std::string requirement;  ///< RequirementLine()
  std::int64_t n = 0;
  std::int64_t failures = 0;  ///< beyond the limit, undefined, or a lost flight
  /// What the exact binomial limits of these n cases alone say: "pass", "fail", "inconclusive"; "study" of
  /// chosen points, which give no verdict.
  std::string so_far;
};

class RunningTally {
 public:
  explicit RunningTally(const Campaign& campaign);

  /// Each case once.
  void Add(const CaseResult& result);
  std::vector<RequirementStanding> Standings() const;

 private:
  std::vector<Requirement> requirements_;
  std::vector<std::size_t> columns_;  ///< of their metrics
  std::vector<std::int64_t> failures_;
  std::int64_t n_ = 0;
  bool independent_;
};

}  // namespace dispersa
