// The limits that a requirement sets for a metric.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace dispersa {

/// A value meets the limits if it lies strictly between them. An undefined value (NaN) meets no limits.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  bool Meets(double value) const { return low < value && value < high; }
  /// Distance to the nearer limit, in the metric's unit: positive inside, negative outside, 0 at a limit.
  double Margin(double value) const { return std::min(value - low, high - value); }
  /// Whether one value is worse than another: its margin is smaller. Of a single limit the values are
  /// compared themselves, because margins to a limit far away round to the same number. What is no number is
  /// worse than any.
  bool IsWorse(double one, double other) const {
    if (!std::isfinite(one) || !std::isfinite(other)) return std::isfinite(other) && !std::isfinite(one);
    if (high == std::numeric_limits<double>::infinity()) return one < other;
    if (low == -std::numeric_limits<double>::infinity()) return one > other;
    return Margin(one) < Margin(other);
  }
};

}  // namespace dispersa
