#include "core/trajectory/ascent_record.h"

#include <cmath>

#include "core/flight/sequence.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/rotation.h"

namespace dispersa {

namespace {

PitchYawRoll AnglesOf(const LaunchFrame& frame, const lanes::Ground& ground, const AscentPoint& point) {
  return ToPitchYawRoll(QuaternionOf(frame.R_IL.transpose() * AttitudeOf(frame, ForwardOf(ground, point))));
}

AscentPoint Beside(AscentPoint point, double dt, const lanes::Vector<double>& acceleration) {
  lanes::MoveBy(dt, acceleration, &point.p, &point.v);
  point.time_s += dt;
  return point;
}

// The rates are derivatives of the program along the motion, not of the recorded table.
AttitudeKnot KnotOf(const LaunchFrame& frame, const lanes::Ground& ground, const AscentPoint& point,
                    const lanes::Vector<double>& acceleration) {
  const PitchYawRoll before = AnglesOf(frame, ground, Beside(point, -lanes::kDifference_s, acceleration));
  const PitchYawRoll now = AnglesOf(frame, ground, point);
  const PitchYawRoll after = AnglesOf(frame, ground, Beside(point, lanes::kDifference_s, acceleration));
  const auto rate = [&](double PitchYawRoll::*angle) {
    return std::remainder(after.*angle - before.*angle, kTwoPi) / (2.0 * lanes::kDifference_s);
  };
  return {point.time_s,
          now.pitch,
          now.yaw,
          now.roll,
          rate(&PitchYawRoll::pitch),
          rate(&PitchYawRoll::yaw),
          rate(&PitchYawRoll::roll)};
}

}  // namespace

lanes::AscentInstant<double> InstantOf(const lanes::Ground& ground, const AscentPoint& point) {
  return lanes::InstantAt(ground, point.leg, point.time_s, point.p, point.v);
}

lanes::Vector<double> ForwardOf(const lanes::Ground& ground, const AscentPoint& point) {
  return lanes::ForwardAt(ground, point.leg, point.time_s, point.p, point.v);
}

lanes::Vector<double> AxisRateOf(const lanes::Ground& ground, const AscentPoint& point) {
  return lanes::AxisRateAt(ground, point.leg, point.time_s, point.p, point.v,
                           InstantOf(ground, point).acceleration_I);
}

Matrix3 AttitudeOf(const LaunchFrame& frame, const lanes::Vector<double>& forward_I) {
  const Vector3 forward = ToEigen(forward_I);
  const Vector3 right_I = frame.R_IL.col(1);
  const Vector3 right = (right_I - right_I.dot(forward) * forward).normalized();
  Matrix3 R_IB;
  R_IB.col(0) = forward;
  R_IB.col(1) = right;
  R_IB.col(2) = forward.cross(right);
  return R_IB;
}

void Record(const LaunchFrame& frame, const lanes::Ground& ground, const AscentPoint& point,
            const lanes::AscentInstant<double>& now, AscentResult* result) {
  const Vector3 p = ToEigen(point.p), v = ToEigen(point.v);
  const Vector3 relative = ToEigen(lanes::VelocityOverGround(ground, point.p, point.v));
  const PitchYawRoll angles = AnglesOf(frame, ground, point);
  AscentSample s;
  s.time_s = point.time_s;
  s.stage = point.stage;
  s.altitude_m = now.altitude_m;
  s.velocity_m_s = v.norm();
  s.relative_velocity_m_s = relative.norm();
  s.flight_path_angle_rad = Atan2(p.dot(v), p.cross(v).norm());
  s.relative_path_angle_rad = Atan2(p.dot(relative), p.cross(relative).norm());
  s.alpha_rad = lanes::IncidenceAt(point.leg.program, point.time_s);
  if (point.leg.any_steers && point.time_s >= point.leg.program.t2_s)
    s.alpha_rad += lanes::SteeringAt(point.leg, point.time_s);
  s.pitch_rad = angles.pitch;
  s.yaw_rad = angles.yaw;
  s.roll_rad = angles.roll;
  s.mach = now.mach;
  s.qbar_pa = now.qbar_pa;
  s.axial_load_g = now.axial_n / (now.mass_kg * kStandardGravity);
  s.mass_kg = now.mass_kg;
  s.p_EoC_I = p;
  s.v_IC_I = v;
  result->samples.push_back(s);
  std::vector<AttitudeKnot>& knots = result->attitude.knots;
  if (!knots.empty() && point.time_s <= knots.back().time_s + kSameInstant_s) return;
  AttitudeKnot knot = KnotOf(frame, ground, point, now.acceleration_I);
  // Angles are interpolated between knots. In a long coast they may turn by more than half a turn, so they
  // are unwrapped.
  if (!knots.empty())
    for (double AttitudeKnot::*angle : {&AttitudeKnot::pitch, &AttitudeKnot::yaw, &AttitudeKnot::roll})
      while (std::fabs(knot.*angle - knots.back().*angle) > kPi)
        knot.*angle += std::copysign(kTwoPi, knots.back().*angle - knot.*angle);
  knots.push_back(knot);
}

}  // namespace dispersa
