// The engine: W closed-loop flights side by side, each from lift-off to injection or to where it fails.
//
// In a pass each lane that flies stands at a tick of its own: the errors are measured, the autopilot or the
// reaction control decides, metrics are taken, and the plant moves on to the lane's next tick, through its
// own events at their exact times. Lanes know nothing of each other: they may be at different stages and at
// different times since lift-off, and one that ends is filled with the next flight of the queue.
//
// What happens once a flight, once an event or only to a flight that is watched is the record's
// (flight_record.h). Compiled once for each instruction set and width (fly_lanes.cc).
#pragma once

#include "core/control/autopilot_step.h"
#include "core/dynamics/launcher_lanes.h"
#include "core/flight/flight_queue.h"
#include "core/flight/lane_metrics.h"
#include "core/flight/sequence.h"
#include "core/flight/simpson_step.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
class Batch {
 public:
  Batch(const FlightModel& model, FlightQueue& queue);

  /// Until the queue has no more flights and no lane flies.
  void Run();

 private:
  static constexpr int kLanes = kWidth<T>;
  using M = MaskOf<T>;

  /// What of a lane is no value of T.
  struct Slot {
    FlightRecord* record = nullptr;  ///< null: the lane does not fly
    const FlightEvent* next_event = nullptr;
    const FlightEvent* last_event = nullptr;  ///< one past
    int stack = 0;
    int stuck_nozzle = -1;
    int whole_delay = 0;        ///< ticks between command and actuator, and
    double part_delay_s = 0.0;  ///< a part of one
    double switch_s = 0.0;      ///< when, within a tick, the next command gets through
  };

  // ---- lanes that come, stand and go ----
  void Refill();
  void Start(int lane, FlightRecord* record);
  void SetStack(int lane, int stack);
  void SetStop(int lane);
  void End(int lane, Outcome outcome, const char* reason);
  LauncherPhase PhaseOf(int lane) const;
  LaneView ViewOf(int lane) const;

  // ---- a pass ----
  void Pass();
  void Measure();
  void FlyGimbals();
  template <bool kAll>
  void FlyGimbalsOf(M powered);
  void PassCommands(M powered);
  void FlyThrusters();
  void Meter(M powered);
  void WatchAndDigest();
  void CheckEnds();

  // ---- to the next tick ----
  void Advance();
  void AdvanceThroughEvents(T target);
  void Step(M moving, T to);
  void Judge(M moving, T from, T to, StateValues* states, M& failed);
  void Happen(int lane);
  void Ignite(int lane, int stage);
  void BurnOut(int lane, int stage);

  const FlightModel& model_;
  const FlightDefinition& definition_;
  FlightQueue& queue_;
  const double tick_s_;
  const double ticks_a_second_;
  Slot slot_[kLanes];
  int flying_ = 0;         ///< lanes
  unsigned patience_ = 0;  ///< passes until the queue is asked again

  M live_, coasting_;
  T time_s_, tick_, next_tick_;
  T stop_s_;  ///< when the next event or switch of commands is due
  T next_digest_tick_, next_row_tick_;
  T lost_ticks_;  ///< for which the attitude has been lost
  StepState<T> step_;
  T next_command_rad_[kNozzles];
  T delay_line_[kDelayLine][kNozzles];  ///< commands by pass
  int line_at_ = 0;
  bool same_delay_ = true;  ///< all lanes that burn have one of whole ticks:
  int common_delay_ = 0;

  Vector<T> angle_rad_, rate_rad_s_;  ///< error, reference less true
  Vector<T> measured_angle_rad_, measured_rate_rad_s_;
  Vector<T> gyro_bias_rad_s_;
  bool any_noise_ = false, any_judged_ = false;
  T steps_a_tick_;
  int most_steps_ = 1;

  GimbalLoop<T> loop_;
  AxisMemory<T> axes_[kAxes];
  GimbalOutput<T> gimbals_;
  ThrusterMemory<T> thrusters_[kAxes];
  LaneMetrics<T> metrics_;
  T gust_bottom_m_, gust_top_m_;
};

