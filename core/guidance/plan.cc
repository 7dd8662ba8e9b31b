#include "core/guidance/plan.h"

#include <algorithm>

#include "core/guidance/motor_estimate.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

// A turn is as late as it can be at this part of the command's greatest rate, with corners at that of its
// acceleration: what is left makes up for what the command loses.
constexpr double kOfTurnRate = 0.7;

// Angles change along the last burn in this time at least: a reference of another vehicle may leave it
// nothing.
constexpr double kShortestCourse_s = 1.0;

// A burn's duration: its scale, and its shortest.
constexpr double kOfBurn = 0.15, kShortestOfBurn = 0.2;
// A longer burn of the last engine uses up the reserve of propellant: this part of the reserve costs 1. The
// reserve counts as this part of the burn at least.
constexpr double kOfReserve = 1.0 / 3.0, kLeastReserveOfBurn = 1e-3;

// 0 before, the time since after, by a parabola within `round_s` of it; and its slope.
double Ramp(double since_s, double round_s) {
  if (since_s >= round_s) return since_s;
  return since_s > -round_s ? Square(since_s + round_s) / (4.0 * round_s) : 0.0;
}
double RampRate(double since_s, double round_s) {
  if (since_s >= round_s) return 1.0;
  return since_s > -round_s ? (since_s + round_s) / (2.0 * round_s) : 0.0;
}

TurnCourse CourseOf(const GuidanceMission& mission) {
  const MotorBurn& burn = mission.last.burn;
  TurnCourse course;
  course.end_s = burn.duration_s;
  // Half of the burn is left to turn in.
  if (mission.config.steers_last_burn)
    course.from_s =
        std::min(StandsAfter(mission.last, kTakeOver_s, mission.config.period_s), 0.5 * burn.duration_s);
  course.back_s = course.from_s + (course.end_s - course.from_s) / 3.0;
  course.round_s = std::min(mission.limits.turn_rate_rad_s / mission.limits.turn_acceleration_rad_s2,
                            0.25 * (course.back_s - course.from_s));
  course.steepest_rad_s = kOfTurnRate * mission.limits.turn_rate_rad_s;
  constexpr int kPieces = 400;
  double sum = 0.0, late = 0.0, early = 0.0, late_late = 0.0, late_early = 0.0, early_early = 0.0;
  for (int i = 0; i < kPieces; ++i) {
    const double time_s = (i + 0.5) / kPieces * burn.duration_s;
    const double weight = burn.Fraction(time_s) / (mission.last.ignition_mass_kg - mission.last.early_kg -
                                                   burn.propellant_mass_kg + burn.Propellant(time_s));
    const double at_late = course.Late(time_s), at_early = course.Early(time_s);
    sum += weight;
    late += weight * at_late;
    early += weight * at_early;
    late_late += weight * at_late * at_late;
    late_early += weight * at_late * at_early;
    early_early += weight * at_early * at_early;
  }
  course.late_mean = late / sum;
  course.early_mean = early / sum;
  course.late_variance = late_late / sum - Square(course.late_mean);
  course.covariance = late_early / sum - course.late_mean * course.early_mean;
  course.early_variance = early_early / sum - Square(course.early_mean);
  return course;
}

}  // namespace

double TurnCourse::Late(double since_ignition_s) const {
  return (Ramp(since_ignition_s - from_s, round_s) - 2.0 * Ramp(since_ignition_s - back_s, round_s)) /
         (back_s - from_s);
}

double TurnCourse::LateRate(double since_ignition_s) const {
  return (RampRate(since_ignition_s - from_s, round_s) - 2.0 * RampRate(since_ignition_s - back_s, round_s)) /
         (back_s - from_s);
}

double TurnCourse::Early(double since_ignition_s) const {
  return 1.0 - 2.0 * Ramp(since_ignition_s - from_s, round_s) / (end_s - from_s);
}

double TurnCourse::EarlyRate(double since_ignition_s) const {
  return -2.0 * RampRate(since_ignition_s - from_s, round_s) / (end_s - from_s);
}

