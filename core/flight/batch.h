// The engine: W closed-loop flights side by side, each from lift-off to injection or to its failure.
//
// In a pass each flying lane stands at its own tick. The errors are measured, the autopilot or the reaction
// control decides, metrics are taken, and the plant moves on to the lane's next tick. On the way it stops at
// the lane's events at their exact times. Lanes do not depend on each other: they may be in different stages
// and at different times since lift-off. A lane whose flight ends takes the next flight of the queue.
//
// This file fills and empties lanes. batch_pass.h does the work of a tick, batch_events.h moves a lane on to
// its next tick. The record (flight_record.h) does what happens once a flight or once an event, and what only
// watched flights need. The engine is compiled once for each instruction set and width (fly_lanes.cc).
#pragma once

#include "core/control/autopilot_step.h"
#include "core/dynamics/fall.h"
#include "core/dynamics/launcher_lanes.h"
#include "core/flight/flight_queue.h"
#include "core/flight/flight_sums.h"
#include "core/flight/lane_sensors.h"
#include "core/flight/nozzle_allocation.h"
#include "core/flight/sequence.h"
#include "core/flight/simpson_step.h"
#include "core/flight/step_limits.h"
#include "core/flight/structural_limits.h"

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

  /// Per-lane bookkeeping that is not a SIMD value.
  struct Slot {
    FlightRecord* record = nullptr;  ///< null: the lane does not fly
    std::size_t next_event = 0;      ///< of its record's
    int stack = 0;
    unsigned jettisoned = 0;  ///< LauncherPhase's
    int stuck_nozzle = -1;
    bool past_last_burn = false;
    bool tails_off = false;     ///< the cut-off has been commanded, and the thrust decays
    int whole_delay = 0;        ///< ticks between command and actuator, and
    double part_delay_s = 0.0;  ///< a part of one
    double switch_s = 0.0;      ///< when, within a tick, the next command gets through
  };

  // ---- lanes that come, stand and go ----
  void Refill();
  void Start(int lane, FlightRecord* record);
  void SetStack(int lane, int stack);
  void SetMass(int lane);
  void SetAllocation(int lane, const NozzleLayout& layout);
  void SetShape(int lane);
  void SetStop(int lane);
  void SetUnsteered(int lane);
  /// Null: the lane's last event has happened.
  const FlightEvent* NextEvent(int lane) const {
    const Slot& slot = slot_[lane];
    const auto& events = slot.record->events;
    return slot.next_event < events.size() ? events.data() + slot.next_event : nullptr;
  }
  /// Whether guidance gives the lane a reference of its own.
  bool IsGuided(int lane) const {
    return definition_.guidance.closed_loop && slot_[lane].record != nullptr &&
           slot_[lane].record->guided->steers();
  }
  void End(int lane, Outcome outcome, const char* reason);
  LauncherPhase PhaseOf(int lane) const;
  LaneView ViewOf(int lane) const;

  // ---- a pass ----
  void Pass();
  void Measure();
  void MeasureBySensors(const T* reference);
  Vector<T> GyroRates(Vector<T> unit_rad_s);
  void DriftOn();
  void AverageNoise();
  void FlyGimbals();
  template <bool kAll>
  void FlyGimbalsOf(M powered);
  const T* PluginCommands(M powered, const T* program, T* command);
  const T* FedForward(T* program) const;
  void PassCommands(M powered);
  T FeltAboutAll(int axis) const;
  void RollByThrusters(M rolling);
  void FlyThrusters();
  void LetGo();
  void CutOff();
  void CutOffByGuidance(int lane, double lead_s, double growing_m_s2);
  void CutOffAt(int lane, double at_s);
  void Guide();
  void Meter(M powered);
  void WatchAndDigest();
  void MeterFree();
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
  const double ticks_a_second_;
  const bool has_jettisons_, cuts_off_in_flight_, has_plugin_;
  const int most_banks_;                  ///< of nozzles, of any stage
  const bool has_free_stage_, flies_on_;  ///< flies_on_: after the last burn
  Slot slot_[kLanes];
  int flying_ = 0;         ///< lanes
  unsigned patience_ = 0;  ///< passes until the queue is asked again

  M live_, coasting_;
  M unsteered_;  ///< nothing controls their attitude
  T time_s_, tick_, next_tick_;
  T stop_s_;  ///< when the next event or switch of commands is due
  T next_digest_tick_, next_row_tick_;
  T lost_ticks_;  ///< for which the attitude has been lost
  StepState<T> step_;
  // Of nozzles, bank by bank: nothing touches those that the vehicle does not have.
  BankAllocation<T> allocation_[kBanks];  ///< of listed nozzles
  T next_command_rad_[kBanks][kDrives];
  T delay_line_[kBanks][kDelayLine][kDrives];  ///< commands by pass
  int line_at_ = 0;
  bool same_delay_ = true;  ///< all lanes that burn have one of whole ticks:
  int common_delay_ = 0;

  Vector<T> angle_rad_, rate_rad_s_;                    ///< error, reference less true
  Vector<T> measured_angle_rad_, measured_rate_rad_s_;  ///< as the sensors see it, and
  Vector<T> measured_body_rate_rad_s_;                  ///< the rate of the body itself
  Vector<T> gyro_bias_rad_s_;
  InertialUnit<T> unit_;
  M drifts_;  ///< whose gyros have a bias or noise, or whose unit is misaligned
  GyroMemory<T> gyros_[kRateGyros];
  T gyro_weight_[kRateGyros], unit_weight_;  ///< of the measured rates
  M gyros_fresh_;                            ///< have not been read since ignition
  bool any_drift_ = false, any_judged_ = false;
  T steps_a_tick_;
  int most_steps_ = 1;

  GimbalLoop<T> loop_;
  AxisMemory<T> axes_[kAxes];
  GimbalOutput<T> gimbals_;
  ThrusterStateOf<T> thrusters_[kAxes];
  LaneMetrics<T> metrics_;
  T gust_bottom_m_, gust_top_m_;
  T roll_rate_peak_rad_s_, least_static_margin_;  ///< of stages without gimbal
};

