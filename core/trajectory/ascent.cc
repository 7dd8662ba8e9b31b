#include "core/trajectory/ascent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "core/dynamics/jettison.h"
#include "core/flight/launch_frame.h"
#include "core/flight/orbit.h"
#include "core/flight/sequence.h"
#include "core/math/constants.h"
#include "core/trajectory/ascent_events.h"
#include "core/trajectory/ascent_record.h"
#include "core/trajectory/point_mass.h"
#include "core/vehicle/cut_off.h"

namespace dispersa {

namespace {

// The attitude program ends this long after the nominal burnout, for flights that burn longer.
constexpr double kProgramReserve_s = 30.0;
// An ascent that comes this far below its site has failed.
constexpr double kGround_m = 1000.0;
// Spacing of samples and of the attitude program's knots, unless the steps are longer: dense in the
// pitch-over, where the programmed incidence changes.
constexpr double kKickKnot_s = 0.1;
constexpr double kBurnKnot_s = 1.0;
constexpr double kCoastKnot_s = 5.0;

using lanes::Lane;
using LaneVector = lanes::Vector<double>;

lanes::Ground GroundOf(const AscentModel& model) {
  const Earth& earth = model.plant.environment.earth;
  return {earth, ToLanes(-BuildLaunchFrame(earth, model.vehicle.site, 0.0).R_IL.col(2))};
}

// The events and steps of one flight. Its motion is a lane of the fleet.
struct Flight {
  const FlightProgram* program = nullptr;
  AscentResult* result = nullptr;  // none: the lane is idle
  LaunchFrame frame;
  std::vector<MotorBurn> burns;  // as this flight burns them
  std::vector<AscentEvent> events;
  std::size_t next_event = 0;

  // The interval to the next event, in equal steps.
  double from_s = 0.0, to_s = 0.0;
  int step = 0, steps = 1, steps_per_knot = 1;

  int stack = 0;
  unsigned jettisoned = 0;  // LauncherPhase's
  bool burning = false, burnt = false, boosting = false, turning = false;
  double ignition_s = 0.0;
  LaneVector turn_offset_I = lanes::Zero<double>();
  double steer_rad = 0.0, steer_rad_s = 0.0, steer_from_s = 0.0, fade_rad = 0.0, fade_from_s = 0.0;  // Leg's

  bool in_reserve = false;  // injected already
  std::size_t samples = 0;  // to the injection

