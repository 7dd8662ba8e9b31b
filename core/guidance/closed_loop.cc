#include "core/guidance/closed_loop.h"

#include <algorithm>
#include <cmath>

#include "core/guidance/air.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

// In the coast nothing changes but by navigation: a plan now and then is enough, and more often towards its
// end.
constexpr double kCoastPeriod_s = 20.0;
constexpr double kNearIgnition_s = 25.0;
// From here on ignition stays where it is unless the attitude has not settled.
constexpr double kLastPlan_s = 2.0;
constexpr double kPostpone_s = 2.0;
constexpr double kLongestPostponement_s = 60.0;
// Of the coast's rate, what a command comes about on its way to another attitude.
constexpr double kOfCoastRate = 0.5;
// What is left of the last burn when altitude and plane are let go, and when the plan is.
constexpr double kOnlyVelocity_s = 10.0;
constexpr double kHold_s = 1.5;
// The same where guidance cuts the burn off: speeds of a weak engine change slowly.
constexpr double kOnlyCutOff_s = 15.0;
// An engine's long burn is planned every `period_s` at first and at last. In between a plan holds for a part
// of the time since ignition, and of the time left.
constexpr double kOfSince = 0.2, kOfLeft = 0.05, kLongestPeriod_s = 10.0;
// From this time before the planned cut-off on, its speed ends the burn. A burn as planned may differ by
// more.
constexpr double kArmed_s = 3.0, kArmedOfBurn = 0.25;
// Where the speed grows by less than this part of the specific force, time ends the burn.
constexpr double kAlong = 0.2;
// A timer does not end a burn that lacks more than this of the target's energy: the propellant does. A flight
// has not arrived if its energy is farther off at the injection, either way.
constexpr double kLacking_m_s = 1.0;
// Between a burn's end and the ignition of the next, at least: separation and settling.
constexpr double kApart_s = 10.0;
// Thrust is measured over the time between two calls, and smoothed.
constexpr double kOffsetGain = 0.3;
constexpr double kLargestOffset_rad = 3.0 * kRadPerDeg;

// What an engine that can be stopped has in place of a turn in yaw.
void FreeCutOff(bool turns_in_burn, CorrectorTask& task) {
  task.free[kWaste] = false;
  task.free[kCutOff] = true;
  task.free[kYawHalf] = turns_in_burn;
}

// Of a burn with a planned end, if guidance cuts it off.
double DurationOf(const GuidedStage& stage, double planned_s) {
  if (!stage.is_engine()) return stage.burn.duration_s;
  return stage.is_cut_off() ? std::min(planned_s, stage.Depletes()) : stage.Depletes();
}

// Between two directions that are near to each other.
double Apart_rad(const Direction& a, const Direction& b) {
  return Sqrt(Square(a.pitch_rad - b.pitch_rad) + Square(a.yaw_rad - b.yaw_rad));
}

constexpr int kFirstIterations = 8;
constexpr int kIterations = 2;

}  // namespace

ClosedLoopGuidance::ClosedLoopGuidance(const GuidanceMission& mission)
    : mission_(mission),
      prior_(BuildPrior(mission)),
      plan_(prior_.nominal),
      at_ignition_(prior_.nominal),
      below_(mission.below),
      last_(mission.last) {
  if (!mission.earlier.empty()) phase_ = GuidancePhase::kEarlierBurns;
  if (mission.below.is_engine()) below_engine_.emplace(mission.below);
  if (mission.last.is_engine()) last_engine_.emplace(mission.last);
}

CorrectorTask ClosedLoopGuidance::Task(std::initializer_list<PlanUnknown> free, const Plan& prior,
                                       int iterations) const {
  CorrectorTask task;
  for (const PlanUnknown unknown : free) task.free[unknown] = true;
  if (mission_.holds_last) task.free[kPitchHalf] = task.free[kWaste] = false;
  task.prior = prior;
  task.low = prior_.low;
  task.high = prior_.high;
  task.iterations = iterations;
  return task;
}

void ClosedLoopGuidance::Wait() {
  if (phase_ != GuidancePhase::kEarlierBurns || !earlier_ || waits_) return;
  waits_ = true;
  cut_off_.reset();
}

