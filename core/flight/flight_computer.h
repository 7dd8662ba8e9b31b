// The flight computer of W flights side by side (core/math/lanes.h): what sensors show goes in, commands to
// actuators and thrusters come out, and events that it decides: cut-offs, and those that guidance moves.
//
// Behind it stand alike the control laws (core/control), plug-ins, closed-loop guidance and the reaction
// control. Of the plant it reads the stage's configuration and its time of ignition. Cut-offs see the true
// speed, and guidance the true state, to which it adds errors of its own (guided_flight.h). Jettisons are the
// record's decision. A command goes to the actuators through a line of delays (delay_line.h).
#pragma once

#include "core/control/autopilot_step.h"
#include "core/flight/delay_line.h"
#include "core/flight/flight_model.h"
#include "core/flight/simpson_step.h"
#include "core/flight/standing.h"
#include "core/math/constants.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// What the sensors show at a tick.
template <class T>
struct Sensed {
  AttitudeErrors<T> errors;
  Vector<T> body_rate_rad_s;  ///< set where a plug-in reads it
};

template <class T>
class FlightComputer {
  using M = MaskOf<T>;
  static constexpr int kLanes = kWidth<T>;

 public:
  void Configure(const FlightModel& model) {
    model_ = &model;
    tick_s_ = model.definition().autopilot.tick_s;
    has_plugin_ = model.autopilot().plugin != nullptr;
    line_.Configure(model.nominal_plant().nozzle_banks());
    for (int lane = 0; lane < kLanes; ++lane) SetLoop(loop_, lane, model.autopilot(), 0, 1.0, 1.0, 1.0);
  }

  // ---- a lane's flight ----
  void StartFlight(int lane) {
    const AxisState fresh;
    for (AxisMemory<T>& axis : axes_) SetLaneValues<T>(axis, lane, fresh);
    for (ThrusterStateOf<T>& thruster : thrusters_) SetLane(thruster, lane, ThrusterState{});
    tails_off_[lane] = false;
  }
  /// Allocates to a stack's nozzles. Boosters burn, or would, while the first stack is as it was at lift-off.
  void SetNozzles(int lane, const NozzleLayout& layout) { line_.SetAllocation(lane, layout); }
  /// No command is on the way.
  void EndCommands(int lane) { line_.Forget(lane); }
  void StartStage(int lane, int stage, const Standing<T>& at, M burning);
  void EndStage(int lane) {
    tails_off_[lane] = false;
    // Thrusters held the roll before: their state ends.
    SetLane(thrusters_[kRoll], lane, ThrusterState{});
  }

  // ---- sensors in, commands out ----
  /// A tick of powered lanes. Returns whether a command gets through within the tick.
  bool Steer(M powered, const Standing<T>& at, const Sensed<T>& sensed, StepState<T>& step);
  /// A tick of coasting lanes. Sets the tick of their next decision.
  void HoldCoast(Standing<T>& at, const Sensed<T>& sensed, StepState<T>& step);
  /// Time at which the lane's next command gets through within the tick, and its way there.
  double switch_s(int lane) const { return line_.switch_s(lane); }
  void Switch(int lane, StepState<T>& step) { line_.Switch(lane, step); }

  // ---- events out ----
  /// When the burn of a lane is to end, if that is before the next tick, else kFarFuture. The computer
  /// extrapolates the speed over the next tick at its present growth. It commands the cut-off for the instant
  /// at which the speed is reached, or CutOffLead() earlier. The growth is then the mean of that time: the
  /// acceleration by thrust grows by its square over the exhaust velocity.
  double CutOffTime(int lane, const Standing<T>& at, const StepState<T>& step) const;
  /// The cut-off of the lane's burn has been commanded. `decays`: its thrust goes on for some time.
  void Commanded(int lane, bool decays) { tails_off_[lane] = decays; }
  /// Whether closed-loop guidance wants to see the lane now.
  bool WantsToGuide(int lane, const Standing<T>& at) const {
    const Slot& slot = at.slot[lane];
    return slot.record != nullptr && !slot.past_last_burn && !tails_off_[lane] &&
           Lane(at.tick, lane) >= slot.record->guided->next_tick();
  }
  /// Guidance sees the lane. True when events have moved.
  bool Guide(int lane, const Standing<T>& at, const Sensed<T>& sensed, const StepState<T>& step) const;