  double StepEnd() const { return step + 1 == steps ? to_s : from_s + (to_s - from_s) * (step + 1) / steps; }
  bool IsAtKnot() const { return step % steps_per_knot == 0; }
};

bool Steers(const AscentModel& model, const FlightProgram& program) {
  for (std::size_t i = 0; i < model.vehicle.stages.size(); ++i)
    if (!program.steering[i].empty()) return true;
  return false;
}

template <class T>
void SetLeg(lanes::Leg<T>& leg, int lane, const AscentModel& model, const Flight& flight) {
  const std::size_t stack = static_cast<std::size_t>(flight.stack);
  SetLane(leg.program, lane, lanes::Prepared(*flight.program));
  SetStack(leg.stack, lane, MassOf(model.plant, flight.stack, flight.jettisoned));
  SetBurn(leg.burn, lane, flight.burns[stack]);
  const LauncherStack& shape = model.plant.stacks[stack];
  SetShape(leg.aero, lane, shape, shape.AeroAfter(flight.jettisoned, flight.burning));
  SetWeather(leg.weather, lane, model.weather);
  leg.has_boosters = model.plant.boosters != nullptr;
  if (leg.has_boosters) {
    SetBeside(leg.beside, lane, model.plant.boosters->burn, model.plant.boosters->propellant);
    if (stack > 0 || (flight.jettisoned & kBoostersGone) != 0) Lane(leg.beside.burn.left_kg, lane) = 0.0;
  }
  lanes::SetLane(leg.boosting, lane, flight.boosting);
  lanes::SetLane(leg.burning, lane, flight.burning);
  lanes::SetLane(leg.burnt, lane, flight.burnt);
  lanes::SetLane(leg.turning, lane, flight.turning);
  Lane(leg.ignition_s, lane) = flight.ignition_s;
  const bool is_last = stack + 1 == model.plant.stacks.size();
  Lane(leg.expelled_kg, lane) = is_last ? model.reaction_control_propellant_kg : 0.0;
  SetLane(leg.right_I, lane, ToLanes(flight.frame.R_IL.col(1)));
  SetLane(leg.turn_offset_I, lane, flight.turn_offset_I);
  leg.any_steers = Steers(model, *flight.program) || (leg.any_steers && lanes::kWidth<T> > 1);
  Lane(leg.steer_rad, lane) = flight.steer_rad;
  Lane(leg.steer_rad_s, lane) = flight.steer_rad_s;
  Lane(leg.steer_from_s, lane) = flight.steer_from_s;
  Lane(leg.fade_rad, lane) = flight.fade_rad;
  Lane(leg.fade_from_s, lane) = flight.fade_from_s;
}

// The largest values of the limited quantities.
template <class T>
struct Peaks {
  T qbar_pa, q_alpha_pa_rad, axial_g, lateral_g, turn_rate_rad_s, transonic_alpha_rad;
};

// Adds an instant to the peaks.
template <class T>
void Observe(const AscentOptions& options, const lanes::Ground& ground, const lanes::Leg<T>& leg, T time_s,
             const lanes::Vector<T>& p, const lanes::Vector<T>& v, const lanes::AscentInstant<T>& now,
             Peaks<T>& peaks) {
  const T inverse_weight = T(1.0) / (now.mass_kg * T(kStandardGravity));
  const T alpha = lanes::Abs(lanes::IncidenceAt(leg.program, time_s));
  peaks.qbar_pa = lanes::Max(peaks.qbar_pa, now.qbar_pa);
  peaks.q_alpha_pa_rad = lanes::Max(peaks.q_alpha_pa_rad, now.qbar_pa * now.incidence_rad);
  peaks.axial_g = lanes::Max(peaks.axial_g, lanes::Abs(now.axial_n) * inverse_weight);
  peaks.lateral_g = lanes::Max(peaks.lateral_g, lanes::Abs(now.lateral_n) * inverse_weight);
  const auto transonic = (now.mach >= T(options.mach_low)) & (now.mach <= T(options.mach_high));
  peaks.transonic_alpha_rad =
      lanes::Select(transonic, lanes::Max(peaks.transonic_alpha_rad, alpha), peaks.transonic_alpha_rad);
  const auto kicking = leg.turning & (time_s <= leg.program.t2_s);
  if (lanes::Any(kicking)) {
    const lanes::Vector<T> rate = lanes::AxisRateAt(ground, leg, time_s, p, v, now.acceleration_I);
    peaks.turn_rate_rad_s =
        lanes::Select(kicking, lanes::Max(peaks.turn_rate_rad_s, lanes::Sqrt(lanes::Dot(rate, rate))),
                      peaks.turn_rate_rad_s);
  }
}

// The beginning of a step.
struct AscentStep {
  AscentPoint start;
  LaneVector acceleration_I;
};

// W ascents side by side, each from event to event in steps of its own. When an ascent ends, its lane takes
// the next program, so that few lanes are idle.
template <class T>
class Fleet {
 public:
  Fleet(const AscentModel& model, const AscentOptions& options)
      : model_(model),
        options_(options),
        ground_(GroundOf(model)),
        cuts_off_in_flight_(CutsOffInFlight(model.vehicle)) {}

  void Fly(std::span<const FlightProgram> programs, std::span<AscentResult> results);

 private:
  static constexpr int kWidth = lanes::kWidth<T>;

  void TakeOff(int lane, const FlightProgram& program, AscentResult* result);
  void AdvanceAll();
  void GoOn(int lane);
  void SetOut(int lane, double to_s);
  void Happen(int lane, const AscentEvent& event);
  unsigned DueAt(int lane, double time_s, const LaneVector& p, const LaneVector& v) const;
  AscentStep StepAgain(int lane, double from_s, const LaneVector& p, const LaneVector& v) const;
  void MoveTo(int lane, const AscentStep& step, double time_s);
  void LetGo(int lane, double from_s, const LaneVector& p, const LaneVector& v);
  void Drop(int lane, unsigned due);
  void CutOff(int lane, double from_s, const LaneVector& p, const LaneVector& v);
  void ObserveHere(int lane);
  void Steer(int lane, int stage);
  void StopSteering(int lane);
  void Conclude(int lane, bool completed);
  void Inject(int lane);