std::optional<GuidedStage> ClosedLoopGuidance::LeftFor(const GuidedStage& stage,
                                                       const BurnStart& start) const {
  if (!start.is_restart || !earlier_engine_) return {};
  const GuidedStage before = earlier_engine_->Stage(0.0);
  return AfterBurn(before, stage, std::min(plan_.value[kEarlierCutOff], before.Depletes()));
}

bool ClosedLoopGuidance::See(const GuidanceSight& sight) {
  waits_ = false;
  if (sight.jettisoned != jettisoned_) {
    jettisoned_ = sight.jettisoned;
    for (std::optional<EngineEstimate>* engine : {&earlier_engine_, &below_engine_, &last_engine_})
      if (*engine) (*engine)->SeeLeft(jettisoned_, sight.state.time_s);
    if (earlier_motor_) earlier_motor_->SeeLeft(jettisoned_, sight.state.time_s);
    below_.SeeLeft(jettisoned_, sight.state.time_s);
    last_.SeeLeft(jettisoned_, sight.state.time_s);
  }
  if (sight.phase != phase_) {
    if (phase_ == GuidancePhase::kEarlierBurns) {
      cut_off_.reset();
      if (below_engine_)
        if (const std::optional<GuidedStage> left = LeftFor(mission_.below, mission_.below_start))
          below_engine_->Begin(left->ignition_mass_kg, left->usable_kg);
    }
    if (phase_ == GuidancePhase::kBelowBurns && below_engine_ && mission_.is_restart) {
      const GuidedStage below = below_engine_->Stage(0.0);
      const double end_s = std::min(plan_.value[kBelowCutOff], below.Depletes());
      const GuidedStage left = AfterBurn(below, mission_.last, end_s);
      last_engine_->Begin(left.ignition_mass_kg, left.usable_kg);
    }
    if (sight.phase == GuidancePhase::kCoast) cut_off_.reset();
    phase_ = sight.phase;
    has_previous_ = false;
    if (sight.phase == GuidancePhase::kLastBurns) at_ignition_ = plan_;
    thrust_offset_rad_I_ = Vector3::Zero();
  }
  next_call_s_ = sight.state.time_s + mission_.config.period_s;
  switch (sight.phase) {
    case GuidancePhase::kEarlierBurns:
      SeeEarlierBurn(sight);
      return false;
    case GuidancePhase::kBelowBurns:
      SeeBelowBurn(sight);
      return false;
    case GuidancePhase::kCoast:
      return SeeCoast(sight);
    case GuidancePhase::kLastBurns:
      SeeLastBurn(sight);
      return false;
  }
  return false;
}

// Where thrust has pointed since the last call, by what it did to the velocity, against where it was to
// point: navigation's error of attitude, the autopilot's, and the motor's misalignment in one.
void ClosedLoopGuidance::MeasureThrust(const GuidanceSight& sight) {
  const NavigatedState& now = sight.state;
  const Vector3 direction_L = UnitVector(command_.direction());
  if (has_previous_) {
    const double since_s = now.time_s - previous_.time_s;
    const Vector3 gravity =
        0.5 * (Gravitation(mission_.earth, previous_.p_EoC_I) + Gravitation(mission_.earth, now.p_EoC_I));
    const Vector3 gained = now.v_IC_I - previous_.v_IC_I - since_s * gravity;
    const Vector3 pointed = (mission_.R_IL * (previous_direction_L_ + direction_L)).normalized();
    const Vector3 offset = pointed.cross(gained.normalized());
    const Vector3 smoothed = thrust_offset_rad_I_ + kOffsetGain * (offset - thrust_offset_rad_I_);
    if (smoothed.norm() < kLargestOffset_rad) thrust_offset_rad_I_ = smoothed;
  }
  previous_ = now;
  previous_direction_L_ = direction_L;
  has_previous_ = true;
}

void ClosedLoopGuidance::TakeOver(double time_s) {
  if (steers_) return;
  steers_ = true;
  command_.Start(time_s, mission_.program.At(time_s), mission_.program.RateAt(time_s));
}

