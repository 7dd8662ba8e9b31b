// A pass of the batch (batch.h): measure, decide, take metrics, end.
#pragma once

#include "core/flight/batch.h"
#include "core/vehicle/cut_off.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// A vehicle this far below its site has hit the ground.
inline constexpr double kImpactDepth_m = 10.0;

template <class T>
void Batch<T>::Pass() {
  next_tick_ = Select(live_, tick_ + T(1.0), tick_);
  Measure();
  FlyGimbals();
  if (Any(coasting_)) FlyThrusters();
  step_.EvaluateStart(time_s_);
  if (has_jettisons_) LetGo();
  if (cuts_off_in_flight_) CutOff();
  if (definition_.guidance.closed_loop) Guide();
  metrics_.AddLoads(live_ & !coasting_, step_.now());
  metrics_.AddMoment(live_ & !coasting_, step_.LargestMomentNow(metrics_.sums.bending_moment_max_n_m));
  M metered = live_ & step_.phase().burning;
  if (has_free_stage_) {
    metered = metered & !unsteered_;
    MeterFree();
  }
  Meter(metered);
  WatchAndDigest();
  if (flies_on_) FlyOn();
  CheckEnds();
  if (flying_ > 0) Advance();
}

/// Jettisons, which the flight computer decides on its ticks.
template <class T>
void Batch<T>::LetGo() {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(Bits(live_) >> lane & 1u)) continue;
    Slot& slot = slot_[lane];
    StateValues y;
    step_.ReadLane(lane, y);
    const unsigned due = slot.record->LetGo(
        slot.stack, slot.jettisoned, Lane(time_s_, lane), Lane(step_.now().altitude_m, lane),
        Lane(step_.density_kg_m3(), lane), Lane(step_.propellant_kg(), lane), y);
    if (due == 0) continue;
    slot.jettisoned |= due;
    step_.WriteLane(lane, y);
    SetMass(lane);
    SetShape(lane);
    slot.record->AddToDigest(Lane(time_s_, lane), y);
    if (slot.record->watched) slot.record->WatchEvent(ViewOf(lane));
  }
  step_.EvaluateStart(time_s_);
}

/// Engines that are cut off at an inertial speed, or by guidance. The flight computer extrapolates the speed
/// over the next tick at its present growth. It commands the cut-off for the instant at which the speed is
/// reached, or CutOffLead() earlier. The growth is then the mean of that time: the acceleration by thrust
/// grows by its square over the exhaust velocity.
template <class T>
void Batch<T>::CutOff() {
  const unsigned burning = Bits(live_ & step_.phase().burning);
  for (int lane = 0; lane < kLanes; ++lane) {
    Slot& slot = slot_[lane];
    if (!(burning >> lane & 1u) || slot.tails_off) continue;
    const Motor* const engine = slot.record->CutOffEngine(slot.stack);
    if (engine == nullptr) continue;
    const double lead_s = CutOffLead(*engine);
    const Vector<double> force_n = LaneOf(step_.now().force_n, lane);
    const double mass_kg = Lane(step_.now().mass_kg, lane);
    const double growing_m_s2 = lead_s > 0.0
                                    ? 0.5 * lead_s * Dot(force_n, force_n) /
                                          (Square(mass_kg) * engine->specific_impulse_s * kStandardGravity)
                                    : 0.0;
    if (const GuidedFlight* const guided = slot.record->guided; guided != nullptr && guided->cuts_off()) {
      CutOffByGuidance(lane, lead_s, growing_m_s2);
      continue;
    }
    if (engine->cut_off == CutOff::kByGuidance) {  // which has no plan
      const double end_s = Lane(step_.phase().ignition_s, lane) + engine->cut_off_s - lead_s;
      if (end_s - Lane(time_s_, lane) <= tick_s_) CutOffAt(lane, Max(end_s, Lane(time_s_, lane)));
      continue;
    }
    const Vector<double> v = LaneOf(step_.motion().v, lane);
    const double speed_m_s = Sqrt(Dot(v, v));
    double rate_m_s2 = Dot(v, LaneOf(step_.acceleration_m_s2(), lane)) / speed_m_s + growing_m_s2;
    double wanted_m_s = engine->cut_off_velocity_m_s;
    if (engine->cut_off == CutOff::kAtTarget) {
      const Vector<double> p = LaneOf(step_.motion().p, lane);
      const double radius_m = Sqrt(Dot(p, p)), altitude_m = Lane(step_.now().altitude_m, lane);
      wanted_m_s = CutOffSpeed(*engine, radius_m, altitude_m);
      rate_m_s2 -= CutOffSpeedRate(*engine, radius_m, altitude_m, Dot(p, v) / radius_m);
    }
    const double lacking_m_s = wanted_m_s - speed_m_s;
    if (lacking_m_s > rate_m_s2 * (tick_s_ + lead_s)) continue;
    CutOffAt(lane,
             Lane(time_s_, lane) + (lacking_m_s > 0.0 ? Max(lacking_m_s / rate_m_s2 - lead_s, 0.0) : 0.0));
  }
}

