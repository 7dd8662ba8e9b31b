#include "core/flight/flight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/flight/history_columns.h"
#include "core/flight/metrics_recorder.h"
#include "core/flight/tick_sample.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/random/draws.h"

namespace dispersa {

namespace {

// Loss of control, as the metrics define it.
constexpr double kLostAngle_rad = 15.0 * kRadPerDeg;
constexpr double kLostFor_s = 0.5;
constexpr double kLostRate_rad_s = 60.0 * kRadPerDeg;
// Simulated time that no flight needs.
constexpr double kTimeLimit_s = 3600.0;
// A vehicle this far below its site has hit the ground.
constexpr double kImpactDepth_m = 10.0;
constexpr int kDelayLine = 128;
constexpr double kNever_s = std::numeric_limits<double>::infinity();

// CVODE's absolute tolerances of the change within a tick: m, m/s, quaternion, rad/s, rad, rad/s.
std::array<double, kLauncherSize> AbsoluteTolerances() {
  std::array<double, kLauncherSize> t{};
  for (int i = 0; i < kLauncherSize; ++i) {
    const double value = i < 3 ? 1e-10 : i < 6 ? 1e-12 : 1e-14;
    t[static_cast<std::size_t>(i)] = value;
  }
  return t;
}

enum class EventKind { kIgnition, kBurnout, kSeparation };
struct Event {
  double time_s;
  EventKind kind;
  int stage;
};

// In the order in which they happen.
std::vector<Event> EventsOf(const std::vector<StageTimes>& timeline) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < timeline.size(); ++i) {
    const int stage = static_cast<int>(i);
    events.push_back({timeline[i].ignition_s, EventKind::kIgnition, stage});
    events.push_back({timeline[i].burnout_s, EventKind::kBurnout, stage});
    if (i + 1 < timeline.size())
      events.push_back({timeline[i].separation_s, EventKind::kSeparation, stage});
  }
  return events;
}

// What the derivative needs to know between two events.
struct Motion {
  LauncherPlant plant;
  LauncherPhase phase;

  static void Rhs(double t, const double* y, double* dydt, void* context) {
    const auto* self = static_cast<const Motion*>(context);
    LauncherDerivative(self->plant, self->phase, t, y, dydt);
  }
};

class Flight {
 public:
  Flight(const FlightModel& model, const FlightInputs& inputs, const FlightOptions& options);
  FlightResult Run();

 private:
  const LauncherStack& stack() const {
    return motion_.plant.stacks[static_cast<std::size_t>(motion_.phase.stack)];
  }
  bool on_last_stack() const {
    return motion_.phase.stack + 1 == static_cast<int>(motion_.plant.stacks.size());
  }
  bool coasting() const {
    return on_last_stack() && motion_.phase.stack > 0 && !motion_.phase.burning && !motion_.phase.burnt;
  }

  long NextTick() const;
  void Tick();
  void StepAutopilot(TickSample& sample);
  void PassCommands(double further_delay_s);
  void HappenUntil(double time_s);
  void Happen(const Event& event);
  void Ignite(int stage, double time_s);
  void BurnOut(int stage, double time_s);
  void Separate(int stage);
  bool Advance(double to_s);
  TickSample Sample() const;
  AttitudeError ErrorAt(const ReferenceAttitude& reference, const RigidBodyState& state) const;
  AttitudeError Measured(const AttitudeError& error);
  void AppendRow(const TickSample& sample);
  void AddToDigest();
  void CheckEnds(const TickSample& sample);
  void End(Outcome outcome, const std::string& reason);

  const FlightModel& model_;
  const FlightInputs& inputs_;
  const FlightOptions& options_;
  double tick_s_;
  Motion motion_;
  MetricsRecorder metrics_;
  Stream gyro_noise_;
  std::vector<Event> events_;
  std::size_t next_event_ = 0;
  std::array<double, kLauncherSize> tolerances_;
  Integrator integrator_;