  // An event of one lane is computed with scalar code, as if it flew alone.
  AscentPoint PointOf(int lane) const {
    const Flight& flight = flights_[lane];
    AscentPoint point;
    SetLeg(point.leg, 0, model_, flight);
    point.time_s = Lane(time_s_, lane);
    point.stage = flight.stack + 1;
    point.p = LaneOf(p_, lane);
    point.v = LaneOf(v_, lane);
    return point;
  }

  // The state of a body that turns with its program.
  RigidBodyState BodyOf(int lane) const {
    const AscentPoint point = PointOf(lane);
    RigidBodyState state;
    state.p_EoC_I = ToEigen(point.p);
    state.v_IC_I = ToEigen(point.v);
    const Matrix3 R_IB = AttitudeOf(flights_[lane].frame, ForwardOf(ground_, point));
    state.q_IB = QuaternionOf(R_IB);
    state.w_IB_B = R_IB.transpose() * R_IB.col(0).cross(ToEigen(AxisRateOf(ground_, point)));
    return state;
  }
  void SetBody(int lane, const RigidBodyState& state) {
    SetLane(p_, lane, ToLanes(state.p_EoC_I));
    SetLane(v_, lane, ToLanes(state.v_IC_I));
  }

  const AscentModel& model_;
  const AscentOptions& options_;
  lanes::Ground ground_;
  const bool cuts_off_in_flight_;
  std::array<Flight, kWidth> flights_;
  lanes::Leg<T> leg_{};
  T time_s_ = T(0.0), next_s_ = T(0.0);
  lanes::Vector<T> p_{}, v_{};
  Peaks<T> peaks_{};
};

template <class T>
void Fleet<T>::Fly(std::span<const FlightProgram> programs, std::span<AscentResult> results) {
  std::size_t taken = 0;
  for (int lane = 0; lane < kWidth; ++lane) {
    // A lane without work stays at the lift-off of the first program, in steps of zero length.
    const bool idle = taken == programs.size();
    TakeOff(lane, programs[idle ? 0 : taken], idle ? nullptr : &results[taken]);
    if (!idle) ++taken;
  }
  const auto flies = [](const Flight& flight) { return flight.result != nullptr; };
  while (std::any_of(flights_.begin(), flights_.end(), flies)) {
    AdvanceAll();
    for (int lane = 0; lane < kWidth; ++lane) {
      Flight& flight = flights_[lane];
      if (!flight.result || ++flight.step < flight.steps) continue;
      GoOn(lane);
      if (flight.result || taken == programs.size()) continue;
      TakeOff(lane, programs[taken], &results[taken]);
      ++taken;
    }
  }
}

template <class T>
void Fleet<T>::TakeOff(int lane, const FlightProgram& program, AscentResult* result) {
  Flight& flight = flights_[lane];
  flight = {};
  flight.program = &program;
  flight.result = result;
  flight.frame = BuildLaunchFrame(ground_.earth, model_.vehicle.site, program.launch_azimuth_rad);
  flight.burns = BurnsOf(model_);
  AscentEvents all = EventsOf(model_, flight.burns, program);
  flight.events = std::move(all.events);
  SetLane(p_, lane, ToLanes(flight.frame.p_EoL_I));
  SetLane(v_, lane, ToLanes(flight.frame.v_IL_I));
  Lane(time_s_, lane) = Lane(next_s_, lane) = 0.0;
  lanes::SetLane(peaks_, lane, Peaks<double>{});
  SetLeg(leg_, lane, model_, flight);
  if (!result) return;
  *result = {};
  result->last_ignition_s = all.last_ignition_s;
  result->jettison_s.assign(model_.plant.jettisons.size(), HUGE_VAL);
  result->earlier_ignition_s = all.earlier_ignition_s;
  result->attitude.launch_azimuth_rad = program.launch_azimuth_rad;
  GoOn(lane);
}

// One step of every lane. Peaks are observed at the start of a step. The end of an interval is observed after
// its event, on the far side of the kink.
template <class T>
void Fleet<T>::AdvanceAll() {
  for (int lane = 0; lane < kWidth; ++lane)
    if (flights_[lane].result) Lane(next_s_, lane) = flights_[lane].StepEnd();
  const lanes::AscentInstant<T> now = lanes::InstantAt(ground_, leg_, time_s_, p_, v_);
  Observe(options_, ground_, leg_, time_s_, p_, v_, now, peaks_);
  if constexpr (kWidth == 1) {
    if (options_.record && flights_[0].IsAtKnot())
      Record(flights_[0].frame, ground_, PointOf(0), now, flights_[0].result);
  }
  const lanes::Vector<T> p = p_, v = v_;
  const T from_s = time_s_;
  lanes::Step(ground_, leg_, time_s_, next_s_, now.acceleration_I, &p_, &v_);
  time_s_ = next_s_;
  if (cuts_off_in_flight_)
    for (int lane = 0; lane < kWidth; ++lane)
      if (flights_[lane].result && flights_[lane].burning)
        CutOff(lane, Lane(from_s, lane), LaneOf(p, lane), LaneOf(v, lane));
  const unsigned all = (1u << model_.plant.jettisons.size()) - 1u;
  if (all == 0) return;
  for (int lane = 0; lane < kWidth; ++lane)
    if (flights_[lane].result && !flights_[lane].in_reserve && (flights_[lane].jettisoned & all) != all)
      LetGo(lane, Lane(from_s, lane), LaneOf(p, lane), LaneOf(v, lane));
}

template <class T>
unsigned Fleet<T>::DueAt(int lane, double time_s, const LaneVector& p, const LaneVector& v) const {
  const Flight& flight = flights_[lane];
  const lanes::Surroundings<double> around =
      lanes::SurroundingsAt(ground_.earth, PointOf(lane).leg.weather, p);
  const LaneVector ground = lanes::VelocityOverGround(ground_, p, v);
  return DueJettisons(
      model_.plant, flight.stack, flight.jettisoned,
      {time_s, around.altitude_m, around.density_kg_m3, std::sqrt(lanes::Dot(ground, ground))});
}

// Removes the jettisoned mass. The state then belongs to the centre of gravity of the remaining stack.
template <class T>
void Fleet<T>::Drop(int lane, unsigned due) {
  Flight& flight = flights_[lane];
  const double since_s = Lane(time_s_, lane) - flight.ignition_s;
  const MotorBurn& burn = flight.burns[static_cast<std::size_t>(flight.stack)];
  const double propellant_kg = flight.burning ? burn.Propellant(since_s)
                               : flight.burnt ? burn.left_kg
                                              : burn.propellant_mass_kg;
  SetBody(lane, AfterJettison(model_.plant, flight.stack, flight.jettisoned, flight.jettisoned | due,
                              propellant_kg, since_s, BodyOf(lane)));
  flight.jettisoned |= due;
}

// The start of a step that went beyond an event of the lane. The step is then repeated to the time of the
// event.
template <class T>
AscentStep Fleet<T>::StepAgain(int lane, double from_s, const LaneVector& p, const LaneVector& v) const {
  AscentPoint start = PointOf(lane);
  start.time_s = from_s;
  start.p = p;
  start.v = v;
  return {start, InstantOf(ground_, start).acceleration_I};
}

template <class T>
void Fleet<T>::MoveTo(int lane, const AscentStep& step, double time_s) {
  LaneVector p = step.start.p, v = step.start.v;
  lanes::Step(ground_, step.start.leg, step.start.time_s, time_s, step.acceleration_I, &p, &v);
  SetLane(p_, lane, p);
  SetLane(v_, lane, v);
  Lane(time_s_, lane) = time_s;
}

// After a step of a lane that began at `from_s`: jettisons. Each due part leaves at the first tick of the
// flight computer at which it is due. The interval to the next event then begins there.
template <class T>
void Fleet<T>::LetGo(int lane, double from_s, const LaneVector& p, const LaneVector& v) {
  Flight& flight = flights_[lane];
  if (DueAt(lane, Lane(time_s_, lane), LaneOf(p_, lane), LaneOf(v_, lane)) == 0) return;
  const AscentStep again = StepAgain(lane, from_s, p, v);
  const auto move_to = [&](double time_s) {
    MoveTo(lane, again, time_s);
    return DueAt(lane, time_s, LaneOf(p_, lane), LaneOf(v_, lane));
  };
  const double end_s = Lane(time_s_, lane);
  long tick = static_cast<long>(std::floor(from_s / model_.tick_s + kSameInstant_s)) + 1;
  long after = static_cast<long>(std::ceil(end_s / model_.tick_s - kSameInstant_s));
  while (tick < after) {
    const long middle = tick + (after - tick) / 2;
    if (move_to(std::min(static_cast<double>(middle) * model_.tick_s, end_s)) != 0)
      after = middle;
    else
      tick = middle + 1;
  }
  const unsigned due = move_to(std::min(static_cast<double>(tick) * model_.tick_s, end_s));
  Drop(lane, due);
  for (std::size_t i = 0; i < flight.result->jettison_s.size(); ++i)
    if (due >> i & 1u) flight.result->jettison_s[i] = Lane(time_s_, lane);
  SetLeg(leg_, lane, model_, flight);
  const double event_s = flight.to_s;
  if (event_s > Lane(time_s_, lane) + kSameInstant_s) {
    SetOut(lane, event_s);
    flight.step = -1;  // the step that has been made was cut short: it does not count
  }
}

// After a step of a lane that began at `from_s`: if the speed has passed the engine's cut-off velocity, the
// engine is cut off at that velocity. The times of all later events change.
template <class T>
void Fleet<T>::CutOff(int lane, double from_s, const LaneVector& p, const LaneVector& v) {
  Flight& flight = flights_[lane];
  const std::size_t stack = static_cast<std::size_t>(flight.stack);
  const Motor& engine = model_.vehicle.stages[stack].motor;
  if (!EndsAtSpeed(engine)) return;
  const auto beyond_m_s = [&](double time_s, const LaneVector& place, const LaneVector& then) {
    const double speed_m_s = std::sqrt(lanes::Dot(then, then));
    if (engine.cut_off == CutOff::kAtVelocity) return speed_m_s - engine.cut_off_velocity_m_s;
    const Vector3 p_EoC_I = ToEigen(place);
    const double altitude_m =
        ToGeodetic(ground_.earth, InertialToEarth(ground_.earth, time_s, p_EoC_I)).altitude_m;
    return speed_m_s - CutOffSpeed(engine, p_EoC_I.norm(), altitude_m);
  };
  double after_m_s = beyond_m_s(Lane(time_s_, lane), LaneOf(p_, lane), LaneOf(v_, lane));
  if (after_m_s < 0.0) return;
  const AscentStep again = StepAgain(lane, from_s, p, v);
  const auto move_to = [&](double time_s) {
    MoveTo(lane, again, time_s);
    return beyond_m_s(time_s, LaneOf(p_, lane), LaneOf(v_, lane));
  };
  // Regula falsi (Illinois): within a step the speed is almost linear in time.
  constexpr double kNear_m_s = 1e-9;
  double before_s = from_s, after_s = Lane(time_s_, lane), before_m_s = beyond_m_s(from_s, p, v);
  if (before_m_s >= 0.0) move_to(from_s);  // it was too fast when it ignited
  for (int i = 0; i < 60 && before_m_s < 0.0 && after_m_s > kNear_m_s; ++i) {
    const double time_s = before_s + (after_s - before_s) * before_m_s / (before_m_s - after_m_s);
    const double there_m_s = move_to(time_s);
    if (there_m_s < 0.0) {
      before_s = time_s;
      before_m_s = there_m_s;
      after_m_s *= 0.5;
      if (there_m_s > -kNear_m_s) break;
    } else {
      after_s = time_s;
      after_m_s = there_m_s;
      before_m_s *= 0.5;
    }
  }
  const double burnt_s = Lane(time_s_, lane) - flight.ignition_s;
  if (burnt_s >= flight.burns[stack].duration_s) return;  // it ends by itself
  CutOffAt(burnt_s, flight.burns[stack]);
  for (std::size_t i = stack + 1; i < flight.burns.size() && model_.vehicle.stages[i].restarts; ++i)
    SetPropellant(model_.vehicle.stages[i].motor, flight.burns[i - 1].left_kg, flight.burns[i]);
  AscentResult& result = *flight.result;
  result.cut_off_s[stack] = burnt_s;
  AscentEvents all = EventsOf(model_, flight.burns, *flight.program);
  flight.events = std::move(all.events);
  result.last_ignition_s = all.last_ignition_s;
  result.earlier_ignition_s = all.earlier_ignition_s;
  SetLeg(leg_, lane, model_, flight);
  flight.step = flight.steps - 1;  // on to the cut-off
}

// Continues from an event, or from lift-off, to the next event.
template <class T>
void Fleet<T>::GoOn(int lane) {
  Flight& flight = flights_[lane];
  if (flight.in_reserve) {
    const AscentPoint point = PointOf(lane);
    Record(flight.frame, ground_, point, InstantOf(ground_, point), flight.result);
    flight.result->samples.resize(flight.samples);
    flight.result = nullptr;
    return;
  }
  const double lowest_m = model_.vehicle.site.altitude_m - kGround_m;
  if (!(ToGeodetic(ground_.earth, ToEigen(LaneOf(p_, lane))).altitude_m > lowest_m))
    return Conclude(lane, false);
  while (flight.next_event < flight.events.size()) {
    const AscentEvent& event = flight.events[flight.next_event];
    if (event.time_s > Lane(time_s_, lane) + kSameInstant_s) return SetOut(lane, event.time_s);
    Happen(lane, event);
    SetLeg(leg_, lane, model_, flight);
    ++flight.next_event;
  }
  Conclude(lane, true);
}

template <class T>
void Fleet<T>::SetOut(int lane, double to_s) {
  Flight& flight = flights_[lane];
  const AscentSteps& steps = options_.steps;
  flight.from_s = Lane(time_s_, lane);
  flight.to_s = to_s;
  const double way_s = to_s - flight.from_s;
  const bool kick = flight.from_s < flight.program->t2_s;
  const bool air = flight.stack == 0 && flight.burning;
  const double largest = air ? steps.air_s : flight.burning ? steps.burn_s : steps.coast_s;
  const double knot = kick ? kKickKnot_s : flight.burning ? kBurnKnot_s : kCoastKnot_s;
  const auto pieces = [](double whole, double part) {
    return std::max(1, static_cast<int>(std::ceil(whole / part - kSameInstant_s)));
  };
  // The steps do not depend on whether their ends are recorded.
  const int knots = pieces(way_s, std::max(knot, largest));
  flight.steps_per_knot = pieces(way_s / knots, largest);
  flight.steps = knots * flight.steps_per_knot;
  flight.step = 0;
}

// Observes the near side of a kink, at which loads peak.
template <class T>
void Fleet<T>::ObserveHere(int lane) {
  const AscentPoint point = PointOf(lane);
  Peaks<double> peaks = lanes::LaneOf(peaks_, lane);
  Observe(options_, ground_, point.leg, point.time_s, point.p, point.v, InstantOf(ground_, point), peaks);
  lanes::SetLane(peaks_, lane, peaks);
}

template <class T>
void Fleet<T>::Steer(int lane, int stage) {
  Flight& flight = flights_[lane];
  const std::size_t i = static_cast<std::size_t>(stage);
  const Steering& steering = flight.program->steering[i];
  // The first stage's begins as its boosters leave.
  flight.steer_from_s = stage == 0 ? Lane(time_s_, lane) : flight.ignition_s;
  flight.steer_rad = steering.begin_rad;
  // The rate is over a burn to depletion of the propellant left by the burn before, even if the engine is cut
  // off earlier. With no propellant left there is no burn.
  const double whole_s = flight.burns[i].duration_s - (flight.steer_from_s - flight.ignition_s);
  flight.steer_rad_s =
      steering.empty() || whole_s == 0.0 ? 0.0 : (steering.end_rad - steering.begin_rad) / whole_s;
}

template <class T>
void Fleet<T>::StopSteering(int lane) {
  Flight& flight = flights_[lane];
  if (!Steers(model_, *flight.program)) return;
  const AscentPoint point = PointOf(lane);
  flight.fade_rad = lanes::SteeringAt(point.leg, point.time_s);
  flight.fade_from_s = point.time_s;
  flight.steer_rad = flight.steer_rad_s = 0.0;
}

template <class T>
void Fleet<T>::Happen(int lane, const AscentEvent& event) {
  Flight& flight = flights_[lane];
  switch (event.kind) {
    case AscentEvent::kIgnition:
      flight.burning = true;
      flight.boosting = event.stage == 0 && model_.plant.boosters != nullptr;
      flight.ignition_s = event.time_s;
      if (event.stage > 0) Steer(lane, event.stage);
      break;
    case AscentEvent::kBoosterBurnout:
      ObserveHere(lane);
      flight.boosting = false;
      break;
    case AscentEvent::kBoosterSeparation:
      Drop(lane, kBoostersGone);
      Steer(lane, 0);
      break;
    case AscentEvent::kBurnout: {
      ObserveHere(lane);
      const AscentPoint point = PointOf(lane);
      if (options_.record) Record(flight.frame, ground_, point, InstantOf(ground_, point), flight.result);
      flight.burning = false;
      flight.burnt = true;
      StopSteering(lane);
      break;
    }
    case AscentEvent::kSeparation: {
      // The vehicle turns with its program, so the stack above leaves with the velocity of its own centre of
      // gravity.
      if (!model_.vehicle.stages[static_cast<std::size_t>(event.stage) + 1].restarts)
        SetBody(lane, AfterSeparation(model_.plant, event.stage, flight.jettisoned, BodyOf(lane),
                                      flight.burns[static_cast<std::size_t>(event.stage)].left_kg));
      flight.stack = event.stage + 1;
      flight.burnt = false;
      break;
    }
    case AscentEvent::kTurnBegin: {
      const AscentPoint point = PointOf(lane);
      flight.turn_offset_I =
          ForwardOf(ground_, point) - lanes::Normalized(lanes::VelocityOverGround(ground_, point.p, point.v));
      flight.turning = true;
      break;
    }
    case AscentEvent::kTurnEnd:
      flight.result->mach_at_t2 = InstantOf(ground_, PointOf(lane)).mach;
      break;
    case AscentEvent::kKink:
      break;
  }
}

template <class T>
void Fleet<T>::Conclude(int lane, bool completed) {
  Flight& flight = flights_[lane];
  AscentResult& result = *flight.result;
  result.completed = completed;
  result.end_time_s = Lane(time_s_, lane);
  result.p_EoC_I = ToEigen(LaneOf(p_, lane));
  result.v_IC_I = ToEigen(LaneOf(v_, lane));
  const OrbitElements e = ElementsOf(ground_.earth, result.p_EoC_I, result.v_IC_I);
  result.orbit = {ToGeodetic(ground_.earth, result.p_EoC_I).altitude_m,
                  e.speed_m_s,
                  e.flight_path_angle_rad,
                  e.inclination_rad,
                  e.ascending_node_rad,
                  e.radius_m,
                  e.argument_of_latitude_rad};
  const Peaks<double> peaks = lanes::LaneOf(peaks_, lane);
  result.q_max_pa = peaks.qbar_pa;
  result.q_alpha_max_pa_rad = peaks.q_alpha_pa_rad;
  result.axial_load_max_g = peaks.axial_g;
  result.lateral_load_max_g = peaks.lateral_g;
  result.turn_rate_max_rad_s = peaks.turn_rate_rad_s;
  result.transonic_alpha_max_rad = peaks.transonic_alpha_rad;
  if (completed && options_.record) {
    // The reserve begins with the sample at the injection.
    flight.in_reserve = true;
    flight.samples = result.samples.size() + 1;
    SetOut(lane, result.end_time_s + kProgramReserve_s);
  } else {
    flight.result = nullptr;
  }
}

}  // namespace

double ProgrammedIncidence(const FlightProgram& program, double time_s) {
  return lanes::IncidenceAt(lanes::Prepared(program), time_s);
}

AscentModel BuildAscentModel(const Vehicle& vehicle, double tick_s) {
  AscentModel model{vehicle, BuildNominalPlant(vehicle), {}, tick_s, 0.0};
  model.weather = PrepareWeather(model.plant.environment.wind, model.plant.environment.density,
                                 model.plant.environment.air);
  return model;
}

AscentResult FlyAscent(const AscentModel& model, const FlightProgram& program, const AscentOptions& options) {
  AscentResult result;
  Fleet<double>(model, options).Fly({&program, 1}, {&result, 1});
  return result;
}

std::vector<AscentResult> FlyAscents(const AscentModel& model, std::span<const FlightProgram> programs,
                                     const AscentOptions& options, int width) {
  std::vector<AscentResult> results(programs.size());
  if (programs.empty()) return results;
  switch (options.record ? 1 : width) {
    case 1:
      Fleet<double>(model, options).Fly(programs, results);
      break;
    case 4:
      Fleet<lanes::Pack<4>>(model, options).Fly(programs, results);
      break;
    case 8:
      Fleet<lanes::Pack<8>>(model, options).Fly(programs, results);
      break;
    default:
      throw std::invalid_argument(fmt::format("FlyAscents: width is {}; allowed are 1, 4 and 8", width));
  }
  return results;
}

}  // namespace dispersa
