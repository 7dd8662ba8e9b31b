// Accumulators of a flight's metrics. Each number is declared here, accumulated here lane by lane
// (core/math/lanes.h), and read once when the flight ends. Angles are in radians. metrics.cc defines the
// metrics.
#pragma once

#include <cstdint>

#include "core/dynamics/actuators.h"
#include "core/dynamics/launcher_body.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/free_flight_sums.h"
#include "core/flight/nozzle_allocation.h"
#include "core/flight/orbit.h"
#include "core/guidance/outcome.h"
#include "core/math/constants.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// What the largest of magnitudes is without any of them: no magnitude.
inline constexpr double kNoPeak = -1.0;
/// What the least of margins is without any of them.
inline constexpr double kNoMargin = 1e300;

/// Sums of a signed angle over ticks.
template <class T>
struct ErrorSumsOf {
  T squares = T(0.0);
  T peak = T(kNoPeak);     ///< largest magnitude
  T peak_time_s = T(0.0);  ///< when it was first reached
  T count = T(0.0);
};
using ErrorSums = ErrorSumsOf<double>;

/// Sums over ticks, and largest magnitudes: for one flight (T = double) or for W flights side by side.
template <class T>
struct TickSums {
  T itae_rad_s2 = T(0.0), saturated_ticks = T(0.0), travel_rad = T(0.0);
  T v_outside_ticks = T(0.0), v_falling_ticks = T(0.0), bending_moment_station_m = T(0.0);
  T deflection_rate_peak_rad_s = T(kNoPeak), departure_norm2_peak = T(kNoPeak);
  T q_max_pa = T(kNoPeak), q_alpha_max_pa_rad = T(kNoPeak), alpha_max_rad = T(kNoPeak);
  T axial_load_max_g = T(kNoPeak), lateral_load_max_g = T(kNoPeak), bending_moment_max_n_m = T(kNoPeak);
};

/// The tick of the largest dynamic pressure.
template <class T>
struct MaxQ {
  T time_s, altitude_m, speed_m_s, mass_kg;  ///< speed: over the rotating Earth
};

struct FlightSums : TickSums<double> {
  MaxQ<double> max_q{};
  ErrorSums pitch[kMaxStages];    ///< powered flight, by stage
  ErrorSums coast;                ///< pitch
  ErrorSums yaw, roll;            ///< powered flight
  ErrorSums deflection;           ///< each nozzle counts
  double ripple_rad = -1.0;       ///< negative without a whole window
  double limit_cycle_rad = -1.0;  ///< negative: not measured, 0: none found
  bool handed_over = false;
  double handover_angle_rad = 0.0, handover_rate_rad_s = 0.0;
  double expelled_kg = 0.0;
  double unburnt_kg[kMaxStages] = {};  ///< usable, that each burn left
  int burnt_out = 0;                   ///< burns that have ended
  bool injected = false;
  double injection_altitude_m = 0.0;
  OrbitElements orbit;
  GuidanceOutcome guidance;  ///< of a flight that is guided
  FreeFlightSums free;
  std::uint32_t rules_fired = 0;
  double step_limit_fraction = 0.0;  ///< known before the flight (step_limits.h)
};

}  // namespace dispersa

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Incidence means nothing where there is no air to feel it.
inline constexpr double kIncidenceFloor_pa = 1000.0;
/// The residual set of pitch, in which V may rise: V up to that of this error at rest.
inline constexpr double kResidualError_rad = 0.05 * kRadPerDeg;

/// Start-up transients of a stage are no limit cycle.
inline constexpr double kSettled_s = 5.0;

/// Times at which deflections do not tell about a limit cycle: the first seconds of a stage, the kick
/// (between two times since lift-off), and the altitudes of a gust (no gust if top <= bottom).
template <class T>
DISPERSA_INLINE MaskOf<T> InTransient(T time_s, T since_ignition_s, T altitude_m, double kick_start_s,
                                      double kick_end_s, T gust_bottom_m, T gust_top_m) {
  const auto in_kick = (time_s >= T(kick_start_s)) & (time_s <= T(kick_end_s));
  const auto in_gust =
      (gust_top_m > gust_bottom_m) & (altitude_m >= gust_bottom_m) & (altitude_m <= gust_top_m);
  return (since_ignition_s < T(kSettled_s)) | in_kick | in_gust;
}

