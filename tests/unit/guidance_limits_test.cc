// The limits of guidance commands, from a vehicle's nozzles, thrusters and deadband, unless the campaign
// gives them.
#include "core/guidance/guidance_limits.h"
#include "core/control/autopilot_config.h"
#include "core/vehicle/mass.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::guidance_limits_test {
namespace {

constexpr double kDeg = kRadPerDeg;

AutopilotConfig WithDeadband(double deadband_rad, int cycle_ticks) {
  AutopilotConfig autopilot = SampleAutopilot();
  autopilot.reaction_control.deadband_rad = deadband_rad;
  autopilot.reaction_control.cycle_ticks = cycle_ticks;
  return autopilot;
}

TEST(GuidanceLimits, TheAuthorityIsThatOfNozzlesAndThrusters) {
  const Vehicle vehicle = SampleVehicle();
  const GuidedAuthority authority = AuthorityOf(vehicle, WithDeadband(0.5 * kDeg, 20));
  const StackMass last = BuildStackMasses(vehicle)[1];
  const MassProperties full = last.At(1000.0);
  // Two of the cross's four nozzles at 6 deg. Of the two stacks the heavier one turns more slowly.
  const MassProperties below = BuildStackMasses(vehicle)[0].At(4000.0);
  const double first = 0.5 * 200e3 * (19.5 - below.cg_station_m) / below.transverse_inertia_kg_m2,
               second = 0.5 * 50e3 * (10.0 - full.cg_station_m) / full.transverse_inertia_kg_m2;
  EXPECT_NEAR(authority.nozzles_rad_s2, 6.0 * kDeg * std::min(first, second), 1e-12);
  EXPECT_NEAR(authority.thrusters_rad_s2, 20.0 / full.transverse_inertia_kg_m2, 1e-12);
  EXPECT_EQ(authority.deadband_rad, 0.5 * kDeg);
  // A cycle of 0.2 s is longer than the least time on, 0.05 s.
  EXPECT_NEAR(authority.least_change_rad_s, 0.2 * authority.thrusters_rad_s2, 1e-15);
  EXPECT_NEAR(AuthorityOf(vehicle, WithDeadband(0.5 * kDeg, 1)).least_change_rad_s,
              0.05 * authority.thrusters_rad_s2, 1e-15);
}

TEST(GuidanceLimits, AStrongVehicleHasTheUsualOnes) {
  const GuidanceLimits limits = LimitsOf({}, {1.0, 1.0, 0.01 * kDeg, 0.01 * kDeg}), usual;
  EXPECT_EQ(limits.turn_rate_rad_s, usual.turn_rate_rad_s);
  EXPECT_EQ(limits.turn_acceleration_rad_s2, usual.turn_acceleration_rad_s2);
  EXPECT_EQ(limits.coast_rate_rad_s, usual.coast_rate_rad_s);
  EXPECT_EQ(limits.coast_acceleration_rad_s2, usual.coast_acceleration_rad_s2);
  EXPECT_EQ(limits.settled_angle_rad, usual.settled_angle_rad);
  EXPECT_EQ(limits.settled_rate_rad_s, usual.settled_rate_rad_s);
}

// A heavy upper stage that cannot do 2 deg/s2, and a deadband of 0.5 deg, within which nothing settles
// nearer.
TEST(GuidanceLimits, AWeakVehicleIsAskedWhatItCanDo) {
  const GuidanceLimits limits = LimitsOf({}, {1.2 * kDeg, 0.06 * kDeg, 0.5 * kDeg, 0.3 * kDeg});
  EXPECT_NEAR(limits.turn_acceleration_rad_s2 / kDeg, 0.3, 1e-12);
  EXPECT_NEAR(limits.turn_rate_rad_s / kDeg, 0.45, 1e-12);
  EXPECT_NEAR(limits.coast_acceleration_rad_s2 / kDeg, 0.02, 1e-12);
  EXPECT_NEAR(limits.coast_rate_rad_s / kDeg, 0.2, 1e-12);
  EXPECT_NEAR(limits.settled_angle_rad / kDeg, 0.75, 1e-12);
  EXPECT_NEAR(limits.settled_rate_rad_s / kDeg, 0.45, 1e-12);
}

TEST(GuidanceLimits, WhatACampaignSaysIsTaken) {
  GuidanceConfig config;
  config.turn_rate_rad_s = 5.0 * kDeg;
  config.turn_acceleration_rad_s2 = 4.0 * kDeg;
  config.coast_rate_rad_s = 1.0 * kDeg;
  config.coast_acceleration_rad_s2 = 0.5 * kDeg;
  config.settled_angle_rad = 0.1 * kDeg;
  config.settled_rate_rad_s = 0.05 * kDeg;
  const GuidanceLimits limits = LimitsOf(config, {1.2 * kDeg, 0.06 * kDeg, 0.5 * kDeg, 0.3 * kDeg});
  EXPECT_EQ(limits.turn_rate_rad_s, 5.0 * kDeg);
  EXPECT_EQ(limits.turn_acceleration_rad_s2, 4.0 * kDeg);
  EXPECT_EQ(limits.coast_rate_rad_s, 1.0 * kDeg);
  EXPECT_EQ(limits.coast_acceleration_rad_s2, 0.5 * kDeg);
  EXPECT_EQ(limits.settled_angle_rad, 0.1 * kDeg);
  EXPECT_EQ(limits.settled_rate_rad_s, 0.05 * kDeg);
}

TEST(GuidanceLimits, WhatTheVehicleCannotFollowIsFound) {
  GuidanceConfig config;
  config.turn_acceleration_rad_s2 = 2.0 * kDeg;
  config.coast_acceleration_rad_s2 = 0.07 * kDeg;
  config.settled_angle_rad = 0.7 * kDeg;
  config.settled_rate_rad_s = 0.2 * kDeg;
  const GuidedAuthority weak = {1.2 * kDeg, 0.06 * kDeg, 0.5 * kDeg, 0.3 * kDeg};
  std::string text;
  for (const GuidanceExcess& one : ExcessesOf(config, weak))
    text += one.key + " " + one.message + " | " + one.allowed + "\n";
  EXPECT_EQ(
      text,
      "turn_acceleration_deg_s2 is more than the nozzles of the last two stages can do at their limit, "
      "1.2 deg/s2 | up to 0.3 deg/s2, or none\n"
      "coast_acceleration_deg_s2 is more than the thrusters can do, 0.06 deg/s2 | up to 0.02 deg/s2, or "
      "none\n"
      "settled_deg is within the reaction control's deadband of 0.5 deg, in which the attitude rests: "
      "the last ignition may wait for a minute | 0.75 deg or more, or none\n"
      "settled_rate_deg_s is less than one firing of the thrusters changes, 0.3 deg/s: the last "
      "ignition may wait for a minute | 0.45 deg/s or more, or none\n");
  EXPECT_TRUE(ExcessesOf({}, weak).empty());
  config = {};
  config.turn_acceleration_rad_s2 = 0.01 * kDeg;
  config.turn_rate_rad_s = 0.02 * kDeg;
  text.clear();
  for (const GuidanceExcess& one : ExcessesOf(config, weak)) text += one.key + " | " + one.allowed + "\n";
  EXPECT_EQ(text,
            "turn_acceleration_deg_s2 | 0.015 deg/s2 or more, or none\n"
            "turn_rate_deg_s | 0.0225 deg/s or more, or none\n");
  config = {};
  config.settled_angle_rad = 0.71 * kDeg;
  EXPECT_TRUE(ExcessesOf(config, weak).empty());
}

}  // namespace
}  // namespace dispersa::guidance_limits_test
