#include "core/guidance/predictor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <vector>

#include "core/guidance/air.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/prepared_burn.h"

namespace dispersa {

namespace {

// How far a place is below where the air begins, about. Only where it falls: what climbs leaves the air.
void SeeDive(const GuidanceMission& mission, double air_below_m, NavigatedState& state) {
  const Vector3& p = state.p_EoC_I;
  if (!(air_below_m > 0.0 && p.dot(state.v_IC_I) < 0.0)) return;
  const double radius_m = p.norm(), sine = p.z() / radius_m;
  const double ground_m = mission.earth.equatorial_radius_m * (1.0 - mission.earth.flattening * sine * sine);
  state.dive_m = std::max(state.dive_m, ground_m + air_below_m - radius_m);
}

// Equal steps of no more than `longest_s` from the state's time to `to_s`. `thrust` is the specific force in
// I at a time since the state's; the end of a step and the beginning of the next share it.
template <class ThrustAt>
void Advance(const GuidanceMission& mission, double air_below_m, double to_s, double longest_s,
             const ThrustAt& thrust, NavigatedState& state) {
  const Earth& earth = mission.earth;
  const double way_s = to_s - state.time_s;
  if (!(way_s > 0.0)) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(way_s / longest_s)));
  const double h = way_s / steps, half = 0.5 * h, from_s = state.time_s;
  Vector3 &p = state.p_EoC_I, &v = state.v_IC_I;
  Vector3 at_start = thrust(from_s);
  for (int i = 0; i < steps; ++i) {
    const double end_s = i + 1 == steps ? to_s : from_s + (i + 1) * h;
    const Vector3 at_middle = thrust(from_s + (i + 0.5) * h), at_end = thrust(end_s);
    const Vector3 a1 = Gravitation(earth, p) + at_start;
    const Vector3 v2 = v + half * a1;
    const Vector3 a2 = Gravitation(earth, p + half * v) + at_middle;
    const Vector3 v3 = v + half * a2;
    const Vector3 a3 = Gravitation(earth, p + half * v2) + at_middle;
    const Vector3 v4 = v + h * a3;
    const Vector3 a4 = Gravitation(earth, p + h * v3) + at_end;
    p += h / 6.0 * (v + 2.0 * (v2 + v3) + v4);
    v += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
    SeeDive(mission, air_below_m, state);
    at_start = at_end;
  }
  state.time_s = to_s;
}

void Coast(const GuidanceMission& mission, double to_s, const PredictorSteps& steps, NavigatedState& state) {
  Advance(
      mission, mission.coast_air_below_m, to_s, steps.coast_s, [](double) { return Vector3(0.0, 0.0, 0.0); },
      state);
}

// Bodies of a burn that wait for their criteria. They leave where the prediction meets these.
class WaitingBodies {
 public:
  WaitingBodies(const GuidanceMission& mission, const GuidedStage& stage) : mission_(mission) {
    std::copy_if(stage.drops.begin(), stage.drops.end(), std::back_inserter(waiting_),
                 [](const MassDrop& drop) { return drop.waits(); });
  }

  /// Advances a state. `mass_kg` is the thrust's mass, which does not know who has left. A step ends where a
  /// body leaves, so that the end of the way changes smoothly with the plan.
  template <class ThrustAt>
  void Advance(double to_s, double longest_s, const ThrustAt& thrust, double& mass_kg,
               NavigatedState& state) {
    mass_kg -= left_kg_;
    while (state.time_s < to_s && !waiting_.empty()) {
      const NavigatedState from = state;
      const auto is_due = [&](const MassDrop& drop) { return BeyondCriterion(mission_, drop, from) >= 0.0; };
      if (const auto due = std::find_if(waiting_.begin(), waiting_.end(), is_due); due != waiting_.end()) {
        LetGo(due, mass_kg);
        continue;
      }
      dispersa::Advance(mission_, mission_.air_below_m, std::min(to_s, from.time_s + longest_s), longest_s,
                        thrust, state);
      const NavigatedState end = state;
      auto first = waiting_.end();
      for (auto drop = waiting_.begin(); drop != waiting_.end(); ++drop) {
        if (!(BeyondCriterion(mission_, *drop, end) >= 0.0)) continue;
        const NavigatedState due = WhereDue(*drop, from, end, longest_s, thrust);
        if (first != waiting_.end() && due.time_s >= state.time_s) continue;
        state = due;
        first = drop;
      }
      if (first != waiting_.end()) LetGo(first, mass_kg);
    }
    dispersa::Advance(mission_, mission_.air_below_m, to_s, longest_s, thrust, state);
  }