void ClosedLoopGuidance::BoundIncidence(const NavigatedState& state, PlanUnknown pitch, PlanUnknown yaw,
                                        CorrectorTask& task) {
  const double most_rad = kMostIncidence_pa_rad / DynamicPressure(mission_, state);
  for (const PlanUnknown unknown : {pitch, yaw}) {
    task.low[unknown] = std::max(task.low[unknown], -most_rad);
    task.high[unknown] = std::min(task.high[unknown], most_rad);
    plan_.value[unknown] = Clamp(plan_.value[unknown], task.low[unknown], task.high[unknown]);
  }
}

void ClosedLoopGuidance::BoundCutOffs(const Knowledge& known, double time_s, CorrectorTask& task) {
  task.keeps_solved = below_engine_ || last_engine_;
  GuidedStage last = known.last;
  const auto bound = [&](PlanUnknown unknown, const GuidedStage& stage, double since_s) {
    task.high[unknown] = std::max(stage.Depletes(), since_s);
    task.low[unknown] = std::min(std::max(task.low[unknown], since_s), task.high[unknown]);
    plan_.value[unknown] = Clamp(plan_.value[unknown], task.low[unknown], task.high[unknown]);
  };
  const bool below_burns = known.phase == GuidancePhase::kBelowBurns;
  if (below_burns && known.below.is_cut_off()) {
    bound(kBelowCutOff, known.below, time_s - known.burn_ignition_s);
    const double end_s = plan_.value[kBelowCutOff];
    if (mission_.is_restart) last = AfterBurn(known.below, last, end_s);
    const double earliest_s = known.burn_ignition_s + end_s + kApart_s;
    task.low[kIgnition] = std::max(task.low[kIgnition], earliest_s);
    task.high[kIgnition] = std::max(task.high[kIgnition], earliest_s);
    plan_.value[kIgnition] = Clamp(plan_.value[kIgnition], task.low[kIgnition], task.high[kIgnition]);
  }
  if (last.is_cut_off())
    bound(kCutOff, last, known.phase == GuidancePhase::kLastBurns ? time_s - known.burn_ignition_s : 0.0);
}

// The last burn ends with the target's energy. If that is out of reach by the estimate, it ends with the
// propellant, of which there may be more. A prediction that is no number leaves the cut-off as it is.
void ClosedLoopGuidance::SetCutOff(const Correction& found) {
  const Injection& reached = found.reached;
  double speed_m_s = reached.burn_end_speed_m_s;
  PlanUnknown duration = kEarlierCutOff;
  const GuidedStage* stage = &mission_.below;
  bool lacks = false;
  switch (phase_) {
    case GuidancePhase::kEarlierBurns:
      stage = &mission_.earlier[*earlier_].stage;
      break;
    case GuidancePhase::kBelowBurns:
      duration = kBelowCutOff;
      break;
    case GuidancePhase::kCoast:
    case GuidancePhase::kLastBurns: {
      const double excess_m2_s2 = OrbitMissOf(mission_, reached).energy_m_s * mission_.target.velocity_m_s;
      speed_m_s = Sqrt(Square(speed_m_s) - 2.0 * excess_m2_s2);
      duration = kCutOff;
      stage = &mission_.last;
      lacks = excess_m2_s2 < -kLacking_m_s * mission_.target.velocity_m_s;
      break;
    }
  }
  if (!(speed_m_s > 0.0) || !std::isfinite(speed_m_s) || !std::isfinite(reached.burn_end_s)) return;
  cut_off_ = {speed_m_s, reached.burn_end_s};
  if (stage->ends_by_time) cut_off_->duration_s = lacks ? HUGE_VAL : plan_.value[duration];
}

double ClosedLoopGuidance::CutOffIn(double time_s, double ignition_s, double speed_m_s, double growth_m_s2,
                                    double specific_force_m_s2) const {
  // The next burn may begin before guidance sees it.
  if (cut_off_->ignition_s && *cut_off_->ignition_s != ignition_s) return HUGE_VAL;
  if (cut_off_->duration_s) return ignition_s + *cut_off_->duration_s - time_s;
  const double left_s = cut_off_->time_s - time_s;
  const double burn_s =
      phase_ == GuidancePhase::kBelowBurns ? plan_.value[kBelowCutOff] : plan_.value[kCutOff];
  const bool is_steered = mission_.config.steers_last_burn || phase_ == GuidancePhase::kBelowBurns ||
                          phase_ == GuidancePhase::kEarlierBurns;
  if (left_s > (is_steered ? kArmed_s : kArmedOfBurn * burn_s)) return left_s;
  if (!(std::fabs(growth_m_s2) > kAlong * specific_force_m_s2)) return left_s;
  return (cut_off_->speed_m_s - speed_m_s) / growth_m_s2;
}

