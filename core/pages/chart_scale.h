// From values to positions in a chart, and the round numbers to write along its edge.
#pragma once

#include <string>
#include <vector>

#include "core/pages/svg_chart.h"

namespace dispersa {

struct Tick {
  double value;
  std::string label;
};

class ChartScale {
 public:
  /// `low` and `high`: range of the data, which the axis's own ends replace; positions run from `from` to
  /// `to`. Linear ranges without given ends widen to round numbers.
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