/// Passes between two questions to an empty queue while other lanes fly.
inline constexpr unsigned kPatience = 256;
inline constexpr double kFarFuture = 1e300;

template <class T>
Batch<T>::Batch(const FlightModel& model, FlightQueue& queue)
    : model_(model),
      definition_(model.definition()),
      queue_(queue),
      tick_s_(definition_.autopilot.tick_s),
      ticks_a_second_(static_cast<double>(static_cast<long>(1.0 / tick_s_ + 0.5))),
      has_jettisons_(!model.nominal_plant().jettisons.empty()),
      cuts_off_in_flight_(CutsOffInFlight(definition_.vehicle)),
      has_plugin_(model.autopilot().plugin != nullptr),
      most_banks_(model.nominal_plant().nozzle_banks()),
      has_free_stage_(model.has_free_stage()),
      flies_on_(definition_.course.ends != FlightEnd::kInjection) {
  // Lanes that never fly compute along with the others, on numbers that do no harm.
  const auto banks = static_cast<std::size_t>(most_banks_);
  __builtin_memset(static_cast<void*>(&allocation_), 0, banks * sizeof allocation_[0]);
  __builtin_memset(static_cast<void*>(&next_command_rad_), 0, banks * sizeof next_command_rad_[0]);
  __builtin_memset(static_cast<void*>(&delay_line_), 0, banks * sizeof delay_line_[0]);
  __builtin_memset(static_cast<void*>(&loop_), 0, sizeof loop_);
  __builtin_memset(static_cast<void*>(&axes_), 0, sizeof axes_);
  __builtin_memset(static_cast<void*>(&gimbals_), 0, sizeof gimbals_);
  __builtin_memset(static_cast<void*>(&thrusters_), 0, sizeof thrusters_);
  __builtin_memset(static_cast<void*>(&metrics_), 0, sizeof metrics_);
  __builtin_memset(static_cast<void*>(&unit_), 0, sizeof unit_);
  __builtin_memset(static_cast<void*>(&gyros_), 0, sizeof gyros_);
  const LauncherPlant& nominal = model.nominal_plant();
  step_.Configure(nominal, tick_s_);
  for (int lane = 0; lane < kLanes; ++lane) {
    SetLane(live_, lane, false);
    SetLane(coasting_, lane, false);
    SetLane(unsteered_, lane, false);
    SetLoop(loop_, lane, model.autopilot(), 0, 1.0, 1.0, 1.0);
    SetLane(drifts_, lane, false);
    SetLane(gyros_fresh_, lane, false);
  }
  time_s_ = tick_ = next_tick_ = lost_ticks_ = T(0.0);
  stop_s_ = next_digest_tick_ = next_row_tick_ = T(kFarFuture);
  steps_a_tick_ = T(1.0);
  gyro_bias_rad_s_ = Zero<T>();
  for (T& weight : gyro_weight_) weight = T(0.0);
  unit_weight_ = unit_.truth.w = unit_.measured.w = T(1.0);
  gust_bottom_m_ = gust_top_m_ = T(0.0);
  roll_rate_peak_rad_s_ = T(kNoPeak);
  least_static_margin_ = T(kFarFuture);
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
  ++flying_;
  SetLane(live_, lane, true);
  SetLane(coasting_, lane, false);
  Lane(time_s_, lane) = Lane(tick_, lane) = Lane(next_tick_, lane) = 0.0;
  Lane(next_digest_tick_, lane) = Lane(lost_ticks_, lane) = 0.0;
  Lane(next_row_tick_, lane) = record->watched ? 0.0 : kFarFuture;
  const AxisState fresh;
  for (AxisMemory<T>& axis : axes_) SetLaneValues<T>(axis, lane, fresh);
  for (ThrusterStateOf<T>& thruster : thrusters_) SetLane(thruster, lane, ThrusterState{});
  metrics_.StartFlight(lane);
  const FlightInputs& in = record->inputs;
  SetLane(gyro_bias_rad_s_, lane,
          {in.gyro_bias_roll_rad_s, in.gyro_bias_pitch_rad_s, in.gyro_bias_yaw_rad_s});
  Lane(gust_bottom_m_, lane) = in.gust_altitude_m;
  Lane(gust_top_m_, lane) =
      in.gust_speed_m_s != 0.0 ? in.gust_altitude_m + in.gust_length_m : in.gust_altitude_m;
  Lane(steps_a_tick_, lane) = record->options.steps_per_tick;
  SetLane(drifts_, lane,
          record->noisy || in.launch_azimuth_error_rad != 0.0 || in.gyro_bias_roll_rad_s != 0.0 ||
              in.gyro_bias_pitch_rad_s != 0.0 || in.gyro_bias_yaw_rad_s != 0.0);
  Lane(unit_weight_, lane) = 1.0;
  for (T& weight : gyro_weight_) Lane(weight, lane) = 0.0;
  Lane(roll_rate_peak_rad_s_, lane) = kNoPeak;
  Lane(least_static_margin_, lane) = kFarFuture;
  any_drift_ = Any(drifts_ & live_);
  any_judged_ = false;
  most_steps_ = 1;
  for (const Slot& each : slot_) {
    if (each.record == nullptr) continue;
    any_judged_ |= each.record->replaces_steps();
    if (each.record->options.steps_per_tick > most_steps_) most_steps_ = each.record->options.steps_per_tick;
  }
  step_.StartFlight(lane, record->weather, record->lift_off);
  unit_.Start(lane, step_.motion().q, record->believed_attitude);
  SetStack(lane, 0);
  if (record->refusal != nullptr) {
    End(lane, record->refused_as, record->refusal);
    return;
  }
  // Events before lift-off happen at lift-off.
  while (slot.record != nullptr && NextEvent(lane) != nullptr && NextEvent(lane)->time_s <= kSameInstant_s)
    Happen(lane);
  if (slot.record != nullptr) SetStop(lane);
}

