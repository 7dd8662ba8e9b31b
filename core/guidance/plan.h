// The guidance plan: the numbers that guidance still decides.
#pragma once

#include <array>

#include "core/guidance/mission.h"

namespace dispersa {

enum PlanUnknown {
  kBelowPitch,  ///< offset to the reference's attitude while the stage before the last burns, rad
  kBelowYaw,
  kIgnition,  ///< of the last stage, s since lift-off
  // Of the last burn. If guidance cuts it off, these are added to the reference's attitude; if nothing steers
  // it, the middle ones are added to that of its ignition.
  kPitchMiddle,  ///< pitch in L at half its nominal duration, rad
  kPitchHalf,    ///< by how much pitch is greater at its nominal end, rad
  kYawMiddle,
  kWaste,  ///< part of the last burn's ideal velocity that turning in yaw takes away
  // Of engines that guidance cuts off.
  kBelowCutOff,  ///< duration of the burn of the stage before the last, s
  kCutOff,       ///< the same of the last stage
  kYawHalf,      ///< as kPitchHalf, of a last burn that guidance cuts off
  // Of the present burn, if it is before the last two.
  kEarlierPitch,  ///< offset to the reference's attitude, rad
  kEarlierYaw,
  kEarlierCutOff,  ///< its duration, s
  kPlanUnknowns
};
struct Plan {
  std::array<double, kPlanUnknowns> value{};

  double ignition_s() const { return value[kIgnition]; }
};

/// The last burn's turn in yaw, which spends excess energy, over the time since ignition in units of its
/// amplitude a: a mixture of two courses. Late: 0 until the motor's estimate is ready at `from_s`, then
/// linear to 1 at `back_s`, then linear to -1 at the nominal burnout. Early: 1 until `from_s`, then linear to
/// -1. Corners are rounded over `round_s` to either side, so that the command can follow.
struct TurnCourse {
  double from_s = 0.0, back_s = 0.0, end_s = 0.0, round_s = 0.0;
  double steepest_rad_s = 0.0;  ///< what the command can follow
  /// Over the nominal burn, weighed by its acceleration.
  double late_mean = 0.0, early_mean = 0.0, late_variance = 0.0, covariance = 0.0, early_variance = 0.0;

  double Late(double since_ignition_s) const;
  double LateRate(double since_ignition_s) const;
  double Early(double since_ignition_s) const;
  double EarlyRate(double since_ignition_s) const;
};

/// The plan of a nominal flight, and the scales and bounds of departures from it.
struct PlanPrior {
  Plan nominal;
  double last_duration_s = 0.0;  ///< nominal, of the last burn
  /// Of the reference's last burn: its attitude halfway between begin and end, and half of the way. Of one
  /// that nothing steers: its attitude at ignition, and none.
  Direction middle, half;
  double yaw_half_rad = 0.0;  ///< of plans, if the last burn ends by itself
  TurnCourse turn;
  const GuidanceMission* mission = nullptr;   ///< the prior's
  std::array<double, kPlanUnknowns> scale{};  ///< a departure that costs 1
  /// By how much more the square of a departure above the nominal plan costs than of one below: burns that
  /// use up the reserve.
  std::array<double, kPlanUnknowns> dearer{};
  std::array<double, kPlanUnknowns> low{}, high{};
};
PlanPrior BuildPrior(const GuidanceMission& mission);
/// For plans in a burn before the last two, which begins with this stage.
void SetEarlier(const GuidedStage& stage, PlanPrior& prior);

/// Direction of the last burn's thrust by a plan: the reference's plus a departure linear in time. A burn
/// that nothing steers keeps one direction. If a steered burn ends by itself, the plan has pitch and yaw of
/// the line between the burn's ends, and a turn in yaw about its mean is added. The turn takes a²/2 of the
/// course's variance from the ideal velocity; kWaste stands for it. It begins as late as the command can
/// follow.
class LastBurnAttitude {
 public:
  LastBurnAttitude(const Plan& plan, const PlanPrior& prior);

  /// Before ignition as at it.
  Direction At(double since_ignition_s) const;
  /// Its slope, rad/s.
  Direction RateAt(double since_ignition_s) const;
  double turn_rad() const { return turn_rad_; }

 private:
  const Plan& plan_;
  const PlanPrior& prior_;
  double early_ = 0.0;  ///< share of the early course
  double turn_rad_ = 0.0, mean_ = 0.0;
};

/// A motor's first seconds, whose start and separation the autopilot is busy with: nothing is planned.
inline constexpr double kTakeOver_s = 3.0;

}  // namespace dispersa
