// Maps values to positions in a chart, and chooses the round numbers at its axis.
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