// Loss of control, as the metrics define it.
inline constexpr double kLostAngle_rad = 15.0 * kRadPerDeg;
inline constexpr double kLostFor_s = 0.5;
inline constexpr double kLostRate_rad_s = 60.0 * kRadPerDeg;
/// Simulated time that no flight needs.
inline constexpr double kTimeLimit_s = 3600.0;
/// A vehicle this far below its site has hit the ground.
inline constexpr double kImpactDepth_m = 10.0;
/// Passes between two questions to an empty queue while other lanes fly.
inline constexpr unsigned kPatience = 256;
inline constexpr double kFarFuture = 1e300;

template <class T>
Batch<T>::Batch(const FlightModel& model, FlightQueue& queue)
    : model_(model),
      definition_(model.definition()),
      queue_(queue),
      tick_s_(definition_.autopilot.tick_s),
      ticks_a_second_(static_cast<double>(static_cast<long>(1.0 / tick_s_ + 0.5))) {
  // Lanes that never fly compute along with the others, on numbers that do no harm.
  __builtin_memset(static_cast<void*>(&step_), 0, sizeof step_);
  __builtin_memset(static_cast<void*>(&delay_line_), 0, sizeof delay_line_);
  __builtin_memset(static_cast<void*>(&loop_), 0, sizeof loop_);
  __builtin_memset(static_cast<void*>(&axes_), 0, sizeof axes_);
  __builtin_memset(static_cast<void*>(&gimbals_), 0, sizeof gimbals_);
  __builtin_memset(static_cast<void*>(&thrusters_), 0, sizeof thrusters_);
  __builtin_memset(static_cast<void*>(&metrics_), 0, sizeof metrics_);
  const LauncherPlant& nominal = model.nominal_plant();
  step_.Configure(nominal.environment.earth, nominal.jet_damping, tick_s_);
  for (int lane = 0; lane < kLanes; ++lane) {
    SetLane(live_, lane, false);
    SetLane(coasting_, lane, false);
    SetLane(loop_, lane, model.autopilot(), 0, 1.0, 1.0, 1.0);
    SetLane(step_.plant, lane, nominal, 0);
    SetLane(step_.drives, lane, nominal.stacks.data()->gimbal, -1);
    step_.SetTickTransition(lane);
  }
  time_s_ = tick_ = next_tick_ = lost_ticks_ = T(0.0);
  stop_s_ = next_digest_tick_ = next_row_tick_ = T(kFarFuture);
  steps_a_tick_ = T(1.0);
  for (T& command : next_command_rad_) command = T(0.0);
  gyro_bias_rad_s_ = Zero<T>();
  gust_bottom_m_ = gust_top_m_ = T(0.0);
  step_.motion.p.x = T(nominal.environment.earth.equatorial_radius_m);
  step_.motion.q.w = T(1.0);
}

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
    while (slot_[lane].record == nullptr) {
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
  Slot& slot = slot_[lane];
  slot = Slot{};
  slot.record = record;
  slot.next_event = record->events.data();
  slot.last_event = slot.next_event + record->events.size();
  ++flying_;
  SetLane(live_, lane, true);
  SetLane(coasting_, lane, false);
  Lane(time_s_, lane) = Lane(tick_, lane) = Lane(next_tick_, lane) = 0.0;
  Lane(next_digest_tick_, lane) = Lane(lost_ticks_, lane) = 0.0;
  Lane(next_row_tick_, lane) = record->watched ? 0.0 : kFarFuture;
  const AxisState fresh;
  for (AxisMemory<T>& axis : axes_) SetLane(axis, lane, fresh);
  for (ThrusterMemory<T>& thruster : thrusters_)
    Lane(thruster.direction, lane) = Lane(thruster.cycles_on, lane) = 0.0;
  metrics_.StartFlight(lane);
  const FlightInputs& in = record->inputs;
  SetLane(gyro_bias_rad_s_, lane,
          {in.gyro_bias_roll_rad_s, in.gyro_bias_pitch_rad_s, in.gyro_bias_yaw_rad_s});
  Lane(gust_bottom_m_, lane) = in.gust_altitude_m;
  Lane(gust_top_m_, lane) =
      in.gust_speed_m_s != 0.0 ? in.gust_altitude_m + in.gust_length_m : in.gust_altitude_m;
  Lane(steps_a_tick_, lane) = record->options.steps_per_tick;
  any_noise_ = any_judged_ = false;
  most_steps_ = 1;
  for (const Slot& each : slot_) {
    if (each.record == nullptr) continue;
    any_noise_ |= each.record->noisy;
    any_judged_ |= each.record->is_judged();
    if (each.record->options.steps_per_tick > most_steps_) most_steps_ = each.record->options.steps_per_tick;
  }
  step_.StartFlight(lane);
  SetLane(step_.plant.weather, lane, record->weather);
  step_.WriteLane(lane, record->lift_off);
  SetStack(lane, 0);
  // What happened before lift-off happens at lift-off.
  while (slot.record != nullptr && slot.next_event < slot.last_event &&
         slot.next_event->time_s <= kSameInstant_s)
    Happen(lane);
  if (slot.record != nullptr) SetStop(lane);
}