/// The same at a speed or a time that guidance has planned, by measured values.
template <class T>
void Batch<T>::CutOffByGuidance(int lane, double lead_s, double growing_m_s2) {
  const auto vector_of = [lane](const Vector<T>& v) {
    return Vector3(Lane(v.x, lane), Lane(v.y, lane), Lane(v.z, lane));
  };
  const Instant<T>& now = step_.now();
  const double time_s = Lane(time_s_, lane);
  const double in_s = slot_[lane].record->guided->CutOffIn(
                          time_s, Lane(step_.phase().ignition_s, lane), vector_of(step_.motion().v),
                          vector_of(step_.acceleration_m_s2()), growing_m_s2,
                          vector_of(now.force_n).norm() / Lane(now.mass_kg, lane)) -
                      lead_s;
  if (!(in_s <= tick_s_)) return;
  CutOffAt(lane, time_s + (in_s > 0.0 ? in_s : 0.0));
}

template <class T>
void Batch<T>::CutOffAt(int lane, double at_s) {
  Slot& slot = slot_[lane];
  FlightRecord& record = *slot.record;
  // By then it has burnt out.
  if (at_s >= Lane(step_.phase().ignition_s, lane) + record.plant.stacks.data()[slot.stack].burn.duration_s)
    return;
  record.CutOff(slot.stack, at_s);
  step_.ShortenBurn(lane, record.plant.stacks.data()[slot.stack].burn);
  slot.tails_off = record.plant.stacks.data()[slot.stack].burn.tail_s > 0.0;
  SetStop(lane);
}

/// Error of the lanes' attitudes against the reference at their ticks, true and as the sensors see it.
template <class T>
void Batch<T>::Measure() {
  const ReferenceRows& reference = model_.reference_rows();
  const double* row[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const double tick = Min(Lane(tick_, lane), reference.last_tick);
    row[lane] = reference.rows.data() + ReferenceRows::kRowSize * static_cast<long>(tick);
    if (IsGuided(lane)) row[lane] = slot_[lane].record->guided->RowAt(Lane(tick_, lane));
  }
  T c[ReferenceRows::kRowSize];
  LoadRow(row, 2, c);
  const Turn<T> q_BR = Compose(Inverse(step_.motion().q), {c[0], c[1], c[2], c[3]});
  angle_rad_ = RotationVector(q_BR);
  rate_rad_s_ = Rotate(q_BR, {c[4], c[5], c[6]}) - step_.motion().w;
  measured_angle_rad_ = angle_rad_;
  measured_rate_rad_s_ = rate_rad_s_;
  if (has_plugin_) measured_body_rate_rad_s_ = step_.motion().w;
  if (any_drift_ || step_.bending().modes > 0 || model_.sensors().uses_gyros) MeasureBySensors(c);
}

