// The range of allowed numbers of an input.
#pragma once

#include <limits>
#include <string>

namespace dispersa {

/// Finite numbers between two limits, each inside or outside of the range.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  bool Contains(double value) const;
  Range Less(double offset) const { return {low - offset, high - offset, low_open, high_open}; }
  /// "a number above 0", with the limits divided by `scale`.
  std::string Text(double scale = 1.0) const;
};

inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{0.0, std::numeric_limits<double>::infinity(), true, false};
inline constexpr Range kNonNegative{0.0, std::numeric_limits<double>::infinity(), false, false};
constexpr Range Between(double low, double high) { return {low, high, false, false}; }
constexpr Range Inside(double low, double high) { return {low, high, true, true}; }
/// Above 0, to `high`.
constexpr Range UpTo(double high) { return {0.0, high, true, false}; }

}  // namespace dispersa
