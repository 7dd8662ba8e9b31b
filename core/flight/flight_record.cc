#include "core/flight/flight_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/dynamics/air_data.h"
#include "core/dynamics/fall.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/jettison.h"
#include "core/dynamics/launcher_lanes.h"
#include "core/environment/ground_track.h"
#include "core/flight/history_columns.h"
#include "core/flight/own_metrics.h"
#include "core/flight/part_events.h"
#include "core/flight/rail_slide.h"
#include "core/flight/sequence.h"
#include "core/flight/step_limits.h"
#include "core/flight/tick_sample.h"
#include "core/math/assertion.h"
#include "core/math/functions.h"
#include "core/vehicle/cut_off.h"

namespace dispersa {

namespace {

std::vector<FlightEvent> EventsOf(const FlightModel& model, const LauncherPlant& plant,
                                  const FlightInputs& in, double last_ignition_s, double rail_exit_s) {
  const FlightDefinition& definition = model.definition();
  std::vector<MotorBurn> burns;
  for (const LauncherStack& stack : plant.stacks) burns.push_back(stack.burn);
  const std::vector<StageTimes> timeline =
      BuildTimeline(definition.vehicle, burns, definition.autopilot.tick_s, last_ignition_s,
                    definition.earlier_ignition_s, in);
  std::vector<FlightEvent> events;
  for (std::size_t i = 0; i < timeline.size(); ++i)
    AddEvents({definition.vehicle, plant, static_cast<int>(i), timeline[i], definition.autopilot.tick_s,
               i == 0 ? rail_exit_s : -1.0},
              i + 1 == timeline.size(), events);
  DISPERSA_ASSERT(!events.empty() && events.front().kind == EventKind::kIgnition, events.size());
  return events;
}

double SpeedOverEarth(const Earth& earth, const Vector3& p_EoC_I, const Vector3& v_IC_I) {
  const Vector3 ground = p_EoC_I.cross(Vector3(0.0, 0.0, -earth.rotation_rate_rad_s));
  return (v_IC_I - ground).norm();
}

// On a rail, without thrust.
constexpr double kLongestSlide_s = 600.0;

// CVODE's absolute tolerances of the change within a tick: m, m/s, quaternion, rad/s, rad, rad/s.
std::array<double, kLauncherSize> AbsoluteTolerances() {
  std::array<double, kLauncherSize> t{};
  for (std::size_t i = 0; i < kLauncherSize; ++i) t[i] = i < 3 ? 1e-10 : i < 6 ? 1e-12 : 1e-14;
  return t;
}

}  // namespace

// A flight's plant between two events, for an integrator that knows nothing of flights.
class FlightRecord::JudgedMotion {
 public:
  JudgedMotion(const LauncherModel& equations, Scheme scheme)
      : equations_(equations),
        is_fixed_(scheme == Scheme::kRungeKutta4),
        tolerances_(AbsoluteTolerances()),
        integrator_(scheme, equations.plant().state_size(), &Rhs, this, tolerances_.data()) {}

  bool Advance(const LauncherPhase& phase, double from_s, double to_s, int steps, double* y) {
    phase_ = phase;
    // An explicit method is unstable where its step is longer than the fastest part's own motion.
    if (is_fixed_)
      steps = lanes::StepsOver(FastestPart(equations_.plant(), phase.stack), to_s - from_s, steps);
    const Gimbal& gimbal = GimbalOf(phase, 0);
    if (gimbal.friction_rad > 0.0) {
      if (!SlideTo(gimbal, from_s, to_s, steps, y)) return false;
    } else if (!integrator_.Advance(from_s, to_s, steps, y)) {
      return false;
    }
    RigidBodyState s = ReadState(y);
    s.q_IB = Normalized(s.q_IB);
    WriteState(s, y);
    // Mechanical stops, and the drives' greatest rate, which a step may overshoot.
    for (int i = 0; i < drives_; ++i) {
      if (NozzleOf(i) == phase.stuck_nozzle) continue;
      const Gimbal& its = GimbalOf(phase, i);
      double& angle = y[AngleOf(i)];
      double& rate = y[RateOf(i)];
      rate = Clamp(rate, -its.rate_limit_rad_s, its.rate_limit_rad_s);
      if (std::fabs(angle) <= its.limit_rad) continue;
      angle = std::copysign(its.limit_rad, angle);
      rate = 0.0;
    }
    return true;
  }

