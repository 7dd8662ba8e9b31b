// What a table shows of one metric over the cases.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace dispersa {

/// A number that the data do not define; written out as null.
inline constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

/// Statistics of a metric's defined (finite) values; kUndefined where there are too few of them.
struct Summary {
  std::size_t n = 0;          ///< defined values
  std::size_t undefined = 0;  ///< values that are not finite, left out of everything below
  double mean = kUndefined;
  double std = kUndefined;  ///< sample standard deviation, divisor n - 1
  double min = kUndefined;
  double max = kUndefined;
  double p00_135 = kUndefined;  ///< quantiles, see Quantile(): 0.135 %, the normal's -3 sigma
  double p01 = kUndefined;
  double p05 = kUndefined;
  double p50 = kUndefined;
  double p95 = kUndefined;
  double p99 = kUndefined;
  double p99_73 = kUndefined;
  double p99_865 = kUndefined;  ///< the normal's +3 sigma
};

/// Of values that SortedFinite() gave; `undefined` were left out.
Summary SummarizeSorted(const std::vector<double>& sorted, std::size_t undefined);

/// The result's bits do not depend on the order of `values`: they are sorted, and summed with compensation.
Summary Summarize(std::vector<double> values);

/// The finite values in increasing order; -0 becomes 0.
std::vector<double> SortedFinite(std::vector<double> values);

/// Of values in increasing order; never beyond the least and the largest. kUndefined without values.
double Mean(const std::vector<double>& sorted_values);

/// Quantile of sorted values: linear between order statistics, the smallest at 0 and the largest at 1 (type 7
/// of Hyndman and Fan, The American Statistician 50 (1996) 361-365, the default of R and NumPy). An estimate
/// without a confidence: requirements use order_statistics.h. NaN without values.
double Quantile(const std::vector<double>& sorted_values, double probability);

}  // namespace dispersa
