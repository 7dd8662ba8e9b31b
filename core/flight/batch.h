// The engine: W closed-loop flights side by side, each from lift-off to injection or to its failure.
//
// In a pass each flying lane stands at its own tick. Sensors measure (lane_sensors.h), the flight computer
// decides (flight_computer.h), metrics are taken (flight_sums.h), and the plant moves on to the lane's next
// tick (simpson_step.h). On the way it stops at the lane's events at their exact times. Lanes do not depend
// on each other: they may be in different stages and at different times since lift-off. A lane whose flight
// ends takes the next flight of the queue.
//
// This file fills and empties lanes. batch_pass.h does the work of a tick, batch_events.h moves a lane on to
// its next tick. The record (flight_record.h) does what happens once a flight or once an event, and what only
// watched flights need. The engine is compiled once for each instruction set and width (fly_lanes.cc).
#pragma once

#include <new>

#include "core/dynamics/fall.h"
#include "core/expressions/part_sums.h"
#include "core/flight/computer_events.h"
#include "core/flight/flight_computer.h"
#include "core/flight/flight_queue.h"
#include "core/flight/flight_sums.h"
#include "core/flight/history_row.h"
#include "core/flight/lane_sensors.h"
#include "core/flight/simpson_step.h"
#include "core/flight/standing.h"
#include "core/flight/step_limits.h"
#include "core/flight/structural_limits.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// All that lanes remember from tick to tick.
template <class T>
struct LaneMemory {
  Standing<T> at;
  StepState<T> step;  ///< the plant
  Sensors<T> sensors;
  FlightComputer<T> computer;
  AttitudeErrors<T> errors;  ///< reference less true
  Sensed<T> sensed;          ///< the same as the sensors show it
  LaneMetrics<T> metrics;
  PartSumOf<T>* own_sums;  ///< of the parts of the campaign's own metrics
  int own_parts;

  /// Of an object of zeros.
  void Configure(const FlightModel& model) {
    if (model.own_metrics() != nullptr) {
      own_parts = static_cast<int>(model.own_metrics()->parts.size());
      const std::size_t bytes = static_cast<std::size_t>(own_parts) * sizeof *own_sums;
      own_sums = static_cast<PartSumOf<T>*>(::operator new(bytes, std::align_val_t(alignof(PartSumOf<T>))));
      __builtin_memset(static_cast<void*>(own_sums), 0, bytes);
    }
    at.Reset();
    step.Configure(model.nominal_plant(), model.definition().autopilot.tick_s);
    sensors.Configure(model);
    computer.Configure(model);
  }
  /// Nothing of the lane's last flight is left.
  void StartFlight(int lane, FlightRecord* record) {
    at.StartFlight(lane, record);
    step.StartFlight(lane, record->weather, record->lift_off);
    sensors.StartFlight(lane, *record, step.motion().q);
    computer.StartFlight(lane);
    metrics.StartFlight(lane, record->inputs);
    for (int i = 0; i < own_parts; ++i) SetLane(own_sums[i], lane, PartSumOf<double>{0.0, 0.0});
  }
};

template <class T>
class Batch {
 public:
  Batch(const FlightModel& model, FlightQueue& queue)
      : model_(model),
        definition_(model.definition()),
        queue_(queue),
        tick_s_(definition_.autopilot.tick_s),
        has_jettisons_(!model.nominal_plant().jettisons.empty()),
        cuts_off_in_flight_(CutsOffInFlight(definition_.vehicle)),
        has_plugin_(model.autopilot().plugin != nullptr),
        has_free_stage_(model.has_free_stage()),
        flies_on_(definition_.course.ends != FlightEnd::kInjection) {
    lanes_.Configure(model);
  }
  ~Batch() { ::operator delete(lanes_.own_sums, std::align_val_t(alignof(PartSumOf<T>))); }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  /// Until the queue has no more flights and no lane flies.
  void Run();

  // ---- what events of parts change (part_events.h) ----
  LaneMemory<T>& lanes() { return lanes_; }
  void SetMass(int lane);
  void SetShape(int lane);
  void FindJudges();
  void AddLoadsBetweenTicks(int lane, const Instant<double>& now);

 private:
  static constexpr int kLanes = kWidth<T>;
  using M = MaskOf<T>;

  // ---- lanes that come, stand and go ----
  void Refill();
  void Start(int lane, FlightRecord* record);
  void SetStack(int lane, int stack);
  void SetStop(int lane);
  void SetUnsteered(int lane);
  void End(int lane, Outcome outcome, const char* reason);
  LauncherPhase PhaseOf(int lane) const;
  LaneView ViewOf(int lane) const;
  EventView EventViewOf(int lane) const;