/// The same through sensors that are not perfect, or sit on a body that bends.
template <class T>
void Batch<T>::MeasureBySensors(const T* reference) {
  const bool everywhere = step_.bending().modes > 0 || model_.sensors().uses_gyros;
  Turn<T> seen = step_.motion().q;
  Vector<T> rate = step_.motion().w;
  if (step_.bending().modes > 0) {
    step_.UpdateShapes(time_s_);
    seen = TurnedBy(seen, UnitTurn(step_.bending(), step_.bending_state()));
    rate = rate + TurnRate(step_.bending(), step_.bending_state(), -1);
  }
  if (model_.sensors().uses_gyros) rate = GyroRates(rate);
  if (any_drift_) {
    AverageNoise();
    unit_.Measure(live_, time_s_, seen);
    Blend<T>(drifts_, unit_.measured, seen);
    DriftOn();
    rate = Select(drifts_, rate + unit_.drift_rad_s, rate);
  }
  const Turn<T> q_SR = Compose(Inverse(seen), {reference[0], reference[1], reference[2], reference[3]});
  const Vector<T> angle = RotationVector(q_SR);
  const Vector<T> error_rate = Rotate(q_SR, {reference[4], reference[5], reference[6]}) - rate;
  const M imperfect = everywhere ? live_ : live_ & drifts_;
  measured_angle_rad_ = Select(imperfect, angle, measured_angle_rad_);
  measured_rate_rad_s_ = Select(imperfect, error_rate, measured_rate_rad_s_);
  if (has_plugin_) measured_body_rate_rad_s_ = Select(imperfect, rate, measured_body_rate_rad_s_);
}

/// The blend of gyros and inertial unit. Without thrust only the inertial unit has weight.
template <class T>
Vector<T> Batch<T>::GyroRates(Vector<T> unit_rad_s) {
  const M burning = live_ & step_.phase().burning;
  Vector<T> blend = unit_weight_ * unit_rad_s;
  const int gyros = static_cast<int>(model_.sensors().gyros.size());
  for (int g = 0; g < gyros; ++g) {
    const GyroModel& gyro = model_.sensors().gyros.data()[g];
    Vector<T> rate = step_.motion().w;
    if (step_.bending().modes > 0) rate = rate + TurnRate(step_.bending(), step_.bending_state(), g);
    const T period(static_cast<double>(gyro.sample_ticks)), last = period * Nearest(tick_ / period);
    const M sampled = (last >= tick_) & (last <= tick_);
    StepGyro(gyro, burning, burning & gyros_fresh_, sampled, rate, gyros_[g]);
    blend = Along(blend, gyro_weight_[g], gyros_[g].output_rad_s);
  }
  gyros_fresh_ = gyros_fresh_ & !burning;
  return blend;
}

/// Bias and noise until the next measurement. Only a tick at which the autopilot acts takes a sample.
template <class T>
void Batch<T>::DriftOn() {
  unit_.drift_rad_s = gyro_bias_rad_s_;
  const unsigned acting = Bits(live_ & (step_.phase().burning | coasting_));
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(acting >> lane & 1u) || !slot_[lane].record->noisy) continue;
    double noise[kAxes];
    slot_[lane].record->DrawNoise(noise);
    Lane(unit_.drift_rad_s.x, lane) += noise[0];
    Lane(unit_.drift_rad_s.y, lane) += noise[1];
    Lane(unit_.drift_rad_s.z, lane) += noise[2];
  }
}

