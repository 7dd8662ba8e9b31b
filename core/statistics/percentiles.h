// Percentiles with what the sample says about them.
#pragma once

#include <string>
#include <vector>

#include "core/statistics/intervals.h"

namespace dispersa {

struct Percentile {
  std::string name;  ///< "p99_73"
  double probability = 0.0;
  double estimate =
      0.0;            ///< undefined where the sample does not reach so far: fewer than one value beyond it
  Interval limits{};  ///< two-sided, of any distribution; infinite where the sample gives none
};

inline constexpr double kPercentileConfidence = 0.95;

/// The percentiles that reports show, from values in increasing order.
std::vector<Percentile> Percentiles(const std::vector<double>& sorted_values);

/// Sample skewness g1 (third central moment over the 3/2 power of the second); undefined without spread.
double Skewness(const std::vector<double>& sorted_values);

}  // namespace dispersa