template <class T>
DISPERSA_INLINE void Add(ErrorSumsOf<T>& sums, MaskOf<T> lanes, T value, T time_s) {
  const T size = Abs(value);
  sums.squares = Select(lanes, Fma(value, value, sums.squares), sums.squares);
  const auto is_higher = lanes & (size > sums.peak);
  sums.peak = Select(is_higher, size, sums.peak);
  sums.peak_time_s = Select(is_higher, time_s, sums.peak_time_s);
  sums.count = sums.count + Select(lanes, T(1.0), T(0.0));
}

/// Telemetry of the pitch axis' control law at a tick.
template <class T>
struct LyapunovSample {
  T v, v_falls, p11;  ///< v_falls: 1 where V is below the last tick's
  T departure_norm2;  ///< of the consequents, squared
};

template <class T>
struct LaneMetrics {
  ErrorSumsOf<T> pitch, coast, yaw, roll, deflection;  ///< pitch: of the current stage
  TickSums<T> sums;
  MaxQ<T> max_q;
  T roll_rate_peak_rad_s, least_static_margin;  ///< of stages without gimbal
  T gust_bottom_m, gust_top_m;                  ///< altitudes of a gust (none if top <= bottom)
  T has_previous, previous_rad[kBanks][kDrives];

  /// Before a lane's first tick.
  DISPERSA_INLINE void StartFlight(int lane, const FlightInputs& in) {
    for (unsigned i = 0; i < kValues<T, LaneMetrics>; ++i) SetLaneAt<T>(*this, i, lane, 0.0);
    for (ErrorSumsOf<T>* e : {&pitch, &coast, &yaw, &roll, &deflection}) SetLane(*e, lane, ErrorSums{});
    SetLane(sums, lane, TickSums<double>{});
    Lane(roll_rate_peak_rad_s, lane) = kNoPeak;
    Lane(least_static_margin, lane) = kNoMargin;
    Lane(gust_bottom_m, lane) = in.air.gust_altitude_m;
    Lane(gust_top_m, lane) =
        in.air.gust_speed_m_s != 0.0 ? in.air.gust_altitude_m + in.air.gust_length_m : in.air.gust_altitude_m;
  }
  /// At a lane's burnout, and when it ends.
  DISPERSA_INLINE void EndStage(int lane, int stage, FlightSums& flight) {
    flight.pitch[stage] = LaneOf(pitch, lane);
    SetLane(pitch, lane, ErrorSums{});
    Lane(has_previous, lane) = 0.0;
  }

  /// One tick of powered flight. Errors are true less reference, about x, y, z.
  DISPERSA_INLINE void AddPowered(MaskOf<T> lanes, T tick_s, T time_s, Vector<T> error_rad,
                                  const LyapunovSample<T>& law) {
    lanes::Add(pitch, lanes, error_rad.y, time_s);
    lanes::Add(yaw, lanes, error_rad.z, time_s);
    lanes::Add(roll, lanes, error_rad.x, time_s);
    sums.itae_rad_s2 =
        Select(lanes, Fma(tick_s * time_s, Abs(error_rad.y), sums.itae_rad_s2), sums.itae_rad_s2);
    const auto is_outside = lanes & (law.v > T(0.5 * kResidualError_rad * kResidualError_rad) * law.p11);
    Add(is_outside, T(1.0), sums.v_outside_ticks);
    Add(is_outside, law.v_falls, sums.v_falling_ticks);
    Raise(lanes, law.departure_norm2, sums.departure_norm2_peak);
  }

