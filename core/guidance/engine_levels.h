// Thrust of an engine that guidance cuts off: its commanded level over the time since ignition, for a burn of
// any duration.
#pragma once

#include <vector>

#include "core/vehicle/motor.h"

namespace dispersa {

class EngineLevels {
 public:
  /// Full thrust for a throttle without points.
  explicit EngineLevels(const Throttle& throttle);

  /// Part of full thrust and flow. The last level of the throttle holds.
  double At(double since_ignition_s) const;
  /// Its integral since ignition, s: the time that full thrust would burn as much.
  double Sum(double since_ignition_s) const;
  /// The time at which Sum() is `sum_s`. If the throttle comes to 0 before, the time at which it does.
  double TimeOf(double sum_s) const;
  /// Times at which the level bends: no integration step may go across.
  const std::vector<double>& bends_s() const { return bends_s_; }

 private:
  struct Piece {
    double begin_s, level, slope_1_s, sum_s;
  };
  const Piece& PieceAt(double since_ignition_s) const;
  std::vector<Piece> pieces_;
  std::vector<double> bends_s_;
};

}  // namespace dispersa
