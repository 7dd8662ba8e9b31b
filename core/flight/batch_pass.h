// A pass of the batch (batch.h): measure, decide, take metrics, end.
#pragma once

#include "core/flight/batch.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// A vehicle this far below its site has hit the ground.
inline constexpr double kImpactDepth_m = 10.0;

template <class T>
void Batch<T>::Pass() {
  lanes_.at.next_tick = Select(lanes_.at.live, lanes_.at.tick + T(1.0), lanes_.at.tick);
  Measure();
  const M powered = Powered();
  if (Any(powered) && lanes_.computer.Steer(powered, lanes_.at, lanes_.sensed, lanes_.step))
    for (int lane = 0; lane < kLanes; ++lane)
      if (lanes_.at.slot[lane].record != nullptr) SetStop(lane);
  if (Any(lanes_.at.coasting)) lanes_.computer.HoldCoast(lanes_.at, lanes_.sensed, lanes_.step);
  lanes_.step.EvaluateStart(lanes_.at.time_s);
  if (has_jettisons_) LetGo();
  if (cuts_off_in_flight_) CutOff();
  if (definition_.guidance.closed_loop) Guide();
  const M loaded = lanes_.at.live & !lanes_.at.coasting;
  lanes_.metrics.NoteMaxQ(loaded, lanes_.at.time_s,
                          model_.nominal_plant().environment.earth.rotation_rate_rad_s, lanes_.step.motion(),
                          lanes_.step.now());
  lanes_.metrics.AddLoads(loaded, lanes_.step.now());
  lanes_.metrics.AddMoment(loaded, lanes_.step.LargestMomentNow(lanes_.metrics.sums.bending_moment_max_n_m));
  if (has_free_stage_) MeterFree();
  Meter(Powered());
  const M due = lanes_.at.live & (lanes_.at.tick >= lanes_.at.next_row_tick);
  if (lanes_.own_parts > 0 || Any(due)) Watch(due);
  const M digested = lanes_.at.live & (lanes_.at.tick >= lanes_.at.next_digest_tick);
  if (Any(digested)) Digest(Bits(digested));
  if (flies_on_) FlyOn();
  CheckEnds();
  if (flying_ > 0) Advance();
}

/// The errors at the lanes' ticks, true and as the sensors show them.
template <class T>
void Batch<T>::Measure() {
  const ReferenceRows& reference = model_.reference_rows();
  const double* row[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const Slot& slot = lanes_.at.slot[lane];
    const double tick = Lane(lanes_.at.tick, lane);
    row[lane] =
        reference.rows.data() + ReferenceRows::kRowSize * static_cast<long>(Min(tick, reference.last_tick));
    if (definition_.guidance.closed_loop && slot.IsGuided()) row[lane] = slot.record->guided->RowAt(tick);
  }
  T now[ReferenceRows::kRowSize];
  LoadRow(row, 2, now);
  lanes_.errors = ErrorsAgainst(now, lanes_.step.motion().q, lanes_.step.motion().w);
  lanes_.sensed.errors = lanes_.errors;
  if (has_plugin_) lanes_.sensed.body_rate_rad_s = lanes_.step.motion().w;
  if (!lanes_.sensors.AreImperfect(lanes_.step, lanes_.at.live)) return;
  const auto seen = lanes_.sensors.Measure(lanes_.at, lanes_.step);
  const AttitudeErrors<T> shown = ErrorsAgainst(now, seen.attitude, seen.rate_rad_s);
  AttitudeErrors<T>& sensed = lanes_.sensed.errors;
  sensed.angle_rad = Select(seen.imperfect, shown.angle_rad, sensed.angle_rad);
  sensed.rate_rad_s = Select(seen.imperfect, shown.rate_rad_s, sensed.rate_rad_s);
  if (!has_plugin_) return;
  lanes_.sensed.body_rate_rad_s = Select(seen.imperfect, seen.rate_rad_s, lanes_.sensed.body_rate_rad_s);
}

/// Lanes that steer by their nozzles.
template <class T>
MaskOf<T> Batch<T>::Powered() const {
  const M burning = lanes_.at.live & lanes_.step.phase().burning;
  return has_free_stage_ ? burning & !lanes_.at.unsteered : burning;
}