 private:
  void LetGo(std::vector<MassDrop>::iterator drop, double& mass_kg) {
    left_kg_ += drop->mass_kg;
    mass_kg -= drop->mass_kg;
    waiting_.erase(drop);
  }
  // Within a step, at whose end the body is due. The secant's steps from the end: the criterion is almost
  // straight.
  template <class ThrustAt>
  NavigatedState WhereDue(const MassDrop& drop, const NavigatedState& from, const NavigatedState& end,
                          double longest_s, const ThrustAt& thrust) const {
    NavigatedState at = end;
    double before_s = from.time_s, before = BeyondCriterion(mission_, drop, from),
           beyond = BeyondCriterion(mission_, drop, end);
    constexpr int kSteps = 5;
    for (int step = 0; step < kSteps && beyond != before; ++step) {
      const double then_s = std::clamp(at.time_s - beyond * (at.time_s - before_s) / (beyond - before),
                                       from.time_s, end.time_s);
      before_s = at.time_s;
      before = beyond;
      at = from;
      dispersa::Advance(mission_, mission_.air_below_m, then_s, longest_s, thrust, at);
      beyond = BeyondCriterion(mission_, drop, at);
    }
    return at;
  }

  const GuidanceMission& mission_;
  std::vector<MassDrop> waiting_;
  double left_kg_ = 0.0;
};

// Through the rest of a burn. Steps end where the thrust has kinks, its direction, `bends` since
// ignition, and where a body leaves. On either side of one the burn is smooth, so the fraction is taken just
// inside the piece.
template <class DirectionAt>
void Burn(const GuidanceMission& mission, const GuidedStage& stage, double ignition_s, double longest_s,
          const Vector3& offset_rad_I, std::initializer_list<double> bends, const DirectionAt& direction_at,
          NavigatedState& state) {
  const MotorBurn& burn = stage.burn;
  const PreparedBurn prepared(burn);
  std::vector<double> ends = burn.Kinks(0.0);
  for (const double bend : bends)
    if (bend < burn.duration_s) ends.push_back(bend);
  for (const MassDrop& drop : stage.drops)
    if (drop.time_s - ignition_s < burn.duration_s) ends.push_back(drop.time_s - ignition_s);
  ends.push_back(burn.duration_s);
  std::sort(ends.begin(), ends.end());
  WaitingBodies waiting(mission, stage);
  for (const double end : ends) {
    const double begin = state.time_s - ignition_s;
    if (!(end > begin)) continue;
    double empty_kg =
        stage.ignition_mass_kg - burn.propellant_mass_kg - stage.DroppedBy(0.5 * (begin + end) + ignition_s);
    // Both ends of a piece belong to it.
    constexpr double kInside = 1e-9;
    const auto thrust = [&](double time_s) -> Vector3 {
      const double since = std::clamp(time_s - ignition_s, begin + kInside, end - kInside);
      const lanes::BurnState<double> now = prepared.At(since);
      const double acceleration = burn.vacuum_thrust_n * now.fraction / (empty_kg + now.propellant_kg);
      const Vector3 along = mission.R_IL * UnitVector(direction_at(time_s));
      return acceleration * (along + offset_rad_I.cross(along));
    };
    waiting.Advance(ignition_s + end, longest_s, thrust, empty_kg, state);
  }
}

// An engine's burn until guidance cuts it off after `duration_s`, if it does, or the propellant is used up.
// Steps end where the level and the direction (`bends`) have kinks, and where a body leaves.
template <class DirectionAt>
void BurnEngine(const GuidanceMission& mission, const GuidedStage& stage, double ignition_s,
                double duration_s, double longest_s, const Vector3& offset_rad_I,
                std::initializer_list<double> bends, const DirectionAt& direction_at, NavigatedState& state) {
  const double end_s = stage.runs_dry ? stage.Depletes() : std::min(duration_s, stage.Depletes());
  std::vector<double> ends = stage.levels->bends_s();
  ends.insert(ends.end(), bends);
  for (const MassDrop& drop : stage.drops) ends.push_back(drop.time_s - ignition_s);
  ends.push_back(end_s);
  std::sort(ends.begin(), ends.end());
  WaitingBodies waiting(mission, stage);
  for (const double end : ends) {
    if (end > end_s) break;
    const double begin = state.time_s - ignition_s;
    if (!(end > begin)) continue;
    double mass_kg = stage.ignition_mass_kg - stage.DroppedBy(0.5 * (begin + end) + ignition_s);
    const auto thrust = [&](double time_s) -> Vector3 {
      const double since = time_s - ignition_s;
      const double acceleration =
          stage.burn.vacuum_thrust_n * stage.levels->At(since) / (mass_kg - stage.Burnt(since));
      const Vector3 along = mission.R_IL * UnitVector(direction_at(time_s));
      return acceleration * (along + offset_rad_I.cross(along));
    };
    waiting.Advance(ignition_s + end, longest_s, thrust, mass_kg, state);
  }
}