/// The unit samples at every tick, although the samples within a cycle of the reaction control are not used.
/// Over the n ticks of a cycle it turns by the mean of n samples; the first one is known.
template <class T>
void Batch<T>::AverageNoise() {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(Bits(live_ & drifts_) >> lane & 1u) || !slot_[lane].record->noisy) continue;
    const double ticks = Nearest((Lane(time_s_, lane) - Lane(unit_.time_s, lane)) / tick_s_);
    if (ticks < 2.0) continue;
    double others[kAxes];
    slot_[lane].record->DrawNoise(others);
    const Vector<double> bias = LaneOf(gyro_bias_rad_s_, lane),
                         first = LaneOf(unit_.drift_rad_s, lane) - bias;
    const Vector<double> sum = first + Sqrt(ticks - 1.0) * Vector<double>{others[0], others[1], others[2]};
    SetLane(unit_.drift_rad_s, lane, bias + (1.0 / ticks) * sum);
  }
}

template <class T>
void Batch<T>::FlyGimbals() {
  M powered = live_ & step_.phase().burning;
  if (has_free_stage_) powered = powered & !unsteered_;
  if (!Any(powered)) return;
  const bool listed = step_.plant().nozzles_listed;
  AxisMemory<T> of_roll;
  if (listed) of_roll = axes_[kRoll];
  if (All(powered))
    FlyGimbalsOf<true>(powered);
  else
    FlyGimbalsOf<false>(powered);
  PassCommands(powered);
  if (!listed) return;
  const M rolling = powered & (allocation_[0].rolls_by_thrusters > T(0.0));
  if (!Any(rolling)) return;
  Blend<T>(rolling, of_roll, axes_[kRoll]);  // restores roll memory: its command was not applied
  RollByThrusters(rolling);
}

template <class T>
template <bool kAll>
void Batch<T>::FlyGimbalsOf(M powered) {
  T program[FeedForwardRows::kRowSize], foreign[kAxes];
  const T* const fed = FedForward(program);
  StepGimbals<kAll>(model_.autopilot(), loop_, powered, time_s_ - step_.phase().ignition_s,
                    measured_angle_rad_, measured_rate_rad_s_, fed,
                    has_plugin_ ? PluginCommands(powered, fed, foreign) : nullptr, axes_, gimbals_);
}

/// The commands of a law from a shared object or from Python: each lane by itself, in ordinary code.
template <class T>
const T* Batch<T>::PluginCommands(M powered, const T* program, T* command) {
  T of_roll, of_pitch;
  Effectiveness(loop_, time_s_ - step_.phase().ignition_s, of_roll, of_pitch);
  for (int lane = 0; lane < kLanes; ++lane) {
    dispersa_law_input input{};
    double wanted[kAxes] = {};
    if (Bits(powered) >> lane & 1u) {
      input.time_s = Lane(time_s_, lane);
      input.since_ignition_s = Lane(time_s_ - step_.phase().ignition_s, lane);
      input.stage = static_cast<std::uint32_t>(slot_[lane].stack);
      for (int axis = 0; axis < kAxes; ++axis) {
        input.angle_error_rad[axis] = Lane(measured_angle_rad_[axis], lane);
        input.rate_error_rad_s[axis] = Lane(measured_rate_rad_s_[axis], lane);
        input.rate_rad_s[axis] = Lane(measured_body_rate_rad_s_[axis], lane);
        input.effectiveness_1_s2[axis] = Lane(axis == kRoll ? of_roll : of_pitch, lane);
        if (program != nullptr) input.program_rad_s2[axis] = Lane(program[axis], lane);
        input.saturation[axis] = Lane(axes_[axis].saturation, lane);
      }
      slot_[lane].record->law->Step(input, wanted);
    }
    for (int axis = 0; axis < kAxes; ++axis) Lane(command[axis], lane) = wanted[axis];
  }
  return command;
}

