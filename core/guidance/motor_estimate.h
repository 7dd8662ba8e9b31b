// Thrust and flow of a burning motor, estimated from its sensed acceleration.
//
// At full thrust a = c q / (m0 - q t): c is the exhaust velocity, q the flow, t the time since ignition less
// half of the rise. So 1/a is a straight line over time, of slope -1/c through m0 / (c q) at t = 0. The line
// of least squares gives c and q. Until it has enough readings the motor counts as nominal. The readings of a
// motor with a thrust curve are on no line: it is estimated by its curve.
#pragma once

#include "core/guidance/curve_estimate.h"
#include "core/guidance/mission.h"

namespace dispersa {

class MotorEstimate {
 public:
  explicit MotorEstimate(const GuidedStage& nominal) : nominal_(nominal) {}

  /// GuidedStage's. The line of the lighter stage begins anew.
  void SeeLeft(unsigned bodies, double time_s);
  /// Adds a reading of the accelerometer. Readings outside full thrust are left out. `expelled_kg`: as in
  /// Stage, until now.
  void Add(double since_ignition_s, double specific_force_m_s2, double expelled_kg = 0.0);
  /// The stage as it burns. Thrust and flow stay within 15 % of nominal. `expelled_kg`: what its mass has
  /// lost to reaction control.
  GuidedStage Stage(double expelled_kg) const;

 private:
  GuidedStage nominal_;
  double count_ = 0.0, sum_t_ = 0.0, sum_y_ = 0.0, sum_tt_ = 0.0, sum_ty_ = 0.0;
  double first_s_ = 0.0, last_s_ = 0.0;
  CurveEstimate by_curve_;
};

/// The time since ignition at which an estimate is ready, from readings since a time, one a period; 0 for a
/// motor that is not estimated.
double StandsAfter(const GuidedStage& nominal, double first_s, double period_s);

}  // namespace dispersa
