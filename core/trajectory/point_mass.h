// The point mass of the 3DOF ascent, W of them side by side (core/math/lanes.h): direction of its axis,
// acceleration, and one step of its motion.
#pragma once

#include "core/dynamics/launcher_lanes.h"
#include "core/environment/surroundings.h"
#include "core/math/lane_vector.h"
#include "core/trajectory/reference.h"
#include "core/vehicle/burning_stack.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Values that all lanes share: the Earth, and the site's vertical at lift-off in I.
struct Ground {
  Earth earth;
  Vector<double> up_I;
};

/// FlightProgram with precomputed reciprocals.
template <class T>
struct PreparedProgram {
  T alpha_max_rad, t1_s, t3_s, t2_s;
  T inverse_fall_1_s, inverse_rise_1_s;  ///< 1 / (t3 - t1), 1 / (t2 - t3)
};
DISPERSA_INLINE PreparedProgram<double> Prepared(const FlightProgram& program) {
  return {program.alpha_max_rad,
          program.t1_s,
          program.t3_s,
          program.t2_s,
          1.0 / (program.t3_s - program.t1_s),
          1.0 / (program.t2_s - program.t3_s)};
}

/// Values that stay constant between two events of a lane.
template <class T>
struct Leg {
  PreparedProgram<T> program;
  FlownWeather<T> weather;
  BurningStack<T> stack;
  BurningMotor<T> burn;
  BodyInFlow<T> aero;
  bool has_boosters;  ///< of the vehicle
  BesideStage<T> beside;
  MaskOf<T> burning, burnt, boosting;
  T ignition_s;
  T expelled_kg;                           ///< by the reaction control
  MaskOf<T> turning;                       ///< t1 is past
  Vector<T> right_I;                       ///< y axis of the launch frame
  Vector<T> turn_offset_I;                 ///< body axis minus direction of flight when the turn began
  bool any_steers;                         ///< the program of a lane has Steering:
  T steer_rad, steer_rad_s, steer_from_s;  ///< value at ignition, rate, ignition time
  T fade_rad, fade_from_s;                 ///< value at the end of the burn before, and its time
};

/// 10 s³ - 15 s⁴ + 6 s⁵: no rate or acceleration at 0 and 1.
template <class T>
DISPERSA_INLINE T SmoothStep(T s) {
  return s * s * s * Horner(s, 10.0, -15.0, 6.0);
}

/// ProgrammedIncidence of ascent.h.
template <class T>
DISPERSA_INLINE T IncidenceAt(const PreparedProgram<T>& program, T time_s) {
  const T s = Select(time_s < program.t3_s, (time_s - program.t1_s) * program.inverse_fall_1_s,
                     (program.t2_s - time_s) * program.inverse_rise_1_s);
  return T(0.0) - program.alpha_max_rad * SmoothStep(Clamp(s, T(0.0), T(1.0)));
}

/// Incidence of Steering. A phase that begins during the pitch-over sets in after it: the pitch-over's own
/// incidence ends at 0, from which it rises.
template <class T>
DISPERSA_INLINE T SteeringAt(const Leg<T>& leg, T time_s) {
  const T since = time_s - leg.steer_from_s;
  const T risen = time_s - Max(leg.steer_from_s, leg.program.t2_s);
  const T rise = SmoothStep(Clamp(risen * T(1.0 / kSteeringRise_s), T(0.0), T(1.0)));
  const T fade = SmoothStep(Clamp((time_s - leg.fade_from_s) * T(1.0 / kSteeringFade_s), T(0.0), T(1.0)));
  return Fma(rise, Fma(leg.steer_rad_s, since, leg.steer_rad), leg.fade_rad * (T(1.0) - fade));
}

template <class T>
DISPERSA_INLINE Vector<T> Normalized(Vector<T> a) {
  return T(1.0) / Max(Sqrt(Dot(a, a)), T(1e-30)) * a;
}

template <class T>
DISPERSA_INLINE Vector<T> VelocityOverGround(const Ground& ground, Vector<T> p, Vector<T> v) {
  const T omega(ground.earth.rotation_rate_rad_s);
  return {Fma(omega, p.y, v.x), Fma(-omega, p.x, v.y), v.z};
}

