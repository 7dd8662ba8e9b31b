// Thrust and propellant of a burn: the trapezoid's area, its ends, and the flight's factors.
#include "core/vehicle/propulsion.h"

#include <gtest/gtest.h>

#include "tests/unit/sample_vehicle.h"

namespace dispersa {
namespace {

Stage RampedStage() {
  Stage stage = SampleVehicle().stages[0];  // 4000 kg in 40 s: 100 kg/s
  stage.motor.ignition_rise_s = 0.5;
  stage.motor.tail_off_s = 2.0;
  return stage;
}

TEST(MotorBurn, ConstantThrustBurnsForTheTablesTime) {
  const MotorBurn burn = BuildBurn(SampleVehicle().stages[0], 1.0, 1.0);
  EXPECT_DOUBLE_EQ(burn.vacuum_thrust_n, 200e3);
  EXPECT_DOUBLE_EQ(burn.full_flow_kg_s, 100.0);
  EXPECT_DOUBLE_EQ(burn.duration_s, 40.0);
  EXPECT_EQ(burn.Fraction(-1e-9), 0.0);
  EXPECT_EQ(burn.Fraction(0.0), 1.0);
  EXPECT_EQ(burn.Fraction(40.0), 1.0);
  EXPECT_EQ(burn.Fraction(40.0 + 1e-9), 0.0);
  EXPECT_DOUBLE_EQ(burn.Propellant(10.0), 3000.0);
}

TEST(MotorBurn, RampsLengthenTheBurnByHalfTheirDurations) {
  const MotorBurn burn = BuildBurn(RampedStage(), 1.0, 1.0);
  EXPECT_DOUBLE_EQ(burn.duration_s, 40.0 + 0.5 * (0.5 + 2.0));
  EXPECT_DOUBLE_EQ(burn.Fraction(0.25), 0.5);
  EXPECT_DOUBLE_EQ(burn.Fraction(burn.duration_s - 0.5), 0.25);
  EXPECT_DOUBLE_EQ(burn.Propellant(0.5), 4000.0 - 0.5 * 100.0 * 0.5);
  EXPECT_DOUBLE_EQ(burn.Propellant(burn.duration_s - 2.0), 0.5 * 100.0 * 2.0);
  EXPECT_EQ(burn.Propellant(burn.duration_s), 0.0);
  EXPECT_EQ(burn.Propellant(0.0), 4000.0);
}

TEST(MotorBurn, PropellantFallsByTheIntegralOfTheFlow) {
  const MotorBurn burn = BuildBurn(RampedStage(), 1.0, 1.0);
  const double step = 0.01;
  double left = 4000.0;
  for (int i = 0; i < 4125; ++i) {
    // The ramps' corners fall on steps, so the midpoint rule is exact.
    left -= step * burn.full_flow_kg_s * burn.Fraction((i + 0.5) * step);
    ASSERT_NEAR(burn.Propellant((i + 1) * step), left, 1e-8) << "at step " << i;
  }
  EXPECT_NEAR(left, 0.0, 1e-8);
}

TEST(MotorBurn, ThrustFactorKeepsPropellantAndTimeFlowFactorShortensTheBurn) {
  const MotorBurn stronger = BuildBurn(RampedStage(), 1.02, 1.0);
  EXPECT_DOUBLE_EQ(stronger.vacuum_thrust_n, 204e3);
  EXPECT_DOUBLE_EQ(stronger.duration_s, 41.25);
  const MotorBurn faster = BuildBurn(RampedStage(), 1.0, 1.25);
  EXPECT_DOUBLE_EQ(faster.full_flow_kg_s, 125.0);
  EXPECT_DOUBLE_EQ(faster.propellant_mass_kg, 4000.0);
  EXPECT_DOUBLE_EQ(faster.duration_s, 32.0 + 1.25);
  EXPECT_NEAR(faster.Propellant(faster.duration_s - 2.0), 125.0, 1e-9);
}

}  // namespace
}  // namespace dispersa
