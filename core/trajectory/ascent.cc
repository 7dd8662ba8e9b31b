#include "core/trajectory/ascent.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/dynamics/integrator.h"
#include "core/flight/sequence.h"
#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

// The attitude program goes on this long after the nominal burnout, for flights that burn longer.
constexpr double kProgramReserve_s = 30.0;
// An ascent that comes this far below its site has failed.
constexpr double kGround_m = 1000.0;
// Spacing of samples and of the attitude program's knots, unless the steps are longer: dense in the
// pitch-over, where the programmed incidence changes.
constexpr double kKickKnot_s = 0.1;
constexpr double kBurnKnot_s = 1.0;
constexpr double kCoastKnot_s = 5.0;
// Rates of the attitude program are central differences over this time: rounding and truncation stay below
// 1e-10 of a rate.
constexpr double kDifference_s = 1e-3;

double SmoothStep(double s) { return s * s * s * (10.0 + s * (-15.0 + 6.0 * s)); }

enum class ProgramPhase { kVertical, kTurn };

// State of an ascent between two events. y: position and velocity in I.
class Ascent {
 public:
  Ascent(const AscentModel& model, const FlightProgram& program, const AscentOptions& options)
      : model_(model),
        program_(program),
        options_(options),
        frame_(BuildLaunchFrame(model.plant.environment.earth, model.vehicle.site,
                                program.launch_azimuth_rad)),
        integrator_(Scheme::kRungeKutta4, 6, &Ascent::Rhs, this, nullptr) {
    SetMotion(frame_.p_EoL_I, frame_.v_IL_I);
  }

  AscentResult Fly();

 private:
  struct Event {
    double time_s;
    enum Kind { kIgnition, kBurnout, kSeparation, kTurnBegin, kTurnEnd, kKink } kind;
    int stage;
  };

  static void Rhs(double t, const double* y, double* dydt, void* context) {
    const auto* self = static_cast<const Ascent*>(context);
    const Vector3 acceleration = self->Acceleration(t, y);
    for (int i = 0; i < 3; ++i) {
      dydt[i] = y[3 + i];
      dydt[3 + i] = acceleration[i];
    }
  }

  void SetMotion(const Vector3& p_EoC_I, const Vector3& v_IC_I) {
    for (int i = 0; i < 3; ++i) {
      y_[i] = p_EoC_I[i];
      y_[3 + i] = v_IC_I[i];
    }
  }
  Vector3 AirVelocity(const double* y) const {
    const double omega = model_.plant.environment.earth.rotation_rate_rad_s;
    return Vector3(y[3] + omega * y[1], y[4] - omega * y[0], y[5]);
  }
  Matrix3 Attitude(double t, const double* y) const;
  static RigidBodyState State(const double* y, const Matrix3& R_IB);
  LauncherInstant Instant(double t, const double* y, const Matrix3& R_IB) const;
  Vector3 Acceleration(double t, const double* y) const;
  Vector3 AxisRate(double t, const double* y) const;
  PitchYawRoll Angles(double t, const double* y) const {
    return ToPitchYawRoll(QuaternionOf(frame_.R_IL.transpose() * Attitude(t, y)));
  }
  std::vector<Event> Events();
  bool Advance(double to_s);
  void Happen(const Event& event);
  void Observe(bool record = true);
  void Record(const LauncherInstant& now);
  void AddKnot(double t, const double* y);
  void Finish();

  const AscentModel& model_;
  const FlightProgram& program_;
  const AscentOptions& options_;
  LaunchFrame frame_;
  Integrator integrator_;
  double time_s_ = 0.0;
  double y_[6] = {};
  ProgramPhase turn_ = ProgramPhase::kVertical;
  Vector3 turn_offset_I_ = Vector3::Zero();  // body axis less velocity direction as the turn begins
  LauncherPhase phase_;
  AscentResult result_;
};