template <class T>
void Batch<T>::SetStack(int lane, int stack) {
  Slot& slot = slot_[lane];
  slot.stack = stack;
  slot.stuck_nozzle = -1;
  slot.switch_s = kFarFuture;
  SetLane(step_.plant, lane, slot.record->plant, stack);
  SetLane(step_.drives, lane, slot.record->plant.stacks.data()[stack].gimbal, -1);
  step_.SetTickTransition(lane);
  step_.MarkMoved(lane);
}

template <class T>
void Batch<T>::SetStop(int lane) {
  const Slot& slot = slot_[lane];
  const double event_s = slot.next_event < slot.last_event ? slot.next_event->time_s : kFarFuture;
  Lane(stop_s_, lane) = Min(event_s, slot.switch_s);
}

template <class T>
void Batch<T>::End(int lane, Outcome outcome, const char* reason) {
  Slot& slot = slot_[lane];
  FlightRecord* record = slot.record;
  StateValues y;
  step_.ReadLane(lane, y);
  if (Bits(step_.phase.burning) >> lane & 1u) metrics_.EndStage(lane, slot.stack, record->sums);
  metrics_.Read(lane, record->sums);
  record->sums.expelled_kg = Lane(step_.phase.expelled_kg, lane);
  record->sums.rules_fired = static_cast<std::uint32_t>(ToBits(Lane(axes_[kPitch].fired, lane)));
  record->End(outcome, reason, Lane(time_s_, lane), slot.stack, y);
  slot.record = nullptr;
  slot.switch_s = kFarFuture;
  step_.plant.weather.profile[lane] = nullptr;  // the record's; an empty lane is computed on
  --flying_;
  patience_ = 0;
  SetLane(live_, lane, false);
  SetLane(coasting_, lane, false);
  SetLane(step_.phase.burning, lane, false);
  Lane(stop_s_, lane) = Lane(next_digest_tick_, lane) = Lane(next_row_tick_, lane) = kFarFuture;
  queue_.Done(record);
}

template <class T>
LauncherPhase Batch<T>::PhaseOf(int lane) const {
  LauncherPhase phase;
  phase.stack = slot_[lane].stack;
  phase.burning = Bits(step_.phase.burning) >> lane & 1u;
  phase.burnt = Bits(step_.phase.burnt) >> lane & 1u;
  phase.ignition_s = Lane(step_.phase.ignition_s, lane);
  phase.expelled_mass_kg = Lane(step_.phase.expelled_kg, lane);
  double* torque = reinterpret_cast<double*>(&phase.control_torque_n_m);
  torque[0] = Lane(step_.phase.control_torque_n_m.x, lane);
  torque[1] = Lane(step_.phase.control_torque_n_m.y, lane);
  torque[2] = Lane(step_.phase.control_torque_n_m.z, lane);
  for (int i = 0; i < kNozzles; ++i) phase.command_rad.data()[i] = Lane(step_.command_rad[i], lane);
  phase.stuck_nozzle = slot_[lane].stuck_nozzle;
  return phase;
}

