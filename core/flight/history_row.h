// Rows of histories of W flights side by side (core/math/lanes.h): at the lanes' ticks for histories and a
// campaign's own metrics, one lane for an event or a scenario. history_columns.h names the columns.
#pragma once

#include "core/dynamics/launcher_body.h"
#include "core/environment/surroundings.h"
#include "core/flight/history_columns.h"
#include "core/flight/standing.h"
#include "core/math/constants.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// What a row shows of any body.
template <class T>
struct BodySeen {
  T time_s;
  RigidMotion<T> motion;
  Vector<T> v_AB_B;  ///< through the air
  T mach, qbar_pa, mass_kg;
};

/// What it shows of a launcher besides.
template <class T>
struct LauncherSeen : BodySeen<T> {
  T stage;                     ///< from 1
  MaskOf<T> burning, steered;  ///< values of the autopilot are undefined elsewhere
  T thrust_n;
  Vector<T> force_n;    ///< all but gravitation, body axes
  Matrix<double> R_IL;  ///< of the launch axes
  T program_pitch_rad;
  AttitudeErrors<T> errors;
  T felt_pitch_rad, felt_yaw_rad, felt_roll_rad;  ///< commands that the nozzles stand for
  T nozzle_rad[kNozzles];
  T command_pitch_rad;
  T control_rad_s2, adaptation_norm_rad_s2, v, v_rate_sign, projected, frozen, rules_fired, total_gain;
  T thruster_roll, thruster_pitch, thruster_yaw;
  T expelled_kg;
  T law_telemetry[kLawTelemetry];
};

/// Angles of a matrix by a middle angle with this sine: `is_singular` where the outer two cannot be told
/// apart.
template <class T>
struct MiddleAngle {
  T sine;
  MaskOf<T> is_singular;
  explicit DISPERSA_INLINE MiddleAngle(T s)
      : sine(Clamp(s, T(-1.0), T(1.0))), is_singular(T(1.0) - Abs(sine) < T(kSingularSine)) {}
};

/// `row`: kBodyColumns values, of which those that are `read` are set.
template <class T>
DISPERSA_OUT_OF_LINE void FillBody(const Earth& earth, const BodySeen<T>& s, RowColumns read, T* row) {
  const T degrees(kDegPerRad), none(0.0);
  const auto reads = [read](int column) { return (read >> column & 1u) != 0; };
  const RigidMotion<T>& m = s.motion;
  row[0] = s.time_s;
  row[1] = m.p.x;
  row[2] = m.p.y;
  row[3] = m.p.z;
  row[4] = m.v.x;
  row[5] = m.v.y;
  row[6] = m.v.z;
  const bool has_place = kPlaceColumns.IsRead(read);
  const bool has_velocity = kLocalVelocity.IsRead(read), has_attitude = kLocalAttitude.IsRead(read);
  if (has_place || has_velocity || has_attitude) {
    const Place<T> place = PlaceAt(earth, m.p);
    row[10] = place.altitude_m;
    if (reads(11)) row[11] = Atan2(place.sin_latitude, place.cos_latitude) * degrees;
    if (reads(12)) {
      const T turn = T(earth.rotation_rate_rad_s) * s.time_s;
      const T c = Cos(turn), sine = Sin(turn);
      row[12] = Atan2(c * m.p.y - sine * m.p.x, c * m.p.x + sine * m.p.y) * degrees;
    }
    if (has_velocity || has_attitude) {
      const auto is_off_axis = place.axis_distance_m > none;
      const T inverse = T(1.0) / Select(is_off_axis, place.axis_distance_m, T(1.0));
      const T c = Select(is_off_axis, m.p.x * inverse, T(1.0)), sine = m.p.y * inverse;
      const T sp = place.sin_latitude, cp = place.cos_latitude;
      const Vector<T> north{-sp * c, -sp * sine, cp}, east{-sine, c, none}, down{-cp * c, -cp * sine, -sp};
      const T omega(earth.rotation_rate_rad_s);
      const Vector<T> v{m.v.x + omega * m.p.y, m.v.y - omega * m.p.x, m.v.z};
      row[7] = Dot(north, v);
      row[8] = Dot(east, v);
      row[9] = Dot(down, v);
      const Matrix<T> R_IB = RotationMatrix(m.q);
      const Vector<T> n = TransposeTimes(R_IB, north), e = TransposeTimes(R_IB, east),
                      d = TransposeTimes(R_IB, down);
      const MiddleAngle<T> pitch(-d.x);
      const T sign = Select(pitch.sine > none, T(1.0), T(-1.0));
      if (reads(13)) row[13] = Select(pitch.is_singular, none, Atan2(e.x, n.x) * degrees);
      if (reads(14)) row[14] = Atan2(pitch.sine, Sqrt(Fma(n.x, n.x, e.x * e.x))) * degrees;
      if (reads(15)) row[15] = Select(pitch.is_singular, Atan2(sign * n.y, e.y), Atan2(d.y, d.z)) * degrees;
    }
  }
  row[16] = m.w.x * degrees;
  row[17] = m.w.y * degrees;
  row[18] = m.w.z * degrees;
  row[19] = s.mach;
  row[20] = s.qbar_pa;
  if (kFlowAngles.IsRead(read)) {
    const Vector<T>& v = s.v_AB_B;
    row[21] = Atan2(v.z, v.x) * degrees;
    row[22] = Atan2(v.y, Sqrt(Fma(v.x, v.x, v.z * v.z))) * degrees;
  }
  row[23] = s.mass_kg;
}