  long tick_ = 0;
  long next_tick_ = 1;
  double time_s_ = 0.0;
  std::array<double, kLauncherSize> y_{};
  AutopilotState autopilot_;
  GimbalCommand gimbal_;
  std::array<int, kAxes> thrusters_{};
  std::array<std::array<double, kNozzles>, kDelayLine> delay_line_{};
  double switch_s_ = kNever_s;  // when, within a tick, a delay of a fraction of a tick lets a command through
  std::array<double, kNozzles> next_command_rad_{};
  long lost_ticks_ = 0;
  bool ended_ = false;
  FlightResult result_;
  Digester digester_;
};

Flight::Flight(const FlightModel& model, const FlightInputs& inputs, const FlightOptions& options)
    : model_(model),
      inputs_(inputs),
      options_(options),
      tick_s_(model.definition().autopilot.tick_s),
      motion_{model.PlantFor(inputs), {}},
      metrics_(model, inputs),
      gyro_noise_(model.definition().noise_seed, options.case_index, "gyro_noise"),
      tolerances_(AbsoluteTolerances()),
      integrator_(options.scheme, kLauncherSize, &Motion::Rhs, &motion_, tolerances_.data()) {
  std::vector<MotorBurn> burns;
  for (const LauncherStack& each : motion_.plant.stacks) burns.push_back(each.burn);
  events_ = EventsOf(
      BuildTimeline(model.definition().vehicle, burns, tick_s_, model.definition().last_ignition_s));
  WriteState(LiftOffState(model), y_.data());
  if (options.history) options.history->values.clear();
}

AttitudeError Flight::ErrorAt(const ReferenceAttitude& reference, const RigidBodyState& state) const {
  const Quaternion q_IR = model_.frame().q_IL * reference.q_LR;
  const Quaternion q_BR = Inverse(state.q_IB) * q_IR;
  AttitudeError error;
  error.angle_rad = RotationVector(q_BR);
  error.rate_rad_s = Rotate(q_BR, reference.w_LR_R) - state.w_IB_B;
  return error;
}

// The rate gyros' bias and noise; the attitude, integrated from them, drifts with the bias.
AttitudeError Flight::Measured(const AttitudeError& error) {
  const Vector3 bias(inputs_.gyro_bias_roll_rad_s, inputs_.gyro_bias_pitch_rad_s,
                     inputs_.gyro_bias_yaw_rad_s);
  AttitudeError measured = error;
  measured.angle_rad -= bias * time_s_;
  measured.rate_rad_s -= bias;
  if (inputs_.gyro_noise_rad_s > 0.0)
    for (int axis = 0; axis < kAxes; ++axis)
      measured.rate_rad_s[axis] -= inputs_.gyro_noise_rad_s * gyro_noise_.Normal();
  return measured;
}

TickSample Flight::Sample() const {
  TickSample s;
  s.time_s = time_s_;
  s.stack = motion_.phase.stack;
  s.burning = motion_.phase.burning;
  s.coasting = coasting();
  s.since_ignition_s = time_s_ - motion_.phase.ignition_s;
  s.state = ReadState(y_.data());
  for (std::size_t i = 0; i < kNozzles; ++i) {
    s.nozzle_rad[i] = y_[kNozzleAngle + i];
    s.nozzle_rate_rad_s[i] = y_[kNozzleRate + i];
  }
  s.command_rad = motion_.phase.command_rad;
  s.limit_rad = stack().gimbal.limit_rad;
  s.reference = model_.definition().program.At(time_s_);
  s.error = ErrorAt(s.reference, s.state);
  s.gimbal = gimbal_;
  s.axes = autopilot_.axes;
  s.thrusters = thrusters_;
  s.expelled_mass_kg = motion_.phase.expelled_mass_kg;
  return s;
}