/// The body's x axis in I: the velocity over the ground, turned by the programmed incidence. In the vertical
/// flight it is the site's vertical, which turns with the Earth. When the turn begins, the two differ by a
/// small angle, which fades by t3.
template <class T>
DISPERSA_INLINE Vector<T> ForwardAt(const Ground& ground, const Leg<T>& leg, T time_s, Vector<T> p,
                                    Vector<T> v) {
  const Vector<T> along = Normalized(VelocityOverGround(ground, p, v));
  Vector<T> forward = along;
  const auto kicking = leg.turning & (time_s < leg.program.t2_s);
  if (Any(kicking)) {
    const Vector<T> right = Normalized(Along(leg.right_I, -Dot(leg.right_I, along), along));
    const T alpha = IncidenceAt(leg.program, time_s);
    const Vector<T> turned = Cos(alpha) * along + Sin(alpha) * Cross(right, along);
    const T faded = Clamp((time_s - leg.program.t1_s) * leg.program.inverse_fall_1_s, T(0.0), T(1.0));
    forward =
        Select(kicking, Normalized(Along(turned, T(1.0) - SmoothStep(faded), leg.turn_offset_I)), forward);
  }
  if (leg.any_steers) {
    const T alpha = SteeringAt(leg, time_s);
    const auto steering = leg.turning & !kicking & ((alpha < T(0.0)) | (alpha > T(0.0)));
    if (Any(steering)) {
      const Vector<T> right = Normalized(Along(leg.right_I, -Dot(leg.right_I, along), along));
      forward = Select(steering, Cos(alpha) * along + Sin(alpha) * Cross(right, along), forward);
    }
  }
  if (!All(leg.turning)) {
    const T turn = T(ground.earth.rotation_rate_rad_s) * time_s;
    const T cosine = Cos(turn), sine = Sin(turn);
    const T x(ground.up_I.x), y(ground.up_I.y);
    const Vector<T> up{Fma(cosine, x, -(sine * y)), Fma(sine, x, cosine * y), T(ground.up_I.z)};
    forward = Select(leg.turning, forward, up);
  }
  return forward;
}

/// Values of one instant for limits and records.
template <class T>
struct AscentInstant {
  Vector<T> acceleration_I;
  T altitude_m, qbar_pa, mach, incidence_rad, mass_kg;
  T axial_n, lateral_n;  ///< forces along the body axis and across it, without gravitation
};

/// The nozzles are straight and the sideslip is zero, so the force lies in the plane of the axis and the
/// flow.
template <class T>
DISPERSA_OUT_OF_LINE AscentInstant<T> InstantAt(const Ground& ground, const Leg<T>& leg, T time_s,
                                                const Vector<T>& p, const Vector<T>& v) {
  const Surroundings<T> around = SurroundingsAt(ground.earth, leg.weather, p);
  const BurnState<T> burn = BurnAt(leg.burn, time_s - leg.ignition_s);
  const T unlit = Select(leg.burnt, leg.burn.left_kg, leg.burn.propellant_mass_kg);
  MassPropertiesOf<T> masses = MassesAt(leg.stack, Select(leg.burning, burn.propellant_kg, unlit));
  T beside_thrust_n(0.0);
  if (leg.has_boosters) {
    const BurningMotor<T>& beside = leg.beside.burn;
    const BurnState<T> boost = BurnAt(beside, time_s - leg.ignition_s);
    AddBeside(leg.beside, Select(leg.boosting, boost.propellant_kg, beside.left_kg), T(0.0), T(0.0), masses);
    const T push =
        Max(Fma(beside.vacuum_thrust_n, boost.fraction, -(around.pressure_pa * beside.exit_area_m2)), T(0.0));
    beside_thrust_n = Select(leg.boosting, push, T(0.0));
  }
  masses.mass_kg = masses.mass_kg - leg.expelled_kg;

  const Vector<T> forward = ForwardAt(ground, leg, time_s, p, v);
  const Vector<T> flow = VelocityOverGround(ground, p, v) - around.wind_m_s;
  const T ahead = Dot(flow, forward);
  const Vector<T> crossing = Along(flow, -ahead, forward);
  const T across = Sqrt(Dot(crossing, crossing));
  const FlowForce<T> air = ForceOfFlow(leg.aero, {ahead, T(0.0), across}, Zero<T>(), around.density_kg_m3,
                                       around.inverse_sound_s_m, masses.cg_station_m);
  // P = P_vac - p A_e. Thrust is 0 if the ambient pressure would make it negative.
  const T thrust = Max(
      Fma(leg.burn.vacuum_thrust_n, burn.fraction, -(around.pressure_pa * leg.burn.exit_area_m2)), T(0.0));
  AscentInstant<T> o;
  o.altitude_m = around.altitude_m;
  o.qbar_pa = air.qbar_pa;
  o.mach = air.mach;
  o.incidence_rad = air.incidence_rad;
  o.mass_kg = masses.mass_kg;
  o.axial_n = air.force_n.x + Select(leg.burning, thrust, T(0.0));
  if (leg.has_boosters) o.axial_n = o.axial_n + beside_thrust_n;
  o.lateral_n = air.force_n.z;
  const T inverse_mass = T(1.0) / masses.mass_kg;
  const T across_1_kg = o.lateral_n * inverse_mass / Max(across, T(1e-30));
  o.acceleration_I =
      Along(Along(around.gravitation_m_s2, o.axial_n * inverse_mass, forward), across_1_kg, crossing);
  return o;
}

