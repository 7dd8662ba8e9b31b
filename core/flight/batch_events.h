// How the batch (batch.h) moves each lane to its next tick, through the lane's own events.
#pragma once

#include "core/flight/batch.h"
#include "core/flight/part_events.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
void Batch<T>::Advance() {
  const T target = lanes_.at.next_tick * T(tick_s_);
  if (Any(lanes_.at.live & (lanes_.at.stop_s <= target + T(kSameInstant_s))))
    AdvanceThroughEvents(target);
  else
    Step(lanes_.at.live, target);
  lanes_.at.tick = Select(lanes_.at.live, lanes_.at.next_tick, lanes_.at.tick);
}

/// Each lane through its own stops. An event as good as on the tick happens on the tick.
template <class T>
void Batch<T>::AdvanceThroughEvents(T target) {
  unsigned pending = Bits(lanes_.at.live);
  while (pending != 0) {
    T to = lanes_.at.time_s;
    M moving = NoLane<T>();
    unsigned due = 0;  // lanes whose next event happens where this step ends
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(pending >> lane & 1u)) continue;
      const double now = Lane(lanes_.at.time_s, lane), end = Lane(target, lane);
      double goal = end;
      if (const FlightEvent* next = lanes_.at.slot[lane].NextEvent()) {
        const double event_s = next->time_s;
        if (event_s < end - kSameInstant_s && event_s > now + kSameInstant_s) {
          goal = event_s;
          due |= 1u << lane;
        } else if (event_s <= end + kSameInstant_s) {
          // An event at nearly the current time, or at nearly the end, is taken as exactly there.
          if (event_s < end - kSameInstant_s) goal = now;
          due |= 1u << lane;
        }
      }
      if (const double switch_s = lanes_.computer.switch_s(lane); switch_s < goal) {
        goal = switch_s > now ? switch_s : now;
        due &= ~(1u << lane);
      }
      Lane(to, lane) = goal;
      if (goal > now) SetLane(moving, lane, true);
    }
    if (Any(moving)) Step(moving, to);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(pending >> lane & 1u)) continue;
      Slot& slot = lanes_.at.slot[lane];
      if (slot.record == nullptr) {  // the step failed
        pending &= ~(1u << lane);
        continue;
      }
      if (lanes_.computer.switch_s(lane) <= Lane(lanes_.at.time_s, lane)) {
        lanes_.computer.Switch(lane, lanes_.step);
      } else if (due >> lane & 1u) {
        Happen(lane);
      } else if (Lane(lanes_.at.time_s, lane) >= Lane(target, lane)) {
        pending &= ~(1u << lane);
      }
      if (slot.record == nullptr) pending &= ~(1u << lane);
    }
  }
  for (int lane = 0; lane < kLanes; ++lane)
    if (lanes_.at.slot[lane].record != nullptr) SetStop(lane);
}

template <class T>
void Batch<T>::Step(M moving, T to) {
  StateValues before[kLanes];
  if (any_judged_)
    for (int lane = 0; lane < kLanes; ++lane) lanes_.step.ReadLane(lane, before[lane]);
  const T from = lanes_.at.time_s;
  M failed = NoLane<T>();
  if (most_steps_ == 1) {
    const M accepted = lanes_.step.Step(moving, All(moving | !lanes_.at.live), from, to);
    failed = moving & !accepted;
    lanes_.at.time_s = Select(accepted, to, from);
  }
  for (int i = 1; most_steps_ > 1 && i <= most_steps_; ++i) {
    const T part(static_cast<double>(i));
    const M steps = moving & !failed & (part <= lanes_.at.steps_a_tick);
    const T end =
        Select(part >= lanes_.at.steps_a_tick, to, Fma(part / lanes_.at.steps_a_tick, to - from, from));
    const M accepted = lanes_.step.Step(steps, false, lanes_.at.time_s, end);
    failed = failed | (steps & !accepted);
    lanes_.at.time_s = Select(accepted, end, lanes_.at.time_s);
  }
  if (any_judged_) Judge(moving, from, to, before, failed);
  if (!Any(failed)) return;
  for (int lane = 0; lane < kLanes; ++lane)
    if (Bits(failed) >> lane & 1u)
      End(lane, Outcome::kNumericalFailure, "the integrator failed or the state is not finite");
}

/// Replaces the step of the lanes whose flights ask for a judge.
template <class T>
void Batch<T>::Judge(M moving, T from, T to, StateValues* states, M& failed) {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(Bits(moving) >> lane & 1u) || !lanes_.at.slot[lane].record->replaces_steps()) continue;
    const bool holds =
        lanes_.at.slot[lane].record->Judge(PhaseOf(lane), Lane(from, lane), Lane(to, lane), states[lane]);
    SetLane(failed, lane, !holds);
    Lane(lanes_.at.time_s, lane) = holds ? Lane(to, lane) : Lane(from, lane);
    lanes_.step.WriteLane(lane, states[lane]);
  }
}

