// Thrust and propellant of a burn: the trapezoid's area, its ends, and the flight's factors.
#include "core/vehicle/propulsion.h"

#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::vehicle_propulsion_test {
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

// Uneven pieces, a rise, a sag, a tail: 0.5 * 0.5 * 200 + 9.5 * 190 + 20 * 150 + 10 * 110 + 0.5 * 2.5 * 100
// kN s.
Stage CurvedStage() {
  Stage stage = SampleVehicle().stages[0];
  SetThrustCurve({{0.0, 0.5, 10.0, 30.0, 40.0, 42.5}, {0.0, 200e3, 180e3, 120e3, 100e3, 0.0}}, stage.motor);
  return stage;
}
constexpr double kCurveImpulse_n_s = 50e3 + 1805e3 + 3000e3 + 1100e3 + 125e3;

TEST(ThrustCurve, ImpulseIsItsArea) {
  const Stage stage = CurvedStage();
  EXPECT_DOUBLE_EQ(stage.motor.thrust_curve.Impulse(), kCurveImpulse_n_s);
  EXPECT_EQ(stage.motor.thrust_n, 200e3);
  EXPECT_DOUBLE_EQ(stage.motor.burning_time_s, kCurveImpulse_n_s / 200e3);
}

// Thrust and flow of shapes of their own: the exhaust gets slower while the flow grows.
TEST(MotorBurn, FollowsTheFlowThatIsGiven) {
  Stage stage = SampleVehicle().stages[0];
  SetThrustCurve({{0.0, 10.0, 40.0}, {200e3, 180e3, 0.0}, {80.0, 100.0, 100.0}}, stage.motor);  // 3900 kg
  const MotorBurn burn = BuildBurn(stage, 1.0, 1.0);
  EXPECT_EQ(burn.duration_s, 40.0);
  EXPECT_DOUBLE_EQ(burn.full_flow_kg_s, 100.0 * 4000.0 / 3900.0);
  EXPECT_DOUBLE_EQ(burn.ExhaustVelocity(), (1900e3 + 2700e3) / 4000.0);
  const double scale = 4000.0 / 3900.0;  // what flows is the propellant
  EXPECT_NEAR(burn.Propellant(5.0), 4000.0 - scale * (80.0 * 5.0 + 0.5 * 2.0 * 25.0), 1e-9);
  EXPECT_NEAR(burn.Propellant(10.0), scale * 3000.0, 1e-9);
  EXPECT_NEAR(burn.Propellant(39.0), scale * 100.0, 1e-9);
  EXPECT_EQ(burn.Propellant(40.0), 0.0);
  EXPECT_NEAR(burn.vacuum_thrust_n * burn.Fraction(25.0), 90e3, 1e-9);
  const MotorBurn faster = BuildBurn(stage, 1.1, 1.1);
  EXPECT_DOUBLE_EQ(faster.duration_s, 40.0 / 1.1);
  EXPECT_NEAR(faster.Propellant(10.0 / 1.1), scale * 3000.0, 1e-9);
  EXPECT_DOUBLE_EQ(faster.ExhaustVelocity(), burn.ExhaustVelocity());
}

TEST(ThrustCurve, AtSeaLevelGainsPressureTimesAreaWhereItBurns) {
  const ThrustCurve curve = InVacuum({{0.0, 1.0, 2.0}, {0.0, 1000.0, 0.0}}, 0.1);
  EXPECT_EQ(curve.thrust_n, (std::vector<double>{0.0, 1000.0 + 10132.5, 0.0}));
}

TEST(MotorBurn, FollowsTheCurveAndUsesThePropellantUpAtItsEnd) {
  const MotorBurn burn = BuildBurn(CurvedStage(), 1.0, 1.0);
  EXPECT_EQ(burn.duration_s, 42.5);
  EXPECT_DOUBLE_EQ(burn.full_flow_kg_s, 4000.0 * 200e3 / kCurveImpulse_n_s);
  for (const auto& [time_s, thrust_n] : {std::pair{0.0, 0.0},
                                         {0.25, 100e3},
                                         {0.5, 200e3},
                                         {5.25, 190e3},
                                         {20.0, 150e3},
                                         {40.0, 100e3},
                                         {41.25, 50e3},
                                         {42.5, 0.0}})
    EXPECT_NEAR(burn.vacuum_thrust_n * burn.Fraction(time_s), thrust_n, 1e-9) << "at " << time_s << " s";
  EXPECT_EQ(burn.Propellant(0.0), 4000.0);
  EXPECT_EQ(burn.Propellant(42.5), 0.0);
  EXPECT_EQ(burn.Fraction(42.5 + 1e-9), 0.0);
  // The propellant burnt is proportional to the impulse given, at corners and within pieces.
  const double per_n_s = 4000.0 / kCurveImpulse_n_s;
  EXPECT_NEAR(burn.Propellant(0.25), 4000.0 - per_n_s * 12.5e3, 1e-9);
  EXPECT_NEAR(burn.Propellant(10.0), 4000.0 - per_n_s * 1855e3, 1e-9);
  EXPECT_NEAR(burn.Propellant(20.0), 4000.0 - per_n_s * (1855e3 + 1650e3), 1e-9);
  EXPECT_NEAR(burn.Propellant(41.25), per_n_s * 0.5 * 1.25 * 50e3, 1e-9);
  EXPECT_EQ(burn.Kinks(-3.0), (std::vector<double>{-2.5, 7.0, 27.0, 37.0}));
}

TEST(MotorBurn, BurnRateDrawsTheCurveTogetherAndKeepsItsImpulse) {
  const double r = 1.25;
  const MotorBurn burn = BuildBurn(CurvedStage(), r, r);
  EXPECT_DOUBLE_EQ(burn.duration_s, 42.5 / r);
  EXPECT_EQ(burn.Kinks(0.0), (std::vector<double>{0.4, 8.0, 24.0, 32.0}));
  EXPECT_NEAR(burn.vacuum_thrust_n * burn.Fraction(16.0), r * 150e3, 1e-9);
  // The midpoint rule is exact between corners, which fall on its steps.
  const double step_s = 0.1;
  double impulse_n_s = 0.0, left_kg = 4000.0;
  for (int i = 0; i < 340; ++i) {
    const double level = burn.Fraction((i + 0.5) * step_s);
    impulse_n_s += step_s * burn.vacuum_thrust_n * level;
    left_kg -= step_s * burn.full_flow_kg_s * level;
    ASSERT_NEAR(burn.Propellant((i + 1) * step_s), left_kg, 1e-8) << "at step " << i;
  }
  EXPECT_NEAR(impulse_n_s, kCurveImpulse_n_s, 1e-6 * kCurveImpulse_n_s * 1e-3);
  EXPECT_NEAR(left_kg, 0.0, 1e-8);
  const MotorBurn stronger = BuildBurn(CurvedStage(), 1.02, 1.0);
  EXPECT_EQ(stronger.duration_s, 42.5);
  EXPECT_DOUBLE_EQ(stronger.vacuum_thrust_n, 204e3);
}

}  // namespace
}  // namespace dispersa::vehicle_propulsion_test