void Flight::StepAutopilot(TickSample& sample) {
  const AutopilotModel& autopilot = model_.autopilot();
  thrusters_ = {};
  motion_.phase.control_torque_n_m.setZero();
  if (sample.burning) {
    const Vector2 pn_factor(inputs_.pn_error_factor, inputs_.pn_rate_factor);
    const long loop_stage = std::lround(inputs_.loop_stage);
    const bool changed = loop_stage == 0 || loop_stage == sample.stack + 1;
    gimbal_ = StepGimbals(autopilot, sample.stack, sample.since_ignition_s, Measured(sample.error),
                          pn_factor, changed ? inputs_.loop_gain_factor : 1.0, autopilot_);
    PassCommands(changed ? inputs_.loop_delay_s : 0.0);
  } else if (sample.coasting) {
    const ReactionControl& rcs = model_.definition().vehicle.reaction_control;
    thrusters_ = StepReactionControl(autopilot, Measured(sample.error), autopilot_);
    const double couple = 2.0 * rcs.thrust_n;
    for (int axis = 0; axis < kAxes; ++axis) {
      const int direction = thrusters_[static_cast<std::size_t>(axis)];
      const double arm = axis == kRoll ? rcs.roll_arm_m : rcs.pitch_yaw_arm_m;
      motion_.phase.control_torque_n_m[axis] = couple * arm * direction;
      if (direction != 0)
        motion_.phase.expelled_mass_kg += couple / (rcs.specific_impulse_s * kStandardGravity) *
                                          static_cast<double>(next_tick_ - tick_) * tick_s_;
    }
  }
  sample.gimbal = gimbal_;
  sample.axes = autopilot_.axes;
  sample.thrusters = thrusters_;
  sample.command_rad = motion_.phase.command_rad;
}

// This tick's command into the line, and what leaves it now to the actuators. A delay that is no whole
// number of ticks lets the command through within the tick.
void Flight::PassCommands(double further_delay_s) {
  delay_line_[static_cast<std::size_t>(tick_ % kDelayLine)] = gimbal_.Nozzles();
  const double delay = stack().gimbal.delay_ticks + further_delay_s / tick_s_;
  const long whole = std::lround(std::floor(delay + kSameInstant_s));
  const double fraction = delay - static_cast<double>(whole);
  const auto before = [&](long ticks) {
    const long from = tick_ - std::min(ticks, kDelayLine - 1L);
    return delay_line_[static_cast<std::size_t>((from + kDelayLine) % kDelayLine)];
  };
  const bool within = fraction > kSameInstant_s;
  motion_.phase.command_rad = before(within ? whole + 1 : whole);
  next_command_rad_ = before(whole);
  switch_s_ = within ? time_s_ + fraction * tick_s_ : kNever_s;
}

void Flight::AppendRow(const TickSample& sample) {
  std::vector<double>& rows = options_.history->values;
  AppendKinematics(motion_.plant.environment.earth, time_s_, sample.state, sample.instant.air,
                   sample.instant.v_AB_B, sample.instant.loads.mass_kg, rows);
  AppendLauncher(model_, sample, rows);
}

void Flight::AddToDigest() {
  digester_.Add(&time_s_, 1);
  digester_.Add(y_.data(), y_.size());
}

void Flight::End(Outcome outcome, const std::string& reason) {
  if (ended_) return;
  ended_ = true;
  result_.outcome = outcome;
  result_.reason = reason;
  result_.end_time_s = time_s_;
  result_.end_stage = motion_.phase.stack + 1;
  result_.end_state = ReadState(y_.data());
  AddToDigest();
}

void Flight::CheckEnds(const TickSample& s) {
  const bool lost = s.error.angle_rad.norm() > kLostAngle_rad;
  // A sample stands for the ticks up to the next one; in the coast these are several.
  lost_ticks_ = lost ? lost_ticks_ + (next_tick_ - tick_) : 0;
  const double altitude_m = ToGeodetic(motion_.plant.environment.earth, s.state.p_EoC_I).altitude_m;
  if (static_cast<double>(lost_ticks_) * tick_s_ >= kLostFor_s)
    End(Outcome::kLostControl, "attitude error above 15 deg for 0.5 s");
  else if (s.state.w_IB_B.norm() > kLostRate_rad_s)
    End(Outcome::kLostControl, "angular rate above 60 deg/s");
  else if (altitude_m < model_.definition().vehicle.site.altitude_m - kImpactDepth_m)
    End(Outcome::kImpact, "fell below the launch site");
  else if (metrics_.structural_limit_exceeded() && model_.definition().vehicle.limits.terminate)
    End(Outcome::kStructuralLimit, "a structural limit of the vehicle was exceeded");
  else if (time_s_ > kTimeLimit_s)
    End(Outcome::kTimeout, "3600 s of simulated time passed");
}

