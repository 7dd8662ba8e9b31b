// Delays, lift-off errors and errors by components: their effect on a flight in almost no air.
#include "core/flight/flight.h"
#include "core/flight/sequence.h"
#include "core/math/constants.h"
#include "core/math/rotation.h"
#include "tests/flown_ticks.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_sequence_dispersions_test {
namespace {

// The first tick of a stack, burning or not.
const TickSample& First(const std::vector<TickSample>& ticks, int stack, bool burning) {
  return *std::find_if(ticks.begin(), ticks.end(),
                       [&](const TickSample& s) { return s.stack == stack && s.burning == burning; });
}

FlightDefinition TriggeredBySeparation() {
  FlightDefinition definition = HighDefinition();
  definition.vehicle.stages[1].ignition = IgnitionTrigger::kBurnoutDetection;
  definition.vehicle.stages[1].ignition_delay_s = 1.0;
  return definition;
}

TEST(Delays, MoveWhatTheyTriggerAndNothingBefore) {
  FlightInputs inputs;
  inputs.stages[0].separation_delay_s = 0.3;
  inputs.stages[1].ignition_delay_s = 0.7;
  const Vehicle vehicle = TriggeredBySeparation().vehicle;
  const std::vector<MotorBurn> burns = {BuildBurn(vehicle.stages[0], 1.0, 1.0),
                                        BuildBurn(vehicle.stages[1], 1.0, 1.0)};
  const auto nominal = BuildTimeline(vehicle, burns, 0.01, 0.0),
             late = BuildTimeline(vehicle, burns, 0.01, 0.0, {}, inputs);
  EXPECT_EQ(late[0].burnout_s, nominal[0].burnout_s);
  EXPECT_NEAR(late[0].separation_s, nominal[0].separation_s + 0.3, 1e-12);
  EXPECT_NEAR(late[1].ignition_s, nominal[1].ignition_s + 1.0, 1e-12);
  EXPECT_NEAR(late[1].burnout_s, nominal[1].burnout_s + 1.0, 1e-12);
  // Nothing happens before what triggers it.
  inputs.stages[0].separation_delay_s = -9.0;
  inputs.stages[1].ignition_delay_s = -9.0;
  const auto early = BuildTimeline(vehicle, burns, 0.01, 0.0, {}, inputs);
  EXPECT_EQ(early[0].separation_s, 40.0);
  EXPECT_EQ(early[1].ignition_s, 40.0);
  // The first stage ignites when it ignites.
  inputs.stages[0].ignition_delay_s = 3.0;
  EXPECT_EQ(BuildTimeline(vehicle, burns, 0.01, 0.0, {}, inputs)[0].ignition_s, 0.0);
}

TEST(Delays, OfATimerAddToIt) {
  FlightInputs inputs;
  inputs.stages[1].ignition_delay_s = 0.25;
  const Vehicle vehicle = SampleVehicle();
  const std::vector<MotorBurn> burns = {BuildBurn(vehicle.stages[0], 1.0, 1.0),
                                        BuildBurn(vehicle.stages[1], 1.0, 1.0)};
  EXPECT_EQ(BuildTimeline(vehicle, burns, 0.01, 60.0, {}, inputs)[1].ignition_s, 60.25);
}

// Until it ignites the vehicle falls freely: it is slower by gravitation times the delay, and has gone on
// with the speed that it had.
TEST(Delays, LetTheVehicleFall) {
  FlightInputs inputs;
  inputs.stages[1].ignition_delay_s = 2.0;
  const FlightDefinition definition = HighDefinition();
  const TickSample nominal = First(TicksOf(definition, {}), 1, true),
                   late = First(TicksOf(definition, inputs), 1, true);
  EXPECT_NEAR(nominal.time_s, 60.0, 1e-9);
  EXPECT_NEAR(late.time_s, 62.0, 1e-9);
  const Vector3& p = nominal.state.p_EoC_I;
  const Vector3 g = -Wgs84().mu_m3_s2 / std::pow(p.norm(), 3) * p;
  const Vector3 slowed = late.state.v_IC_I - nominal.state.v_IC_I;
  // The field's second harmonic and its change along 2 s of path: some thousandths.
  EXPECT_NEAR((slowed - 2.0 * g).norm() / (2.0 * g).norm(), 0.0, 4e-3);
  const Vector3 moved = late.state.p_EoC_I - p;
  EXPECT_NEAR((moved - 2.0 * nominal.state.v_IC_I - 2.0 * g).norm() / moved.norm(), 0.0, 1e-3);
}

// Launched at 45 deg of pitch, so that an azimuth shows.
FlightDefinition Slanted() {
  FlightDefinition definition = HighDefinition();
  definition.program.knots = {{.time_s = 0.0, .pitch = 0.25 * kPi}, {.time_s = 200.0, .pitch = 0.25 * kPi}};
  return definition;
}

TEST(LaunchAzimuthError, TurnsTheWholeFlight) {
  constexpr double kError_rad = 0.02;
  FlightInputs inputs;
  inputs.launch_azimuth_error_rad = kError_rad;
  const FlightModel model(Slanted());
  const auto nominal = TicksOf(Slanted(), {}), turned = TicksOf(Slanted(), inputs);
  const Matrix3 R_LI = RotationMatrix(model.frame().q_IL).transpose();
  for (const std::size_t tick : {std::size_t{0}, std::size_t{1000}, std::size_t{3500}}) {
    // The body's axis in the launch frame: x downrange, y right.
    const Vector3 x_L = R_LI * Rotate(turned[tick].state.q_IB, Vector3::UnitX());
    EXPECT_NEAR(std::atan2(x_L.y(), x_L.x()), kError_rad, 1e-4) << tick;
    // The autopilot takes its measurement for right, so nothing turns the vehicle back.
    EXPECT_NEAR(turned[tick].error.angle_rad.norm(), kError_rad, 1e-3) << tick;
  }
  // The velocity gained to the right is that gained downrange, times the sine of the error.
  const Vector3 gained_n = R_LI * (nominal[3500].state.v_IC_I - nominal[0].state.v_IC_I);
  const Vector3 gained_t = R_LI * (turned[3500].state.v_IC_I - turned[0].state.v_IC_I);
  EXPECT_GT(gained_n.x(), 100.0);
  EXPECT_NEAR((gained_t.y() - gained_n.y()) / gained_n.x(), std::sin(kError_rad), 1e-2 * kError_rad);
}

TEST(InitialAttitudeError, IsThereAtLiftOffAndIsTakenOut) {
  FlightInputs inputs;
  inputs.initial_roll_error_rad = 0.004;
  inputs.initial_pitch_error_rad = -0.01;
  inputs.initial_yaw_error_rad = 0.006;
  const auto ticks = TicksOf(HighDefinition(), inputs);
  // Reference less true, about the body's axes.
  EXPECT_NEAR((ticks[0].error.angle_rad - Vector3(-0.004, 0.01, -0.006)).norm(), 0.0, 1e-4);
  EXPECT_NEAR(ticks[0].error.rate_rad_s.norm(),
              First(TicksOf(HighDefinition(), {}), 0, true).error.rate_rad_s.norm(), 1e-5);
  // PD with 16 1/s² and 7 1/s: four seconds are more than eight of its time constants.
  EXPECT_LT(ticks[400].error.angle_rad.norm(), 3e-4);
}

TEST(Components, AreWhatMagnitudeAndClockStandFor) {
  const FlightModel model(SampleDefinition());
  FlightInputs polar, parts;
  constexpr double kClock = 2.5;
  const double cosine = std::cos(kClock), sine = std::sin(kClock);
  polar.stages[0].thrust.misalignment_rad.magnitude = 0.01;
  polar.stages[0].thrust.offset_m.magnitude = 0.005;
  polar.stages[0].cg_offset_m.magnitude = 0.02;
  polar.stages[0].nozzles[2].line.misalignment_rad.magnitude = 0.003;
  polar.stages[0].nozzles[2].line.offset_m.magnitude = 0.001;
  polar.stages[0].thrust.misalignment_rad.clock_rad = polar.stages[0].thrust.offset_m.clock_rad =
      polar.stages[0].cg_offset_m.clock_rad = kClock;
  polar.stages[0].nozzles[2].line.misalignment_rad.clock_rad =
      polar.stages[0].nozzles[2].line.offset_m.clock_rad = kClock;
  parts.stages[0].thrust.misalignment_rad.y = 0.01 * cosine;
  parts.stages[0].thrust.misalignment_rad.z = 0.01 * sine;
  parts.stages[0].thrust.offset_m.y = 0.005 * cosine;
  parts.stages[0].thrust.offset_m.z = 0.005 * sine;
  parts.stages[0].cg_offset_m.y = 0.02 * cosine;
  parts.stages[0].cg_offset_m.z = 0.02 * sine;
  parts.stages[0].nozzles[2].line.misalignment_rad.y = 0.003 * cosine;
  parts.stages[0].nozzles[2].line.misalignment_rad.z = 0.003 * sine;
  parts.stages[0].nozzles[2].line.offset_m.y = 0.001 * cosine;
  parts.stages[0].nozzles[2].line.offset_m.z = 0.001 * sine;
  const LauncherStack a = model.PlantFor(polar).stacks[0], b = model.PlantFor(parts).stacks[0];
  EXPECT_GT((a.thrust_tilt - Matrix3::Identity()).norm(), 0.01);
  EXPECT_NEAR((a.thrust_tilt - b.thrust_tilt).norm(), 0.0, 1e-16);
  EXPECT_NEAR((a.nozzles[2].tilt - b.nozzles[2].tilt).norm(), 0.0, 1e-16);
  EXPECT_NEAR(a.thrust_offset_y_m, b.thrust_offset_y_m, 1e-17);
  EXPECT_NEAR(a.thrust_offset_z_m, b.thrust_offset_z_m, 1e-17);
  EXPECT_NEAR(a.nozzles[2].offset_y_m, b.nozzles[2].offset_y_m, 1e-18);
  EXPECT_NEAR(a.lateral_moment_y_kg_m, b.lateral_moment_y_kg_m, 1e-12);
  EXPECT_NEAR(a.lateral_moment_z_kg_m, b.lateral_moment_z_kg_m, 1e-12);
  // Both together add.
  FlightInputs both = parts;
  both.stages[0].thrust.offset_m.magnitude = 0.005;
  both.stages[0].thrust.offset_m.clock_rad = kClock;
  EXPECT_NEAR(model.PlantFor(both).stacks[0].thrust_offset_y_m, 2.0 * a.thrust_offset_y_m, 1e-17);
}

}  // namespace
}  // namespace dispersa::flight_sequence_dispersions_test
