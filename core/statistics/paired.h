// Comparison of two designs on the same cases.
#pragma once

#include <cstddef>
#include <vector>

#include "core/statistics/intervals.h"
#include "core/statistics/summary.h"

namespace dispersa {

/// The change of a metric from a to b, pair by pair. Less is better.
///
/// An undefined value (a lost flight) is infinitely bad, so that no pair is dropped. If only b lost, the
/// difference is infinity; if only a lost, it is -infinity; if both lost, they are equal. Intervals are order
/// statistics of the pairs, valid for any distribution. Without pairs every number is undefined.
struct PairedDifference {
  std::size_t n = 0;       ///< pairs
  std::size_t worse = 0;   ///< b > a, or only b undefined
  std::size_t better = 0;  ///< b < a, or only a undefined
  std::size_t equal = 0;
  std::size_t lost_a = 0;  ///< undefined values in a, with any value in b
  std::size_t lost_b = 0;
  double median_difference = kUndefined;  ///< of b - a
  Interval difference_interval{kUndefined, kUndefined};
  double median_ratio =
      kUndefined;  ///< of b / a; ratio and its interval are undefined unless all values are positive
  Interval ratio_interval{kUndefined, kUndefined};
  double sign_test_p =
      kUndefined;  ///< exact, two-sided, for "worse is as likely as better"; equal pairs are left out
};

/// a[i] and b[i] belong to the same case; both vectors have the same length.
PairedDifference ComparePaired(const std::vector<double>& a, const std::vector<double>& b, double confidence);

}  // namespace dispersa