// The feed-forward that the flight program asks of each lane's axes at its tick; null where nothing is fed
// forward. The body axes stand for the reference's axes: an attitude error of one degree mixes a fiftieth
// part of a small quantity.
template <class T>
const T* Batch<T>::FedForward(T* program) const {
  const FeedForwardRows& table = model_.feed_forward_rows();
  if (table.rows.empty()) return nullptr;
  const double* row[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const double tick = Min(Lane(tick_, lane), model_.reference_rows().last_tick);
    row[lane] = table.rows.data() + FeedForwardRows::kRowSize * static_cast<long>(tick);
    if (IsGuided(lane)) row[lane] = slot_[lane].record->guided->feed_forward_row();
  }
  LoadFour(row, program);
  return program;
}

// This tick's commands into the line, and what leaves it now to the actuators. A delay that is no whole
// number of ticks lets the command through within the tick. The flight computer allocates a command to the
// drives as it gives it: what is on the way when boosters burn out is of the nozzles that burnt.
template <class T>
void Batch<T>::PassCommands(M powered) {
  const T roll = gimbals_.deflection_rad[kRoll], pitch = gimbals_.deflection_rad[kPitch];
  const T yaw = gimbals_.deflection_rad[kYaw];
  const bool listed = step_.plant().nozzles_listed;
  const int drives = listed ? kDrives : kNozzles;
  for (int bank = 0; bank < step_.plant().banks; ++bank) {
    T(*const line)[kDrives] = delay_line_[bank];
    T* const entry = line[line_at_];
    if (listed) {
      Allocate(allocation_[bank], roll, pitch, yaw, entry);
    } else {
      entry[0] = pitch + roll;
      entry[1] = pitch - roll;
      entry[2] = yaw + roll;
      entry[3] = yaw - roll;
    }
    if (same_delay_) {
      step_.Command(powered, bank, line[(line_at_ - common_delay_) & (kDelayLine - 1)]);
      continue;
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(Bits(powered) >> lane & 1u)) continue;
      const Slot& slot = slot_[lane];
      const int late = slot.part_delay_s > 0.0 ? 1 : 0;
      const T* const next = line[(line_at_ - slot.whole_delay) & (kDelayLine - 1)];
      step_.CommandLane(lane, bank, line[(line_at_ - slot.whole_delay - late) & (kDelayLine - 1)]);
      for (int i = 0; i < drives; ++i) Lane(next_command_rad_[bank][i], lane) = Lane(next[i], lane);
    }
  }
  line_at_ = (line_at_ + 1) & (kDelayLine - 1);
  for (int lane = 0; !same_delay_ && lane < kLanes; ++lane) {
    Slot& slot = slot_[lane];
    if (!(Bits(powered) >> lane & 1u) || !(slot.part_delay_s > 0.0)) continue;
    slot.switch_s = Lane(time_s_, lane) + slot.part_delay_s;
    SetStop(lane);
  }
}

/// The command about an axis that the present deflections of all listed nozzles stand for.
template <class T>
T Batch<T>::FeltAboutAll(int axis) const {
  T felt(0.0);
  for (int bank = 0; bank < step_.plant().banks; ++bank) {
    const BankState<T>& drives = step_.drives(bank);
    const T all = FeltAbout(allocation_[bank], axis, drives.first.angle_rad, drives.second.angle_rad, felt);
    felt = Select(step_.plant().bank[bank].driven, all, felt);
  }
  return felt;
}