template <class T>
void Batch<T>::SetStack(int lane, int stack) {
  Slot& slot = slot_[lane];
  slot.stack = stack;
  slot.stuck_nozzle = -1;
  slot.switch_s = kFarFuture;
  step_.SetStack(lane, slot.record->plant, stack);
  SetUnsteered(lane);
  SetMass(lane);
  SetShape(lane);
  if (!step_.plant().nozzles_listed) return;
  SetAllocation(lane, slot.record->plant.LayoutOf(stack, stack == 0));
}

/// Boosters burn, or would, while the first stack is as it was at lift-off.
template <class T>
void Batch<T>::SetAllocation(int lane, const NozzleLayout& layout) {
  // A stage without further banks sets them to nothing.
  for (int bank = 0; bank < most_banks_; ++bank) SetLane(allocation_[bank], lane, AllocationOf(layout, bank));
}

/// Thrusters hold a stage without gimbal while it coasts.
template <class T>
void Batch<T>::SetUnsteered(int lane) {
  const Slot& slot = slot_[lane];
  const bool is_fixed = slot.record->plant.stacks.data()[slot.stack].gimbal.fixed;
  SetLane(unsteered_, lane, slot.past_last_burn || (is_fixed && !(Bits(coasting_) >> lane & 1u)));
}