/// Half the interval (s) of numerical derivatives along the motion. Rounding and truncation stay below 1e-10
/// of a rate.
inline constexpr double kDifference_s = 1e-3;

/// Moves position and velocity along the motion by `dt` (s), forward or back.
template <class T>
DISPERSA_INLINE void MoveBy(double dt, Vector<T> acceleration, Vector<T>* p, Vector<T>* v) {
  *p = Along(Along(*p, T(dt), *v), T(0.5 * dt * dt), acceleration);
  *v = Along(*v, T(dt), acceleration);
}

/// Rate of the body's x axis in I, 1/s.
template <class T>
DISPERSA_INLINE Vector<T> AxisRateAt(const Ground& ground, const Leg<T>& leg, T time_s, Vector<T> p,
                                     Vector<T> v, Vector<T> acceleration) {
  Vector<T> p0 = p, v0 = v, p1 = p, v1 = v;
  MoveBy(-kDifference_s, acceleration, &p0, &v0);
  MoveBy(kDifference_s, acceleration, &p1, &v1);
  const Vector<T> before = ForwardAt(ground, leg, time_s - T(kDifference_s), p0, v0);
  const Vector<T> after = ForwardAt(ground, leg, time_s + T(kDifference_s), p1, v1);
  return T(0.5 / kDifference_s) * (after - before);
}

/// One step of the classical Runge-Kutta method, from the acceleration at its start.
template <class T>
DISPERSA_OUT_OF_LINE void Step(const Ground& ground, const Leg<T>& leg, T from_s, T to_s, const Vector<T>& a1,
                               Vector<T>* p, Vector<T>* v) {
  const T h = to_s - from_s, half = T(0.5) * h, middle_s = from_s + half;
  const Vector<T> v2 = Along(*v, half, a1);
  const Vector<T> a2 = InstantAt(ground, leg, middle_s, Along(*p, half, *v), v2).acceleration_I;
  const Vector<T> v3 = Along(*v, half, a2);
  const Vector<T> a3 = InstantAt(ground, leg, middle_s, Along(*p, half, v2), v3).acceleration_I;
  const Vector<T> v4 = Along(*v, h, a3);
  const Vector<T> a4 = InstantAt(ground, leg, to_s, Along(*p, h, v3), v4).acceleration_I;
  const T sixth = h * T(1.0 / 6.0);
  *p = Along(*p, sixth, (*v + v4) + T(2.0) * (v2 + v3));
  *v = Along(*v, sixth, (a1 + a4) + T(2.0) * (a2 + a3));
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