void Flight::Tick() {
  TickSample sample = Sample();
  StepAutopilot(sample);
  const long second = std::lround(1.0 / tick_s_);
  const long output =
      options_.history ? std::max(1L, std::lround(options_.history->step_s / tick_s_)) : 0;
  const bool row = output > 0 && tick_ % output == 0;
  // In the coast nothing acts that metrics measure.
  if (!sample.coasting || row) {
    sample.instant = Evaluate(motion_.plant, motion_.phase, time_s_, y_.data());
    sample.has_instant = true;
  }
  metrics_.AddTick(sample);
  if (options_.observe) options_.observe(sample);
  if (row) AppendRow(sample);
  if (tick_ % second == 0) AddToDigest();
  CheckEnds(sample);
}

void Flight::Ignite(int stage, double time_s) {
  motion_.phase.burning = true;
  motion_.phase.ignition_s = time_s;
  motion_.phase.command_rad = {};
  motion_.phase.control_torque_n_m.setZero();
  delay_line_ = {};
  switch_s_ = kNever_s;
  thrusters_ = {};
  StartStage(model_.autopilot(), stage, autopilot_);
  motion_.phase.stuck_nozzle = -1;
  if (std::lround(inputs_.stuck_nozzle_stage) == stage + 1 && inputs_.stuck_nozzle > 0.0) {
    motion_.phase.stuck_nozzle = static_cast<int>(std::lround(inputs_.stuck_nozzle)) - 1;
    y_[static_cast<std::size_t>(kNozzleAngle + motion_.phase.stuck_nozzle)] = inputs_.stuck_nozzle_rad;
  }
  if (on_last_stack() && stage > 0)
    metrics_.AddHandover(ErrorAt(model_.definition().program.At(time_s_), ReadState(y_.data())));
}

void Flight::BurnOut(int stage, double) {
  const LauncherInstant now = Evaluate(motion_.plant, motion_.phase, time_s_, y_.data());
  metrics_.AddLoads(now);
  motion_.phase.burning = false;
  motion_.phase.burnt = true;
  if (stage + 1 < static_cast<int>(motion_.plant.stacks.size())) return;
  metrics_.AddInjection(motion_.plant.environment.earth, ReadState(y_.data()),
                        now.air.place.altitude_m);
  End(Outcome::kCompleted, "");
}

void Flight::Separate(int stage) {
  const std::size_t below = static_cast<std::size_t>(stage);
  RigidBodyState s = AfterSeparation(motion_.plant, stage, ReadState(y_.data()));
  s.w_IB_B += Vector3(inputs_.tip_off_roll_rad_s[below], inputs_.tip_off_pitch_rad_s[below],
                      inputs_.tip_off_yaw_rad_s[below]);
  y_.fill(0.0);
  WriteState(s, y_.data());

  motion_.phase.stack = stage + 1;
  motion_.phase.burnt = false;
  motion_.phase.command_rad = {};
  switch_s_ = kNever_s;
}

void Flight::Happen(const Event& event) {
  switch (event.kind) {
    case EventKind::kIgnition:
      Ignite(event.stage, event.time_s);
      break;
    case EventKind::kBurnout:
      BurnOut(event.stage, event.time_s);
      break;
    case EventKind::kSeparation:
      Separate(event.stage);
      break;
  }
  AddToDigest();
  if (options_.history) {
    TickSample sample = Sample();
    sample.instant = Evaluate(motion_.plant, motion_.phase, time_s_, y_.data());
    AppendRow(sample);
  }
}