/// Jettisons, which the flight computer decides on its ticks.
template <class T>
void Batch<T>::LetGo() {
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(Bits(lanes_.at.live) >> lane & 1u)) continue;
    Slot& slot = lanes_.at.slot[lane];
    StateValues y;
    lanes_.step.ReadLane(lane, y);
    const unsigned due = slot.record->LetGo(
        slot.stack, slot.jettisoned, Lane(lanes_.at.time_s, lane), Lane(lanes_.step.now().altitude_m, lane),
        Lane(lanes_.step.density_kg_m3(), lane), Lane(lanes_.step.propellant_kg(), lane), y);
    if (due == 0) continue;
    slot.jettisoned |= due;
    lanes_.step.WriteLane(lane, y);
    SetMass(lane);
    SetShape(lane);
    slot.record->AddToDigest(Lane(lanes_.at.time_s, lane), y);
    slot.record->NoteJettisons(due, EventViewOf(lane), y);
    if (slot.record->watched) slot.record->WatchEvent(ViewOf(lane));
  }
  lanes_.step.EvaluateStart(lanes_.at.time_s);
}

/// Ends of burns that the flight computer commands.
template <class T>
void Batch<T>::CutOff() {
  const unsigned burning = Bits(lanes_.at.live & lanes_.step.phase().burning);
  for (int lane = 0; lane < kLanes; ++lane)
    if (burning >> lane & 1u) CutOffAt(lane, lanes_.computer.CutOffTime(lane, lanes_.at, lanes_.step));
}

template <class T>
void Batch<T>::CutOffAt(int lane, double at_s) {
  Slot& slot = lanes_.at.slot[lane];
  FlightRecord& record = *slot.record;
  // By then it has burnt out, or nobody commands it.
  if (at_s >=
      Lane(lanes_.step.phase().ignition_s, lane) + record.plant.stacks.data()[slot.stack].burn.duration_s)
    return;
  StateValues y;
  lanes_.step.ReadLane(lane, y);
  record.NoteCutOff(slot.stack, EventViewOf(lane), y);
  record.CutOff(slot.stack, at_s);
  lanes_.step.ShortenBurn(lane, record.plant.stacks.data()[slot.stack].burn);
  lanes_.computer.Commanded(lane, record.plant.stacks.data()[slot.stack].burn.tail_s > 0.0);
  SetStop(lane);
}

template <class T>
void Batch<T>::Guide() {
  for (int lane = 0; lane < kLanes; ++lane)
    if (lanes_.computer.WantsToGuide(lane, lanes_.at) &&
        lanes_.computer.Guide(lane, lanes_.at, lanes_.sensed, lanes_.step))
      SetStop(lane);
}

/// Metrics of this tick.
template <class T>
void Batch<T>::Meter(M powered) {
  const T pitch_error = -lanes_.errors.angle_rad.y;
  if (Any(lanes_.at.coasting)) lanes_.metrics.AddCoast(lanes_.at.coasting, lanes_.at.time_s, pitch_error);
  if (!Any(powered)) return;
  const AxisOutput<T>& pitch = lanes_.computer.output().axes[kPitch];
  const LyapunovSample<T> law{pitch.v, Select(pitch.v_rate_sign < T(0.0), T(1.0), T(0.0)),
                              lanes_.computer.law(kPitch).p11, pitch.departure_norm2};
  lanes_.metrics.AddPowered(powered, T(tick_s_), lanes_.at.time_s,
                            {-lanes_.errors.angle_rad.x, pitch_error, -lanes_.errors.angle_rad.z}, law);
  const bool listed = lanes_.step.plant().nozzles_listed;
  if (listed) {
    typename LaneMetrics<T>::Travel travel{T(0.0), T(0.0), NoLane<T>()};
    for (int bank = 0; bank < lanes_.step.plant().banks; ++bank) {
      const BankState<T>& drives = lanes_.step.drives(bank);
      lanes_.metrics.AddToTravel(powered & lanes_.step.plant().bank[bank].driven, lanes_.at.time_s, bank,
                                 drives.first, drives.second, lanes_.step.command_rad(bank),
                                 lanes_.computer.allocation(bank), travel);
    }
    lanes_.metrics.EndTravel(powered, lanes_.computer.allocation(0).per_drive, travel);
  } else {
    lanes_.metrics.AddDeflections(powered, lanes_.at.time_s, lanes_.step.drives(0).first,
                                  lanes_.step.command_rad(0), lanes_.computer.limit_rad());
  }

  const M is_transient =
      InTransient(lanes_.at.time_s, lanes_.at.time_s - lanes_.step.phase().ignition_s,
                  lanes_.step.now().altitude_m, definition_.kick_start_s, definition_.kick_end_s,
                  lanes_.metrics.gust_bottom_m, lanes_.metrics.gust_top_m);
  const unsigned metered = Bits(powered), interrupted = Bits(is_transient);
  const T* n = lanes_.step.drives(0).first.angle_rad;
  T roll = T(0.25) * ((n[0] - n[1]) + (n[2] - n[3]));
  T pitch_angle = T(0.5) * (n[0] + n[1]), yaw = T(0.5) * (n[2] + n[3]);
  if (listed) {
    roll = lanes_.computer.FeltAboutAll(kRoll, lanes_.step);
    pitch_angle = lanes_.computer.FeltAboutAll(kPitch, lanes_.step);
    yaw = lanes_.computer.FeltAboutAll(kYaw, lanes_.step);
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(metered >> lane & 1u)) continue;
    FlightRecord& record = *lanes_.at.slot[lane].record;
    if (interrupted >> lane & 1u) {
      record.ripple.Interrupt();
      record.limit_cycle.Interrupt();
    } else {
      record.ripple.Add(Lane(roll, lane), Lane(pitch_angle, lane), Lane(yaw, lane));
      record.limit_cycle.Add(Lane(roll, lane), Lane(pitch_angle, lane), Lane(yaw, lane));
    }
  }
}

