#include "core/guidance/closed_loop.h"

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
// What is left of the last burn when altitude and plane are let go, and when the plan is.
constexpr double kOnlyVelocity_s = 10.0;
constexpr double kHold_s = 1.5;
// Thrust is measured over the time between two calls, and smoothed.
constexpr double kOffsetGain = 0.3;
constexpr double kLargestOffset_rad = 3.0 * kRadPerDeg;

constexpr int kFirstIterations = 8;
constexpr int kIterations = 2;

}  // namespace

ClosedLoopGuidance::ClosedLoopGuidance(const GuidanceMission& mission)
    : mission_(mission),
      prior_(BuildPrior(mission)),
      plan_(prior_.nominal),
      at_ignition_(prior_.nominal),
      below_(mission.below),
      last_(mission.last) {}

CorrectorTask ClosedLoopGuidance::Task(std::initializer_list<PlanUnknown> free, const Plan& prior,
                                       int iterations) const {
  CorrectorTask task;
  for (const PlanUnknown unknown : free) task.free[unknown] = true;
  task.prior = prior;
  task.low = prior_.low;
  task.high = prior_.high;
  task.iterations = iterations;
  return task;
}

bool ClosedLoopGuidance::See(const GuidanceSight& sight) {
  if (sight.phase != phase_) {
    phase_ = sight.phase;
    has_previous_ = false;
    if (sight.phase == GuidancePhase::kLastBurns) at_ignition_ = plan_;
    thrust_offset_rad_I_ = Vector3::Zero();
  }
  next_call_s_ = sight.state.time_s + mission_.config.period_s;
  switch (sight.phase) {
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

void ClosedLoopGuidance::SeeBelowBurn(const GuidanceSight& sight) {
  const double since_s = sight.state.time_s - sight.burn_ignition_s;
  below_.Add(since_s, sight.specific_force_m_s2);
  if (since_s < kTakeOver_s) return;
  const double time_s = sight.state.time_s;
  if (!steers_) {
    steers_ = true;
    command_.Start(time_s, mission_.program.At(time_s), mission_.program.RateAt(time_s));
    plan_ = prior_.nominal;
  }
  MeasureThrust(sight);
  Knowledge known;
  known.phase = sight.phase;
  known.burn_ignition_s = sight.burn_ignition_s;
  known.below = below_.Stage(0.0);
  known.last = mission_.last;
  known.thrust_offset_rad_I = thrust_offset_rad_I_;
  known.commanded = command_.direction();
  const double left_s = sight.burn_ignition_s + known.below.burn.duration_s - time_s;
  if (left_s < kHold_s) return;
  CorrectorTask task = Task({kBelowPitch, kBelowYaw, kIgnition, kPitchMiddle, kPitchHalf, kYawMiddle, kWaste},
                            prior_.nominal, outcome_.acted ? kIterations : kFirstIterations);
  plan_ = Correct(mission_, prior_, known, sight.state, plan_, task).plan;
  outcome_.acted = true;
}

bool ClosedLoopGuidance::SeeCoast(const GuidanceSight& sight) {
  const double time_s = sight.state.time_s;
  if (!steers_) {
    steers_ = true;
    command_.Start(time_s, mission_.program.At(time_s), mission_.program.RateAt(time_s));
  }
  double earliest_s = time_s + kLastPlan_s;
  double& ignition_s = plan_.value[kIgnition];
  const double left_s = ignition_s - time_s;
  if (left_s <= kLastPlan_s) {
    const bool settled = sight.attitude_error_rad <= mission_.limits.settled_angle_rad &&
                         sight.rate_error_rad_s <= mission_.limits.settled_rate_rad_s;
    const Direction wanted = LastBurnAttitude(plan_, prior_).At(0.0);
    const Direction at = command_.direction();
    const bool there = Square(wanted.pitch_rad - at.pitch_rad) + Square(wanted.yaw_rad - at.yaw_rad) <=
                       Square(mission_.limits.settled_angle_rad);
    if ((settled && there) || outcome_.postponed_s >= kLongestPostponement_s) {
      next_call_s_ = ignition_s + kTakeOver_s;
      return false;
    }
    outcome_.postponed_s += kPostpone_s;
    earliest_s = ignition_s + kPostpone_s;
  }
  Knowledge known;
  known.phase = sight.phase;
  known.last = last_.Stage(sight.expelled_kg);
  // Near ignition the plan stays near itself: the attitude that the burn begins with takes its time.
  const bool is_near = outcome_.acted && left_s <= kCoastPeriod_s + kNearIgnition_s;
  CorrectorTask task =
      Task({kIgnition, kPitchMiddle, kPitchHalf, kYawMiddle, kWaste}, is_near ? plan_ : prior_.nominal,
           outcome_.acted ? kIterations + 1 : kFirstIterations);
  if (task.low[kIgnition] < earliest_s) task.low[kIgnition] = earliest_s;
  if (task.high[kIgnition] < earliest_s) task.high[kIgnition] = earliest_s;
  ignition_s = Clamp(ignition_s, task.low[kIgnition], task.high[kIgnition]);
  const Correction found = Correct(mission_, prior_, known, sight.state, plan_, task);
  plan_ = found.plan;
  outcome_.acted = true;
  outcome_.arrives = found.arrives;
  outcome_.ignition_shift_s = ignition_s - mission_.last_ignition_s;
  outcome_.excess_m_s = plan_.value[kWaste] * IdealVelocity(known.last);
  const double until_s = ignition_s - time_s;
  next_call_s_ =
      time_s + (until_s > kCoastPeriod_s + kNearIgnition_s ? kCoastPeriod_s : mission_.config.period_s);
  return true;
}

void ClosedLoopGuidance::SeeLastBurn(const GuidanceSight& sight) {
  if (!mission_.config.steers_last_burn) return;
  const double time_s = sight.state.time_s;
  last_.Add(time_s - sight.burn_ignition_s, sight.specific_force_m_s2);
  MeasureThrust(sight);
  Knowledge known;
  known.phase = sight.phase;
  known.burn_ignition_s = sight.burn_ignition_s;
  known.last = last_.Stage(sight.expelled_kg);
  known.thrust_offset_rad_I = thrust_offset_rad_I_;
  known.commanded = command_.direction();
  const double left_s = sight.burn_ignition_s + known.last.burn.duration_s - time_s;
  if (left_s < kHold_s) return;
  const bool all = left_s > kOnlyVelocity_s;
  CorrectorTask task = all ? Task({kPitchMiddle, kPitchHalf, kYawMiddle, kWaste}, at_ignition_, kIterations)
                           : Task({kPitchMiddle, kYawMiddle}, plan_, kIterations);
  task.meets_altitude = task.meets_plane = all;
  const Correction found = Correct(mission_, prior_, known, sight.state, plan_, task);
  plan_ = found.plan;
  if (all) met_all_ = found.arrives;
  outcome_.arrives = met_all_ && found.arrives;
}

void ClosedLoopGuidance::Command(double time_s) {
  const GuidanceLimits& limits = mission_.limits;
  Direction wanted, rate;
  switch (phase_) {
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
  wanted = burn.At(time_s - plan_.ignition_s());
  if (time_s < plan_.ignition_s())
    return command_.Follow(time_s, wanted, {}, limits.coast_rate_rad_s, limits.coast_acceleration_rad_s2);
  rate = burn.RateAt(time_s - plan_.ignition_s());
  command_.Follow(time_s, wanted, rate, limits.turn_rate_rad_s, limits.turn_acceleration_rad_s2);
}

}  // namespace dispersa