// Advances the plant and lets happen what is due up to and including `time_s`.
void Flight::HappenUntil(double time_s) {
  while (!ended_ && next_event_ < events_.size() &&
         events_[next_event_].time_s <= time_s + kSameInstant_s) {
    const Event& event = events_[next_event_];
    // An event as good as on the tick happens on the tick; one before lift-off, at lift-off.
    const bool between = event.time_s < time_s - kSameInstant_s && event.time_s > time_s_ + kSameInstant_s;
    if (between && !Advance(event.time_s)) return;
    if (!between && event.time_s >= time_s - kSameInstant_s && time_s > time_s_ && !Advance(time_s)) return;
    Happen(event);
    ++next_event_;
  }
  if (!ended_ && time_s > time_s_) Advance(time_s);
}

bool Flight::Advance(double to_s) {
  if (switch_s_ < to_s) {
    const double at_s = switch_s_;
    switch_s_ = kNever_s;
    if (at_s > time_s_ && !Advance(at_s)) return false;
    motion_.phase.command_rad = next_command_rad_;
  }
  const double from_s = time_s_;
  if (!integrator_.Advance(from_s, to_s, options_.steps_per_tick, y_.data())) {
    End(Outcome::kNumericalFailure, "the integrator failed or the state is not finite");
    return false;
  }
  time_s_ = to_s;
  RigidBodyState s = ReadState(y_.data());
  s.q_IB = Normalized(s.q_IB);
  WriteState(s, y_.data());
  // Mechanical stops, and the drives' greatest rate, which a step may overshoot.
  const Gimbal& gimbal = stack().gimbal;
  for (std::size_t i = 0; i < kNozzles; ++i) {
    if (static_cast<int>(i) == motion_.phase.stuck_nozzle) continue;
    double& angle = y_[kNozzleAngle + i];
    double& rate = y_[kNozzleRate + i];
    rate = Clamp(rate, -gimbal.rate_limit_rad_s, gimbal.rate_limit_rad_s);
    if (std::fabs(angle) <= gimbal.limit_rad) continue;
    angle = std::copysign(gimbal.limit_rad, angle);
    rate = 0.0;
  }
  return true;
}

// Every tick counts but in the coast, where decisions fall on the thrusters' cycles, and on the first tick
// after an event.
long Flight::NextTick() const {
  if (!coasting()) return tick_ + 1;
  const long cycle = model_.autopilot().config.reaction_control.cycle_ticks;
  const long next = (tick_ / cycle + 1) * cycle;
  const double event_s = events_[next_event_].time_s;
  const long event_tick = static_cast<long>(std::ceil((event_s - kSameInstant_s) / tick_s_));
  return std::max(tick_ + 1, std::min(next, event_tick));
}

FlightResult Flight::Run() {
  HappenUntil(0.0);
  while (!ended_) {
    next_tick_ = NextTick();
    Tick();
    if (ended_) break;
    tick_ = next_tick_;
    HappenUntil(static_cast<double>(tick_) * tick_s_);
  }
  metrics_.SetExpelledMass(motion_.phase.expelled_mass_kg);
  result_.metrics = metrics_.Finish();
  digester_.Add(result_.metrics.data(), result_.metrics.size());
  result_.digest = digester_.Finish();
  return result_;
}

}  // namespace

RigidBodyState LiftOffState(const FlightModel& model) {
  const LaunchFrame& frame = model.frame();
  RigidBodyState s;
  s.p_EoC_I = frame.p_EoL_I;
  s.v_IC_I = frame.v_IL_I;
  s.q_IB = frame.q_IL * model.definition().program.At(0.0).q_LR;
  const Vector3 earth_rate_I(0.0, 0.0, model.nominal_plant().environment.earth.rotation_rate_rad_s);
  s.w_IB_B = Rotate(Inverse(s.q_IB), earth_rate_I);
  return s;
}

FlightResult Fly(const FlightModel& model, const FlightInputs& inputs, const FlightOptions& options) {
  return Flight(model, inputs, options).Run();
}

}  // namespace dispersa
