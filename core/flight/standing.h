// Where W flights stand that are flown side by side (core/math/lanes.h): which lanes fly, in which phase,
// when.
#pragma once

#include "core/flight/flight_record.h"
#include "core/math/lane_vector.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

inline constexpr double kFarFuture = 1e300;

/// What of a lane is no SIMD value.
struct Slot {
  FlightRecord* record = nullptr;  ///< null: the lane does not fly
  std::size_t next_event = 0;      ///< of its record's
  int stack = 0;
  unsigned jettisoned = 0;  ///< LauncherPhase's
  int stuck_nozzle = -1;
  bool past_last_burn = false;

  /// Null: the last event has happened.
  const FlightEvent* NextEvent() const {
    return next_event < record->events.size() ? record->events.data() + next_event : nullptr;
  }
  /// Whether guidance gives the lane a reference of its own.
  bool IsGuided() const { return record != nullptr && record->guided != nullptr && record->guided->steers(); }
};

template <class T>
struct Standing {
  Slot slot[kWidth<T>];
  MaskOf<T> live, coasting;
  MaskOf<T> unsteered;  ///< nothing controls their attitude
  T time_s, tick, next_tick;
  T stop_s;  ///< when the next event or switch of commands is due
  T next_digest_tick, next_row_tick;
  T lost_ticks;  ///< for which the attitude has been lost
  T steps_a_tick;

  /// No lane flies. Each computes with finite numbers that nothing reads.
  void Reset() {
    live = coasting = unsteered = NoLane<T>();
    time_s = tick = next_tick = lost_ticks = T(0.0);
    stop_s = next_digest_tick = next_row_tick = T(kFarFuture);
    steps_a_tick = T(1.0);
  }
  void StartFlight(int lane, FlightRecord* record) {
    slot[lane] = Slot{};
    slot[lane].record = record;
    SetLane(live, lane, true);
    SetLane(coasting, lane, false);
    Lane(time_s, lane) = Lane(tick, lane) = Lane(next_tick, lane) = 0.0;
    Lane(next_digest_tick, lane) = Lane(lost_ticks, lane) = 0.0;
    Lane(next_row_tick, lane) = record->watched ? 0.0 : kFarFuture;
    Lane(steps_a_tick, lane) = record->options.steps_per_tick;
  }
  void EndFlight(int lane) {
    slot[lane].record = nullptr;
    SetLane(live, lane, false);
    SetLane(coasting, lane, false);
    Lane(stop_s, lane) = Lane(next_digest_tick, lane) = Lane(next_row_tick, lane) = kFarFuture;
  }
};

/// Attitude and rate errors about body x, y, z: reference less true, or less what sensors see.
template <class T>
struct AttitudeErrors {
  Vector<T> angle_rad, rate_rad_s;
};
/// Of an attitude and a rate against a row of the reference (ReferenceRows).
template <class T>
DISPERSA_INLINE AttitudeErrors<T> ErrorsAgainst(const T* reference, const Turn<T>& q, const Vector<T>& w) {
  const Turn<T> to_reference = Compose(Inverse(q), {reference[0], reference[1], reference[2], reference[3]});
  return {RotationVector(to_reference), Rotate(to_reference, {reference[4], reference[5], reference[6]}) - w};
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