  // ---- for metrics and histories ----
  const GimbalOutput<T>& output() const { return gimbals_; }
  const StageLawOf<T>& law(int axis) const { return loop_.axes[axis]; }
  T limit_rad() const { return loop_.limit_rad; }
  const AxisMemory<T>& memory(int axis) const { return axes_[axis]; }
  const ThrusterStateOf<T>& thruster(int axis) const { return thrusters_[axis]; }
  const BankAllocation<T>& allocation(int bank) const { return line_.allocation(bank); }
  /// The command about an axis that the present deflections of all listed nozzles stand for.
  T FeltAboutAll(int axis, const StepState<T>& step) const {
    T felt(0.0);
    for (int bank = 0; bank < step.plant().banks; ++bank) {
      const BankState<T>& drives = step.drives(bank);
      const T all = FeltAbout(allocation(bank), axis, drives.first.angle_rad, drives.second.angle_rad, felt);
      felt = Select(step.plant().bank[bank].driven, all, felt);
    }
    return felt;
  }

 private:
  template <bool kAll>
  void SteerAxes(M powered, const Standing<T>& at, const Sensed<T>& sensed, T since_ignition_s) {
    T program[FeedForwardRows::kRowSize], foreign[kAxes];
    const T* const fed = FedForward(at, program);
    const T* const commanded =
        has_plugin_ ? PluginCommands(powered, at, sensed, since_ignition_s, fed, foreign) : nullptr;
    StepGimbals<kAll>(model_->autopilot(), loop_, powered, since_ignition_s, sensed.errors.angle_rad,
                      sensed.errors.rate_rad_s, fed, commanded, axes_, gimbals_);
  }
  const T* FedForward(const Standing<T>& at, T* program) const;
  const T* PluginCommands(M powered, const Standing<T>& at, const Sensed<T>& sensed, T since_ignition_s,
                          const T* program, T* command) const;
  void RollByThrusters(M rolling, const Standing<T>& at, const Sensed<T>& sensed, StepState<T>& step);
  double CutOffByGuidance(int lane, double lead_s, double growing_m_s2, const Standing<T>& at,
                          const StepState<T>& step) const;

  const FlightModel* model_;
  double tick_s_;
  bool has_plugin_;
  GimbalLoop<T> loop_;
  AxisMemory<T> axes_[kAxes];
  GimbalOutput<T> gimbals_;
  ThrusterStateOf<T> thrusters_[kAxes];
  bool tails_off_[kLanes];  ///< the cut-off has been commanded, and the thrust decays
  DelayLine<T> line_;
};

template <class T>
void FlightComputer<T>::StartStage(int lane, int stage, const Standing<T>& at, M burning) {
  const AutopilotModel& autopilot = model_->autopilot();
  const FlightRecord& record = *at.slot[lane].record;
  AutopilotState state;
  for (int axis = 0; axis < kAxes; ++axis) ReadLaneValues<T>(axes_[axis], lane, state.axes[axis]);
  dispersa::StartStage(autopilot, stage, state);
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
    record.law->StartStage(of_stage, Lane(at.time_s, lane));
  }
  // The outputs of the last stage belong to no stage now.
  SetLane(gimbals_, lane, GimbalOutput<double>{});
  const FlightInputs& in = record.inputs;
  const int loop_stage = static_cast<int>(in.loop_stage + 0.5);
  const bool is_changed = loop_stage == 0 || loop_stage == stage + 1;
  SetLoop(loop_, lane, autopilot, stage, in.pn_error_factor, in.pn_rate_factor,
          is_changed ? in.loop_gain_factor : 1.0);
  line_.StartStage(
      lane,
      record.plant.stacks.data()[stage].gimbal.delay_ticks + (is_changed ? in.loop_delay_s / tick_s_ : 0.0),
      tick_s_, burning);
}