// Body x along the velocity through the air turned by the programmed incidence; body y as near to the
// launch frame's y as it can be (zero roll in L). While vertical, body x is the vertical of the site, which
// turns with the Earth; the small angle that the velocity makes with it as the turn begins fades by t3.
Matrix3 Ascent::Attitude(double t, const double* y) const {
  const Vector3 right_L = frame_.R_IL.col(1);
  Vector3 forward;
  if (turn_ == ProgramPhase::kVertical) {
    forward = EarthToInertial(model_.plant.environment.earth, t, -frame_.R_IL.col(2));
  } else {
    const Vector3 along = AirVelocity(y).normalized();
    const Vector3 right = (right_L - right_L.dot(along) * along).normalized();
    const SinCos alpha = SineCosine(ProgrammedIncidence(program_, t));
    forward = alpha.cos * along + alpha.sin * right.cross(along);
    const double faded = (t - program_.t1_s) / (program_.t3_s - program_.t1_s);
    if (faded < 1.0) forward += (1.0 - SmoothStep(Clamp(faded, 0.0, 1.0))) * turn_offset_I_;
    forward.normalize();
  }
  const Vector3 right = (right_L - right_L.dot(forward) * forward).normalized();
  Matrix3 R_IB;
  R_IB.col(0) = forward;
  R_IB.col(1) = right;
  R_IB.col(2) = forward.cross(right);
  return R_IB;
}

RigidBodyState Ascent::State(const double* y, const Matrix3& R_IB) {
  RigidBodyState state;
  state.p_EoC_I = Vector3(y[0], y[1], y[2]);
  state.v_IC_I = Vector3(y[3], y[4], y[5]);
  state.q_IB = QuaternionOf(R_IB);
  return state;
}

LauncherInstant Ascent::Instant(double t, const double* y, const Matrix3& R_IB) const {
  std::array<double, kLauncherSize> full{};
  WriteState(State(y, R_IB), full.data());
  return Evaluate(model_.plant, phase_, t, full.data());
}

Vector3 Ascent::Acceleration(double t, const double* y) const {
  const Matrix3 R_IB = Attitude(t, y);
  const LauncherInstant now = Instant(t, y, R_IB);
  return Gravitation(model_.plant.environment.earth, Vector3(y[0], y[1], y[2])) +
         R_IB * (now.loads.force_n / now.loads.mass_kg);
}

// Calls visit(t + dt, state there) for dt = ±1 ms along the motion, to difference what depends on both.
template <typename Visit>
void Beside(double t, const double* y, const Vector3& acceleration, const Visit& visit) {
  for (const double dt : {-kDifference_s, kDifference_s}) {
    double there[6];
    for (int i = 0; i < 3; ++i) {
      there[i] = y[i] + dt * y[3 + i] + 0.5 * dt * dt * acceleration[i];
      there[3 + i] = y[3 + i] + dt * acceleration[i];
    }
    visit(t + dt, there);
  }
}

// Of the body's x axis against the stars, 1/s, in I.
Vector3 Ascent::AxisRate(double t, const double* y) const {
  Vector3 turned = Vector3::Zero();
  double sign = -1.0;
  Beside(t, y, Acceleration(t, y), [&](double beside_s, const double* there) {
    turned += sign * Attitude(beside_s, there).col(0);
    sign = 1.0;
  });
  return turned / (2.0 * kDifference_s);
}

std::vector<Ascent::Event> Ascent::Events() {
  std::vector<MotorBurn> burns;
  for (const LauncherStack& stack : model_.plant.stacks) burns.push_back(stack.burn);
  const std::size_t last = burns.size() - 1;
  // The coast counts from the burnout below, which does not depend on the timer.
  std::vector<StageTimes> times = BuildTimeline(model_.vehicle, burns, model_.tick_s, 0.0);
  if (last > 0) result_.last_ignition_s = times[last - 1].burnout_s + program_.coast_s;
  times = BuildTimeline(model_.vehicle, burns, model_.tick_s, result_.last_ignition_s);

  std::vector<Event> events;
  for (std::size_t i = 0; i <= last; ++i) {
    const int stage = static_cast<int>(i);
    events.push_back({times[i].ignition_s, Event::kIgnition, stage});
    events.push_back({times[i].ignition_s + burns[i].rise_s, Event::kKink, stage});
    events.push_back({times[i].burnout_s - burns[i].tail_s, Event::kKink, stage});
    events.push_back({times[i].burnout_s, Event::kBurnout, stage});
    if (i < last) events.push_back({times[i].separation_s, Event::kSeparation, stage});
  }
  events.push_back({program_.t1_s, Event::kTurnBegin, 0});
  events.push_back({program_.t3_s, Event::kKink, 0});
  events.push_back({program_.t2_s, Event::kTurnEnd, 0});
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.time_s < b.time_s; });
  return events;
}