// How far an angle's command is behind the plan, from its error now on: it closes in at what the greatest
// rate has left, and brakes. About what AttitudeCommand does, without its first half second.
class Lag {
 public:
  Lag() = default;
  // `rate_rad_s` of the plan.
  Lag(double error_rad, double rate_rad_s, const GuidanceLimits& limits) : error_rad_(error_rad) {
    const double left_rad_s = limits.turn_rate_rad_s + (error_rad > 0.0 ? rate_rad_s : -rate_rad_s);
    closing_rad_s_ = std::max(left_rad_s, kLeast * limits.turn_rate_rad_s);
    brake_s_ = std::max(2.0 * closing_rad_s_ / limits.turn_acceleration_rad_s2, kShortest_s);
    const double brake_rad = 0.5 * closing_rad_s_ * brake_s_, way_rad = std::fabs(error_rad);
    if (way_rad > brake_rad) until_s_ = (way_rad - brake_rad) / closing_rad_s_;
    at_brake_rad_ = std::min(way_rad, brake_rad);
    if (error_rad < 0.0) at_brake_rad_ = -at_brake_rad_;
  }
  double At(double since_s) const {
    if (since_s < until_s_) return error_rad_ + (at_brake_rad_ - error_rad_) * (since_s / until_s_);
    const double left = 1.0 - (since_s - until_s_) / brake_s_;
    return left > 0.0 ? at_brake_rad_ * left * left : 0.0;
  }
  double brakes_s() const { return until_s_; }

 private:
  static constexpr double kLeast = 0.1, kShortest_s = 2.0;
  double error_rad_ = 0.0, closing_rad_s_ = 0.0, until_s_ = 0.0, at_brake_rad_ = 0.0, brake_s_ = 1.0;
};

// Of both angles. Within a thousandth of a degree it is none.
struct Lags {
  Lag pitch, yaw;
  bool any = false;

  Direction Of(const Direction& plan, double since_s) const {
    if (!any) return plan;
    return {plan.pitch_rad + pitch.At(since_s), plan.yaw_rad + yaw.At(since_s)};
  }
};
Lags LagsOf(const GuidanceLimits& limits, const Knowledge& known, const Direction& plan,
            const Direction& rate) {
  Lags lags;
  if (!known.commanded) return lags;
  const double pitch = known.commanded->pitch_rad - plan.pitch_rad,
               yaw = known.commanded->yaw_rad - plan.yaw_rad;
  lags.any = std::max(std::fabs(pitch), std::fabs(yaw)) > 1e-3 * kRadPerDeg;
  if (lags.any) {
    lags.pitch = Lag(pitch, rate.pitch_rad, limits);
    lags.yaw = Lag(yaw, rate.yaw_rad, limits);
  }
  return lags;
}