/// Roll control of stages whose nozzles cannot roll: the thrusters of the coast fire in the same cycles while
/// the motor burns.
template <class T>
void Batch<T>::RollByThrusters(M rolling) {
  const AutopilotModel& autopilot = model_.autopilot();
  const ReactionControlLogic& logic = autopilot.config.reaction_control;
  const ReactionControl& rcs = definition_.vehicle.reaction_control;
  M decides = NoLane<T>();
  for (int lane = 0; lane < kLanes; ++lane)
    SetLane(decides, lane, static_cast<long>(Lane(tick_, lane)) % logic.cycle_ticks == 0);
  decides = decides & rolling;
  StepThrusters(logic, autopilot.thruster_minimum_cycles, decides, measured_angle_rad_.x,
                measured_rate_rad_s_.x, thrusters_[kRoll]);
  const double couple_n = 2.0 * rcs.thrust_n;
  const double flow_kg = couple_n / (rcs.specific_impulse_s * kStandardGravity) * tick_s_;  // a tick
  const T direction = thrusters_[kRoll].direction;
  Vector<T> torque_n_m = step_.phase().control_torque_n_m;
  torque_n_m.x = T(couple_n * rcs.roll_arm_m) * direction;
  step_.SetControlTorque(rolling, torque_n_m);
  step_.Expel(rolling & (Abs(direction) > T(0.0)), T(flow_kg), Abs(direction));
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
    const FlightEvent& event = slot_[lane].record->events.data()[slot_[lane].next_event];
    const double event_ticks = (event.time_s - kSameInstant_s) / tick_s_;
    long event_tick = static_cast<long>(event_ticks);
    if (static_cast<double>(event_tick) < event_ticks) ++event_tick;
    long next = cycle_end < event_tick ? cycle_end : event_tick;
    if (next <= tick) next = tick + 1;
    Lane(next_tick_, lane) = static_cast<double>(next);
  }
  const double couple_n = 2.0 * rcs.thrust_n;
  const double flow_kg = couple_n / (rcs.specific_impulse_s * kStandardGravity) * tick_s_;  // a tick
  Vector<T> torque_n_m;
  T firing(0.0);
  for (int axis = 0; axis < kAxes; ++axis) {
    StepThrusters(logic, autopilot.thruster_minimum_cycles, coasting_, measured_angle_rad_[axis],
                  measured_rate_rad_s_[axis], thrusters_[axis]);
    const T direction = thrusters_[axis].direction;
    torque_n_m[axis] = T(couple_n * (axis == kRoll ? rcs.roll_arm_m : rcs.pitch_yaw_arm_m)) * direction;
    firing = firing + Abs(direction);
  }
  step_.SetControlTorque(coasting_, torque_n_m);
  // A firing counts for as long as it lasts: until the next decision.
  step_.Expel(coasting_ & (firing > T(0.0)), T(flow_kg) * (next_tick_ - tick_), firing);
}