template <class T>
LaneView Batch<T>::ViewOf(int lane) const {
  LaneView view;
  view.time_s = Lane(time_s_, lane);
  step_.ReadLane(lane, view.y);
  view.phase = PhaseOf(lane);
  view.coasting = Bits(coasting_) >> lane & 1u;
  const T* angle = &angle_rad_.x;
  const T* rate = &rate_rad_s_.x;
  for (int axis = 0; axis < kAxes; ++axis) {
    view.error_angle_rad[axis] = Lane(angle[axis], lane);
    view.error_rate_rad_s[axis] = Lane(rate[axis], lane);
    view.thrusters[axis] = static_cast<int>(Lane(thrusters_[axis].direction, lane));
    // Without thrust the lane's autopilot does not act; what stands there is its neighbours' doing.
    if (!view.phase.burning) continue;
    view.gimbal_rad[axis] = Lane(gimbals_.deflection_rad[axis], lane);
    view.axes[axis] =
        TelemetryOf(model_.autopilot().laws.data()[axis].config, gimbals_.axes[axis], axes_[axis], lane);
  }
  return view;
}

// ---- a pass ----------------------------------------------------------------------------------------------

template <class T>
void Batch<T>::Pass() {
  next_tick_ = Select(live_, tick_ + T(1.0), tick_);
  Measure();
  FlyGimbals();
  if (Any(coasting_)) FlyThrusters();
  step_.EvaluateStart(time_s_);
  metrics_.AddLoads(live_ & !coasting_, step_.now());
  Meter(live_ & step_.phase.burning);
  WatchAndDigest();
  CheckEnds();
  if (flying_ > 0) Advance();
}

/// Error of the lanes' attitudes against the reference at their ticks, true and as the gyros see it: rates
/// with bias and noise; the attitude, integrated from them, drifts with the bias.
template <class T>
void Batch<T>::Measure() {
  const ReferenceRows& reference = model_.reference_rows();
  const double* row[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const double tick = Min(Lane(tick_, lane), reference.last_tick);
    row[lane] = reference.rows.data() + ReferenceRows::kRowSize * static_cast<long>(tick);
  }
  T c[ReferenceRows::kRowSize];
  LoadRow(row, 2, c);
  const Turn<T> q_BR = Compose(Inverse(step_.motion.q), {c[0], c[1], c[2], c[3]});
  angle_rad_ = RotationVector(q_BR);
  rate_rad_s_ = Rotate(q_BR, {c[4], c[5], c[6]}) - step_.motion.w;
  measured_angle_rad_ = Along(angle_rad_, -time_s_, gyro_bias_rad_s_);
  measured_rate_rad_s_ = rate_rad_s_ - gyro_bias_rad_s_;
  if (!any_noise_) return;
  // Only a tick at which the autopilot acts takes a sample.
  const unsigned acting = Bits(live_ & (step_.phase.burning | coasting_));
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(acting >> lane & 1u) || !slot_[lane].record->noisy) continue;
    double noise[kAxes];
    slot_[lane].record->DrawNoise(noise);
    Lane(measured_rate_rad_s_.x, lane) -= noise[0];
    Lane(measured_rate_rad_s_.y, lane) -= noise[1];
    Lane(measured_rate_rad_s_.z, lane) -= noise[2];
  }
}

template <class T>
void Batch<T>::FlyGimbals() {
  const M powered = live_ & step_.phase.burning;
  if (!Any(powered)) return;
  if (All(powered))
    FlyGimbalsOf<true>(powered);
  else
    FlyGimbalsOf<false>(powered);
  PassCommands(powered);
}