/// Rows of histories, the campaign's own metrics, and observers. `due`: the lanes that have a row or are
/// observed at this tick.
template <class T>
DISPERSA_OUT_OF_LINE void Batch<T>::Watch(M due) {
  const OwnMetricsPlan* const own = model_.own_metrics();
  M has_row = NoLane<T>();
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(Bits(due) >> lane & 1u)) continue;
    const long every = lanes_.at.slot[lane].record->history_ticks;
    SetLane(has_row, lane, every > 0 && static_cast<long>(Lane(lanes_.at.tick, lane)) % every == 0);
  }
  const RowColumns read = Any(has_row) ? kWholeRow : own != nullptr ? own->row_columns : 0;
  T row[kBodyColumns + kLauncherColumns + kRowConditions];
  LauncherSeen<T> seen;
  if (own != nullptr || Any(has_row)) {  // an observer alone sees the lane itself
    See(own != nullptr ? lanes_.at.live : has_row, read, seen);
    FillLauncher<T>(model_.nominal_plant().environment.earth, seen, read, row);
  }
  if (own != nullptr) {
    T* const conditions = row + kBodyColumns + kLauncherColumns;
    conditions[0] = OneWhere<T>(seen.burning);
    for (int stage = 1; stage <= kMaxStages; ++stage)
      conditions[stage] = OneWhere<T>(seen.burning & (Abs(seen.stage - T(stage)) < T(0.5)));
    conditions[1 + kMaxStages] = OneWhere<T>(lanes_.at.coasting);
    for (int i = 0; i < lanes_.own_parts; ++i)
      AddTick<T>(own->parts.data()[i], lanes_.at.live, lanes_.at.time_s, tick_s_, row, lanes_.own_sums[i]);
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(Bits(due) >> lane & 1u)) continue;
    FlightRecord& record = *lanes_.at.slot[lane].record;
    if (record.options.observe) {
      LaneView view = ViewOf(lane);
      view.has_error = true;
      record.Watch(view);
    }
    if (Bits(has_row) >> lane & 1u) {
      double values[kBodyColumns + kLauncherColumns];
      for (int i = 0; i < kBodyColumns + kLauncherColumns; ++i) values[i] = Lane(row[i], lane);
      record.AppendRow(values);
    }
    const long tick = static_cast<long>(Lane(lanes_.at.tick, lane));
    Lane(lanes_.at.next_row_tick, lane) =
        record.options.observe
            ? Lane(lanes_.at.tick, lane)
            : static_cast<double>((tick / record.history_ticks + 1) * record.history_ticks);
  }
}