  /// Adds the deflections of four nozzles in a cross, at the same tick: angles of the actuators, and their
  /// commands.
  DISPERSA_INLINE void AddDeflections(MaskOf<T> lanes, T time_s, const DriveState<T>& drives,
                                      const T* command_rad, T limit_rad) {
    T travel(0.0), largest(0.0), fastest(0.0);
    for (int i = 0; i < kNozzles; ++i) {
      const T angle = drives.angle_rad[i];
      lanes::Add(deflection, lanes, angle, time_s);
      fastest = Max(fastest, Abs(drives.rate_rad_s[i]));
      largest = Max(largest, Abs(command_rad[i]));
      travel = travel + Abs(angle - previous_rad[0][i]);
      previous_rad[0][i] = Select(lanes, angle, previous_rad[0][i]);
    }
    AddTravel(lanes, fastest, T(1.0 / kNozzles), travel, largest >= limit_rad);
  }
  /// Deflections of listed nozzles at a tick, bank by bank: every drive of the lane's stage counts.
  struct Travel {
    T fastest_rad_s, moved_rad;
    MaskOf<T> saturated;
  };
  /// `lanes`: those that have the bank.
  DISPERSA_INLINE void AddToTravel(MaskOf<T> lanes, T time_s, int bank, const DriveState<T>& first,
                                   const DriveState<T>& second, const T* command_rad,
                                   const BankAllocation<T>& list, Travel& travel) {
    Travel with = travel;
    for (int i = 0; i < kDrives; ++i) {
      const DriveState<T>& drives = i < kNozzles ? first : second;
      const T angle = drives.angle_rad[i % kNozzles];
      T& previous = previous_rad[bank][i];
      lanes::Add(deflection, lanes & (list.there[i] > T(0.0)), angle, time_s);
      with.fastest_rad_s = Max(with.fastest_rad_s, Abs(drives.rate_rad_s[i % kNozzles]));
      with.moved_rad = with.moved_rad + Abs(angle - previous);
      previous = Select(lanes, angle, previous);
    }
    travel.fastest_rad_s = Select(lanes, with.fastest_rad_s, travel.fastest_rad_s);
    travel.moved_rad = Select(lanes, with.moved_rad, travel.moved_rad);
    travel.saturated = travel.saturated | (lanes & IsSaturated(list, command_rad));
  }
  DISPERSA_INLINE void EndTravel(MaskOf<T> lanes, T per_drive, const Travel& travel) {
    AddTravel(lanes, travel.fastest_rad_s, per_drive, travel.moved_rad, travel.saturated);
  }
  DISPERSA_INLINE void AddTravel(MaskOf<T> lanes, T fastest_rad_s, T per_drive, T moved_rad,
                                 MaskOf<T> saturated) {
    Raise(lanes, fastest_rad_s, sums.deflection_rate_peak_rad_s);
    Add(lanes & saturated, T(1.0), sums.saturated_ticks);
    sums.travel_rad =
        Select(lanes & (has_previous > T(0.0)), Fma(per_drive, moved_rad, sums.travel_rad), sums.travel_rad);
    has_previous = Select(lanes, T(1.0), has_previous);
  }

  DISPERSA_INLINE void AddCoast(MaskOf<T> lanes, T time_s, T pitch_error_rad) {
    lanes::Add(coast, lanes, pitch_error_rad, time_s);
  }