LastBurnAttitude::LastBurnAttitude(const Plan& plan, const PlanPrior& prior) : plan_(plan), prior_(prior) {
  if (prior.mission->last.is_cut_off() || prior.mission->holds_last) return;
  const TurnCourse& course = prior.turn;
  const double waste = plan.value[kWaste], way_s = course.end_s - course.from_s;
  // The late course has slopes of 3 turns over the way, the early one of 2.
  const double all_late_rad = Sqrt(2.0 * waste / course.late_variance);
  if (all_late_rad > 0.0) early_ = Clamp(3.0 - course.steepest_rad_s * way_s / all_late_rad, 0.0, 1.0);
  // Nothing to wait for.
  if (!(course.from_s > 0.0)) early_ = 1.0;
  const double late = 1.0 - early_;
  turn_rad_ = Sqrt(2.0 * waste /
                   (late * late * course.late_variance + 2.0 * late * early_ * course.covariance +
                    early_ * early_ * course.early_variance));
  mean_ = late * course.late_mean + early_ * course.early_mean;
}

Direction LastBurnAttitude::At(double since_ignition_s) const {
  const double since = since_ignition_s > 0.0 ? since_ignition_s : 0.0;
  const double s = 2.0 * since / prior_.last_duration_s - 1.0;
  const GuidanceMission& mission = *prior_.mission;
  if (mission.holds_last)
    return {prior_.middle.pitch_rad + plan_.value[kPitchMiddle],
            prior_.middle.yaw_rad + plan_.value[kYawMiddle]};
  const Direction at = mission.program.At(mission.last_ignition_s + since);
  if (mission.last.is_cut_off())
    return {at.pitch_rad + plan_.value[kPitchMiddle] + s * plan_.value[kPitchHalf],
            at.yaw_rad + plan_.value[kYawMiddle] + s * plan_.value[kYawHalf]};
  const double turned = (1.0 - early_) * prior_.turn.Late(since) + early_ * prior_.turn.Early(since) - mean_;
  const Direction bend{at.pitch_rad - (prior_.middle.pitch_rad + s * prior_.half.pitch_rad),
                       at.yaw_rad - (prior_.middle.yaw_rad + s * prior_.half.yaw_rad)};
  return {bend.pitch_rad + plan_.value[kPitchMiddle] + s * plan_.value[kPitchHalf],
          bend.yaw_rad + plan_.value[kYawMiddle] + s * prior_.yaw_half_rad + turn_rad_ * turned};
}

Direction LastBurnAttitude::RateAt(double since_ignition_s) const {
  const double slope = 2.0 / prior_.last_duration_s;
  const GuidanceMission& mission = *prior_.mission;
  if (mission.holds_last) return {};
  const Direction rate = mission.program.RateAt(mission.last_ignition_s + since_ignition_s);
  if (mission.last.is_cut_off())
    return {rate.pitch_rad + slope * plan_.value[kPitchHalf], rate.yaw_rad + slope * plan_.value[kYawHalf]};
  const TurnCourse& course = prior_.turn;
  const double turning =
      (1.0 - early_) * course.LateRate(since_ignition_s) + early_ * course.EarlyRate(since_ignition_s);
  return {rate.pitch_rad + slope * (plan_.value[kPitchHalf] - prior_.half.pitch_rad),
          rate.yaw_rad + slope * (prior_.yaw_half_rad - prior_.half.yaw_rad) + turn_rad_ * turning};
}

