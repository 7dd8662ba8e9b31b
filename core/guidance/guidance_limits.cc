#include "core/guidance/guidance_limits.h"

#include <algorithm>
#include <cmath>

#include "core/control/autopilot_config.h"
#include "core/guidance/mission.h"
#include "core/input/number_text.h"
#include "core/math/assertion.h"
#include "core/math/functions.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/nozzle_layout.h"
#include "core/vehicle/propulsion.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

namespace {

// Of what nozzles and thrusters can do, for turning.
constexpr double kOfNozzles = 0.25, kOfThrusters = 1.0 / 3.0;
// Of the default, a setting that is slower is warned of.
constexpr double kSlow = 0.05;
// A rate is reached in this time.
constexpr double kHasten_s = 1.5, kCoastHasten_s = 10.0;
// Pitch and yaw may both be at the edge of the deadband, and beyond it by what the rate adds.
constexpr double kOfDeadband = 1.5, kOfChange = 1.5;

}  // namespace

GuidedAuthority AuthorityOf(const Vehicle& vehicle, const AutopilotConfig& autopilot,
                            const GuidanceConfig& config) {
  DISPERSA_ASSERT(vehicle.stages.size() >= 2, vehicle.stages.size());
  const std::vector<StackMass> stacks = BuildStackMasses(vehicle);
  GuidedAuthority authority;
  authority.deadband_rad = autopilot.reaction_control.deadband_rad;
  authority.nozzles_rad_s2 = HUGE_VAL;
  const std::size_t last = stacks.size() - 1;
  for (std::size_t i = FirstGuided(vehicle, config); i <= last; ++i) {
    const Stage& stage = vehicle.stages[i];
    if (!stage.is_controlled()) continue;  // it is pointed before its ignition
    // The first stage is guided after its boosters have left.
    const bool had_boosters = i == 0 && vehicle.boosters.count > 0;
    const StackMass stack =
        had_boosters ? Without(stacks[i], 0, {BuildBoosterMass(vehicle.boosters)}, 1u) : stacks[i];
    const MassProperties full = stack.At(stack.propellant_mass_kg);
    const double share = stage.gimbal.nozzles.empty() ? 0.5 : BuildNozzleLayout(stage.gimbal).pitch_share;
    const double effectiveness_1_s2 = share * BuildBurn(stage, 1.0, 1.0).vacuum_thrust_n *
                                      (stage.gimbal.pivot_station_m - full.cg_station_m) /
                                      full.transverse_inertia_kg_m2;
    authority.nozzles_rad_s2 =
        std::min(authority.nozzles_rad_s2, effectiveness_1_s2 * stage.gimbal.limit_rad);
  }
  const ReactionControl& control = vehicle.reaction_control;
  const MassProperties full = stacks[last].At(stacks[last].propellant_mass_kg);
  authority.thrusters_rad_s2 =
      2.0 * control.thrust_n * control.pitch_yaw_arm_m / full.transverse_inertia_kg_m2;
  authority.least_change_rad_s =
      authority.thrusters_rad_s2 *
      std::max(control.minimum_on_time_s, autopilot.reaction_control.cycle_ticks * autopilot.tick_s);
  return authority;
}

GuidanceLimits LimitsOf(const GuidanceConfig& config, const GuidedAuthority& authority) {
  const GuidanceLimits usual;
  GuidanceLimits limits;
  limits.turn_acceleration_rad_s2 = config.turn_acceleration_rad_s2.value_or(
      std::min(usual.turn_acceleration_rad_s2, kOfNozzles * authority.nozzles_rad_s2));
  limits.turn_rate_rad_s = config.turn_rate_rad_s.value_or(
      std::min(usual.turn_rate_rad_s, kHasten_s * limits.turn_acceleration_rad_s2));
  limits.coast_acceleration_rad_s2 = config.coast_acceleration_rad_s2.value_or(
      std::min(usual.coast_acceleration_rad_s2, kOfThrusters * authority.thrusters_rad_s2));
  limits.coast_rate_rad_s = config.coast_rate_rad_s.value_or(
      std::min(usual.coast_rate_rad_s, kCoastHasten_s * limits.coast_acceleration_rad_s2));
  limits.settled_angle_rad = config.settled_angle_rad.value_or(
      std::max(usual.settled_angle_rad, kOfDeadband * authority.deadband_rad));
  limits.settled_rate_rad_s = config.settled_rate_rad_s.value_or(
      std::max(usual.settled_rate_rad_s, kOfChange * authority.least_change_rad_s));
  return limits;
}

std::vector<GuidanceExcess> ExcessesOf(const GuidanceConfig& config, const GuidedAuthority& authority) {
  const GuidanceLimits can = LimitsOf({}, authority);
  const auto degrees = [](double value_rad, const char* unit) {
    return FormatRounded(value_rad * kDegPerRad) + unit;
  };
  std::vector<GuidanceExcess> found;
  if (config.turn_acceleration_rad_s2.value_or(0.0) > authority.nozzles_rad_s2)
    found.push_back({"turn_acceleration_deg_s2",
                     "is more than the nozzles of the last two stages can do at their limit, " +
                         degrees(authority.nozzles_rad_s2, " deg/s2"),
                     "up to " + degrees(can.turn_acceleration_rad_s2, " deg/s2, or none")});
  if (config.coast_acceleration_rad_s2.value_or(0.0) > authority.thrusters_rad_s2)
    found.push_back({"coast_acceleration_deg_s2",
                     "is more than the thrusters can do, " + degrees(authority.thrusters_rad_s2, " deg/s2"),
                     "up to " + degrees(can.coast_acceleration_rad_s2, " deg/s2, or none")});
  // A plan that is not followed in time is none.
  const auto is_slow = [](const std::optional<double>& asked, double usual) {
    return asked.value_or(HUGE_VAL) < kSlow * usual;
  };
  const char* const slow = "is so slow that the command does not follow the plans of a burn";
  if (is_slow(config.turn_acceleration_rad_s2, can.turn_acceleration_rad_s2))
    found.push_back({"turn_acceleration_deg_s2", slow,
                     degrees(kSlow * can.turn_acceleration_rad_s2, " deg/s2 or more, or none")});
  if (is_slow(config.turn_rate_rad_s, can.turn_rate_rad_s))
    found.push_back(
        {"turn_rate_deg_s", slow, degrees(kSlow * can.turn_rate_rad_s, " deg/s or more, or none")});
  // Pitch and yaw may both rest at its edge.
  if (config.settled_angle_rad.value_or(HUGE_VAL) < Sqrt(2.0) * authority.deadband_rad)
    found.push_back({"settled_deg",
                     "is within the reaction control's deadband of " +
                         degrees(authority.deadband_rad, " deg") +
                         ", in which the attitude rests: the last ignition may wait for a minute",
                     degrees(can.settled_angle_rad, " deg or more, or none")});
  if (config.settled_rate_rad_s.value_or(HUGE_VAL) < authority.least_change_rad_s)
    found.push_back({"settled_rate_deg_s",
                     "is less than one firing of the thrusters changes, " +
                         degrees(authority.least_change_rad_s, " deg/s") +
                         ": the last ignition may wait for a minute",
                     degrees(can.settled_rate_rad_s, " deg/s or more, or none")});
  return found;
}

}  // namespace dispersa
