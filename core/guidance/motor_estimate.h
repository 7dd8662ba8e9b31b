// What a burning motor really does, from its sensed acceleration.
//
// At full thrust a = c q / (m0 - q t), c the exhaust velocity, q the flow, t the time since ignition less
// half of the rise: 1/a is a straight line over time, of slope -1/c through m0 / (c q) at t = 0. The line of
// least squares gives both; until it has enough to go by the motor is nominal. So is one with a thrust curve
// or a throttle all the time, whose readings lie on no line: what its burn rate did shows in the state alone.
#pragma once

#include "core/guidance/mission.h"

namespace dispersa {

class MotorEstimate {
 public:
  explicit MotorEstimate(const GuidedStage& nominal) : nominal_(nominal) {}

  /// A reading of the accelerometer; those outside full thrust are left out.
  void Add(double since_ignition_s, double specific_force_m_s2);
  /// The stage as it burns. Thrust and flow stay within 15 % of nominal. `expelled_kg`: what its mass has
  /// lost to reaction control.
  GuidedStage Stage(double expelled_kg) const;

 private:
  GuidedStage nominal_;
  double count_ = 0.0, sum_t_ = 0.0, sum_y_ = 0.0, sum_tt_ = 0.0, sum_ty_ = 0.0;
  double first_s_ = 0.0, last_s_ = 0.0;
};

/// The time since ignition at which an estimate stands of readings from a time on, one a period; 0 of a motor
/// that is not estimated.
double StandsAfter(const GuidedStage& nominal, double first_s, double period_s);

}  // namespace dispersa
