// How the batch (batch.h) moves each lane to its next tick, through the lane's own events.
#pragma once

#include "core/flight/batch.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
void Batch<T>::Advance() {
  const T target = next_tick_ * T(tick_s_);
  if (Any(live_ & (stop_s_ <= target + T(kSameInstant_s))))
    AdvanceThroughEvents(target);
  else
    Step(live_, target);
  tick_ = Select(live_, next_tick_, tick_);
}

/// Each lane through its own stops. An event as good as on the tick happens on the tick.
template <class T>
void Batch<T>::AdvanceThroughEvents(T target) {
  unsigned pending = Bits(live_);
  while (pending != 0) {
    T to = time_s_;
    M moving = NoLane<T>();
    unsigned due = 0;  // lanes whose next event happens where this step ends
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(pending >> lane & 1u)) continue;
      Slot& slot = slot_[lane];
      const double now = Lane(time_s_, lane), end = Lane(target, lane);
      double goal = end;
      if (const FlightEvent* next = NextEvent(lane)) {
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
      if (slot.switch_s < goal) {
        goal = slot.switch_s > now ? slot.switch_s : now;
        due &= ~(1u << lane);
      }
      Lane(to, lane) = goal;
      if (goal > now) SetLane(moving, lane, true);
    }
    if (Any(moving)) Step(moving, to);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(pending >> lane & 1u)) continue;
      Slot& slot = slot_[lane];
      if (slot.record == nullptr) {  // the step failed
        pending &= ~(1u << lane);
        continue;
      }
      if (slot.switch_s <= Lane(time_s_, lane)) {
        slot.switch_s = kFarFuture;
        for (int bank = 0; bank < step_.plant().banks; ++bank)
          step_.CommandLane(lane, bank, next_command_rad_[bank]);
      } else if (due >> lane & 1u) {
        Happen(lane);
      } else if (Lane(time_s_, lane) >= Lane(target, lane)) {
        pending &= ~(1u << lane);
      }
      if (slot.record == nullptr) pending &= ~(1u << lane);
    }
  }
  for (int lane = 0; lane < kLanes; ++lane)
    if (slot_[lane].record != nullptr) SetStop(lane);
}

template <class T>
void Batch<T>::Step(M moving, T to) {
  StateValues before[kLanes];
  if (any_judged_)
    for (int lane = 0; lane < kLanes; ++lane) step_.ReadLane(lane, before[lane]);
  const T from = time_s_;
  M failed = NoLane<T>();
  if (most_steps_ == 1) {
    const M accepted = step_.Step(moving, All(moving | !live_), from, to);
    failed = moving & !accepted;
    time_s_ = Select(accepted, to, from);
  }
  for (int i = 1; most_steps_ > 1 && i <= most_steps_; ++i) {
    const T part(static_cast<double>(i));
    const M steps = moving & !failed & (part <= steps_a_tick_);
    const T end = Select(part >= steps_a_tick_, to, Fma(part / steps_a_tick_, to - from, from));
    const M accepted = step_.Step(steps, false, time_s_, end);
    failed = failed | (steps & !accepted);
    time_s_ = Select(accepted, end, time_s_);
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
    if (!(Bits(moving) >> lane & 1u) || !slot_[lane].record->replaces_steps()) continue;
    const bool holds =
        slot_[lane].record->Judge(PhaseOf(lane), Lane(from, lane), Lane(to, lane), states[lane]);
    SetLane(failed, lane, !holds);
    Lane(time_s_, lane) = holds ? Lane(to, lane) : Lane(from, lane);
    step_.WriteLane(lane, states[lane]);
  }
}