 private:
  static void Rhs(double t, const double* y, double* dydt, void* context) {
    const auto* self = static_cast<const JudgedMotion*>(context);
    self->equations_.Derivative(self->phase_, t, y, dydt);
  }

  using State = std::array<double, kLauncherSize>;

  // Of a drive: the stage's, or that of a booster.
  const Gimbal& GimbalOf(const LauncherPhase& phase, int drive) const {
    const LauncherPlant& plant = equations_.plant();
    const LauncherStack& stack = plant.stacks[static_cast<std::size_t>(phase.stack)];
    const bool is_boosters =
        phase.stack == 0 && plant.boosters_steer() && drive >= stack.layout.banks() * kDrives;
    return is_boosters ? plant.boosters->gimbal : stack.gimbal;
  }

  // From rest to rest of the drives, each found by bisection: in between friction is constant and all is
  // smooth.
  bool SlideTo(const Gimbal& gimbal, double from_s, double to_s, int steps, double* y) {
    // Whether a nozzle is stuck plays no part: a drive at rest stays so.
    lanes::Actuators<double> drives{};
    lanes::SetActuators(drives, 0, gimbal, phase_.stuck_nozzle);
    State start;
    std::copy(y, y + kLauncherSize, start.begin());
    // A drive turns round a few times a second. More rests than these within a tick are a programming error.
    for (int rests = 0; rests < 64; ++rests) {
      for (int i = 0; i < drives_; ++i) {
        const std::size_t drive = static_cast<std::size_t>(i);
        phase_.slides[drive] = lanes::SlidesIn(drives, lanes::Followed(drives, phase_.command_rad[drive]),
                                               start[static_cast<std::size_t>(AngleOf(i))],
                                               start[static_cast<std::size_t>(RateOf(i))]);
      }
      State end = start;
      if (!integrator_.Advance(from_s, to_s, steps, end.data())) return false;
      if (!TurnsRound(end)) {
        std::copy(end.begin(), end.end(), y);
        return true;
      }
      double before_s = from_s, after_s = to_s;
      for (int halving = 0; halving < 30; ++halving) {
        const double middle_s = 0.5 * (before_s + after_s);
        State middle = start;
        if (!integrator_.Advance(from_s, middle_s, steps, middle.data())) return false;
        if (TurnsRound(middle)) {
          after_s = middle_s;
          end = middle;
        } else {
          before_s = middle_s;
        }
      }
      for (int i = 0; i < drives_; ++i) {
        double& rate = end[static_cast<std::size_t>(RateOf(i))];
        if (phase_.slides[static_cast<std::size_t>(i)] * rate < 0.0) rate = 0.0;
      }
      start = end;
      from_s = after_s;
      if (!(to_s - from_s > 1e-12)) {
        std::copy(end.begin(), end.end(), y);
        return true;
      }
    }
    return false;
  }
  bool TurnsRound(const State& y) const {
    for (int i = 0; i < drives_; ++i)
      if (phase_.slides[static_cast<std::size_t>(i)] * y[static_cast<std::size_t>(RateOf(i))] < 0.0)
        return true;
    return false;
  }

