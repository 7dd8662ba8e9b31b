// Maps values to positions in a chart, and chooses the round numbers at its axis.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/pages/svg_chart.h"

namespace dispersa {

/// From the least to the largest of the values added. Empty: low > high.
struct ChartRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Add(double value, bool positive_only) {
    if (!std::isfinite(value) || (positive_only && value <= 0.0)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void Add(const std::vector<double>& values, bool positive_only) {
    for (const double value : values) Add(value, positive_only);
  }
};

struct Tick {
  double value;
  std::string label;
};

class ChartScale {
 public:
  /// `low` and `high` are the range of the data; ends given by the axis replace them. Positions run from
  /// `from` to `to`. A linear range without given ends is widened to round numbers.
  ChartScale(const ChartAxis& axis, double low, double high, double from, double to, int about_ticks);

  double At(double value) const;
  double low() const { return low_; }
  double high() const { return high_; }
  const std::vector<Tick>& ticks() const { return ticks_; }

 private:
  void LinearTicks(const ChartAxis& axis, int about_ticks);
  void LogarithmicTicks(const ChartAxis& axis, int about_ticks);

  bool logarithmic_;
  double low_;
  double high_;
  double from_;
  double to_;
  std::vector<Tick> ticks_;
};

}  // namespace dispersa
