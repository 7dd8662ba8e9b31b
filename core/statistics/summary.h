// The statistics of one metric over the cases, as tables show them.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/math/circle.h"

namespace dispersa {

/// A number that the data do not define; files have null for it.
inline constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

/// Statistics of a metric's defined (finite) values, in the metric's unit. kUndefined if there are too few
/// values.
struct Summary {
  std::size_t n = 0;          ///< defined values
  std::size_t undefined = 0;  ///< values that are not finite; nothing below includes them
  double mean = kUndefined;
  double std = kUndefined;  ///< sample standard deviation, divisor n - 1
  double min = kUndefined;
  double max = kUndefined;
  double p00_135 = kUndefined;  ///< quantiles, see Quantile(): 0.135 %, -3 sigma of a normal distribution
  double p01 = kUndefined;
  double p05 = kUndefined;
  double p50 = kUndefined;
  double p95 = kUndefined;
  double p99 = kUndefined;
  double p99_73 = kUndefined;
  double p99_865 = kUndefined;  ///< +3 sigma of a normal distribution
};

/// `sorted` comes from SortedFinite(), which left out `undefined` values.
Summary SummarizeSorted(const std::vector<double>& sorted, std::size_t undefined);

/// The order of `values` does not change a bit of the result: they are sorted, and summed with compensation.
Summary Summarize(std::vector<double> values);
/// The same of a quantity on a circle, unwrapped about its centre, so that values may go on beyond the cut.
/// If the values lie all around, nothing but their number is defined.
Summary Summarize(std::vector<double> values, const Circle& circle);
inline bool IsAllAround(const Summary& summary) { return summary.n > 0 && std::isnan(summary.mean); }

/// The finite values in increasing order; -0 becomes 0.
std::vector<double> SortedFinite(std::vector<double> values);

/// Mean of values in increasing order. It never lies outside the smallest and the largest. kUndefined without
/// values.
double Mean(const std::vector<double>& sorted_values);

/// Quantile of sorted values, linear between order statistics: the smallest value at 0, the largest at 1.
/// This is type 7 of Hyndman and Fan (The American Statistician 50 (1996) 361-365), the default of R and
/// NumPy. The estimate has no confidence limits; requirements use order_statistics.h. NaN without values.
double Quantile(const std::vector<double>& sorted_values, double probability);

}  // namespace dispersa