  /// Before AddLoads of the same tick.
  DISPERSA_INLINE void NoteMaxQ(MaskOf<T> lanes, T time_s, double rotation_rate_rad_s,
                                const RigidMotion<T>& motion, const Instant<T>& now) {
    const auto is_higher = lanes & (now.qbar_pa > sums.q_max_pa);
    if (!Any(is_higher)) return;
    const T omega(rotation_rate_rad_s);
    const Vector<T> v{Fma(omega, motion.p.y, motion.v.x), Fma(-omega, motion.p.x, motion.v.y), motion.v.z};
    Blend<T>(is_higher, MaxQ<T>{time_s, now.altitude_m, Sqrt(Dot(v, v)), now.mass_kg}, max_q);
  }
  /// Loads at a tick outside the coast.
  DISPERSA_INLINE void AddLoads(MaskOf<T> lanes, const Instant<T>& now) {
    Raise(lanes, now.qbar_pa, sums.q_max_pa);
    const auto is_felt = lanes & (now.qbar_pa >= T(kIncidenceFloor_pa));
    Raise(is_felt, now.incidence_rad, sums.alpha_max_rad);
    Raise(is_felt, now.qbar_pa * now.incidence_rad, sums.q_alpha_max_pa_rad);
    const T weight = T(1.0) / (now.mass_kg * T(kStandardGravity));
    const T axial = Abs(now.force_n.x * weight);
    const T lateral = Sqrt(Fma(now.force_n.y, now.force_n.y, now.force_n.z * now.force_n.z)) * weight;
    Raise(lanes, axial, sums.axial_load_max_g);
    Raise(lanes, lateral, sums.lateral_load_max_g);
  }

  /// A tick of stages that nothing controls: their roll rate, and the static margin where there is air.
  DISPERSA_INLINE void AddFree(MaskOf<T> lanes, T roll_rate_rad_s, T qbar_pa, T margin) {
    Raise(lanes, Abs(roll_rate_rad_s), roll_rate_peak_rad_s);
    const auto felt = lanes & (qbar_pa >= T(kIncidenceFloor_pa));
    least_static_margin = Select(felt & (margin < least_static_margin), margin, least_static_margin);
  }

  DISPERSA_INLINE void AddMoment(MaskOf<T> lanes, const LargestMoment<T>& now) {
    const auto is_larger = lanes & (now.moment_n_m > sums.bending_moment_max_n_m);
    sums.bending_moment_max_n_m = Select(is_larger, now.moment_n_m, sums.bending_moment_max_n_m);
    sums.bending_moment_station_m = Select(is_larger, now.station_m, sums.bending_moment_station_m);
  }

  /// Reads the lane's sums. The record keeps the rest: stages, handover, orbit, limit cycle.
  DISPERSA_INLINE void Read(int lane, FlightSums& s) const {
    s.coast = LaneOf(coast, lane);
    s.yaw = LaneOf(yaw, lane);
    s.roll = LaneOf(roll, lane);
    s.deflection = LaneOf(deflection, lane);
    ReadLaneValues<T>(sums, lane, static_cast<TickSums<double>&>(s));
    ReadLaneValues<T>(max_q, lane, s.max_q);
    s.free.roll_rate_peak_rad_s = Lane(roll_rate_peak_rad_s, lane);
    if (const double least = Lane(least_static_margin, lane); least < kNoMargin)
      s.free.least_static_margin = least;
  }
  /// Loads of one lane at a moment between ticks, its burnout.
  DISPERSA_INLINE void AddLoadsOfLane(int lane, double time_s, double rotation_rate_rad_s,
                                      const RigidMotion<double>& motion, const Instant<double>& now) {
    LaneMetrics<double> one{};
    one.sums.q_max_pa = Lane(sums.q_max_pa, lane);
    one.max_q = LaneOf(max_q, lane);
    one.NoteMaxQ(true, time_s, rotation_rate_rad_s, motion, now);
    SetLane(max_q, lane, one.max_q);
    one.AddLoads(true, now);
    // All other values of `one` are of no tick, which raises nothing.
    for (unsigned i = 0; i < kValues<T, TickSums<T>>; ++i) {
      const double to = LaneAt<double>(one.sums, i, 0);
      if (to > LaneAt<T>(sums, i, lane)) SetLaneAt<T>(sums, i, lane, to);
    }
  }

 private:
  DISPERSA_INLINE static void Raise(MaskOf<T> lanes, T value, T& to) {
    to = Select(lanes, Max(to, value), to);
  }
  DISPERSA_INLINE static void Add(MaskOf<T> lanes, T value, T& to) { to = to + Select(lanes, value, T(0.0)); }
};

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