// The rest of an earlier burn and all burns after it but the last one. The last one's stage, if it burns what
// they leave.
std::optional<GuidedStage> FlyEarlierBurns(const GuidanceMission& mission, const Knowledge& known,
                                           const Plan& plan, const PredictorSteps& steps,
                                           NavigatedState& state, Injection& injection) {
  const auto offset_by = [&](PlanUnknown pitch, PlanUnknown yaw) {
    return [&mission, by_pitch = plan.value[pitch], by_yaw = plan.value[yaw]](double time_s) {
      Direction along = mission.program.At(time_s);
      along.pitch_rad += by_pitch;
      along.yaw_rad += by_yaw;
      return along;
    };
  };
  const auto fly = [&](const GuidedStage& stage, double ignition_s, double duration_s, const Vector3& offset,
                       const auto& direction) {
    if (stage.is_engine())
      BurnEngine(mission, stage, ignition_s, duration_s, steps.engine_s, offset, {}, direction, state);
    else
      Burn(mission, stage, ignition_s, steps.burn_s, offset, {}, direction, state);
  };
  const auto planned = offset_by(kEarlierPitch, kEarlierYaw);
  const double from_s = state.time_s;
  const Lags lags = LagsOf(mission.limits, known, planned(from_s), mission.program.RateAt(from_s));
  fly(known.below, known.burn_ignition_s, plan.value[kEarlierCutOff], known.thrust_offset_rad_I,
      [&](double time_s) { return lags.Of(planned(time_s), time_s - from_s); });
  injection.burn_end_speed_m_s = state.v_IC_I.norm();
  injection.burn_end_s = state.time_s;
  GuidedStage before = known.below;
  double ignition_s = known.burn_ignition_s;
  // What the reaction control has expelled counts in the mass of the burn that is estimated.
  const auto begin = [&](const GuidedStage& nominal, const BurnStart& start) {
    GuidedStage stage = nominal;
    if (start.is_restart && before.is_cut_off())
      stage = AfterBurn(before, nominal, state.time_s - ignition_s);
    else
      stage.ignition_mass_kg -= known.expelled_kg;
    ignition_s =
        start.on_timer ? std::max(start.ignition_s, state.time_s) : state.time_s + start.after_burnout_s;
    Coast(mission, ignition_s, steps, state);
    before = stage;
    return stage;
  };
  const Vector3 no_offset(0.0, 0.0, 0.0);
  for (std::size_t i = known.earlier + 1; i < mission.earlier.size(); ++i) {
    const GuidedStage stage = begin(mission.earlier[i].stage, mission.earlier[i].start);
    fly(stage, ignition_s, mission.earlier[i].stage.burn.duration_s, no_offset,
        [&](double time_s) { return mission.program.At(time_s); });
  }
  const GuidedStage below = begin(mission.below, mission.below_start);
  fly(below, ignition_s, plan.value[kBelowCutOff], no_offset, offset_by(kBelowPitch, kBelowYaw));
  if (!mission.is_restart || !below.is_cut_off()) return {};
  return AfterBurn(below, known.last, state.time_s - ignition_s);
}

// Whether plans have the same burns before the last one, to the bit.
bool ShareBurns(const Plan& a, const Plan& b) {
  for (const PlanUnknown unknown :
       {kBelowPitch, kBelowYaw, kBelowCutOff, kEarlierPitch, kEarlierYaw, kEarlierCutOff})
    if (std::bit_cast<std::uint64_t>(a.value[unknown]) != std::bit_cast<std::uint64_t>(b.value[unknown]))
      return false;
  return true;
}

// From the present state through all burns but the last one.
void FlyBurnsBeforeLast(const GuidanceMission& mission, const Knowledge& known, const NavigatedState& from,
                        const Plan& plan, const PredictorSteps& steps, WayToLastBurn& way) {
  NavigatedState state = from;
  Injection injection;
  if (known.phase == GuidancePhase::kEarlierBurns)
    way.restarted = FlyEarlierBurns(mission, known, plan, steps, state, injection);
  if (known.phase == GuidancePhase::kBelowBurns) {
    const auto planned = [&](double time_s) {
      Direction along = mission.program.At(time_s);
      along.pitch_rad += plan.value[kBelowPitch];
      along.yaw_rad += plan.value[kBelowYaw];
      return along;
    };
    const Lags lags =
        LagsOf(mission.limits, known, planned(from.time_s), mission.program.RateAt(from.time_s));
    const auto direction = [&](double time_s) { return lags.Of(planned(time_s), time_s - from.time_s); };
    if (known.below.is_engine()) {
      BurnEngine(mission, known.below, known.burn_ignition_s, plan.value[kBelowCutOff], steps.engine_s,
                 known.thrust_offset_rad_I, {}, direction, state);
      if (mission.is_restart)
        way.restarted = AfterBurn(known.below, known.last, state.time_s - known.burn_ignition_s);
    } else {
      Burn(mission, known.below, known.burn_ignition_s, steps.burn_s, known.thrust_offset_rad_I, {},
           direction, state);
    }
    injection.burn_end_speed_m_s = state.v_IC_I.norm();
    injection.burn_end_s = state.time_s;
  }
  way.after_burns = state;
  way.burn_end_speed_m_s = injection.burn_end_speed_m_s;
  way.burn_end_s = injection.burn_end_s;
}

}  // namespace