/// What the columns that are `read` show of the lanes. `shown`: those whose row is read.
template <class T>
DISPERSA_OUT_OF_LINE void Batch<T>::See(M shown, RowColumns read, LauncherSeen<T>& seen) const {
  const Instant<T>& now = lanes_.step.now();
  seen.time_s = lanes_.at.time_s;
  seen.motion = lanes_.step.motion();
  if (kFlowAngles.IsRead(read) || kIncidence.IsRead(read)) seen.v_AB_B = lanes_.step.VelocityThroughAir();
  seen.mach = now.mach;
  seen.qbar_pa = now.qbar_pa;
  seen.mass_kg = now.mass_kg;
  seen.burning = lanes_.step.phase().burning;
  seen.steered = !lanes_.at.unsteered;
  seen.thrust_n = now.thrust_n;
  seen.force_n = now.force_n;
  if (kLaunchPitch.IsRead(read)) seen.R_IL = MatrixAt(model_.frame().R_IL.data());
  if (kSteered.IsRead(read)) {
    seen.errors = lanes_.errors;
    const T* const n = lanes_.step.drives(0).first.angle_rad;
    seen.felt_pitch_rad = T(0.5) * (n[0] + n[1]);
    seen.felt_yaw_rad = T(0.5) * (n[2] + n[3]);
    seen.felt_roll_rad = T(0.25) * ((n[0] - n[1]) + (n[2] - n[3]));
    if (lanes_.step.plant().nozzles_listed) {
      seen.felt_pitch_rad = lanes_.computer.FeltAboutAll(kPitch, lanes_.step);
      seen.felt_yaw_rad = lanes_.computer.FeltAboutAll(kYaw, lanes_.step);
      seen.felt_roll_rad = lanes_.computer.FeltAboutAll(kRoll, lanes_.step);
    }
    for (int i = 0; i < kNozzles; ++i) seen.nozzle_rad[i] = n[i];
  }
  const AxisOutput<T>& pitch = lanes_.computer.output().axes[kPitch];
  if (kLawColumns.IsRead(read)) {
    seen.command_pitch_rad = lanes_.computer.output().deflection_rad[kPitch];
    seen.control_rad_s2 = pitch.command_rad_s2;
    seen.adaptation_norm_rad_s2 = Sqrt(pitch.departure_norm2);
    seen.v = pitch.v;
    seen.v_rate_sign = pitch.v_rate_sign;
    seen.frozen = OneWhere<T>(pitch.frozen > T(0.0));
    seen.total_gain = lanes_.computer.memory(kPitch).total_gain;
    seen.projected = seen.rules_fired = T(0.0);
  }
  if (kThrusters.IsRead(read)) {
    seen.thruster_roll = lanes_.computer.thruster(kRoll).direction;
    seen.thruster_pitch = lanes_.computer.thruster(kPitch).direction;
    seen.thruster_yaw = lanes_.computer.thruster(kYaw).direction;
  }
  seen.expelled_kg = lanes_.step.phase().expelled_kg;
  seen.stage = seen.program_pitch_rad = T(0.0);
  for (T& told : seen.law_telemetry) told = T(__builtin_nan(""));
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(Bits(shown) >> lane & 1u)) continue;
    const Slot& slot = lanes_.at.slot[lane];
    Lane(seen.stage, lane) = slot.stack + 1.0;
    if (kProgramPitch.IsRead(read))
      Lane(seen.program_pitch_rad, lane) = slot.record->ProgramPitch(Lane(lanes_.at.time_s, lane));
    if (kLearntColumns.IsRead(read)) {
      const AxisTelemetry learnt = TelemetryOf(model_.autopilot().laws.data()[kPitch].config, pitch,
                                               lanes_.computer.memory(kPitch), lane);
      Lane(seen.projected, lane) = learnt.projected ? 1.0 : 0.0;
      Lane(seen.rules_fired, lane) = __builtin_popcount(learnt.rules_fired);
    }
    if (slot.record->law == nullptr) continue;
    const double* const told = slot.record->law->telemetry().data();
    for (int i = 0; i < kLawTelemetry; ++i) Lane(seen.law_telemetry[i], lane) = told[i];
  }
}

/// `due`: bits of lanes at a whole second, or at their lift-off.
template <class T>
DISPERSA_OUT_OF_LINE void Batch<T>::Digest(unsigned due) {
  const long second = static_cast<long>(1.0 / tick_s_ + 0.5);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(due >> lane & 1u)) continue;
    FlightRecord& record = *lanes_.at.slot[lane].record;
    const long tick = static_cast<long>(Lane(lanes_.at.tick, lane));
    if (tick % second == 0) {
      StateValues y;
      lanes_.step.ReadLane(lane, y);
      record.AddToDigest(Lane(lanes_.at.time_s, lane), y);
    }
    Lane(lanes_.at.next_digest_tick, lane) = static_cast<double>((tick / second + 1) * second);
  }
}

/// Metrics of stages that nothing controls.
template <class T>
void Batch<T>::MeterFree() {
  const M free = lanes_.at.live & lanes_.at.unsteered;
  if (!Any(free)) return;
  const Instant<T>& now = lanes_.step.now();
  const BodyInFlow<T>& aero = lanes_.step.plant().aero;
  T foremost_m = now.normal.xcp_station_m;
  if (aero.has_yaw_plane) foremost_m = Min(foremost_m, now.side.xcp_station_m);
  lanes_.metrics.AddFree(free, lanes_.step.motion().w.x, now.qbar_pa,
                         (foremost_m - lanes_.step.cg_station_m()) / aero.span_m);
}