/// Sets the mass of the bodies that the lane's stack still carries.
template <class T>
void Batch<T>::SetMass(int lane) {
  const Slot& slot = slot_[lane];
  if (slot.jettisoned == 0) return;
  StackMass mass;
  slot.record->MassWithout(slot.stack, slot.jettisoned, mass);
  step_.SetMass(lane, mass, slot.record->BendingWithout(slot.stack, slot.jettisoned));
}

/// Sets the aerodynamics of the lane's stack: those after its jettisons, with the motor burning or out.
template <class T>
void Batch<T>::SetShape(int lane) {
  const Slot& slot = slot_[lane];
  const LauncherStack& stack = slot.record->plant.stacks.data()[slot.stack];
  if (stack.aero_variants.get() == nullptr) return;
  const bool burning = Bits(step_.phase().burning) >> lane & 1u;
  step_.SetShape(lane, stack, stack.AeroAfter(slot.jettisoned, burning));
}

template <class T>
void Batch<T>::SetStop(int lane) {
  const FlightEvent* next = NextEvent(lane);
  Lane(stop_s_, lane) = Min(next != nullptr ? next->time_s : kFarFuture, slot_[lane].switch_s);
}

template <class T>
void Batch<T>::End(int lane, Outcome outcome, const char* reason) {
  Slot& slot = slot_[lane];
  FlightRecord* record = slot.record;
  StateValues y;
  step_.ReadLane(lane, y);
  if (Bits(step_.phase().burning) >> lane & 1u) metrics_.EndStage(lane, slot.stack, record->sums);
  metrics_.Read(lane, record->sums);
  record->sums.expelled_kg = Lane(step_.phase().expelled_kg, lane);
  record->sums.free.roll_rate_peak_rad_s = Lane(roll_rate_peak_rad_s_, lane);
  if (const double least = Lane(least_static_margin_, lane); least < kFarFuture)
    record->sums.free.least_static_margin = least;
  record->sums.rules_fired = static_cast<std::uint32_t>(ToBits(Lane(axes_[kPitch].rules_fired, lane)));
  record->End(outcome, reason, Lane(time_s_, lane), slot.stack, y);
  slot.record = nullptr;
  slot.switch_s = kFarFuture;
  step_.EndFlight(lane);
  --flying_;
  patience_ = 0;
  SetLane(live_, lane, false);
  SetLane(coasting_, lane, false);
  Lane(stop_s_, lane) = Lane(next_digest_tick_, lane) = Lane(next_row_tick_, lane) = kFarFuture;
  queue_.Done(record);
}

template <class T>
LauncherPhase Batch<T>::PhaseOf(int lane) const {
  LauncherPhase phase;
  phase.stack = slot_[lane].stack;
  phase.jettisoned = slot_[lane].jettisoned;
  phase.boosters_burning = step_.BoostersBurning(lane);
  phase.burning = Bits(step_.phase().burning) >> lane & 1u;
  phase.burnt = Bits(step_.phase().burnt) >> lane & 1u;
  phase.ignition_s = Lane(step_.phase().ignition_s, lane);
  phase.expelled_mass_kg = Lane(step_.phase().expelled_kg, lane);
  for (int axis = 0; axis < 3; ++axis)
    phase.control_torque_n_m.data()[axis] = Lane(step_.phase().control_torque_n_m[axis], lane);
  for (int i = 0; i < most_banks_ * kDrives; ++i)
    phase.command_rad.data()[i] = Lane(step_.command_rad(i / kDrives)[i % kDrives], lane);
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
  view.unsteered = Bits(unsteered_) >> lane & 1u;
  for (int axis = 0; axis < kAxes; ++axis) {
    view.error_angle_rad[axis] = Lane(angle_rad_[axis], lane);
    view.error_rate_rad_s[axis] = Lane(rate_rad_s_[axis], lane);
    view.thrusters[axis] = static_cast<int>(Lane(thrusters_[axis].direction, lane));
    // Without thrust the lane's autopilot does not act. The values in its place come from neighbouring lanes.
    if (!view.phase.burning || (Bits(unsteered_) >> lane & 1u)) continue;
    view.gimbal_rad[axis] = Lane(gimbals_.deflection_rad[axis], lane);
    view.axes[axis] =
        TelemetryOf(model_.autopilot().laws.data()[axis].config, gimbals_.axes[axis], axes_[axis], lane);
    ReadLaneValues<T>(axes_[axis], lane, view.memories[axis]);
  }
  return view;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