  const LauncherModel& equations_;
  const int drives_ = equations_.plant().nozzle_banks() * kDrives;
  LauncherPhase phase_;
  const bool is_fixed_;  ///< its steps do not find their own length
  std::array<double, kLauncherSize> tolerances_;
  Integrator integrator_;
};

FlightRecord::FlightRecord(const FlightModel& model, const FlightOrder& order)
    : inputs(model.AsApplied(order.inputs)),
      options(order.options),
      plant(model.PlantFor(order.inputs, order.options.case_index)),
      weather(PrepareWeather(plant.environment.wind, plant.environment.density, plant.environment.air,
                             plant.environment.turbulence.get())),
      events(EventsOf(model, plant, inputs, model.definition().last_ignition_s, -1.0)),
      lift_off{},
      watched(options.observe != nullptr || options.history != nullptr),
      history_ticks(options.history ? std::max(1L, std::lround(options.history->step_s /
                                                               model.definition().autopilot.tick_s))
                                    : 0),
      noisy(inputs.sensors.gyro_noise_rad_s > 0.0),
      ripple(model.definition().autopilot.tick_s),
      limit_cycle(model.definition().autopilot.tick_s),
      model_(model),
      gyro_noise_(model.definition().noise_seed, options.case_index, "gyro_noise") {
  const double tick_s = model.definition().autopilot.tick_s;
  sums.step_limit_fraction = GreatestStepUse(plant, tick_s).fraction;
  const FlightDefinition& of = model.definition();
  refusal_ = RefusalOf({of.vehicle, of.autopilot, of.guidance, of.course, inputs, of.soundings.size()}, plant,
                       tick_s);
  if (!refusal_.empty()) refusal = refusal_.c_str();
  WriteState(LiftOffState(model, inputs), lift_off);
  const Quaternion believed = BelievedAttitude(model, inputs, ReadState(lift_off).q_IB);
  const double wxyz[] = {believed.w, believed.x, believed.y, believed.z};
  std::copy(std::begin(wxyz), std::end(wxyz), believed_attitude);
  if (model.guidance_mission()) {
    guided_ = std::make_unique<GuidedFlight>(model, inputs);
    guided = guided_.get();
  }
  if (const PluginLaw* const plugin = model.autopilot().plugin.get()) {
    law_ = std::make_unique<PluginFlight>(*plugin, tick_s, model.autopilot().stages.size(),
                                          PluginAxes(model.autopilot().config), options.case_index);
    law = law_.get();
  }
  if (options.history) options.history->values.clear();
  if (model.own_metrics()) own_sums.resize(model.own_metrics()->parts.size());
  const bool is_usual = model.definition().vehicle.loss_of_control == LossOfControl{};
  lost_attitude = is_usual ? "attitude error above 15 deg for 0.5 s"
                           : "attitude error above the vehicle's limit, for longer than it allows";
  lost_rate = is_usual ? "angular rate above 60 deg/s" : "angular rate above the vehicle's limit";
  SetEquations();
  if (refusal == nullptr) StandOnRail();
}

void FlightRecord::StandOnRail() {
  const std::optional<Rail>& rail = model_.definition().vehicle.rail;
  if (!rail || !(rail->length_m > 0.0)) return;
  if (!equations_) equations_ = std::make_unique<const LauncherModel>(plant);
  rail_ = std::make_unique<RailSlide>(*equations_, *rail, ReadState(lift_off));
  LauncherPhase phase;
  phase.burning = true;
  if (plant.boosters) phase.boosters_burning = (1u << plant.boosters->each.size()) - 1u;
  phase.ignition_s = events.front().time_s;
  RailSlide::Way way;
  const auto ends_at = [&](double limit_s) {
    return rail_->Follow(phase, model_.definition().autopilot.tick_s, limit_s, way);
  };
  bool leaves = false, separates = false;
  for (const FlightEvent& event : events) {
    const bool burns_out = event.kind == EventKind::kBurnout, boosters = Is<BoosterBurnout>(event);
    separates = event.kind == EventKind::kSeparation || Is<BoosterSeparation>(event);
    if (!burns_out && !boosters && !separates) continue;
    leaves = ends_at(event.time_s);
    if (leaves || separates) break;
    if (burns_out) {
      phase.burning = false;
      phase.boosters_burning = 0;
      phase.burnt = true;
    } else {
      phase.boosters_burning &= ~(1u << event.item);
    }
  }
  // Without thrust it slides on until it stops.
  if (!leaves && !separates && way.speed_m_s > 0.0) leaves = ends_at(way.time_s + kLongestSlide_s);
  if (leaves) {
    rail_exit_s_ = way.time_s;
    events = EventsOf(model_, plant, inputs, model_.definition().last_ignition_s, rail_exit_s_);
    return;
  }
  char text[100];
  const char* const how = way.stops() ? "stops and would slide back" : separates ? "separates" : "stays";
  std::snprintf(text, sizeof text, "on its rail the vehicle %s, %.2f m of %.2f m from its foot, at %.1f s",
                how, way.travel_m, rail->length_m, way.time_s);
  refusal_ = text;
  refusal = refusal_.c_str();
  // A way that is no number is the computation's fault, all others are the vehicle's.
  if (std::isfinite(way.travel_m)) refused_as = Outcome::kImpact;
}

void FlightRecord::LeaveRail(const double* y) {
  sums.free.left_rail = true;
  sums.free.rail_exit_incidence_rad = TotalIncidence(equations_->Evaluate({}, rail_exit_s_, y).v_AB_B);
  sums.free.rail_exit_time_s = rail_exit_s_;
  sums.free.rail_exit_speed_m_s = rail_->speed_m_s();
  rail_.reset();
}

double FlightRecord::SpinTorque(int stage) const {
  const auto& spin = model_.definition().vehicle.stages[static_cast<std::size_t>(stage)].spin_motors;
  return spin ? spin->moment_n_m : 0.0;
}

bool FlightRecord::Climbs(const double* y) const {
  const RigidBodyState s = ReadState(y);
  const Geodetic place = ToGeodetic(plant.environment.earth, s.p_EoC_I);
  return s.v_IC_I.dot(NedAxes(place.latitude_rad, place.longitude_rad).col(2)) < 0.0;
}

void FlightRecord::Note(std::string name, const EventView& view, const Vector3& p_EoC_I,
                        const Vector3& v_IC_I) {
  result_.events.push_back({std::move(name), view.time_s, view.altitude_m,
                            SpeedOverEarth(plant.environment.earth, p_EoC_I, v_IC_I), view.qbar_pa,
                            view.mass_kg});
}

void FlightRecord::Note(const FlightEvent& event, const EventView& view, const double* y) {
  std::string name = NameOf(model_.definition().vehicle, event);
  const RigidBodyState s = ReadState(y);
  if (!name.empty()) Note(std::move(name), view, s.p_EoC_I, s.v_IC_I);
}

void FlightRecord::NoteJettisons(unsigned due, const EventView& view, const double* y) {
  const RigidBodyState s = ReadState(y);
  for (int i = 0; i < kMaxJettisons; ++i)
    if (due >> i & 1u) Note("jettison_" + std::to_string(i + 1), view, s.p_EoC_I, s.v_IC_I);
}

void FlightRecord::NoteCutOff(int stage, const EventView& view, const double* y) {
  const RigidBodyState s = ReadState(y);
  Note("stage_" + std::to_string(stage + 1) + "_cut_off", view, s.p_EoC_I, s.v_IC_I);
}

void FlightRecord::NoteEnd(Outcome outcome, const EventView& view, const double* y) {
  const RigidBodyState s = ReadState(y);
  if (outcome != Outcome::kCompleted)
    Note("lost", view, s.p_EoC_I, s.v_IC_I);
  else if (!fall_end_s_)  // else it ends on its fall, at an event of its own
    Note("injection", view, s.p_EoC_I, s.v_IC_I);
}

// In its place among the events, which are in the order of their times.
void FlightRecord::NoteMaxQ() {
  if (!(sums.q_max_pa > 0.0)) return;
  const MaxQ<double>& at = sums.max_q;
  const auto next = std::find_if(result_.events.begin(), result_.events.end(),
                                 [&](const SeenEvent& event) { return event.time_s >= at.time_s; });
  result_.events.insert(next, {"max_q", at.time_s, at.altitude_m, at.speed_m_s, sums.q_max_pa, at.mass_kg});
}

Outcome FlightRecord::Fall(double time_s, double mass_kg, const double* y, const char** reason) {
  const FlightDefinition& definition = model_.definition();
  const Descent& descent = definition.vehicle.descent;
  const Stage& last = definition.vehicle.stages.back();
  const bool at_apogee = definition.course.ends == FlightEnd::kApogee;
  const FallingBody body{
      mass_kg,
      descent.drag_area_m2 > 0.0 ? descent.drag_area_m2
                                 : TumblingCylinderDragArea(last.bottom_station_m, last.diameter_m),
      descent.parachute_area_m2 * descent.parachute_drag_coefficient, descent.parachute_altitude_m};
  const RigidBodyState s = ReadState(y);
  const Earth& earth = plant.environment.earth;
  const FallPath path = FollowFall(plant.environment, body, {time_s, s.p_EoC_I, s.v_IC_I},
                                   {at_apogee, descent.ground_altitude_m, kTimeLimit_s - time_s});
  FreeFlightSums& free = sums.free;
  free.has_apogee = path.apogee.has_value() || path.impact.has_value();
  // A body that only descends has its apogee where it begins to.
  free.apogee_time_s = path.apogee ? path.apogee->time_s : time_s;
  free.apogee_altitude_m = path.apogee ? path.apogee->altitude_m : ToGeodetic(earth, s.p_EoC_I).altitude_m;
  // The way of a point tells no dynamic pressure.
  if (free.has_apogee)
    Note("apogee", {free.apogee_time_s, free.apogee_altitude_m, std::nan(""), mass_kg},
         path.apogee ? path.apogee->p_EoP_I : s.p_EoC_I, path.apogee ? path.apogee->v_IP_I : s.v_IC_I);
  if (path.impact && !at_apogee) {
    const Impact& impact = *path.impact;
    result_.events.push_back(
        {"impact", impact.time_s, descent.ground_altitude_m, impact.speed_m_s, std::nan(""), mass_kg});
    free.has_impact = true;
    free.impact_time_s = impact.time_s;
    free.impact_latitude_rad = impact.place.latitude_rad;
    free.impact_longitude_rad = impact.place.longitude_rad;
    free.impact_speed_m_s = impact.speed_m_s;
    const LaunchSite& site = definition.vehicle.site;
    const GroundTrack track = TrackOf({site.latitude_rad, site.longitude_rad, 0.0},
                                      definition.program.launch_azimuth_rad, impact.place);
    free.impact_downrange_m = track.along_m;
    free.impact_crossrange_m = track.across_m;
  }
  const bool arrives = at_apogee ? free.has_apogee : free.has_impact;
  fall_end_s_ = !arrives ? kTimeLimit_s : at_apogee ? free.apogee_time_s : free.impact_time_s;
  const double fallen[] = {free.apogee_time_s, free.apogee_altitude_m, free.impact_latitude_rad,
                           free.impact_longitude_rad, free.impact_speed_m_s};
  digester_.Add(fallen, std::size(fallen));
  if (arrives) return Outcome::kCompleted;
  *reason = at_apogee ? "no apogee within 86400 s of simulated time"
                      : "not on the ground within 86400 s of simulated time";
  return Outcome::kTimeout;
}

void FlightRecord::SetEquations() {
  judged_.reset();
  if (watched || is_judged() || rail_) equations_ = std::make_unique<const LauncherModel>(plant);
  if (is_judged()) judged_ = std::make_unique<JudgedMotion>(*equations_, options.scheme);
}

FlightRecord::~FlightRecord() = default;

void FlightRecord::DrawNoise(double* rate_rad_s) {
  for (int axis = 0; axis < kAxes; ++axis)
    rate_rad_s[axis] = inputs.sensors.gyro_noise_rad_s * gyro_noise_.Normal();
}

void FlightRecord::AddToDigest(double time_s, const double* y) {
  digester_.Add(&time_s, 1);
  digester_.Add(y, static_cast<std::size_t>(plant.state_size()));
}

bool FlightRecord::Guide(const LaneSight& sight) {
  if (!guided->See(sight)) return false;
  // The last stage's events keep their distances from its ignition.
  const int last = events.back().stage;
  std::size_t first = events.size();
  while (events[first - 1].stage == last) --first;
  // The motor ignites late by its dispersed delay after guidance's command.
  const double late_s = inputs.stages[static_cast<std::size_t>(last)].ignition_delay_s;
  const double ignition_s =
      late_s != 0.0 ? std::max(guided->ignition_s() + late_s, sight.time_s) : guided->ignition_s();
  const double shift_s = ignition_s - events[first].time_s;
  for (std::size_t i = first; i < events.size(); ++i) events[i].time_s += shift_s;
  return true;
}

ReferenceAttitude FlightRecord::ReferenceAt(double time_s) const {
  return guided && guided->steers() ? guided->ReferenceAt(time_s) : model_.definition().program.At(time_s);
}

double FlightRecord::ProgramPitch(double time_s) const { return ReferenceAt(time_s).angles.pitch; }

TickSample FlightRecord::SampleOf(const LaneView& view) const {
  TickSample s;
  s.time_s = view.time_s;
  s.stack = view.phase.stack;
  s.burning = view.phase.burning;
  s.unsteered = view.unsteered;
  s.coasting = view.coasting;
  s.since_ignition_s = view.time_s - view.phase.ignition_s;
  s.state = ReadState(view.y);
  for (int i = 0; i < plant.nozzle_banks() * kDrives; ++i) {
    s.nozzle_rad[static_cast<std::size_t>(i)] = view.y[AngleOf(i)];
    s.nozzle_rate_rad_s[static_cast<std::size_t>(i)] = view.y[RateOf(i)];
  }
  std::copy(view.y + kModalState, view.y + kBentLauncherSize, s.bending.begin());
  s.command_rad = view.phase.command_rad;
  s.limit_rad = plant.stacks[static_cast<std::size_t>(s.stack)].gimbal.limit_rad;
  s.reference = ReferenceAt(view.time_s);
  if (view.has_error) {
    for (int axis = 0; axis < kAxes; ++axis) {
      s.error.angle_rad[axis] = view.error_angle_rad[axis];
      s.error.rate_rad_s[axis] = view.error_rate_rad_s[axis];
    }
  } else {
    s.error = ErrorAt(model_, s.reference, s.state);
  }
  s.gimbal = {view.gimbal_rad[kRoll], view.gimbal_rad[kPitch], view.gimbal_rad[kYaw], {}};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    s.gimbal.telemetry[axis] = view.axes[axis];
    s.memories[axis] = view.memories[axis];
    s.thrusters[axis] = view.thrusters[axis];
  }
  if (law) s.law_telemetry = law->telemetry();
  s.stuck_nozzle = view.phase.stuck_nozzle;
  s.expelled_mass_kg = view.phase.expelled_mass_kg;
  s.jettisoned = view.phase.jettisoned;
  s.boosting = view.phase.boosting();
  s.boosters_burning = view.phase.boosters_burning;
  s.instant = equations_->Evaluate(view.phase, view.time_s, view.y);
  return s;
}