Arrival ArrivalOf(const Earth& earth, double time_s, const Vector3& p, const Vector3& v) {
  Arrival arrival;
  arrival.altitude_m = ToGeodetic(earth, InertialToEarth(earth, time_s, p)).altitude_m;
  const Vector3 h = p.cross(v);
  arrival.velocity_m_s = v.norm();
  arrival.flight_path_angle_rad = Atan2(p.dot(v), h.norm());
  arrival.inclination_rad = Atan2(Sqrt(h.x() * h.x() + h.y() * h.y()), h.z());
  return arrival;
}

Injection Predict(const GuidanceMission& mission, const PlanPrior& prior, const Knowledge& known,
                  const NavigatedState& from, const Plan& plan, const PredictorSteps& steps) {
  return Predict(mission, prior, known, from, plan, steps, nullptr, nullptr);
}

Injection Predict(const GuidanceMission& mission, const PlanPrior& prior, const Knowledge& known,
                  const NavigatedState& from, const Plan& plan, const PredictorSteps& steps,
                  const WayToLastBurn* known_way, WayToLastBurn* way_out) {
  const bool shares_burns = known_way != nullptr && ShareBurns(known_way->plan, plan);
  const bool shares_coast = shares_burns && known_way->plan.ignition_s() == plan.ignition_s();
  WayToLastBurn way;
  if (shares_burns)
    way = *known_way;
  else
    FlyBurnsBeforeLast(mission, known, from, plan, steps, way);
  NavigatedState state = way.after_burns;
  const std::optional<GuidedStage>& restarted = way.restarted;
  Injection injection;
  injection.burn_end_speed_m_s = way.burn_end_speed_m_s;
  injection.burn_end_s = way.burn_end_s;
  const bool lit = known.phase == GuidancePhase::kLastBurns;
  double ignition_s = lit ? known.burn_ignition_s : plan.ignition_s();
  if (known.phase == GuidancePhase::kEarlierBurns) ignition_s = std::max(ignition_s, state.time_s);
  if (!lit && !mission.moves_ignition)
    ignition_s = state.time_s + (mission.last_ignition_s - mission.below_burnout_s);
  if (shares_coast)
    state = way.at_ignition;
  else if (!lit)
    Coast(mission, ignition_s, steps, state);
  if (way_out != nullptr) {
    way.plan = plan;
    way.at_ignition = state;
    *way_out = way;
  }
  const LastBurnAttitude burn(plan, prior);
  Lags lags;
  double brakes_s = 0.0;
  if (lit) {
    const double since_s = from.time_s - ignition_s;
    lags = LagsOf(mission.limits, known, burn.At(since_s), burn.RateAt(since_s));
    brakes_s = since_s + lags.yaw.brakes_s();
  }
  const auto direction = [&](double time_s) {
    return lags.Of(burn.At(time_s - ignition_s), time_s - from.time_s);
  };
  const TurnCourse& turn = prior.turn;
  const Vector3 offset = lit ? known.thrust_offset_rad_I : Vector3(0.0, 0.0, 0.0);
  if (known.last.is_cut_off())
    BurnEngine(mission, restarted ? *restarted : known.last, ignition_s, plan.value[kCutOff], steps.engine_s,
               offset, {}, direction, state);
  else if (known.last.is_engine())
    BurnEngine(mission, known.last, ignition_s, HUGE_VAL, steps.engine_s, offset,
               {turn.from_s - turn.round_s, turn.from_s + turn.round_s, turn.back_s - turn.round_s,
                turn.back_s + turn.round_s, brakes_s},
               direction, state);
  else
    Burn(mission, known.last, ignition_s, steps.burn_s, offset,
         {turn.from_s - turn.round_s, turn.from_s + turn.round_s, turn.back_s - turn.round_s,
          turn.back_s + turn.round_s, brakes_s},
         direction, state);
  injection.at = ArrivalOf(mission.earth, state.time_s, state.p_EoC_I, state.v_IC_I);
  injection.time_s = state.time_s;
  injection.radius_m = state.p_EoC_I.norm();
  injection.dive_m = state.dive_m;
  injection.p_EoC_I = state.p_EoC_I;
  injection.v_IC_I = state.v_IC_I;
  if (known.phase == GuidancePhase::kCoast || lit) {
    injection.burn_end_speed_m_s = injection.at.velocity_m_s;
    injection.burn_end_s = state.time_s;
  }
  return injection;
}

}  // namespace dispersa