template <class T>
void Batch<T>::Happen(int lane) {
  Slot& slot = slot_[lane];
  const FlightEvent event = *NextEvent(lane);
  ++slot.next_event;
  FlightRecord& record = *slot.record;
  switch (event.kind) {
    case EventKind::kIgnition:
      step_.Ignite(lane, event.time_s, event.stage == 0);
      SetShape(lane);
      Ignite(lane, event.stage);
      SetUnsteered(lane);
      if (const double torque_n_m = record.SpinTorque(event.stage); torque_n_m != 0.0)
        step_.SetRollTorque(lane, torque_n_m);
      break;
    case EventKind::kSpinEnd:
      step_.SetRollTorque(lane, 0.0);
      break;
    case EventKind::kRailExit: {
      StateValues y;
      step_.ReadLane(lane, y);
      record.LeaveRail(y);
      any_judged_ = false;
      for (const Slot& each : slot_)
        if (each.record != nullptr) any_judged_ |= each.record->replaces_steps();
      step_.WriteLane(lane, y);
      break;
    }
    case EventKind::kBurnout:
      BurnOut(lane, event.stage);
      break;
    case EventKind::kSeparation: {
      StateValues y;
      step_.ReadLane(lane, y);
      record.Separate(event.stage, slot.jettisoned, y);
      step_.WriteLane(lane, y);
      SetLane(coasting_, lane,
              definition_.course.is_controlled &&
                  (event.stage + 2 == static_cast<int>(record.plant.stacks.size()) ||
                   definition_.vehicle.stages.data()[event.stage + 1].ignition == IgnitionTrigger::kTimer));
      SetStack(lane, event.stage + 1);
      break;
    }
    case EventKind::kBoosterBurnout:
      metrics_.AddLoadsOfLane(lane, step_.InstantOf(lane, time_s_));  // they peak here, between ticks
      // Commands of one unit turn other nozzles, or move the body less, from here on: no swing of a nozzle.
      record.ripple.Interrupt();
      record.limit_cycle.Interrupt();
      if (step_.BurnOutBooster(lane, event.booster) && step_.plant().nozzles_listed)
        SetAllocation(lane, record.plant.LayoutOf(0, false));
      break;
    case EventKind::kBoosterSeparation: {
      StateValues y;
      step_.ReadLane(lane, y);
      const double time_s = Lane(time_s_, lane);
      // Computed from the burn itself, because the last evaluation is of an earlier time.
      const double since_ignition_s = time_s - Lane(step_.phase().ignition_s, lane);
      const double propellant_kg = record.plant.stacks.data()->burn.Propellant(since_ignition_s);
      record.LetGoOfBoosters(slot.jettisoned, time_s, propellant_kg, y);
      slot.jettisoned |= kBoostersGone;
      step_.WriteLane(lane, y);
      step_.DropBoosters(lane);
      SetMass(lane);
      SetShape(lane);
      break;
    }
    case EventKind::kKink:
      step_.PassKink(lane);
      return;
  }
  StateValues y;
  step_.ReadLane(lane, y);
  record.AddToDigest(Lane(time_s_, lane), y);
  if (record.watched) record.WatchEvent(ViewOf(lane));
  // The last event is the last stage's burnout.
  if (NextEvent(lane) == nullptr) EndPowered(lane);
}

/// After its last burn a flight is completed, or goes on until its apogee: as a rigid body in the air, as a
/// point above it.
template <class T>
void Batch<T>::EndPowered(int lane) {
  if (!flies_on_) {
    End(lane, Outcome::kCompleted, "");
    return;
  }
  slot_[lane].past_last_burn = true;
  SetUnsteered(lane);
  const Instant<double> now = step_.InstantOf(lane, time_s_);
  if (now.altitude_m > kFallAir_m) FallFrom(lane, now.mass_kg);
}

/// The rest of the flight, as a point mass.
template <class T>
void Batch<T>::FallFrom(int lane, double mass_kg) {
  StateValues y;
  step_.ReadLane(lane, y);
  const char* reason = "";
  const Outcome outcome = slot_[lane].record->Fall(Lane(time_s_, lane), mass_kg, y, &reason);
  End(lane, outcome, reason);
}