void ClosedLoopGuidance::BeginEarlierBurn(std::size_t index) {
  const EarlierBurn& burn = mission_.earlier[index];
  const std::optional<GuidedStage> left = LeftFor(burn.stage, burn.start);
  earlier_ = index;
  earlier_motor_.emplace(burn.stage);
  earlier_engine_.reset();
  earlier_motor_->SeeLeft(jettisoned_, mission_.program.start_s);
  if (burn.stage.is_engine()) {
    earlier_engine_.emplace(burn.stage);
    if (left) earlier_engine_->Begin(left->ignition_mass_kg, left->usable_kg);
    earlier_engine_->SeeLeft(jettisoned_, mission_.program.start_s);
  }
  SetEarlier(burn.stage, prior_);
  for (const PlanUnknown unknown : {kEarlierPitch, kEarlierYaw, kEarlierCutOff})
    plan_.value[unknown] = prior_.nominal.value[unknown];
  cut_off_.reset();
  has_previous_ = false;
  thrust_offset_rad_I_ = Vector3::Zero();
}

// As in the burn below, with everything after it free too.
void ClosedLoopGuidance::SeeEarlierBurn(const GuidanceSight& sight) {
  if (earlier_ != sight.earlier) BeginEarlierBurn(sight.earlier);
  const double time_s = sight.state.time_s, since_s = time_s - sight.burn_ignition_s;
  const bool reads = !FeelsAir(mission_, mission_.earlier[sight.earlier].stage, sight.state);
  if (!earlier_engine_ && reads) earlier_motor_->Add(since_s, sight.specific_force_m_s2, sight.expelled_kg);
  if (since_s < kTakeOver_s) return;
  TakeOver(time_s);
  if (earlier_engine_ && reads)
    earlier_engine_->Add(time_s, since_s, sight.specific_force_m_s2, sight.expelled_kg);
  MeasureThrust(sight);
  Knowledge known;
  known.phase = sight.phase;
  known.earlier = sight.earlier;
  known.expelled_kg = sight.expelled_kg;
  known.burn_ignition_s = sight.burn_ignition_s;
  known.below =
      earlier_engine_ ? earlier_engine_->Stage(sight.expelled_kg) : earlier_motor_->Stage(sight.expelled_kg);
  known.last = last_engine_ ? last_engine_->Stage(sight.expelled_kg) : last_.Stage(sight.expelled_kg);
  known.thrust_offset_rad_I = thrust_offset_rad_I_;
  known.commanded = command_.direction();
  if (sight.burn_ignition_s + DurationOf(known.below, plan_.value[kEarlierCutOff]) - time_s < kHold_s) return;
  CorrectorTask task = Task({kEarlierPitch, kEarlierYaw, kBelowPitch, kBelowYaw, kIgnition, kPitchMiddle,
                             kPitchHalf, kYawMiddle, kWaste},
                            prior_.nominal, outcome_.acted ? kIterations : kFirstIterations);
  if (mission_.last.is_cut_off()) FreeCutOff(!mission_.holds_last, task);
  BoundIncidence(sight.state, kEarlierPitch, kEarlierYaw, task);
  task.free[kBelowCutOff] = mission_.below.is_cut_off();
  task.free[kIgnition] = mission_.moves_ignition;
  task.keeps_solved = true;
  if (known.below.is_cut_off()) {
    task.free[kEarlierCutOff] = true;
    task.high[kEarlierCutOff] = std::max(known.below.Depletes(), since_s);
    task.low[kEarlierCutOff] =
        std::min(std::max(task.low[kEarlierCutOff], since_s), task.high[kEarlierCutOff]);
    plan_.value[kEarlierCutOff] =
        Clamp(plan_.value[kEarlierCutOff], task.low[kEarlierCutOff], task.high[kEarlierCutOff]);
  }
  const Correction found = Correct(mission_, prior_, known, sight.state, plan_, task);
  plan_ = found.plan;
  outcome_.acted = true;
  if (known.below.is_cut_off()) {
    SetCutOff(found);
    if (cut_off_) cut_off_->ignition_s = sight.burn_ignition_s;
  }
  SetPeriod(since_s, found.reached.burn_end_s - time_s);
}