template <class T>
template <bool kAll>
void Batch<T>::FlyGimbalsOf(M powered) {
  StepGimbals<kAll>(model_.autopilot(), loop_, powered, time_s_ - step_.phase.ignition_s, measured_angle_rad_,
                    measured_rate_rad_s_, axes_, gimbals_);
}

// This tick's commands into the line, and what leaves it now to the actuators. A delay that is no whole
// number of ticks lets the command through within the tick.
template <class T>
void Batch<T>::PassCommands(M powered) {
  const T roll = gimbals_.deflection_rad[kRoll], pitch = gimbals_.deflection_rad[kPitch];
  const T yaw = gimbals_.deflection_rad[kYaw];
  T* entry = delay_line_[line_at_];
  entry[0] = pitch + roll;
  entry[1] = pitch - roll;
  entry[2] = yaw + roll;
  entry[3] = yaw - roll;
  if (same_delay_) {
    const T* leaving = delay_line_[(line_at_ - common_delay_) & (kDelayLine - 1)];
    for (int i = 0; i < kNozzles; ++i)
      step_.command_rad[i] = Select(powered, leaving[i], step_.command_rad[i]);
  } else {
    const unsigned acting = Bits(powered);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(acting >> lane & 1u)) continue;
      Slot& slot = slot_[lane];
      const bool within = slot.part_delay_s > 0.0;
      const T* next = delay_line_[(line_at_ - slot.whole_delay) & (kDelayLine - 1)];
      const T* now = delay_line_[(line_at_ - slot.whole_delay - (within ? 1 : 0)) & (kDelayLine - 1)];
      for (int i = 0; i < kNozzles; ++i) {
        Lane(step_.command_rad[i], lane) = Lane(now[i], lane);
        Lane(next_command_rad_[i], lane) = Lane(next[i], lane);
      }
      if (!within) continue;
      slot.switch_s = Lane(time_s_, lane) + slot.part_delay_s;
      SetStop(lane);
    }
  }
  line_at_ = (line_at_ + 1) & (kDelayLine - 1);
}

/// The coast: decisions fall on the thrusters' cycles, and on the first tick after an event.
template <class T>
void Batch<T>::FlyThrusters() {
  const AutopilotModel& autopilot = model_.autopilot();
  const ReactionControlLogic& logic = autopilot.config.reaction_control;
  const ReactionControl& rcs = definition_.vehicle.reaction_control;
  const unsigned coasting = Bits(coasting_);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(coasting >> lane & 1u)) continue;
    const long tick = static_cast<long>(Lane(tick_, lane));
    const long cycle_end = (tick / logic.cycle_ticks + 1) * logic.cycle_ticks;
    // The first tick at or after the next event: rounded up.
    const double event_ticks = (slot_[lane].next_event->time_s - kSameInstant_s) / tick_s_;
    long event_tick = static_cast<long>(event_ticks);
    if (static_cast<double>(event_tick) < event_ticks) ++event_tick;
    long next = cycle_end < event_tick ? cycle_end : event_tick;
    if (next <= tick) next = tick + 1;
    Lane(next_tick_, lane) = static_cast<double>(next);
  }
  const double couple_n = 2.0 * rcs.thrust_n;
  const double flow_kg = couple_n / (rcs.specific_impulse_s * kStandardGravity) * tick_s_;  // a tick
  const T* angle = &measured_angle_rad_.x;
  const T* rate = &measured_rate_rad_s_.x;
  T* torque = &step_.phase.control_torque_n_m.x;
  M changes = NoLane<T>();
  T firing(0.0);
  for (int axis = 0; axis < kAxes; ++axis) {
    StepThrusters(logic, autopilot.thruster_minimum_cycles, coasting_, angle[axis], rate[axis],
                  thrusters_[axis]);
    const T direction = thrusters_[axis].direction;
    const T anew = T(couple_n * (axis == kRoll ? rcs.roll_arm_m : rcs.pitch_yaw_arm_m)) * direction;
    changes = changes | (coasting_ & ((anew < torque[axis]) | (anew > torque[axis])));
    torque[axis] = Select(coasting_, anew, torque[axis]);
    firing = firing + Abs(direction);
  }
  const M fires = coasting_ & (firing > T(0.0));
  // A firing counts for as long as it lasts: until the next decision.
  const T expelled = Fma(T(flow_kg) * (next_tick_ - tick_), firing, step_.phase.expelled_kg);
  step_.phase.expelled_kg = Select(fires, expelled, step_.phase.expelled_kg);
  step_.MarkStale(changes | fires);
}