void Ascent::AddKnot(double t, const double* y) {
  // Rates along the motion: the program's own derivative, not the table's.
  std::array<PitchYawRoll, 2> beside;
  std::size_t count = 0;
  Beside(t, y, Acceleration(t, y),
         [&](double beside_s, const double* there) { beside[count++] = Angles(beside_s, there); });
  const PitchYawRoll now = Angles(t, y);
  const auto rate = [&](double PitchYawRoll::*angle) {
    return (beside[1].*angle - beside[0].*angle) / (2.0 * kDifference_s);
  };
  result_.attitude.knots.push_back({t, now.pitch, now.yaw, now.roll, rate(&PitchYawRoll::pitch),
                                    rate(&PitchYawRoll::yaw), rate(&PitchYawRoll::roll)});
}

void Ascent::Observe(bool record) {
  const LauncherInstant now = Instant(time_s_, y_, Attitude(time_s_, y_));
  const double alpha = std::fabs(ProgrammedIncidence(program_, time_s_));
  const Vector3 specific = now.loads.force_n / (now.loads.mass_kg * kStandardGravity);
  AscentResult& r = result_;
  r.q_max_pa = std::max(r.q_max_pa, now.air.qbar_pa);
  r.q_alpha_max_pa_rad = std::max(r.q_alpha_max_pa_rad, now.air.qbar_pa * TotalIncidence(now.v_AB_B));
  r.axial_load_max_g = std::max(r.axial_load_max_g, std::fabs(specific.x()));
  r.lateral_load_max_g = std::max(
      r.lateral_load_max_g, Sqrt(specific.y() * specific.y() + specific.z() * specific.z()));
  if (now.air.mach >= options_.mach_low && now.air.mach <= options_.mach_high)
    r.transonic_alpha_max_rad = std::max(r.transonic_alpha_max_rad, alpha);
  if (turn_ == ProgramPhase::kTurn && time_s_ <= program_.t2_s)
    r.turn_rate_max_rad_s = std::max(r.turn_rate_max_rad_s, AxisRate(time_s_, y_).norm());
  if (options_.record && record) Record(now);
}

void Ascent::Record(const LauncherInstant& now) {
  const Vector3 p(y_[0], y_[1], y_[2]), v(y_[3], y_[4], y_[5]);
  const Vector3 relative = AirVelocity(y_);
  const PitchYawRoll angles = Angles(time_s_, y_);
  AscentSample s;
  s.time_s = time_s_;
  s.stage = phase_.stack + 1;
  s.altitude_m = now.air.place.altitude_m;
  s.velocity_m_s = v.norm();
  s.relative_velocity_m_s = relative.norm();
  s.flight_path_angle_rad = Atan2(p.dot(v), p.cross(v).norm());
  s.relative_path_angle_rad = Atan2(p.dot(relative), p.cross(relative).norm());
  s.alpha_rad = ProgrammedIncidence(program_, time_s_);
  s.pitch_rad = angles.pitch;
  s.yaw_rad = angles.yaw;
  s.roll_rad = angles.roll;
  s.mach = now.air.mach;
  s.qbar_pa = now.air.qbar_pa;
  s.axial_load_g = now.loads.force_n.x() / (now.loads.mass_kg * kStandardGravity);
  s.mass_kg = now.loads.mass_kg;
  s.p_EoC_I = p;
  s.v_IC_I = v;
  result_.samples.push_back(s);
  const std::vector<AttitudeKnot>& knots = result_.attitude.knots;
  if (knots.empty() || time_s_ > knots.back().time_s + kSameInstant_s)
    AddKnot(time_s_, y_);
}

