// The limits that a requirement sets to a metric.
#pragma once

#include <algorithm>
#include <limits>

namespace dispersa {

/// Met strictly between both; an undefined value meets none.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  bool Meets(double value) const { return low < value && value < high; }
  /// How far inside, in the metric's unit; negative outside, 0 at a limit.
  double Margin(double value) const { return std::min(value - low, high - value); }
};

}  // namespace dispersa