/// Metrics of this tick.
template <class T>
void Batch<T>::Meter(M powered) {
  const T pitch_error = -angle_rad_.y;
  if (Any(coasting_)) metrics_.AddCoast(coasting_, time_s_, pitch_error);
  if (!Any(powered)) return;
  const AxisOutput<T>& pitch = gimbals_.axes[kPitch];
  const LyapunovSample<T> law{pitch.v, Select(pitch.v_rate_sign < T(0.0), T(1.0), T(0.0)),
                              loop_.axes[kPitch].p11, pitch.departure_norm2};
  metrics_.AddPowered(powered, T(tick_s_), time_s_, {-angle_rad_.x, pitch_error, -angle_rad_.z},
                      step_.drive_state, step_.command_rad, loop_.limit_rad, law);

  const M is_transient =
      InTransient(time_s_, time_s_ - step_.phase.ignition_s, step_.now().altitude_m, definition_.kick_start_s,
                  definition_.kick_end_s, gust_bottom_m_, gust_top_m_);
  const unsigned metered = Bits(powered), interrupted = Bits(is_transient);
  const T* n = step_.drive_state.angle_rad;
  const T roll = T(0.25) * ((n[0] - n[1]) + (n[2] - n[3]));
  const T pitch_angle = T(0.5) * (n[0] + n[1]), yaw = T(0.5) * (n[2] + n[3]);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(metered >> lane & 1u)) continue;
    LimitCycleMeter& meter = slot_[lane].record->limit_cycle;
    if (interrupted >> lane & 1u)
      meter.Interrupt();
    else
      meter.Add(Lane(roll, lane), Lane(pitch_angle, lane), Lane(yaw, lane));
  }
}

template <class T>
void Batch<T>::WatchAndDigest() {
  const unsigned due = Bits(live_ & ((tick_ >= next_digest_tick_) | (tick_ >= next_row_tick_)));
  if (due == 0) return;
  const long second = static_cast<long>(ticks_a_second_);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(due >> lane & 1u)) continue;
    FlightRecord& record = *slot_[lane].record;
    const long tick = static_cast<long>(Lane(tick_, lane));
    if (record.watched) {
      LaneView view = ViewOf(lane);
      view.has_error = true;
      record.Watch(view, record.history_ticks > 0 && tick % record.history_ticks == 0);
      const bool every_tick = static_cast<bool>(record.options.observe);
      Lane(next_row_tick_, lane) =
          every_tick ? Lane(tick_, lane)
                     : static_cast<double>((tick / record.history_ticks + 1) * record.history_ticks);
    }
    if (static_cast<double>(tick) < Lane(next_digest_tick_, lane)) continue;
    if (tick % second == 0) {
      StateValues y;
      step_.ReadLane(lane, y);
      record.AddToDigest(Lane(time_s_, lane), y);
    }
    Lane(next_digest_tick_, lane) = static_cast<double>((tick / second + 1) * second);
  }
}