void FlightRecord::Watch(const LaneView& view) const { options.observe(SampleOf(view)); }

void FlightRecord::AppendRow(const double* row) {
  options.history->values.insert(options.history->values.end(), row, row + kBodyColumns + kLauncherColumns);
}

void FlightRecord::WatchEvent(const LaneView& view) {
  if (options.history) dispersa::AppendRow(model_, SampleOf(view), options.history->values);
}

void FlightRecord::HandOver(double time_s, const double* y) {
  const AttitudeError error = ErrorAt(model_, ReferenceAt(time_s), ReadState(y));
  sums.handed_over = true;
  sums.handover_angle_rad = error.angle_rad.norm();
  sums.handover_rate_rad_s = error.rate_rad_s.norm();
}

void FlightRecord::Inject(double altitude_m, const double* y) {
  const RigidBodyState s = ReadState(y);
  sums.injected = true;
  sums.injection_altitude_m = altitude_m;
  sums.orbit = ElementsOf(plant.environment.earth, s.p_EoC_I, s.v_IC_I);
  if (guided) guided->Inject(altitude_m, s.p_EoC_I, s.v_IC_I);
}

unsigned FlightRecord::LetGo(int stack, unsigned jettisoned, double time_s, double altitude_m,
                             double density_kg_m3, double propellant_kg, double* y) {
  const RigidBodyState s = ReadState(y);
  const unsigned due = DueJettisons(
      plant, stack, jettisoned,
      {time_s, altitude_m, density_kg_m3, SpeedOverEarth(plant.environment.earth, s.p_EoC_I, s.v_IC_I)});
  if (due == 0) return due;
  RigidBodyState left = AfterJettison(plant, stack, jettisoned, jettisoned | due, propellant_kg,
                                      time_s - events.front().time_s, s);
  LetGoBent(plant.stacks[static_cast<std::size_t>(stack)], jettisoned, jettisoned | due, propellant_kg,
            y + kModalState, left);
  WriteState(left, y);
  return due;
}