/// `row`: kBodyColumns + kLauncherColumns values, of which those that are `read` are set.
template <class T>
DISPERSA_OUT_OF_LINE void FillLauncher(const Earth& earth, const LauncherSeen<T>& s, RowColumns read,
                                       T* row) {
  FillBody<T>(earth, s, read, row);
  T* const o = row + kBodyColumns;
  const T degrees(kDegPerRad), none(0.0), undefined(__builtin_nan(""));
  const auto powered = s.burning & s.steered;
  const RigidMotion<T>& m = s.motion;
  o[0] = s.stage;
  o[1] = s.thrust_n;
  if (kOrbitColumns.IsRead(read)) {
    const Vector<T> h = Cross(m.p, m.v);
    o[2] = Sqrt(Dot(m.v, m.v));
    o[3] = Atan2(Dot(m.p, m.v), Sqrt(Dot(h, h))) * degrees;
  }
  if (kProgramPitch.IsRead(read)) o[4] = Select(s.steered, s.program_pitch_rad * degrees, undefined);
  if (kLaunchPitch.IsRead(read)) {
    const Matrix<T> R_IB = RotationMatrix(m.q);
    // The body's x axis along an axis of L.
    const auto along = [&](int axis) {
      const Vector<double>* const L = s.R_IL.row;
      return Fma(T(L[0][axis]), R_IB.row[0].x,
                 Fma(T(L[1][axis]), R_IB.row[1].x, T(L[2][axis]) * R_IB.row[2].x));
    };
    const MiddleAngle<T> yaw(along(1));
    o[5] = Select(yaw.is_singular, none, Atan2(-along(2), along(0))) * degrees;
  }
  if (kSteered.IsRead(read)) {
    const T steered[] = {-s.errors.angle_rad.y,  -s.errors.angle_rad.z, -s.errors.angle_rad.x,
                         -s.errors.rate_rad_s.y, s.felt_pitch_rad,      s.felt_yaw_rad,
                         s.felt_roll_rad,        s.nozzle_rad[0],       s.nozzle_rad[1],
                         s.nozzle_rad[2],        s.nozzle_rad[3]};
    for (int i = 0; i < 11; ++i) o[6 + i] = Select(s.steered, steered[i] * degrees, undefined);
  }
  if (kLawColumns.IsRead(read)) {
    const T law[] = {s.command_pitch_rad * degrees,
                     s.control_rad_s2 * degrees,
                     s.adaptation_norm_rad_s2 * degrees,
                     s.v,
                     s.v_rate_sign,
                     s.projected,
                     s.frozen,
                     s.rules_fired,
                     s.total_gain};
    for (int i = 0; i < 9; ++i) o[17 + i] = Select(powered, law[i], undefined);
  }
  if (kThrusters.IsRead(read)) {
    o[26] = s.thruster_roll;
    o[27] = s.thruster_pitch;
    o[28] = s.thruster_yaw;
  }
  o[29] = s.expelled_kg;
  if (kLoadColumns.IsRead(read)) {
    const T weight = s.mass_kg * T(kStandardGravity);
    o[30] = s.force_n.x / weight;
    o[31] = Sqrt(Fma(s.force_n.y, s.force_n.y, s.force_n.z * s.force_n.z)) / weight;
  }
  if (kIncidence.IsRead(read)) {
    const Vector<T>& v = s.v_AB_B;
    o[32] = Atan2(Sqrt(Fma(v.y, v.y, v.z * v.z)), v.x) * degrees;
  }
  for (int i = 0; kToldByLaw.IsRead(read) && i < kLawTelemetry; ++i)
    o[33 + i] = Select(powered, s.law_telemetry[i], undefined);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