/// Ends the flights that have passed their apogee, or lets them fall on from there.
template <class T>
void Batch<T>::FlyOn() {
  for (int lane = 0; lane < kLanes; ++lane) {
    Slot& slot = lanes_.at.slot[lane];
    if (slot.record == nullptr || !slot.past_last_burn) continue;
    // Near the apogee only: altitude grows along the vertical, which is within 0.2 deg of the radius.
    const Vector<double> p = LaneOf(lanes_.step.motion().p, lane), v = LaneOf(lanes_.step.motion().v, lane);
    if (Dot(p, v) > 0.01 * Sqrt(Dot(p, p) * Dot(v, v))) continue;
    StateValues y;
    lanes_.step.ReadLane(lane, y);
    if (slot.record->Climbs(y)) continue;
    FallFrom(lane, Lane(lanes_.step.now().mass_kg, lane));
  }
}

template <class T>
void Batch<T>::CheckEnds() {
  const LossOfControl& loss = definition_.vehicle.loss_of_control;
  const T lost_angle2(loss.attitude_error_rad * loss.attitude_error_rad);
  const T angle2 = Dot(lanes_.errors.angle_rad, lanes_.errors.angle_rad);
  const T rate2 = Dot(lanes_.step.motion().w, lanes_.step.motion().w);
  const T lowest(definition_.vehicle.site.altitude_m - kImpactDepth_m);
  M is_lost = angle2 > lost_angle2;
  M is_fast = rate2 > T(loss.rate_rad_s * loss.rate_rad_s);
  if (has_free_stage_ || flies_on_) {
    const double turn_rad_s = kTurnLimit_rad / tick_s_;
    is_lost = is_lost & !lanes_.at.unsteered;
    is_fast = (is_fast & !lanes_.at.unsteered) | (lanes_.at.unsteered & (rate2 > T(turn_rad_s * turn_rad_s)));
  }
  const M is_low = lanes_.step.now().altitude_m < lowest;
  const M is_late = lanes_.at.time_s > T(kTimeLimit_s);
  M suspects = lanes_.at.live & (is_lost | is_fast | is_low | is_late | (lanes_.at.lost_ticks > T(0.0)));
  const StructuralLimits& limits = definition_.vehicle.limits;
  if (limits.terminate) {
    const auto above = [](T value, double limit) { return value > T(limit > 0.0 ? limit : kFarFuture); };
    suspects = suspects | (lanes_.at.live &
                           (above(lanes_.metrics.sums.q_max_pa, limits.q_max_pa) |
                            above(lanes_.metrics.sums.q_alpha_max_pa_rad, limits.q_alpha_pa_rad) |
                            above(lanes_.metrics.sums.axial_load_max_g, limits.axial_load_g) |
                            above(lanes_.metrics.sums.lateral_load_max_g, limits.lateral_load_g) |
                            above(lanes_.metrics.sums.bending_moment_max_n_m, limits.bending_moment_n_m)));
  }
  if (has_plugin_) {
    for (int lane = 0; lane < kLanes; ++lane)
      if (lanes_.at.slot[lane].record != nullptr && lanes_.at.slot[lane].record->law->failure() != nullptr)
        End(lane, Outcome::kNumericalFailure, lanes_.at.slot[lane].record->law->failure());
    suspects = suspects & lanes_.at.live;
  }
  if (!Any(suspects)) return;
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(Bits(suspects) >> lane & 1u)) continue;
    // A sample stands for all ticks up to the next sample: in the coast these are several.
    const double lost_ticks =
        Bits(is_lost) >> lane & 1u
            ? Lane(lanes_.at.lost_ticks, lane) + Lane(lanes_.at.next_tick, lane) - Lane(lanes_.at.tick, lane)
            : 0.0;
    Lane(lanes_.at.lost_ticks, lane) = lost_ticks;
    FlightSums loads;
    lanes_.metrics.Read(lane, loads);
    if (lost_ticks > 0.0 && lost_ticks * tick_s_ >= loss.for_s)
      End(lane, Outcome::kLostControl, lanes_.at.slot[lane].record->lost_attitude);
    else if ((Bits(is_fast) & Bits(lanes_.at.unsteered)) >> lane & 1u)
      End(lane, Outcome::kNumericalFailure, "turns faster than the integration's steps follow");
    else if (Bits(is_fast) >> lane & 1u)
      End(lane, Outcome::kLostControl, lanes_.at.slot[lane].record->lost_rate);
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