/// Closed-loop guidance sees the lanes whose time has come: each by itself, as ordinary code.
template <class T>
void Batch<T>::Guide() {
  for (int lane = 0; lane < kLanes; ++lane) {
    FlightRecord* const record = slot_[lane].record;
    if (record == nullptr || slot_[lane].past_last_burn || slot_[lane].tails_off) continue;
    if (Lane(tick_, lane) < record->guided->next_tick()) continue;
    StateValues y;
    step_.ReadLane(lane, y);
    const LauncherPhase phase = PhaseOf(lane);
    const Instant<T>& now = step_.now();
    const auto size_of = [lane](const Vector<T>& v) {
      const double x = Lane(v.x, lane), y_ = Lane(v.y, lane), z = Lane(v.z, lane);
      return Sqrt(x * x + y_ * y_ + z * z);
    };
    LaneSight sight;
    sight.time_s = Lane(time_s_, lane);
    for (int i = 0; i < 3; ++i) {
      sight.p_EoC_I[i] = y[i];
      sight.v_IC_I[i] = y[3 + i];
    }
    sight.stack = phase.stack;
    sight.burning = phase.burning;
    sight.jettisoned = phase.jettisoned;
    sight.ignition_s = phase.ignition_s;
    sight.expelled_kg = phase.expelled_mass_kg;
    sight.specific_force_m_s2 = size_of(now.force_n) / Lane(now.mass_kg, lane);
    const auto across_of = [lane](const Vector<T>& v) {
      const double y_ = Lane(v.y, lane), z = Lane(v.z, lane);
      return Sqrt(y_ * y_ + z * z);
    };
    sight.measured_angle_rad = across_of(measured_angle_rad_);
    sight.measured_rate_rad_s = across_of(measured_rate_rad_s_);
    if (record->Guide(sight)) SetStop(lane);
  }
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
  metrics_.AddPowered(powered, T(tick_s_), time_s_, {-angle_rad_.x, pitch_error, -angle_rad_.z}, law);
  const bool listed = step_.plant().nozzles_listed;
  if (listed) {
    typename LaneMetrics<T>::Travel travel{T(0.0), T(0.0), NoLane<T>()};
    for (int bank = 0; bank < step_.plant().banks; ++bank) {
      const BankState<T>& drives = step_.drives(bank);
      metrics_.AddToTravel(powered & step_.plant().bank[bank].driven, time_s_, bank, drives.first,
                           drives.second, step_.command_rad(bank), allocation_[bank], travel);
    }
    metrics_.EndTravel(powered, allocation_[0].per_drive, travel);
  } else {
    metrics_.AddDeflections(powered, time_s_, step_.drives(0).first, step_.command_rad(0), loop_.limit_rad);
  }

  const M is_transient =
      InTransient(time_s_, time_s_ - step_.phase().ignition_s, step_.now().altitude_m,
                  definition_.kick_start_s, definition_.kick_end_s, gust_bottom_m_, gust_top_m_);
  const unsigned metered = Bits(powered), interrupted = Bits(is_transient);
  const T* n = step_.drives(0).first.angle_rad;
  T roll = T(0.25) * ((n[0] - n[1]) + (n[2] - n[3]));
  T pitch_angle = T(0.5) * (n[0] + n[1]), yaw = T(0.5) * (n[2] + n[3]);
  if (listed) {
    roll = FeltAboutAll(kRoll);
    pitch_angle = FeltAboutAll(kPitch);
    yaw = FeltAboutAll(kYaw);
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(metered >> lane & 1u)) continue;
    FlightRecord& record = *slot_[lane].record;
    if (interrupted >> lane & 1u) {
      record.ripple.Interrupt();
      record.limit_cycle.Interrupt();
    } else {
      record.ripple.Add(Lane(roll, lane), Lane(pitch_angle, lane), Lane(yaw, lane));
      record.limit_cycle.Add(Lane(roll, lane), Lane(pitch_angle, lane), Lane(yaw, lane));
    }
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
      Lane(next_row_tick_, lane) =
          record.every_tick ? Lane(tick_, lane)
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

/// Metrics of stages that nothing controls.
template <class T>
void Batch<T>::MeterFree() {
  const M free = live_ & unsteered_;
  if (!Any(free)) return;
  roll_rate_peak_rad_s_ =
      Select(free, Max(roll_rate_peak_rad_s_, Abs(step_.motion().w.x)), roll_rate_peak_rad_s_);
  const Instant<T>& now = step_.now();
  const M felt = free & (now.qbar_pa >= T(kIncidenceFloor_pa));
  const BodyInFlow<T>& aero = step_.plant().aero;
  T foremost_m = now.normal.xcp_station_m;
  if (aero.has_yaw_plane) foremost_m = Min(foremost_m, now.side.xcp_station_m);
  const T margin = (foremost_m - step_.cg_station_m()) / aero.span_m;
  least_static_margin_ = Select(felt & (margin < least_static_margin_), margin, least_static_margin_);
}

/// Ends the flights that have passed their apogee, or lets them fall on from there.
template <class T>
void Batch<T>::FlyOn() {
  for (int lane = 0; lane < kLanes; ++lane) {
    Slot& slot = slot_[lane];
    if (slot.record == nullptr || !slot.past_last_burn) continue;
    // Near the apogee only: altitude grows along the vertical, which is within 0.2 deg of the radius.
    const Vector<double> p = LaneOf(step_.motion().p, lane), v = LaneOf(step_.motion().v, lane);
    if (Dot(p, v) > 0.01 * Sqrt(Dot(p, p) * Dot(v, v))) continue;
    StateValues y;
    step_.ReadLane(lane, y);
    if (slot.record->Climbs(y)) continue;
    FallFrom(lane, Lane(step_.now().mass_kg, lane));
  }
}

template <class T>
void Batch<T>::CheckEnds() {
  const LossOfControl& loss = definition_.vehicle.loss_of_control;
  const T lost_angle2(loss.attitude_error_rad * loss.attitude_error_rad);
  const T angle2 = Dot(angle_rad_, angle_rad_);
  const T rate2 = Dot(step_.motion().w, step_.motion().w);
  const T lowest(definition_.vehicle.site.altitude_m - kImpactDepth_m);
  M is_lost = angle2 > lost_angle2;
  M is_fast = rate2 > T(loss.rate_rad_s * loss.rate_rad_s);
  if (has_free_stage_ || flies_on_) {
    const double turn_rad_s = kTurnLimit_rad / tick_s_;
    is_lost = is_lost & !unsteered_;
    is_fast = (is_fast & !unsteered_) | (unsteered_ & (rate2 > T(turn_rad_s * turn_rad_s)));
  }
  const M is_low = step_.now().altitude_m < lowest;
  const M is_late = time_s_ > T(kTimeLimit_s);
  M suspects = live_ & (is_lost | is_fast | is_low | is_late | (lost_ticks_ > T(0.0)));
  const StructuralLimits& limits = definition_.vehicle.limits;
  if (limits.terminate) {
    const auto above = [](T value, double limit) { return value > T(limit > 0.0 ? limit : kFarFuture); };
    suspects = suspects | (live_ & (above(metrics_.sums.q_max_pa, limits.q_max_pa) |
                                    above(metrics_.sums.q_alpha_max_pa_rad, limits.q_alpha_pa_rad) |
                                    above(metrics_.sums.axial_load_max_g, limits.axial_load_g) |
                                    above(metrics_.sums.lateral_load_max_g, limits.lateral_load_g) |
                                    above(metrics_.sums.bending_moment_max_n_m, limits.bending_moment_n_m)));
  }
  if (has_plugin_) {
    for (int lane = 0; lane < kLanes; ++lane)
      if (slot_[lane].record != nullptr && slot_[lane].record->law->failure() != nullptr)
        End(lane, Outcome::kNumericalFailure, slot_[lane].record->law->failure());
    suspects = suspects & live_;
  }
  if (!Any(suspects)) return;
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(Bits(suspects) >> lane & 1u)) continue;
    // A sample stands for all ticks up to the next sample: in the coast these are several.
    const double lost_ticks = Bits(is_lost) >> lane & 1u
                                  ? Lane(lost_ticks_, lane) + Lane(next_tick_, lane) - Lane(tick_, lane)
                                  : 0.0;
    Lane(lost_ticks_, lane) = lost_ticks;
    FlightSums loads;
    metrics_.Read(lane, loads);
    if (lost_ticks > 0.0 && lost_ticks * tick_s_ >= loss.for_s)
      End(lane, Outcome::kLostControl, slot_[lane].record->lost_attitude);
    else if ((Bits(is_fast) & Bits(unsteered_)) >> lane & 1u)
      End(lane, Outcome::kNumericalFailure, "turns faster than the integration's steps follow");
    else if (Bits(is_fast) >> lane & 1u)
      End(lane, Outcome::kLostControl, slot_[lane].record->lost_rate);
    else if (Bits(is_low) >> lane & 1u)
      End(lane, Outcome::kImpact, "fell below the launch site");
    else if (limits.terminate && ExceedsStructure(limits, loads))
      End(lane, Outcome::kStructuralLimit, "a structural limit of the vehicle was exceeded");
    else if (Bits(is_late) >> lane & 1u)
      End(lane, Outcome::kTimeout, "86400 s of simulated time passed");
  }
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