const Motor* FlightRecord::CutOffEngine(int stage) const {
  const Motor& engine = model_.definition().vehicle.stages[static_cast<std::size_t>(stage)].motor;
  return EndsInFlight(engine) ? &engine : nullptr;
}

void FlightRecord::CutOff(int stage, double time_s) {
  const auto ignition = std::find_if(events.begin(), events.end(),
                                     [&](const FlightEvent& event) { return event.stage == stage; });
  CommandCutOffOf(model_.definition().vehicle, stage, time_s - ignition->time_s, plant);
  events = EventsOf(model_, plant, inputs,
                    guided ? guided->ignition_s() : model_.definition().last_ignition_s, rail_exit_s_);
  SetEquations();
}

void FlightRecord::LetGoOfBoosters(unsigned jettisoned, double time_s, double propellant_kg, double* y) {
  const unsigned without = jettisoned | kBoostersGone;
  RigidBodyState left = AfterJettison(plant, 0, jettisoned, without, propellant_kg,
                                      time_s - events.front().time_s, ReadState(y));
  LetGoBent(plant.stacks[0], jettisoned, without, propellant_kg, y + kModalState, left);
  WriteState(left, y);
  if (!plant.boosters_steer()) return;
  for (int drive = plant.stacks[0].layout.banks() * kDrives; drive < plant.nozzle_banks() * kDrives; ++drive)
    y[AngleOf(drive)] = y[RateOf(drive)] = 0.0;
}

