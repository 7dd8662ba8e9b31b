#include "core/flight/attitude_program.h"

#include "core/math/functions.h"

namespace dispersa {

namespace {

struct ValueAndRate {
  double value;
  double rate;
};

ValueAndRate Hermite(double y0, double r0, double y1, double r1, double h, double s) {
  const double d = y1 - y0;
  const double a = h * r0 - d;
  const double b = d - h * r1;
  // y = y0 + s d + s (1 - s) (a (1 - s) + b s)
  const double blend = a * (1.0 - s) + b * s;
  const double value = y0 + s * d + s * (1.0 - s) * blend;
  const double slope = d + (1.0 - 2.0 * s) * blend + s * (1.0 - s) * (b - a);
  return {value, slope / h};
}

std::size_t Find(const std::vector<AttitudeKnot>& knots, double time_s) {
  std::size_t low = 0, high = knots.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (time_s >= knots[middle].time_s ? low : high) = middle;
  }
  return low;
}

}  // namespace

ReferenceAttitude AttitudeProgram::At(double time_s) const {
  const std::size_t i = Find(knots, time_s);
  const AttitudeKnot& k0 = knots[i];
  const AttitudeKnot& k1 = knots[i + 1];
  const double h = k1.time_s - k0.time_s;
  const bool outside = time_s < k0.time_s || time_s > k1.time_s;
  const double s = Clamp((time_s - k0.time_s) / h, 0.0, 1.0);
  ValueAndRate pitch = Hermite(k0.pitch, k0.pitch_rate, k1.pitch, k1.pitch_rate, h, s);
  ValueAndRate yaw = Hermite(k0.yaw, k0.yaw_rate, k1.yaw, k1.yaw_rate, h, s);
  ValueAndRate roll = Hermite(k0.roll, k0.roll_rate, k1.roll, k1.roll_rate, h, s);
  if (outside) pitch.rate = yaw.rate = roll.rate = 0.0;
  ReferenceAttitude reference;
  reference.angles = {pitch.value, yaw.value, roll.value};
  reference.q_LR = FromPitchYawRoll(reference.angles);
  // w = pitch' y_L + yaw' z' + roll' x_R, in reference axes: with R = Ry Rz Rx.
  const Quaternion yaw_then_roll = FromPitchYawRoll({0.0, yaw.value, roll.value});
  const Quaternion only_roll = FromPitchYawRoll({0.0, 0.0, roll.value});
  reference.w_LR_R = Rotate(Inverse(yaw_then_roll), Vector3(0.0, pitch.rate, 0.0)) +
                     Rotate(Inverse(only_roll), Vector3(0.0, 0.0, yaw.rate)) + Vector3(roll.rate, 0.0, 0.0);
  return reference;
}

}  // namespace dispersa