template <class T>
void Batch<T>::CheckEnds() {
  const T lost_angle2(kLostAngle_rad * kLostAngle_rad);
  const T angle2 = Dot(angle_rad_, angle_rad_);
  const T rate2 = Dot(step_.motion.w, step_.motion.w);
  const T lowest(definition_.vehicle.site.altitude_m - kImpactDepth_m);
  const M is_lost = angle2 > lost_angle2;
  const M is_fast = rate2 > T(kLostRate_rad_s * kLostRate_rad_s);
  const M is_low = step_.now().altitude_m < lowest;
  const M is_late = time_s_ > T(kTimeLimit_s);
  M suspects = live_ & (is_lost | is_fast | is_low | is_late | (lost_ticks_ > T(0.0)));
  const StructuralLimits& limits = definition_.vehicle.limits;
  if (limits.terminate) {
    const auto above = [](T value, double limit) { return value > T(limit > 0.0 ? limit : kFarFuture); };
    suspects = suspects | (live_ & (above(metrics_.q_alpha_max_pa_rad, limits.q_alpha_pa_rad) |
                                    above(metrics_.axial_load_max_g, limits.axial_load_g) |
                                    above(metrics_.lateral_load_max_g, limits.lateral_load_g)));
  }
  if (!Any(suspects)) return;
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(Bits(suspects) >> lane & 1u)) continue;
    // A sample stands for the ticks up to the next one; in the coast these are several.
    const double lost_ticks = Bits(is_lost) >> lane & 1u
                                  ? Lane(lost_ticks_, lane) + Lane(next_tick_, lane) - Lane(tick_, lane)
                                  : 0.0;
    Lane(lost_ticks_, lane) = lost_ticks;
    FlightSums loads;
    metrics_.Read(lane, loads);
    if (lost_ticks * tick_s_ >= kLostFor_s)
      End(lane, Outcome::kLostControl, "attitude error above 15 deg for 0.5 s");
    else if (Bits(is_fast) >> lane & 1u)
      End(lane, Outcome::kLostControl, "angular rate above 60 deg/s");
    else if (Bits(is_low) >> lane & 1u)
      End(lane, Outcome::kImpact, "fell below the launch site");
    else if (limits.terminate && ExceedsStructure(limits, loads))
      End(lane, Outcome::kStructuralLimit, "a structural limit of the vehicle was exceeded");
    else if (Bits(is_late) >> lane & 1u)
      End(lane, Outcome::kTimeout, "3600 s of simulated time passed");
  }
}