template <class T>
bool FlightComputer<T>::Steer(M powered, const Standing<T>& at, const Sensed<T>& sensed, StepState<T>& step) {
  const bool listed = step.plant().nozzles_listed;
  AxisMemory<T> of_roll;
  if (listed) of_roll = axes_[kRoll];
  const T since_ignition_s = at.time_s - step.phase().ignition_s;
  if (All(powered))
    SteerAxes<true>(powered, at, sensed, since_ignition_s);
  else
    SteerAxes<false>(powered, at, sensed, since_ignition_s);
  const bool switches = line_.Pass(powered, at.time_s, gimbals_.deflection_rad, step);
  if (!listed) return switches;
  const M rolling = powered & (allocation(0).rolls_by_thrusters > T(0.0));
  if (!Any(rolling)) return switches;
  Blend<T>(rolling, of_roll, axes_[kRoll]);  // restores roll memory: its command was not applied
  RollByThrusters(rolling, at, sensed, step);
  return switches;
}

/// The commands of a law from a shared object or from Python: each lane by itself, in ordinary code.
template <class T>
const T* FlightComputer<T>::PluginCommands(M powered, const Standing<T>& at, const Sensed<T>& sensed,
                                           T since_ignition_s, const T* program, T* command) const {
  T of_roll, of_pitch;
  Effectiveness(loop_, since_ignition_s, of_roll, of_pitch);
  for (int lane = 0; lane < kLanes; ++lane) {
    dispersa_law_input input{};
    double wanted[kAxes] = {};
    if (Bits(powered) >> lane & 1u) {
      input.time_s = Lane(at.time_s, lane);
      input.since_ignition_s = Lane(since_ignition_s, lane);
      input.stage = static_cast<std::uint32_t>(at.slot[lane].stack);
      for (int axis = 0; axis < kAxes; ++axis) {
        input.angle_error_rad[axis] = Lane(sensed.errors.angle_rad[axis], lane);
        input.rate_error_rad_s[axis] = Lane(sensed.errors.rate_rad_s[axis], lane);
        input.rate_rad_s[axis] = Lane(sensed.body_rate_rad_s[axis], lane);
        input.effectiveness_1_s2[axis] = Lane(axis == kRoll ? of_roll : of_pitch, lane);
        if (program != nullptr) input.program_rad_s2[axis] = Lane(program[axis], lane);
        input.saturation[axis] = Lane(axes_[axis].saturation, lane);
      }
      at.slot[lane].record->law->Step(input, wanted);
    }
    for (int axis = 0; axis < kAxes; ++axis) Lane(command[axis], lane) = wanted[axis];
  }
  return command;
}

/// The feed-forward that the flight program asks of each lane's axes at its tick; null where nothing is fed
/// forward. The body axes stand for the reference's axes: an attitude error of one degree mixes a fiftieth
/// part of a small quantity.
template <class T>
const T* FlightComputer<T>::FedForward(const Standing<T>& at, T* program) const {
  const FeedForwardRows& table = model_->feed_forward_rows();
  if (table.rows.empty()) return nullptr;
  const double* row[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const double tick = Min(Lane(at.tick, lane), model_->reference_rows().last_tick);
    row[lane] = table.rows.data() + FeedForwardRows::kRowSize * static_cast<long>(tick);
    if (model_->definition().guidance.closed_loop && at.slot[lane].IsGuided())
      row[lane] = at.slot[lane].record->guided->feed_forward_row();
  }
  LoadFour(row, program);
  return program;
}

