// Events that the flight computer decides (flight_computer.h): cut-offs, and what closed-loop guidance wants.
// Each lane by itself, as ordinary code.
#pragma once

#include "core/flight/flight_computer.h"
#include "core/vehicle/cut_off.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
double FlightComputer<T>::CutOffTime(int lane, const Standing<T>& at, const StepState<T>& step) const {
  const FlightRecord& record = *at.slot[lane].record;
  const Motor* const engine = tails_off_[lane] ? nullptr : record.CutOffEngine(at.slot[lane].stack);
  if (engine == nullptr) return kFarFuture;
  const double time_s = Lane(at.time_s, lane);
  const double lead_s = CutOffLead(*engine);
  const Vector<double> force_n = LaneOf(step.now().force_n, lane);
  const double mass_kg = Lane(step.now().mass_kg, lane);
  const double growing_m_s2 = lead_s > 0.0
                                  ? 0.5 * lead_s * Dot(force_n, force_n) /
                                        (Square(mass_kg) * engine->specific_impulse_s * kStandardGravity)
                                  : 0.0;
  if (record.guided != nullptr && record.guided->cuts_off())
    return CutOffByGuidance(lane, lead_s, growing_m_s2, at, step);
  if (engine->cut_off == CutOff::kByGuidance) {  // which has no plan
    const double end_s = Lane(step.phase().ignition_s, lane) + engine->cut_off_s - lead_s;
    return end_s - time_s <= tick_s_ ? Max(end_s, time_s) : kFarFuture;
  }
  const Vector<double> v = LaneOf(step.motion().v, lane);
  const double speed_m_s = Sqrt(Dot(v, v));
  double rate_m_s2 = Dot(v, LaneOf(step.acceleration_m_s2(), lane)) / speed_m_s + growing_m_s2;
  double wanted_m_s = engine->cut_off_velocity_m_s;
  if (engine->cut_off == CutOff::kAtTarget) {
    const Vector<double> p = LaneOf(step.motion().p, lane);
    const double radius_m = Sqrt(Dot(p, p)), altitude_m = Lane(step.now().altitude_m, lane);
    wanted_m_s = CutOffSpeed(*engine, radius_m, altitude_m);
    rate_m_s2 -= CutOffSpeedRate(*engine, radius_m, altitude_m, Dot(p, v) / radius_m);
  }
  const double lacking_m_s = wanted_m_s - speed_m_s;
  if (lacking_m_s > rate_m_s2 * (tick_s_ + lead_s)) return kFarFuture;
  return time_s + (lacking_m_s > 0.0 ? Max(lacking_m_s / rate_m_s2 - lead_s, 0.0) : 0.0);
}

/// The same at a speed or a time that guidance has planned, by measured values.
template <class T>
double FlightComputer<T>::CutOffByGuidance(int lane, double lead_s, double growing_m_s2,
                                           const Standing<T>& at, const StepState<T>& step) const {
  const auto vector_of = [lane](const Vector<T>& v) {
    return Vector3(Lane(v.x, lane), Lane(v.y, lane), Lane(v.z, lane));
  };
  const Instant<T>& now = step.now();
  const double time_s = Lane(at.time_s, lane);
  const double in_s = at.slot[lane].record->guided->CutOffIn(
                          time_s, Lane(step.phase().ignition_s, lane), vector_of(step.motion().v),
                          vector_of(step.acceleration_m_s2()), growing_m_s2,
                          vector_of(now.force_n).norm() / Lane(now.mass_kg, lane)) -
                      lead_s;
  if (!(in_s <= tick_s_)) return kFarFuture;
  return time_s + (in_s > 0.0 ? in_s : 0.0);
}

template <class T>
bool FlightComputer<T>::Guide(int lane, const Standing<T>& at, const Sensed<T>& sensed,
                              const StepState<T>& step) const {
  const Slot& slot = at.slot[lane];
  const Instant<double> now = LaneOf(step.now(), lane);
  const Vector<double> p = LaneOf(step.motion().p, lane), v = LaneOf(step.motion().v, lane);
  LaneSight sight;
  sight.time_s = Lane(at.time_s, lane);
  for (int axis = 0; axis < 3; ++axis) {
    sight.p_EoC_I[axis] = p[axis];
    sight.v_IC_I[axis] = v[axis];
  }
  sight.stack = slot.stack;
  sight.burning = Bits(step.phase().burning) >> lane & 1u;
  sight.jettisoned = slot.jettisoned;
  sight.ignition_s = Lane(step.phase().ignition_s, lane);
  sight.expelled_kg = Lane(step.phase().expelled_kg, lane);
  const Vector<double>& f = now.force_n;
  sight.specific_force_m_s2 = Sqrt(f.x * f.x + f.y * f.y + f.z * f.z) / now.mass_kg;
  const auto across = [lane](const Vector<T>& error) {
    const double y = Lane(error.y, lane), z = Lane(error.z, lane);
    return Sqrt(y * y + z * z);
  };
  sight.measured_angle_rad = across(sensed.errors.angle_rad);
  sight.measured_rate_rad_s = across(sensed.errors.rate_rad_s);
  return slot.record->Guide(sight);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