template <class T>
void Batch<T>::Happen(int lane) {
  Slot& slot = lanes_.at.slot[lane];
  const FlightEvent event = *slot.NextEvent();
  ++slot.next_event;
  FlightRecord& record = *slot.record;
  switch (event.kind) {
    case EventKind::kIgnition:
      lanes_.step.Ignite(lane, event.time_s, event.stage == 0);
      SetShape(lane);
      Ignite(lane, event.stage);
      SetUnsteered(lane);
      if (const double torque_n_m = record.SpinTorque(event.stage); torque_n_m != 0.0)
        lanes_.step.SetRollTorque(lane, torque_n_m);
      break;
    case EventKind::kBurnout:
      BurnOut(lane, event.stage);
      break;
    case EventKind::kSeparation: {
      StateValues y;
      lanes_.step.ReadLane(lane, y);
      record.Separate(event.stage, slot.jettisoned, y);
      lanes_.step.WriteLane(lane, y);
      SetLane(lanes_.at.coasting, lane,
              definition_.course.is_controlled &&
                  (event.stage + 2 == static_cast<int>(record.plant.stacks.size()) ||
                   definition_.vehicle.stages.data()[event.stage + 1].ignition == IgnitionTrigger::kTimer));
      SetStack(lane, event.stage + 1);
      break;
    }
    case EventKind::kPart: {
      bool is_silent = false;
      PartEvents::At(event.part, [&](auto of) {
        is_silent = of.is_silent;
        of.Happen(*this, lane, event);
      });
      if (is_silent) return;
      break;
    }
  }
  StateValues y;
  lanes_.step.ReadLane(lane, y);
  record.AddToDigest(Lane(lanes_.at.time_s, lane), y);
  record.Note(event, EventViewOf(lane), y);
  if (record.watched) record.WatchEvent(ViewOf(lane));
  // The last event is the last stage's burnout.
  if (slot.NextEvent() == nullptr) EndPowered(lane);
}

/// After its last burn a flight is completed, or goes on until its apogee: as a rigid body in the air, as a
/// point above it.
template <class T>
void Batch<T>::EndPowered(int lane) {
  if (!flies_on_) {
    End(lane, Outcome::kCompleted, "");
    return;
  }
  lanes_.at.slot[lane].past_last_burn = true;
  SetUnsteered(lane);
  const Instant<double> now = lanes_.step.InstantOf(lane, lanes_.at.time_s);
  if (now.altitude_m > kFallAir_m) FallFrom(lane, now.mass_kg);
}

/// The rest of the flight, as a point mass.
template <class T>
void Batch<T>::FallFrom(int lane, double mass_kg) {
  StateValues y;
  lanes_.step.ReadLane(lane, y);
  const char* reason = "";
  const Outcome outcome =
      lanes_.at.slot[lane].record->Fall(Lane(lanes_.at.time_s, lane), mass_kg, y, &reason);
  End(lane, outcome, reason);
}

template <class T>
void Batch<T>::Ignite(int lane, int stage) {
  Slot& slot = lanes_.at.slot[lane];
  FlightRecord& record = *slot.record;
  SetLane(lanes_.at.coasting, lane, false);
  lanes_.sensors.StartStage(lane, model_.sensors().stages.data()[stage]);
  lanes_.computer.StartStage(lane, stage, lanes_.at, lanes_.step.phase().burning);

  const FlightInputs& in = record.inputs;
  slot.stuck_nozzle = -1;
  const int stuck = static_cast<int>(in.stuck_nozzle + 0.5);
  if (static_cast<int>(in.stuck_nozzle_stage + 0.5) == stage + 1 && stuck > 0) {
    slot.stuck_nozzle = stuck - 1;
    lanes_.step.StickNozzle(lane, record.plant.stacks.data()[stage].gimbal, slot.stuck_nozzle,
                            in.stuck_nozzle_rad);
  }
  if (stage > 0 && stage + 1 == static_cast<int>(record.plant.stacks.size())) {
    StateValues y;
    lanes_.step.ReadLane(lane, y);
    record.HandOver(Lane(lanes_.at.time_s, lane), y);
  }
}

template <class T>
void Batch<T>::AddLoadsBetweenTicks(int lane, const Instant<double>& now) {
  const Earth& earth = model_.nominal_plant().environment.earth;
  lanes_.metrics.AddLoadsOfLane(lane, Lane(lanes_.at.time_s, lane), earth.rotation_rate_rad_s,
                                LaneOf(lanes_.step.motion(), lane), now);
}

template <class T>
void Batch<T>::BurnOut(int lane, int stage) {
  FlightRecord& record = *lanes_.at.slot[lane].record;
  StateValues y;
  lanes_.step.ReadLane(lane, y);
  // Loads peak here, between ticks.
  const Instant<double> now = lanes_.step.InstantOf(lane, lanes_.at.time_s);
  AddLoadsBetweenTicks(lane, now);
  lanes_.metrics.EndStage(lane, stage, record.sums);
  record.ripple.Interrupt();
  record.limit_cycle.Interrupt();
  lanes_.sensors.EndStage(lane);
  lanes_.computer.EndStage(lane);
  lanes_.step.BurnOut(lane);
  SetShape(lane);
  const MotorBurn& burn = record.plant.stacks.data()[stage].burn;
  record.sums.unburnt_kg[stage] = burn.left_kg - burn.residual_kg;
  record.sums.burnt_out = stage + 1;
  if (stage + 1 == static_cast<int>(record.plant.stacks.size())) record.Inject(now.altitude_m, y);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
