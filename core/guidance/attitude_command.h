// The attitude command of the autopilot. It follows the wish of guidance with limited rate and acceleration.
#pragma once

#include "core/guidance/mission.h"
#include "core/math/rotation.h"

namespace dispersa {

/// Angles in L (2-3-1), rad, with their rates and, over the last step, accelerations.
class AttitudeCommand {
 public:
  void Start(double time_s, const Direction& at, const Direction& rate);
  /// To a time not before the last one: towards a wanted direction that moves with a rate.
  void Follow(double time_s, const Direction& wanted, const Direction& wanted_rate, double most_rate_rad_s,
              double most_acceleration_rad_s2);

  /// The last step's end, carried on to a time by its rates.
  PitchYawRoll AnglesAt(double time_s) const;
  /// Angular velocity relative to L in the commanded body axes.
  Vector3 RateAt(double time_s) const;
  /// Mean angular acceleration over the last step, in the same axes, for small yaw and roll.
  Vector3 Acceleration() const { return {0.0, pitch_.acceleration, yaw_.acceleration}; }
  Direction direction() const { return {pitch_.angle, yaw_.angle}; }

 private:
  struct Angle {
    double angle = 0.0, rate = 0.0, acceleration = 0.0;
    void Follow(double step_s, double wanted, double wanted_rate, double most_rate, double most_acceleration);
  };
  double time_s_ = 0.0;
  Angle pitch_, yaw_;
};

}  // namespace dispersa