// ---- to the next tick ------------------------------------------------------------------------------------

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
      if (slot.next_event < slot.last_event) {
        const double event_s = slot.next_event->time_s;
        if (event_s < end - kSameInstant_s && event_s > now + kSameInstant_s) {
          goal = event_s;
          due |= 1u << lane;
        } else if (event_s <= end + kSameInstant_s) {
          // As good as now, or as good as at the end.
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
        for (int i = 0; i < kNozzles; ++i)
          Lane(step_.command_rad[i], lane) = Lane(next_command_rad_[i], lane);
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
  for (int i = 1; i <= most_steps_; ++i) {
    const T part(static_cast<double>(i));
    const M steps = moving & !failed & (part <= steps_a_tick_);
    const T end = Select(part >= steps_a_tick_, to, Fma(part / steps_a_tick_, to - from, from));
    const M accepted = step_.Step(steps, most_steps_ == 1 && All(steps | !live_), time_s_, end);
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
    if (!(Bits(moving) >> lane & 1u) || !slot_[lane].record->is_judged()) continue;
    const bool holds =
        slot_[lane].record->Judge(PhaseOf(lane), Lane(from, lane), Lane(to, lane), states[lane]);
    SetLane(failed, lane, !holds);
    Lane(time_s_, lane) = holds ? Lane(to, lane) : Lane(from, lane);
    step_.WriteLane(lane, states[lane]);
    step_.MarkMoved(lane);
  }
}

template <class T>
void Batch<T>::Happen(int lane) {
  Slot& slot = slot_[lane];
  const FlightEvent& event = *slot.next_event++;
  FlightRecord& record = *slot.record;
  switch (event.kind) {
    case EventKind::kIgnition:
      Lane(step_.phase.ignition_s, lane) = event.time_s;
      Ignite(lane, event.stage);
      break;
    case EventKind::kBurnout:
      BurnOut(lane, event.stage);
      break;
    case EventKind::kSeparation: {
      StateValues y;
      step_.ReadLane(lane, y);
      record.Separate(event.stage, y);
      step_.WriteLane(lane, y);
      SetStack(lane, event.stage + 1);
      SetLane(step_.phase.burnt, lane, false);
      SetLane(coasting_, lane, event.stage + 2 == static_cast<int>(record.plant.stacks.size()));
      for (T& command : step_.command_rad) Lane(command, lane) = 0.0;
      break;
    }
    case EventKind::kKink:
      step_.MarkMoved(lane);
      return;
  }
  step_.MarkMoved(lane);
  StateValues y;
  step_.ReadLane(lane, y);
  record.AddToDigest(Lane(time_s_, lane), y);
  if (record.watched) record.WatchEvent(ViewOf(lane));
  // The last event is the last stage's burnout.
  if (slot.next_event == slot.last_event) End(lane, Outcome::kCompleted, "");
}

template <class T>
void Batch<T>::Ignite(int lane, int stage) {
  Slot& slot = slot_[lane];
  FlightRecord& record = *slot.record;
  const FlightInputs& in = record.inputs;
  const AutopilotModel& autopilot = model_.autopilot();
  SetLane(step_.phase.burning, lane, true);
  SetLane(coasting_, lane, false);
  SetLane(step_.phase.control_torque_n_m, lane, Zero<double>());
  for (T& command : step_.command_rad) Lane(command, lane) = 0.0;
  for (auto& entry : delay_line_)
    for (T& command : entry) Lane(command, lane) = 0.0;

  AutopilotState state;
  for (int axis = 0; axis < kAxes; ++axis) ReadLane(axes_[axis], lane, state.axes[axis]);
  StartStage(autopilot, stage, state);
  for (int axis = 0; axis < kAxes; ++axis) {
    SetLane(axes_[axis], lane, state.axes[axis]);
    Lane(thrusters_[axis].direction, lane) = Lane(thrusters_[axis].cycles_on, lane) = 0.0;
  }
  // The last stage's are nobody's now.
  const AxisOutput<double> nothing{};
  for (int axis = 0; axis < kAxes; ++axis) {
    Lane(gimbals_.deflection_rad[axis], lane) = 0.0;
    SetLane(gimbals_.axes[axis], lane, nothing);
  }
  const int loop_stage = static_cast<int>(in.loop_stage + 0.5);
  const bool is_changed = loop_stage == 0 || loop_stage == stage + 1;
  SetLane(loop_, lane, autopilot, stage, in.pn_error_factor, in.pn_rate_factor,
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
    if (Bits(step_.phase.burning) >> i & 1u)
      same_delay_ &= slot_[i].part_delay_s == 0.0 && slot_[i].whole_delay == common_delay_;

  slot.stuck_nozzle = -1;
  const int stuck = static_cast<int>(in.stuck_nozzle + 0.5);
  if (static_cast<int>(in.stuck_nozzle_stage + 0.5) == stage + 1 && stuck > 0) {
    slot.stuck_nozzle = stuck - 1;
    Lane(step_.drive_state.angle_rad[slot.stuck_nozzle], lane) = in.stuck_nozzle_rad;
  }
  SetLane(step_.drives, lane, gimbal, slot.stuck_nozzle);
  if (stage > 0 && stage + 1 == static_cast<int>(record.plant.stacks.size())) {
    StateValues y;
    step_.ReadLane(lane, y);
    record.HandOver(Lane(time_s_, lane), y);
  }
}

template <class T>
void Batch<T>::BurnOut(int lane, int stage) {
  FlightRecord& record = *slot_[lane].record;
  StateValues y;
  step_.ReadLane(lane, y);
  // Loads peak here, between ticks.
  const Instant<double> now = step_.InstantOf(lane, time_s_);
  metrics_.AddLoadsOfLane(lane, now);
  metrics_.EndStage(lane, stage, record.sums);
  record.limit_cycle.Interrupt();
  SetLane(step_.phase.burning, lane, false);
  SetLane(step_.phase.burnt, lane, true);
  if (stage + 1 == static_cast<int>(record.plant.stacks.size())) record.Inject(now.altitude_m, y);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
