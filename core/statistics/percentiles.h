// Percentiles with confidence limits from the sample.
#pragma once

#include <string>
#include <vector>

#include "core/statistics/intervals.h"

namespace dispersa {

struct Percentile {
  std::string name;  ///< "p99_73"
  double probability = 0.0;
  double estimate = 0.0;  ///< undefined if fewer than one value of the sample lies beyond the percentile
  Interval limits{};      ///< two-sided, for any distribution; infinite if the sample gives no limit
};

inline constexpr double kPercentileConfidence = 0.95;

/// The percentiles that reports show, from values in increasing order.
std::vector<Percentile> Percentiles(const std::vector<double>& sorted_values);

/// Sample skewness g1: the third central moment over the 3/2 power of the second. Undefined without spread.
double Skewness(const std::vector<double>& sorted_values);

}  // namespace dispersa