void FlightRecord::MassWithout(int stack, unsigned jettisoned, StackMass& mass) const {
  mass = MassOf(plant, stack, jettisoned);
}

const ModeTable* FlightRecord::BendingWithout(int stack, unsigned jettisoned) const {
  return plant.stacks[static_cast<std::size_t>(stack)].BendingWithout(jettisoned);
}

void FlightRecord::Separate(int stage, unsigned jettisoned, double* y) {
  const std::size_t below = static_cast<std::size_t>(stage);
  RigidBodyState s = AfterSeparation(plant, stage, jettisoned, ReadState(y));
  if (model_.definition().vehicle.stages[below + 1].restarts) {  // nothing has left: it bends on
    std::fill(y, y + kModalState, 0.0);
    std::fill(y + kBentLauncherSize, y + kLauncherSize, 0.0);
    WriteState(s, y);
    return;
  }
  TakeAlong(plant.stacks[below], jettisoned, y + kModalState, s);
  s.w_IB_B += Vector3(inputs.stages[below].tip_off_roll_rad_s, inputs.stages[below].tip_off_pitch_rad_s,
                      inputs.stages[below].tip_off_yaw_rad_s);
  std::fill(y, y + kLauncherSize, 0.0);
  WriteState(s, y);
}

bool FlightRecord::Judge(const LauncherPhase& phase, double from_s, double to_s, double* y) {
  if (!rail_) return judged_->Advance(phase, from_s, to_s, options.steps_per_tick, y);
  rail_->Advance(phase, from_s, to_s, y);
  return true;
}

void FlightRecord::End(Outcome outcome, const char* reason, double time_s, int stack, const double* y) {
  result_.outcome = outcome;
  result_.reason = reason;
  result_.end_time_s = fall_end_s_.value_or(time_s);
  result_.end_stage = stack + 1;
  result_.end_state = ReadState(y);
  AddToDigest(time_s, y);
}

FlightResult FlightRecord::Result() {
  sums.ripple_rad = ripple.worst_rad();
  sums.limit_cycle_rad = limit_cycle.worst_rad();
  if (guided) sums.guidance = guided->outcome();
  NoteMaxQ();
  MeasuredFlight measured = Measure(sums, model_.definition());
  result_.metrics = std::move(measured.metrics);
  if (model_.own_metrics()) {
    const std::vector<double> own = model_.own_metrics()->ValuesOf(own_sums);
    result_.metrics.insert(result_.metrics.end(), own.begin(), own.end());
  }
  digester_.Add(measured.digested.data(), measured.digested.size());
  result_.digest = digester_.Finish();
  return std::move(result_);
}

}  // namespace dispersa