template <class T>
void Batch<T>::Ignite(int lane, int stage) {
  Slot& slot = slot_[lane];
  FlightRecord& record = *slot.record;
  const FlightInputs& in = record.inputs;
  const AutopilotModel& autopilot = model_.autopilot();
  SetLane(coasting_, lane, false);
  for (int bank = 0; bank < most_banks_; ++bank)
    for (auto& entry : delay_line_[bank])
      for (T& command : entry) Lane(command, lane) = 0.0;

  AutopilotState state;
  for (int axis = 0; axis < kAxes; ++axis) ReadLaneValues<T>(axes_[axis], lane, state.axes[axis]);
  StartStage(autopilot, stage, state);
  for (int axis = 0; axis < kAxes; ++axis) {
    SetLaneValues<T>(axes_[axis], lane, state.axes[axis]);
    SetLane(thrusters_[axis], lane, state.thrusters[axis]);
  }
  if (has_plugin_) {
    dispersa_law_stage of_stage{};
    of_stage.stage = static_cast<std::uint32_t>(stage);
    for (int axis = 0; axis < kAxes; ++axis) {
      const StageLaw& law = autopilot.laws.data()[axis].stages.data()[stage];
      of_stage.kp_1_s2[axis] = law.kp_1_s2;
      of_stage.kd_1_s[axis] = law.kd_1_s;
    }
    of_stage.limit_rad = autopilot.stages.data()[stage].limit_rad;
    record.law->StartStage(of_stage, Lane(time_s_, lane));
  }
  // The outputs of the last stage belong to no stage now.
  const AxisOutput<double> nothing{};
  for (int axis = 0; axis < kAxes; ++axis) {
    Lane(gimbals_.deflection_rad[axis], lane) = 0.0;
    SetLane(gimbals_.axes[axis], lane, nothing);
  }
  const SensorModel::Weights& weights = model_.sensors().stages.data()[stage];
  for (int i = 0; i < kRateGyros; ++i) Lane(gyro_weight_[i], lane) = weights.gyro.data()[i];
  Lane(unit_weight_, lane) = weights.unit;
  SetLane(gyros_fresh_, lane, true);
  const int loop_stage = static_cast<int>(in.loop_stage + 0.5);
  const bool is_changed = loop_stage == 0 || loop_stage == stage + 1;
  SetLoop(loop_, lane, autopilot, stage, in.pn_error_factor, in.pn_rate_factor,
          is_changed ? in.loop_gain_factor : 1.0);

  const Gimbal& gimbal = record.plant.stacks.data()[stage].gimbal;
  const double delay = gimbal.delay_ticks + (is_changed ? in.loop_delay_s / tick_s_ : 0.0);
  slot.whole_delay = static_cast<int>(delay + kSameInstant_s);
  const double part = delay - slot.whole_delay;
  slot.part_delay_s = part > kSameInstant_s ? part * tick_s_ : 0.0;
  if (slot.whole_delay > kDelayLine - 2) {  // longer than the line: its end
    slot.whole_delay = kDelayLine - 2;
    slot.part_delay_s = 0.0;
  }
  slot.switch_s = kFarFuture;
  same_delay_ = true;
  common_delay_ = slot.whole_delay;
  for (int i = 0; i < kLanes; ++i)
    if (Bits(step_.phase().burning) >> i & 1u)
      same_delay_ &= slot_[i].part_delay_s == 0.0 && slot_[i].whole_delay == common_delay_;

  slot.stuck_nozzle = -1;
  const int stuck = static_cast<int>(in.stuck_nozzle + 0.5);
  if (static_cast<int>(in.stuck_nozzle_stage + 0.5) == stage + 1 && stuck > 0) {
    slot.stuck_nozzle = stuck - 1;
    step_.StickNozzle(lane, gimbal, slot.stuck_nozzle, in.stuck_nozzle_rad);
  }
  if (stage > 0 && stage + 1 == static_cast<int>(record.plant.stacks.size())) {
    StateValues y;
    step_.ReadLane(lane, y);
    record.HandOver(Lane(time_s_, lane), y);
  }
}

template <class T>
void Batch<T>::BurnOut(int lane, int stage) {
  FlightRecord& record = *slot_[lane].record;
  slot_[lane].tails_off = false;
  StateValues y;
  step_.ReadLane(lane, y);
  // Loads peak here, between ticks.
  const Instant<double> now = step_.InstantOf(lane, time_s_);
  metrics_.AddLoadsOfLane(lane, now);
  metrics_.EndStage(lane, stage, record.sums);
  record.ripple.Interrupt();
  record.limit_cycle.Interrupt();
  for (T& weight : gyro_weight_) Lane(weight, lane) = 0.0;
  Lane(unit_weight_, lane) = 1.0;
  step_.BurnOut(lane);
  SetShape(lane);
  // Thrusters held the roll before: their state ends.
  SetLane(thrusters_[kRoll], lane, ThrusterState{});
  if (stage + 1 == static_cast<int>(record.plant.stacks.size())) record.Inject(now.altitude_m, y);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
