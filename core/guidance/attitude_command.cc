#include "core/guidance/attitude_command.h"

#include <cmath>

#include "core/math/functions.h"

namespace dispersa {

namespace {
// Near its goal the command is a critically damped second-order filter, s² + 4 s + 4: a plan that moves a
// little asks a little of the gimbals.
constexpr double kClosing_1_s = 1.0;
constexpr double kHastening_1_s = 4.0;
}  // namespace

// A bounded acceleration can still brake a rate of √(2 a |e|) on the way left. Half of it leaves room for the
// filter's delay.
void AttitudeCommand::Angle::Follow(double step_s, double wanted, double wanted_rate, double most_rate,
                                    double most_acceleration) {
  const double left = wanted - angle;
  const double closing = std::fmin(Sqrt(most_acceleration * std::fabs(left)), kClosing_1_s * std::fabs(left));
  const double goal = Clamp(wanted_rate + std::copysign(closing, left), -most_rate, most_rate);
  acceleration = Clamp(kHastening_1_s * (goal - rate), -most_acceleration, most_acceleration);
  const double change = step_s * acceleration;
  angle += step_s * (rate + 0.5 * change);
  rate += change;
}

void AttitudeCommand::Start(double time_s, const Direction& at, const Direction& rate) {
  time_s_ = time_s;
  pitch_ = {at.pitch_rad, rate.pitch_rad, 0.0};
  yaw_ = {at.yaw_rad, rate.yaw_rad, 0.0};
}

void AttitudeCommand::Follow(double time_s, const Direction& wanted, const Direction& wanted_rate,
                             double most_rate_rad_s, double most_acceleration_rad_s2) {
  const double step_s = time_s - time_s_;
  if (!(step_s > 0.0)) return;
  pitch_.Follow(step_s, wanted.pitch_rad, wanted_rate.pitch_rad, most_rate_rad_s, most_acceleration_rad_s2);
  yaw_.Follow(step_s, wanted.yaw_rad, wanted_rate.yaw_rad, most_rate_rad_s, most_acceleration_rad_s2);
  time_s_ = time_s;
}

PitchYawRoll AttitudeCommand::AnglesAt(double time_s) const {
  const double since = time_s - time_s_;
  return {pitch_.angle + since * pitch_.rate, yaw_.angle + since * yaw_.rate, 0.0};
}

// w = pitch' y_L + yaw' z' in the axes after both turns: with R = Ry Rz.
Vector3 AttitudeCommand::RateAt(double time_s) const {
  const SinCos yaw = SineCosine(AnglesAt(time_s).yaw);
  return {pitch_.rate * yaw.sin, pitch_.rate * yaw.cos, yaw_.rate};
}

}  // namespace dispersa
