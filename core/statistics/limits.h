// The limits that a requirement sets for a metric.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/circle.h"

namespace dispersa {

/// A value meets the limits if it lies strictly between them. An undefined value (NaN) meets no limits.
///
/// On a circle a value counts by its representation nearest to the limit, of a range to its middle. So "above
/// 179.9" is met by all that lies up to half a turn to the east of 179.9, also by -179.9.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  Circle circle = {};

  /// The representation that is held against the limits.
  double Represented(double value) const {
    if (!circle.is_closed()) return value;
    return NearTo(std::isinf(low) ? high : std::isinf(high) ? low : 0.5 * (low + high), value, circle);
  }
  bool Meets(double value) const {
    const double is = Represented(value);
    return low < is && is < high;
  }
  /// Distance to the nearer limit, in the metric's unit: positive inside, negative outside, 0 at a limit.
  double Margin(double value) const {
    const double is = Represented(value);
    return std::min(is - low, high - is);
  }
  /// The limit that a value stands beside: the nearer one.
  double Beside(double value) const { return value - low < high - value ? low : high; }
  /// Whether one value is worse than another: its margin is smaller. Of a single limit the values are
  /// compared themselves, because margins to a limit far away round to the same number. What is no number is
  /// worse than any.
  bool IsWorse(double one, double other) const {
    if (!std::isfinite(one) || !std::isfinite(other)) return std::isfinite(other) && !std::isfinite(one);
    one = Represented(one), other = Represented(other);
    if (high == std::numeric_limits<double>::infinity()) return one < other;
    if (low == -std::numeric_limits<double>::infinity()) return one > other;
    return Margin(one) < Margin(other);
  }
};

}  // namespace dispersa