void ClosedLoopGuidance::SeeBelowBurn(const GuidanceSight& sight) {
  const double since_s = sight.state.time_s - sight.burn_ignition_s;
  const bool reads = !FeelsAir(mission_, mission_.below, sight.state);
  if (!below_engine_ && reads) below_.Add(since_s, sight.specific_force_m_s2, sight.expelled_kg);
  if (since_s < kTakeOver_s) return;
  const double time_s = sight.state.time_s;
  if (!steers_) {
    TakeOver(time_s);
    plan_ = prior_.nominal;
  }
  if (below_engine_ && reads)
    below_engine_->Add(time_s, since_s, sight.specific_force_m_s2, sight.expelled_kg);
  MeasureThrust(sight);
  Knowledge known;
  known.phase = sight.phase;
  known.burn_ignition_s = sight.burn_ignition_s;
  known.below = below_engine_ ? below_engine_->Stage(sight.expelled_kg) : below_.Stage(0.0);
  known.last = last_engine_ ? last_engine_->Stage(sight.expelled_kg) : last_.Stage(0.0);
  known.thrust_offset_rad_I = thrust_offset_rad_I_;
  known.commanded = command_.direction();
  if (sight.burn_ignition_s + DurationOf(known.below, plan_.value[kBelowCutOff]) - time_s < kHold_s) return;
  CorrectorTask task = Task({kBelowPitch, kBelowYaw, kIgnition, kPitchMiddle, kPitchHalf, kYawMiddle, kWaste},
                            prior_.nominal, outcome_.acted ? kIterations : kFirstIterations);
  BoundIncidence(sight.state, kBelowPitch, kBelowYaw, task);
  task.free[kBelowCutOff] = known.below.is_cut_off();
  if (mission_.last.is_cut_off()) FreeCutOff(!mission_.holds_last, task);
  task.free[kIgnition] = mission_.moves_ignition;
  BoundCutOffs(known, time_s, task);
  const Correction found = Correct(mission_, prior_, known, sight.state, plan_, task);
  plan_ = found.plan;
  outcome_.acted = true;
  outcome_.arrives = found.arrives;  // the last plan, if nothing plans the burn that follows
  if (known.below.is_cut_off()) SetCutOff(found);
  SetPeriod(since_s, found.reached.burn_end_s - time_s);
}

void ClosedLoopGuidance::SetPeriod(double since_s, double left_s) {
  const double period_s = mission_.config.period_s;
  const double longer_s = std::min({kOfSince * since_s, kOfLeft * left_s, kLongestPeriod_s});
  if (longer_s > period_s) next_call_s_ += longer_s - period_s;
}