/// Two thrusters of an axis, of which each one's thrust acts at the axis' arm.
struct ThrusterPair {
  double thrust_n;  ///< of both
  double tick_kg;   ///< that both expel in a tick
};
inline ThrusterPair PairOf(const ReactionControl& rcs, double tick_s) {
  const double thrust_n = 2.0 * rcs.thrust_n;
  return {thrust_n, thrust_n / (rcs.specific_impulse_s * kStandardGravity) * tick_s};
}

/// Roll control of stages whose nozzles cannot roll: the thrusters of the coast fire in the same cycles while
/// the motor burns.
template <class T>
void FlightComputer<T>::RollByThrusters(M rolling, const Standing<T>& at, const Sensed<T>& sensed,
                                        StepState<T>& step) {
  const AutopilotModel& autopilot = model_->autopilot();
  const ReactionControlLogic& logic = autopilot.config.reaction_control;
  const ReactionControl& rcs = model_->definition().vehicle.reaction_control;
  M decides = NoLane<T>();
  for (int lane = 0; lane < kLanes; ++lane)
    SetLane(decides, lane, static_cast<long>(Lane(at.tick, lane)) % logic.cycle_ticks == 0);
  decides = decides & rolling;
  StepThrusters(logic, autopilot.thruster_minimum_cycles, decides, sensed.errors.angle_rad.x,
                sensed.errors.rate_rad_s.x, thrusters_[kRoll]);
  const ThrusterPair pair = PairOf(rcs, tick_s_);
  const T direction = thrusters_[kRoll].direction;
  Vector<T> torque_n_m = step.phase().control_torque_n_m;
  torque_n_m.x = T(pair.thrust_n * rcs.roll_arm_m) * direction;
  step.SetControlTorque(rolling, torque_n_m);
  step.Expel(rolling & (Abs(direction) > T(0.0)), T(pair.tick_kg), Abs(direction));
}

/// The coast: decisions fall on the thrusters' cycles, and on the first tick after an event.
template <class T>
void FlightComputer<T>::HoldCoast(Standing<T>& at, const Sensed<T>& sensed, StepState<T>& step) {
  const AutopilotModel& autopilot = model_->autopilot();
  const ReactionControlLogic& logic = autopilot.config.reaction_control;
  const ReactionControl& rcs = model_->definition().vehicle.reaction_control;
  const unsigned coasting = Bits(at.coasting);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(coasting >> lane & 1u)) continue;
    const long tick = static_cast<long>(Lane(at.tick, lane));
    const long cycle_end = (tick / logic.cycle_ticks + 1) * logic.cycle_ticks;
    // The first tick at or after the next event: rounded up.
    const FlightEvent& event = at.slot[lane].record->events.data()[at.slot[lane].next_event];
    const double event_ticks = (event.time_s - kSameInstant_s) / tick_s_;
    long event_tick = static_cast<long>(event_ticks);
    if (static_cast<double>(event_tick) < event_ticks) ++event_tick;
    long next = cycle_end < event_tick ? cycle_end : event_tick;
    if (next <= tick) next = tick + 1;
    Lane(at.next_tick, lane) = static_cast<double>(next);
  }
  const ThrusterPair pair = PairOf(rcs, tick_s_);
  Vector<T> torque_n_m;
  T firing(0.0);
  for (int axis = 0; axis < kAxes; ++axis) {
    StepThrusters(logic, autopilot.thruster_minimum_cycles, at.coasting, sensed.errors.angle_rad[axis],
                  sensed.errors.rate_rad_s[axis], thrusters_[axis]);
    const T direction = thrusters_[axis].direction;
    torque_n_m[axis] = T(pair.thrust_n * (axis == kRoll ? rcs.roll_arm_m : rcs.pitch_yaw_arm_m)) * direction;
    firing = firing + Abs(direction);
  }
  step.SetControlTorque(at.coasting, torque_n_m);
  // A firing counts for as long as it lasts: until the next decision.
  step.Expel(at.coasting & (firing > T(0.0)), T(pair.tick_kg) * (at.next_tick - at.tick), firing);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
