// Comparison of two designs on the same cases.
#pragma once

#include <cstddef>
#include <vector>

#include "core/statistics/intervals.h"
#include "core/statistics/summary.h"

namespace dispersa {

/// How a metric of which less is better changes from a to b, pair by pair.
///
/// An undefined value (a lost flight) is infinitely bad, so that no pair is dropped: a pair that only b lost
/// has the difference infinity, one that only a lost -infinity, one that both lost is equal. Intervals are
/// order statistics of the pairs, valid for any distribution. Without pairs every number is undefined.
struct PairedDifference {
  std::size_t n = 0;       ///< pairs
  std::size_t worse = 0;   ///< b > a, or only b undefined
  std::size_t better = 0;  ///< b < a, or only a undefined
  std::size_t equal = 0;
  std::size_t lost_a = 0;  ///< undefined in a, whether or not in b
  std::size_t lost_b = 0;
  double median_difference = kUndefined;  ///< of b - a
  Interval difference_interval{kUndefined, kUndefined};
  double median_ratio = kUndefined;  ///< of b / a; undefined, as its interval, unless all values are positive
  Interval ratio_interval{kUndefined, kUndefined};
  double sign_test_p = kUndefined;  ///< exact, two-sided: worse as likely as better, equal left out
};

/// a[i] and b[i] belong to the same case; as many of each.
PairedDifference ComparePaired(const std::vector<double>& a, const std::vector<double>& b, double confidence);

}  // namespace dispersa