bool ClosedLoopGuidance::SeeCoast(const GuidanceSight& sight) {
  if (!mission_.moves_ignition) return false;
  const double time_s = sight.state.time_s;
  TakeOver(time_s);
  double earliest_s = time_s + kLastPlan_s;
  double& ignition_s = plan_.value[kIgnition];
  const double left_s = ignition_s - time_s;
  if (left_s <= kLastPlan_s) {
    const bool settled = sight.attitude_error_rad <= mission_.limits.settled_angle_rad &&
                         sight.rate_error_rad_s <= mission_.limits.settled_rate_rad_s;
    const Direction wanted = LastBurnAttitude(plan_, prior_).At(0.0);
    const bool there = Apart_rad(wanted, command_.direction()) <= mission_.limits.settled_angle_rad;
    if ((settled && there) || outcome_.postponed_s >= kLongestPostponement_s) {
      next_call_s_ = ignition_s + kTakeOver_s;
      return false;
    }
    outcome_.postponed_s += kPostpone_s;
    earliest_s = ignition_s + kPostpone_s;
  }
  Knowledge known;
  known.phase = sight.phase;
  known.last = last_engine_ ? last_engine_->Stage(sight.expelled_kg) : last_.Stage(sight.expelled_kg);
  // Near ignition plans stay near the last one before: the attitude that the burn begins with takes its time.
  // Not each near the one before it, which could walk away.
  const bool is_near = outcome_.acted && left_s <= kCoastPeriod_s + kNearIgnition_s;
  if (is_near && !before_near_) before_near_ = plan_;
  CorrectorTask task =
      Task({kIgnition, kPitchMiddle, kPitchHalf, kYawMiddle, kWaste},
           is_near ? *before_near_ : prior_.nominal, outcome_.acted ? kIterations + 1 : kFirstIterations);
  if (task.low[kIgnition] < earliest_s) task.low[kIgnition] = earliest_s;
  if (task.high[kIgnition] < earliest_s) task.high[kIgnition] = earliest_s;
  ignition_s = Clamp(ignition_s, task.low[kIgnition], task.high[kIgnition]);
  if (mission_.last.is_cut_off()) {
    FreeCutOff(!mission_.holds_last, task);
    BoundCutOffs(known, time_s, task);
  }
  const Correction found = Correct(mission_, prior_, known, sight.state, plan_, task);
  outcome_.acted = true;
  // A plan that begins with an attitude which the command does not come to would have to wait, and the next
  // one again. The last burn can still turn.
  const auto way_rad = [&](const Plan& plan) {
    return Apart_rad(LastBurnAttitude(plan, prior_).At(0.0), command_.direction());
  };
  const double nearest_rad = mission_.limits.settled_angle_rad +
                             kOfCoastRate * mission_.limits.coast_rate_rad_s * std::max(left_s, 0.0);
  const bool is_held = is_near && mission_.config.steers_last_burn &&
                       way_rad(found.plan) > std::max(nearest_rad, way_rad(plan_));
  if (!is_held) plan_ = found.plan;
  outcome_.arrives = found.arrives;
  outcome_.ignition_shift_s = ignition_s - mission_.last_ignition_s;
  outcome_.excess_m_s = plan_.value[kWaste] * IdealVelocity(known.last);
  if (mission_.last.is_cut_off()) SetCutOff(found);
  const double until_s = ignition_s - time_s;
  next_call_s_ = time_s + (until_s > kCoastPeriod_s + kNearIgnition_s
                               ? kCoastPeriod_s
                               : std::max(mission_.config.period_s, kOfLeft * until_s));
  if (last_engine_ && until_s > kCoastPeriod_s + kNearIgnition_s)
    next_call_s_ = time_s + std::max(kCoastPeriod_s, kOfLeft * until_s);
  return true;
}

void ClosedLoopGuidance::SeeLastBurn(const GuidanceSight& sight) {
  if (!mission_.config.steers_last_burn) return;
  const double time_s = sight.state.time_s, since_s = time_s - sight.burn_ignition_s;
  if (!mission_.moves_ignition) plan_.value[kIgnition] = sight.burn_ignition_s;
  const bool reads = !FeelsAir(mission_, mission_.last, sight.state);
  if (last_engine_) {
    if (since_s < kTakeOver_s) return;
    TakeOver(time_s);
    if (reads) last_engine_->Add(time_s, since_s, sight.specific_force_m_s2, sight.expelled_kg);
  } else if (reads) {
    last_.Add(since_s, sight.specific_force_m_s2, sight.expelled_kg);
  }
  MeasureThrust(sight);
  Knowledge known;
  known.phase = sight.phase;
  known.burn_ignition_s = sight.burn_ignition_s;
  known.last = last_engine_ ? last_engine_->Stage(sight.expelled_kg) : last_.Stage(sight.expelled_kg);
  known.thrust_offset_rad_I = thrust_offset_rad_I_;
  known.commanded = command_.direction();
  if (mission_.last.is_cut_off()) return SteerToCutOff(known, sight.state);
  const double left_s = sight.burn_ignition_s + DurationOf(known.last, 0.0) - time_s;
  if (left_s < kHold_s) return;
  const bool all = left_s > kOnlyVelocity_s;
  CorrectorTask task = all ? Task({kPitchMiddle, kPitchHalf, kYawMiddle, kWaste}, at_ignition_, kIterations)
                           : Task({kPitchMiddle, kYawMiddle}, plan_, kIterations);
  task.meets_altitude = task.meets_plane = all;
  const Correction found = Correct(mission_, prior_, known, sight.state, plan_, task);
  plan_ = found.plan;
  if (all) met_all_ = found.arrives;
  outcome_.arrives = met_all_ && found.arrives;
  if (last_engine_ && left_s > 2.0 * kOnlyCutOff_s) SetPeriod(since_s, left_s);
}