  // ---- a pass ----
  void Pass();
  void Measure();
  M Powered() const;
  void LetGo();
  void CutOff();
  void CutOffAt(int lane, double at_s);
  void Guide();
  void Meter(M powered);
  void MeterFree();
  void Watch(M due);
  void See(M shown, RowColumns read, LauncherSeen<T>& seen) const;
  void Digest(unsigned due);
  void FlyOn();
  void CheckEnds();

  // ---- to the next tick ----
  void Advance();
  void AdvanceThroughEvents(T target);
  void Step(M moving, T to);
  void Judge(M moving, T from, T to, StateValues* states, M& failed);
  void Happen(int lane);
  void Ignite(int lane, int stage);
  void BurnOut(int lane, int stage);
  void EndPowered(int lane);
  void FallFrom(int lane, double mass_kg);

  const FlightModel& model_;
  const FlightDefinition& definition_;
  FlightQueue& queue_;
  const double tick_s_;
  const bool has_jettisons_, cuts_off_in_flight_, has_plugin_;
  const bool has_free_stage_, flies_on_;  ///< flies_on_: after the last burn
  int flying_ = 0;                        ///< lanes
  unsigned patience_ = 0;                 ///< passes until the queue is asked again
  bool any_judged_ = false;
  int most_steps_ = 1;
  LaneMemory<T> lanes_{};
};

/// Passes between two questions to an empty queue while other lanes fly.
inline constexpr unsigned kPatience = 256;

template <class T>
void Batch<T>::Run() {
  for (;;) {
    Refill();
    if (flying_ == 0) return;
    Pass();
  }
}

// ---- lanes that come, stand and go -----------------------------------------------------------------------

template <class T>
void Batch<T>::Refill() {
  if (flying_ == kLanes) return;
  if (flying_ > 0 && patience_ > 0) {
    --patience_;
    return;
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    while (lanes_.at.slot[lane].record == nullptr) {
      FlightRecord* record = queue_.Next(flying_ == 0);
      if (record == nullptr) {
        patience_ = kPatience;
        return;
      }
      Start(lane, record);  // may end at once
    }
  }
}

template <class T>
void Batch<T>::Start(int lane, FlightRecord* record) {
  lanes_.StartFlight(lane, record);
  ++flying_;
  FindJudges();
  SetStack(lane, 0);
  if (record->refusal != nullptr) {
    End(lane, record->refused_as, record->refusal);
    return;
  }
  // Events before lift-off happen at lift-off.
  const Slot& slot = lanes_.at.slot[lane];
  while (slot.record != nullptr && slot.NextEvent() != nullptr && slot.NextEvent()->time_s <= kSameInstant_s)
    Happen(lane);
  if (slot.record != nullptr) SetStop(lane);
}

/// Whether any lane's step is replaced, and how many steps of a tick any lane takes at most.
template <class T>
void Batch<T>::FindJudges() {
  any_judged_ = false;
  most_steps_ = 1;
  for (const Slot& each : lanes_.at.slot) {
    if (each.record == nullptr) continue;
    any_judged_ |= each.record->replaces_steps();
    if (each.record->options.steps_per_tick > most_steps_) most_steps_ = each.record->options.steps_per_tick;
  }
}

template <class T>
void Batch<T>::SetStack(int lane, int stack) {
  Slot& slot = lanes_.at.slot[lane];
  slot.stack = stack;
  slot.stuck_nozzle = -1;
  lanes_.computer.EndCommands(lane);
  lanes_.step.SetStack(lane, slot.record->plant, stack);
  SetUnsteered(lane);
  SetMass(lane);
  SetShape(lane);
  // Boosters burn, or would, while the first stack is as it was at lift-off.
  if (lanes_.step.plant().nozzles_listed)
    lanes_.computer.SetNozzles(lane, slot.record->plant.LayoutOf(stack, stack == 0));
}

/// Thrusters hold a stage without gimbal while it coasts.
template <class T>
void Batch<T>::SetUnsteered(int lane) {
  const Slot& slot = lanes_.at.slot[lane];
  const bool is_fixed = slot.record->plant.stacks.data()[slot.stack].gimbal.fixed;
  SetLane(lanes_.at.unsteered, lane,
          slot.past_last_burn || (is_fixed && !(Bits(lanes_.at.coasting) >> lane & 1u)));
}

/// Sets the mass of the bodies that the lane's stack still carries.
template <class T>
void Batch<T>::SetMass(int lane) {
  const Slot& slot = lanes_.at.slot[lane];
  if (slot.jettisoned == 0) return;
  StackMass mass;
  slot.record->MassWithout(slot.stack, slot.jettisoned, mass);
  lanes_.step.SetMass(lane, mass, slot.record->BendingWithout(slot.stack, slot.jettisoned));
}

/// Sets the aerodynamics of the lane's stack: those after its jettisons, with the motor burning or out.
template <class T>
void Batch<T>::SetShape(int lane) {
  const Slot& slot = lanes_.at.slot[lane];
  const LauncherStack& stack = slot.record->plant.stacks.data()[slot.stack];
  if (stack.aero_variants.get() == nullptr) return;
  const bool burning = Bits(lanes_.step.phase().burning) >> lane & 1u;
  lanes_.step.SetShape(lane, stack, stack.AeroAfter(slot.jettisoned, burning));
}