bool Ascent::Advance(double to_s) {
  const bool kick = time_s_ < program_.t2_s;
  const AscentSteps& steps = options_.steps;
  const bool air = phase_.stack == 0 && phase_.burning;
  const double largest = air ? steps.air_s : phase_.burning ? steps.burn_s : steps.coast_s;
  const double knot = kick ? kKickKnot_s : phase_.burning ? kBurnKnot_s : kCoastKnot_s;
  const auto pieces = [](double whole, double part) {
    return std::max(1, static_cast<int>(std::ceil(whole / part - kSameInstant_s)));
  };
  // The steps are the same whether their ends are recorded or not.
  const double from = time_s_;
  const int knots = pieces(to_s - from, std::max(knot, largest));
  const int steps_per_knot = pieces((to_s - from) / knots, largest);
  const int count = knots * steps_per_knot;
  for (int i = 1; i <= count; ++i) {
    const double next = i == count ? to_s : from + (to_s - from) * i / count;
    if (!integrator_.Advance(time_s_, next, 1, y_)) return false;
    time_s_ = next;
    // The end of an interval is observed after its event, on the far side of the kink.
    if (i < count) Observe(i % steps_per_knot == 0);
  }
  const Geodetic place = ToGeodetic(model_.plant.environment.earth, Vector3(y_[0], y_[1], y_[2]));
  return place.altitude_m > model_.vehicle.site.altitude_m - kGround_m;
}

void Ascent::Happen(const Event& event) {
  switch (event.kind) {
    case Event::kIgnition:
      phase_.burning = true;
      phase_.ignition_s = event.time_s;
      break;
    case Event::kBurnout:
      Observe();
      phase_.burning = false;
      phase_.burnt = true;
      break;
    case Event::kSeparation: {
      // The vehicle turns with its program: the stack above leaves with the velocity of its own CG.
      const Matrix3 R_IB = Attitude(time_s_, y_);
      RigidBodyState state = State(y_, R_IB);
      state.w_IB_B = R_IB.transpose() * R_IB.col(0).cross(AxisRate(time_s_, y_));
      state = AfterSeparation(model_.plant, event.stage, state);
      SetMotion(state.p_EoC_I, state.v_IC_I);
      phase_.stack = event.stage + 1;
      phase_.burnt = false;
      break;
    }
    case Event::kTurnBegin:
      turn_offset_I_ = Attitude(time_s_, y_).col(0) - AirVelocity(y_).normalized();
      turn_ = ProgramPhase::kTurn;
      break;
    case Event::kTurnEnd:
      result_.mach_at_t2 = Instant(time_s_, y_, Attitude(time_s_, y_)).air.mach;
      break;
    case Event::kKink:
      break;
  }
}

void Ascent::Finish() {
  const Earth& earth = model_.plant.environment.earth;
  result_.p_EoC_I = Vector3(y_[0], y_[1], y_[2]);
  result_.v_IC_I = Vector3(y_[3], y_[4], y_[5]);
  const OrbitElements e = ElementsOf(earth, result_.p_EoC_I, result_.v_IC_I);
  result_.orbit = {ToGeodetic(earth, result_.p_EoC_I).altitude_m, e.speed_m_s, e.flight_path_angle_rad,
                   e.inclination_rad};
}

AscentResult Ascent::Fly() {
  const std::vector<Event> events = Events();
  result_.attitude.launch_azimuth_rad = program_.launch_azimuth_rad;
  bool flying = true;
  for (const Event& event : events) {
    if (event.time_s > time_s_ + kSameInstant_s) {
      Observe();
      flying = Advance(event.time_s);
      if (!flying) break;
    }
    Happen(event);
  }
  result_.end_time_s = time_s_;
  result_.completed = flying;
  Finish();
  if (flying && options_.record) {
    Observe();
    const std::size_t samples = result_.samples.size();
    Advance(time_s_ + kProgramReserve_s);
    Observe();
    result_.samples.resize(samples);
  }
  return result_;
}

}  // namespace

double ProgrammedIncidence(const FlightProgram& program, double t) {
  if (t <= program.t1_s || t >= program.t2_s) return 0.0;
  const double s = t < program.t3_s ? (t - program.t1_s) / (program.t3_s - program.t1_s)
                                    : (program.t2_s - t) / (program.t2_s - program.t3_s);
  return -program.alpha_max_rad * SmoothStep(s);
}

AscentModel BuildAscentModel(const Vehicle& vehicle, double tick_s) {
  return {vehicle, BuildNominalPlant(vehicle), tick_s};
}

AscentResult FlyAscent(const AscentModel& model, const FlightProgram& program,
                       const AscentOptions& options) {
  return Ascent(model, program, options).Fly();
}

}  // namespace dispersa