void ClosedLoopGuidance::SteerToCutOff(const Knowledge& known, const NavigatedState& state) {
  const double since_s = state.time_s - known.burn_ignition_s;
  const double left_s = std::min(plan_.value[kCutOff], known.last.Depletes()) - since_s;
  if (left_s < kHold_s) return;
  const bool all = left_s > kOnlyCutOff_s;
  CorrectorTask task = all ? Task({kPitchMiddle, kPitchHalf, kYawMiddle, kYawHalf, kCutOff}, at_ignition_,
                                  outcome_.acted ? kIterations : kFirstIterations)
                           : Task({kPitchMiddle, kCutOff}, plan_, kIterations);
  BoundCutOffs(known, state.time_s, task);
  task.meets_altitude = task.meets_plane = all;
  const Correction found = Correct(mission_, prior_, known, state, plan_, task);
  plan_ = found.plan;
  outcome_.acted = true;
  if (all) met_all_ = found.arrives;
  outcome_.arrives = met_all_ && found.arrives;
  SetCutOff(found);
  SetPeriod(since_s, found.reached.burn_end_s - state.time_s);
}

void ClosedLoopGuidance::BurnOut(double altitude_m, const Vector3& p_EoC_I, const Vector3& v_IC_I) {
  Injection reached;
  reached.at = ArrivalOf(mission_.earth, 0.0, p_EoC_I, v_IC_I);
  reached.at.altitude_m = altitude_m;
  reached.radius_m = p_EoC_I.norm();
  reached.p_EoC_I = p_EoC_I;
  reached.v_IC_I = v_IC_I;
  const OrbitMiss miss = OrbitMissOf(mission_, reached);
  // A number that is none has not arrived.
  if (!(std::fabs(miss.energy_m_s) <= kLacking_m_s &&
        std::fabs(miss.plane_m_s) <= kArrivesPlane_rad * mission_.target.velocity_m_s))
    outcome_.arrives = false;
}

void ClosedLoopGuidance::Command(double time_s) {
  const GuidanceLimits& limits = mission_.limits;
  Direction wanted, rate;
  switch (phase_) {
    case GuidancePhase::kEarlierBurns: {
      // In a coast it turns to what the next burn begins with.
      const bool is_last = waits_ && earlier_ && *earlier_ + 1 == mission_.earlier.size();
      wanted = mission_.program.At(time_s);
      rate = mission_.program.RateAt(time_s);
      if (!waits_ || is_last) {
        wanted.pitch_rad += plan_.value[waits_ ? kBelowPitch : kEarlierPitch];
        wanted.yaw_rad += plan_.value[waits_ ? kBelowYaw : kEarlierYaw];
      }
      if (waits_)
        return command_.Follow(time_s, wanted, rate, limits.coast_rate_rad_s,
                               limits.coast_acceleration_rad_s2);
      return command_.Follow(time_s, wanted, rate, limits.turn_rate_rad_s, limits.turn_acceleration_rad_s2);
    }
    case GuidancePhase::kBelowBurns:
      wanted = mission_.program.At(time_s);
      rate = mission_.program.RateAt(time_s);
      wanted.pitch_rad += plan_.value[kBelowPitch];
      wanted.yaw_rad += plan_.value[kBelowYaw];
      return command_.Follow(time_s, wanted, rate, limits.turn_rate_rad_s, limits.turn_acceleration_rad_s2);
    case GuidancePhase::kCoast:
    case GuidancePhase::kLastBurns:
      break;
  }
  const LastBurnAttitude burn(plan_, prior_);
  const bool waits = !mission_.moves_ignition && phase_ == GuidancePhase::kCoast;
  const double ignition_s = waits ? time_s : plan_.ignition_s();
  wanted = burn.At(time_s - ignition_s);
  if (waits || time_s < ignition_s)
    return command_.Follow(time_s, wanted, {}, limits.coast_rate_rad_s, limits.coast_acceleration_rad_s2);
  rate = burn.RateAt(time_s - ignition_s);
  command_.Follow(time_s, wanted, rate, limits.turn_rate_rad_s, limits.turn_acceleration_rad_s2);
}

}  // namespace dispersa