namespace {

// Scales, and bounds on either side. A cut-off's later bound is the propellant's end, which is known in
// flight.
void SetReach(const GuidanceMission& mission, PlanPrior& prior) {
  constexpr double kDeg = kRadPerDeg;
  const auto& value = prior.nominal.value;
  const double below_s = value[kBelowCutOff], last_s = value[kCutOff];
  const auto scale_s = [](double burn_s) { return burn_s > 0.0 ? kOfBurn * burn_s : 1.0; };
  // So wide that departures of a few scales cost less than a miss of a tolerance.
  prior.scale = {6.0 * kDeg,       3.0 * kDeg,      60.0,       15.0 * kDeg, 15.0 * kDeg, 9.0 * kDeg, 0.09,
                 scale_s(below_s), scale_s(last_s), 9.0 * kDeg, 6.0 * kDeg,  3.0 * kDeg,  1.0};
  const double late_s = (1.0 - kShortestOfBurn);
  const std::array<double, kPlanUnknowns> reach = {
      10.0 * kDeg,      5.0 * kDeg,      120.0,       25.0 * kDeg, 25.0 * kDeg, 25.0 * kDeg, 0.0,
      late_s * below_s, late_s * last_s, 25.0 * kDeg, 10.0 * kDeg, 5.0 * kDeg,  0.0};
  for (int i = 0; i < kPlanUnknowns; ++i) {
    const auto k = static_cast<std::size_t>(i);
    prior.low[k] = value[k] - reach[k];
    prior.high[k] = value[k] + reach[k];
  }
  if (mission.below.is_cut_off()) prior.high[kBelowCutOff] = mission.below.Depletes();
  if (!mission.last.is_cut_off()) return;
  prior.high[kCutOff] = mission.last.Depletes();
  const double reserve_s = std::max(mission.last.Depletes() - last_s, kLeastReserveOfBurn * last_s);
  const auto dearer = [&](PlanUnknown burn) {
    return std::max(Square(prior.scale[burn] / (kOfReserve * reserve_s)) - 1.0, 0.0);
  };
  prior.dearer[kCutOff] = dearer(kCutOff);
  if (mission.is_restart && mission.below.is_cut_off()) prior.dearer[kBelowCutOff] = dearer(kBelowCutOff);
}

}  // namespace

PlanPrior BuildPrior(const GuidanceMission& mission) {
  PlanPrior prior;
  prior.mission = &mission;
  prior.last_duration_s = std::max(mission.last.burn.duration_s, kShortestCourse_s);
  const double burnout_s = mission.last_ignition_s + prior.last_duration_s;
  const Direction from = mission.program.At(mission.last_ignition_s), to = mission.program.At(burnout_s);
  auto& value = prior.nominal.value;
  value[kIgnition] = mission.last_ignition_s;
  if (mission.below.is_cut_off()) value[kBelowCutOff] = mission.below.burn.duration_s;
  if (mission.last.is_cut_off()) value[kCutOff] = mission.last.burn.duration_s;
  if (mission.holds_last) prior.middle = from;
  if (mission.last.is_cut_off() || mission.holds_last) {
    SetReach(mission, prior);
    return prior;
  }
  prior.middle = {0.5 * (from.pitch_rad + to.pitch_rad), 0.5 * (from.yaw_rad + to.yaw_rad)};
  prior.half = {0.5 * (to.pitch_rad - from.pitch_rad), 0.5 * (to.yaw_rad - from.yaw_rad)};
  value[kPitchMiddle] = prior.middle.pitch_rad;
  value[kPitchHalf] = prior.half.pitch_rad;
  value[kYawMiddle] = prior.middle.yaw_rad;
  value[kWaste] = mission.velocity_reserve_m_s / IdealVelocity(mission.last);
  prior.yaw_half_rad = prior.half.yaw_rad;
  prior.turn = CourseOf(mission);
  SetReach(mission, prior);
  // From no turn, of which nothing is left to give, to an early one of 45 degrees either way.
  prior.low[kWaste] = 0.0;
  prior.high[kWaste] = 0.5 * Square(45.0 * kRadPerDeg) * prior.turn.early_variance;
  return prior;
}

void SetEarlier(const GuidedStage& stage, PlanPrior& prior) {
  auto& value = prior.nominal.value;
  value[kEarlierPitch] = value[kEarlierYaw] = value[kEarlierCutOff] = 0.0;
  prior.scale[kEarlierCutOff] = 1.0;
  prior.low[kEarlierCutOff] = prior.high[kEarlierCutOff] = 0.0;
  if (!stage.is_cut_off()) return;
  const double burn_s = stage.burn.duration_s;
  value[kEarlierCutOff] = burn_s;
  prior.scale[kEarlierCutOff] = kOfBurn * burn_s;
  prior.low[kEarlierCutOff] = kShortestOfBurn * burn_s;
  prior.high[kEarlierCutOff] = stage.Depletes();
}

}  // namespace dispersa
