// Events of parts: when each happens in a stage's course, and what it does to a lane. A new one is a struct
// here, its times in part_events.cc, and its place in the list at the end. The stages' own events are
// Batch::Happen's.
//
// Times adds the event's times. Happen gets the batch (batch.h) with the event's lane. `is_silent`: the event
// changes no state, and neither digests nor histories hold it.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "core/flight/flight_record.h"
#include "core/flight/sequence.h"
#include "core/math/lanes.h"

namespace dispersa {

/// A stage's course, for the events of its parts.
struct StageCourse {
  const Vehicle& vehicle;
  const LauncherPlant& plant;
  int stage;  ///< 0-based
  StageTimes times;
  double tick_s;
  double rail_exit_s;  ///< negative: no rail
};
struct PartTime {
  double time_s;
  int item = -1;               ///< its booster
  bool after_burnout = false;  ///< the stage's
};
using PartTimes = std::vector<PartTime>;

/// The thrust's ramp ends or begins: nothing but a step that ends there.
struct Kink {
  static constexpr bool is_silent = true;
  static void Times(const StageCourse& course, PartTimes& times);
  template <class Batch>
  static void Happen(Batch& batch, int lane, const FlightEvent&) {
    batch.lanes().step.PassKink(lane);
  }
};

/// Of one booster.
struct BoosterBurnout {
  static constexpr bool is_silent = false;
  static void Times(const StageCourse& course, PartTimes& times);
  template <class Batch>
  static void Happen(Batch& batch, int lane, const FlightEvent& event) {
    auto& m = batch.lanes();
    FlightRecord& record = *m.at.slot[lane].record;
    batch.AddLoadsBetweenTicks(lane, m.step.InstantOf(lane, m.at.time_s));  // they peak here
    // Commands of one unit turn other nozzles, or move the body less, from here on: no swing of a nozzle.
    record.ripple.Interrupt();
    record.limit_cycle.Interrupt();
    if (m.step.BurnOutBooster(lane, event.item) && m.step.plant().nozzles_listed)
      m.computer.SetNozzles(lane, record.plant.LayoutOf(0, false));
  }
};

/// Of all boosters.
struct BoosterSeparation {
  static constexpr bool is_silent = false;
  static void Times(const StageCourse& course, PartTimes& times);
  template <class Batch>
  static void Happen(Batch& batch, int lane, const FlightEvent&) {
    auto& m = batch.lanes();
    auto& slot = m.at.slot[lane];
    StateValues y;
    m.step.ReadLane(lane, y);
    const double time_s = lanes::Lane(m.at.time_s, lane);
    // Computed from the burn itself, because the last evaluation is of an earlier time.
    const double propellant_kg = slot.record->plant.stacks.data()->burn.Propellant(
        time_s - lanes::Lane(m.step.phase().ignition_s, lane));
    slot.record->LetGoOfBoosters(slot.jettisoned, time_s, propellant_kg, y);
    slot.jettisoned |= kBoostersGone;
    m.step.WriteLane(lane, y);
    m.step.DropBoosters(lane);
    batch.SetMass(lane);
    batch.SetShape(lane);
  }
};

/// The vehicle leaves its rail.
struct RailExit {
  static constexpr bool is_silent = false;
  static void Times(const StageCourse& course, PartTimes& times);
  template <class Batch>
  static void Happen(Batch& batch, int lane, const FlightEvent&) {
    auto& m = batch.lanes();
    StateValues y;
    m.step.ReadLane(lane, y);
    m.at.slot[lane].record->LeaveRail(y);
    batch.FindJudges();
    m.step.WriteLane(lane, y);
  }
};

/// The spin motors burn out.
struct SpinEnd {
  static constexpr bool is_silent = false;
  static void Times(const StageCourse& course, PartTimes& times);
  template <class Batch>
  static void Happen(Batch& batch, int lane, const FlightEvent&) {
    batch.lanes().step.SetRollTorque(lane, 0.0);
  }
};

/// Events by their places in a list: FlightEvent::part.
template <class... Events>
struct EventList {
  /// visit(an Event) of the event at a place.
  template <class Visit>
  static void At(int place, const Visit& visit) {
    int i = 0;
    ((i++ == place ? visit(Events{}) : void()), ...);
  }
  /// visit(an Event, its place) of each.
  template <class Visit>
  static void Each(const Visit& visit) {
    int i = 0;
    (visit(Events{}, i++), ...);
  }
};
/// Where several happen at one time, in this order.
using PartEvents = EventList<Kink, BoosterBurnout, BoosterSeparation, RailExit, SpinEnd>;

/// Whether an event of a part is of this kind.
template <class Event>
bool Is(const FlightEvent& event) {
  bool is = false;
  if (event.kind == EventKind::kPart)
    PartEvents::At(event.part, [&](auto of) { is = std::is_same_v<decltype(of), Event>; });
  return is;
}

/// Its name in results (SeenEvent); empty where nothing is seen to happen.
std::string NameOf(const Vehicle& vehicle, const FlightEvent& event);

/// All events of a stage in their order.
void AddEvents(const StageCourse& course, bool is_last, std::vector<FlightEvent>& events);

}  // namespace dispersa