template <class T>
void Batch<T>::SetStop(int lane) {
  const FlightEvent* next = lanes_.at.slot[lane].NextEvent();
  Lane(lanes_.at.stop_s, lane) =
      Min(next != nullptr ? next->time_s : kFarFuture, lanes_.computer.switch_s(lane));
}

template <class T>
void Batch<T>::End(int lane, Outcome outcome, const char* reason) {
  const Slot& slot = lanes_.at.slot[lane];
  FlightRecord* record = slot.record;
  StateValues y;
  lanes_.step.ReadLane(lane, y);
  if (Bits(lanes_.step.phase().burning) >> lane & 1u) lanes_.metrics.EndStage(lane, slot.stack, record->sums);
  lanes_.metrics.Read(lane, record->sums);
  record->sums.expelled_kg = Lane(lanes_.step.phase().expelled_kg, lane);
  record->sums.rules_fired =
      static_cast<std::uint32_t>(ToBits(Lane(lanes_.computer.memory(kPitch).rules_fired, lane)));
  record->NoteEnd(outcome, EventViewOf(lane), y);
  for (int i = 0; i < lanes_.own_parts; ++i)
    record->own_sums.data()[i] = {Lane(lanes_.own_sums[i].value, lane), Lane(lanes_.own_sums[i].count, lane)};
  record->End(outcome, reason, Lane(lanes_.at.time_s, lane), slot.stack, y);
  lanes_.at.EndFlight(lane);
  lanes_.computer.EndCommands(lane);
  lanes_.step.EndFlight(lane);
  --flying_;
  patience_ = 0;
  queue_.Done(record);
}

template <class T>
DISPERSA_OUT_OF_LINE EventView Batch<T>::EventViewOf(int lane) const {
  const Instant<double> now = lanes_.step.InstantOf(lane, lanes_.at.time_s);
  return {Lane(lanes_.at.time_s, lane), now.altitude_m, now.qbar_pa, now.mass_kg};
}

template <class T>
LauncherPhase Batch<T>::PhaseOf(int lane) const {
  LauncherPhase phase;
  phase.stack = lanes_.at.slot[lane].stack;
  phase.jettisoned = lanes_.at.slot[lane].jettisoned;
  phase.boosters_burning = lanes_.step.BoostersBurning(lane);
  phase.burning = Bits(lanes_.step.phase().burning) >> lane & 1u;
  phase.burnt = Bits(lanes_.step.phase().burnt) >> lane & 1u;
  phase.ignition_s = Lane(lanes_.step.phase().ignition_s, lane);
  phase.expelled_mass_kg = Lane(lanes_.step.phase().expelled_kg, lane);
  for (int axis = 0; axis < 3; ++axis)
    phase.control_torque_n_m.data()[axis] = Lane(lanes_.step.phase().control_torque_n_m[axis], lane);
  for (int i = 0; i < model_.nominal_plant().nozzle_banks() * kDrives; ++i)
    phase.command_rad.data()[i] = Lane(lanes_.step.command_rad(i / kDrives)[i % kDrives], lane);
  phase.stuck_nozzle = lanes_.at.slot[lane].stuck_nozzle;
  return phase;
}

template <class T>
LaneView Batch<T>::ViewOf(int lane) const {
  LaneView view;
  view.time_s = Lane(lanes_.at.time_s, lane);
  lanes_.step.ReadLane(lane, view.y);
  view.phase = PhaseOf(lane);
  view.coasting = Bits(lanes_.at.coasting) >> lane & 1u;
  view.unsteered = Bits(lanes_.at.unsteered) >> lane & 1u;
  for (int axis = 0; axis < kAxes; ++axis) {
    view.error_angle_rad[axis] = Lane(lanes_.errors.angle_rad[axis], lane);
    view.error_rate_rad_s[axis] = Lane(lanes_.errors.rate_rad_s[axis], lane);
    view.thrusters[axis] = static_cast<int>(Lane(lanes_.computer.thruster(axis).direction, lane));
    // Without thrust the lane's autopilot does not act. The values in its place come from neighbouring lanes.
    if (!view.phase.burning || (Bits(lanes_.at.unsteered) >> lane & 1u)) continue;
    view.gimbal_rad[axis] = Lane(lanes_.computer.output().deflection_rad[axis], lane);
    view.axes[axis] = TelemetryOf(model_.autopilot().laws.data()[axis].config,
                                  lanes_.computer.output().axes[axis], lanes_.computer.memory(axis), lane);
    ReadLaneValues<T>(lanes_.computer.memory(axis), lane, view.memories[axis]);
  }
  return view;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
