// The effect of each input on the plant and on the flight. The sample vehicle flies above the air.
#include "core/flight/flight.h"
#include "core/math/constants.h"
#include "tests/flown_ticks.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_dispersions_test {

using Layout = std::array<double, kLauncherSize>;

// Pointing up over the equator, at rest in the inertial frame, so that the air flows by from the west.
Layout Above(double altitude_m) {
  RigidBodyState state;
  state.p_EoC_I = {Wgs84().equatorial_radius_m + altitude_m, 0.0, 0.0};
  Layout y{};
  WriteState(state, y.data());
  return y;
}

LauncherPhase Burning() {
  LauncherPhase phase;
  phase.burning = true;
  return phase;
}

LauncherInstant InstantOf(const FlightInputs& inputs, double altitude_m) {
  const FlightModel model(SampleDefinition());
  return LauncherModel(model.PlantFor(inputs)).Evaluate(Burning(), 10.0, Above(altitude_m).data());
}

constexpr double kSpace_m = 2e6;  // above the atmosphere's end

TEST(Dispersions, MisalignmentTiltsTheThrustTowardsItsClockAngle) {
  FlightInputs inputs;
  inputs.stages[0].thrust.misalignment_rad.magnitude = 0.01;
  for (const double clock : {0.0, 0.5 * kPi, 2.5}) {
    inputs.stages[0].thrust.misalignment_rad.clock_rad = clock;
    const LauncherInstant now = InstantOf(inputs, kSpace_m);
    const Vector3 expected(std::cos(0.01), std::sin(0.01) * std::cos(clock),
                           std::sin(0.01) * std::sin(clock));
    EXPECT_NEAR((now.loads.force_n / 200e3 - expected).norm(), 0.0, 1e-14) << clock;
    // Behind the CG: thrust to the right turns the nose left, thrust downwards turns it up.
    const double lever = 19.5 - now.cg_station_m;
    const Vector3 moment = Vector3(-lever, 0.0, 0.0).cross(200e3 * expected);
    EXPECT_NEAR((now.loads.moment_n_m - moment).norm(), 0.0, 1e-8) << clock;
  }
}

TEST(Dispersions, ThrustOffsetGivesAMomentTowardsItsClockAngle) {
  FlightInputs inputs;
  inputs.stages[0].thrust.offset_m.magnitude = 0.005;
  for (const double clock : {0.0, 0.5 * kPi, 2.5}) {
    inputs.stages[0].thrust.offset_m.clock_rad = clock;
    const LauncherInstant now = InstantOf(inputs, kSpace_m);
    EXPECT_NEAR(now.loads.moment_n_m.y(), 200e3 * 0.005 * std::sin(clock), 1e-9) << clock;
    EXPECT_NEAR(now.loads.moment_n_m.z(), -200e3 * 0.005 * std::cos(clock), 1e-9) << clock;
    EXPECT_EQ(now.loads.force_n.x(), 200e3);
  }
}

// One nozzle alone, its quarter of 200 kN turned, moved and strengthened; radius and pivot of the sample
// vehicle.
TEST(Dispersions, EachNozzleHasItsOwnThrust) {
  const LauncherInstant straight = InstantOf({}, kSpace_m);
  const double radius = FlightModel(SampleDefinition()).PlantFor({}).stacks[0].gimbal.radius_m;
  const double lever = 19.5 - straight.cg_station_m;
  const Vector3 place[] = {
      {-lever, radius, 0.0}, {-lever, -radius, 0.0}, {-lever, 0.0, radius}, {-lever, 0.0, -radius}};
  for (std::size_t nozzle = 0; nozzle < kNozzles; ++nozzle) {
    FlightInputs inputs;
    inputs.stages[0].nozzles[nozzle].line.misalignment_rad.magnitude = 0.01;
    inputs.stages[0].nozzles[nozzle].line.misalignment_rad.clock_rad = 0.7;
    inputs.stages[0].nozzles[nozzle].line.offset_m.magnitude = 0.02;
    inputs.stages[0].nozzles[nozzle].line.offset_m.clock_rad = 2.5;
    inputs.stages[0].nozzles[nozzle].thrust_factor = 1.03;
    const LauncherInstant now = InstantOf(inputs, kSpace_m);
    const Vector3 nominal(50e3, 0.0, 0.0);
    const Vector3 force =
        1.03 * 50e3 * Vector3(std::cos(0.01), std::sin(0.01) * std::cos(0.7), std::sin(0.01) * std::sin(0.7));
    const Vector3 moved(0.0, 0.02 * std::cos(2.5), 0.02 * std::sin(2.5));
    const Vector3 moment = (place[nozzle] + moved).cross(force) - place[nozzle].cross(nominal);
    EXPECT_NEAR((now.loads.force_n - straight.loads.force_n - (force - nominal)).norm(), 0.0, 1e-9) << nozzle;
    EXPECT_NEAR((now.loads.moment_n_m - straight.loads.moment_n_m - moment).norm(), 0.0, 1e-8) << nozzle;
    EXPECT_GT(std::fabs(now.loads.moment_n_m.x()), 1.0) << nozzle;
    EXPECT_EQ(now.flow_kg_s, straight.flow_kg_s);
  }
}

// The centre of gravity of what does not burn is given; the propellant, about the axis, draws it back.
TEST(Dispersions, ACentreOfGravityOffTheAxisGivesThrustAndDragALever) {
  FlightInputs inputs;
  inputs.stages[0].cg_offset_m.magnitude = 0.01;
  const LauncherPlant nominal = FlightModel(SampleDefinition()).PlantFor({});
  for (const double clock : {0.0, 0.5 * kPi, 2.5}) {
    inputs.stages[0].cg_offset_m.clock_rad = clock;
    const LauncherInstant in_space = InstantOf(inputs, kSpace_m);
    const double aside = 0.01 * nominal.stacks[0].mass.fixed_mass_kg /
                         in_space.loads.mass_kg;  // the inertia's own is left out
    EXPECT_LT(aside, 0.009);
    // The thrust passes the CG on the other side.
    EXPECT_NEAR(in_space.loads.moment_n_m.y(), -200e3 * aside * std::sin(clock), 1e-9) << clock;
    EXPECT_NEAR(in_space.loads.moment_n_m.z(), 200e3 * aside * std::cos(clock), 1e-9) << clock;
    const Vector3 axis_from_cg(0.0, -aside * std::cos(clock), -aside * std::sin(clock));
    const LauncherInstant low = InstantOf(inputs, 5e3), straight = InstantOf({}, 5e3);
    const Vector3 expected = axis_from_cg.cross(straight.loads.force_n);
    EXPECT_GT(std::fabs(straight.loads.force_n.x() - 200e3), 1.0);
    EXPECT_NEAR((low.loads.moment_n_m - straight.loads.moment_n_m - expected).norm(), 0.0, 1e-8) << clock;
  }
}

TEST(Dispersions, TheUpperStackLeavesWithTheVelocityOfItsOwnOffsetCg) {
  FlightInputs inputs;
  inputs.stages[1].cg_offset_m.magnitude = 0.02;
  const LauncherPlant offset = FlightModel(SampleDefinition()).PlantFor(inputs),
                      straight = FlightModel(SampleDefinition()).PlantFor({});
  RigidBodyState state;
  state.w_IB_B = {0.1, 0.0, 0.0};
  const StackMass& upper = offset.stacks[1].mass;
  const double aside = 0.02 * upper.fixed_mass_kg / (upper.fixed_mass_kg + upper.propellant_mass_kg);
  const RigidBodyState off = AfterSeparation(offset, 0, 0u, state),
                       on = AfterSeparation(straight, 0, 0u, state);
  EXPECT_NEAR((off.p_EoC_I - on.p_EoC_I - Vector3(0.0, aside, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((off.v_IC_I - on.v_IC_I - Vector3(0.0, 0.0, 0.1 * aside)).norm(), 0.0, 1e-15);
}

TEST(Dispersions, EachStageHasItsOwnThrust) {
  FlightInputs inputs;
  inputs.stages[1].thrust.misalignment_rad.magnitude = 0.01;
  inputs.stages[1].thrust.offset_m.magnitude = 0.005;
  inputs.stages[1].thrust_factor = 1.1;
  const LauncherPlant plant = FlightModel(SampleDefinition()).PlantFor(inputs);
  EXPECT_EQ(plant.stacks[0].thrust_tilt, Matrix3(Matrix3::Identity()));
  EXPECT_EQ(plant.stacks[0].thrust_offset_y_m, 0.0);
  EXPECT_EQ(plant.stacks[0].burn.vacuum_thrust_n, 200e3);
  EXPECT_GT(plant.stacks[1].thrust_tilt(1, 0), 0.0099);
  EXPECT_EQ(plant.stacks[1].thrust_offset_y_m, 0.005);
  EXPECT_DOUBLE_EQ(plant.stacks[1].burn.vacuum_thrust_n, 55e3);
}

// `conserve: total_impulse` multiplies flow with thrust, `conserve: propellant` thrust alone; neither changes
// the propellant, and a specific impulse is thrust at the same flow.
TEST(Dispersions, WhatThrustConserves) {
  const FlightModel model(SampleDefinition());
  FlightInputs total_impulse, propellant, specific_impulse;
  total_impulse.stages[0].thrust_factor = total_impulse.stages[0].mass_flow_factor = 1.02;
  propellant.stages[0].thrust_factor = specific_impulse.stages[0].specific_impulse_factor = 1.02;
  const MotorBurn faster = model.PlantFor(total_impulse).stacks[0].burn;
  EXPECT_DOUBLE_EQ(faster.vacuum_thrust_n, 1.02 * 200e3);
  EXPECT_DOUBLE_EQ(faster.full_flow_kg_s, 1.02 * 100.0);
  EXPECT_DOUBLE_EQ(faster.duration_s, 40.0 / 1.02);
  EXPECT_DOUBLE_EQ(faster.vacuum_thrust_n * faster.duration_s, 200e3 * 40.0);
  for (const FlightInputs& inputs : {propellant, specific_impulse}) {
    const MotorBurn stronger = model.PlantFor(inputs).stacks[0].burn;
    EXPECT_DOUBLE_EQ(stronger.vacuum_thrust_n, 1.02 * 200e3);
    EXPECT_EQ(stronger.full_flow_kg_s, 100.0);
    EXPECT_EQ(stronger.duration_s, 40.0);
  }
  for (const FlightInputs& inputs : {total_impulse, propellant, specific_impulse})
    EXPECT_EQ(model.PlantFor(inputs).stacks[0].burn.propellant_mass_kg, 4000.0);
}

TEST(Launcher, AmbientPressureTakesItsPartOfTheThrust) {
  FlightDefinition definition = SampleDefinition();
  definition.vehicle.stages[0].motor.nozzle_exit_area_m2 = 0.5;
  LauncherPlant plant = FlightModel(definition).PlantFor({});
  const auto thrust = [&](double altitude_m) {
    return LauncherModel(plant).Evaluate(Burning(), 10.0, Above(altitude_m).data()).thrust_n;
  };
  // The standard's pressure at sea level and at 11 km of geopotential altitude.
  EXPECT_NEAR(thrust(0.0), 200e3 - 0.5 * 101325.0, 1e-3);
  EXPECT_NEAR(thrust(11019.1), 200e3 - 0.5 * 22632.0, 1.0);
  EXPECT_EQ(thrust(kSpace_m), 200e3);
  plant.stacks[0].burn.exit_area_m2 = 3.0;
  EXPECT_EQ(thrust(0.0), 0.0) << "a nozzle does not pull";
}

TEST(Dispersions, DensityFactorMultipliesAirAndDynamicPressure) {
  FlightInputs inputs;
  inputs.air.density_factor = 1.1;
  const AirData nominal = InstantOf({}, 12e3).air, dense = InstantOf(inputs, 12e3).air;
  EXPECT_GT(nominal.qbar_pa, 1000.0);
  EXPECT_NEAR(dense.density_kg_m3 / nominal.density_kg_m3, 1.1, 1e-14);
  EXPECT_NEAR(dense.qbar_pa / nominal.qbar_pa, 1.1, 1e-14);
  EXPECT_EQ(dense.mach, nominal.mach);
}

TEST(Dispersions, DensityProfileOfTheEnvironmentIsMultiplied) {
  FlightInputs inputs;
  inputs.air.density_factor = 1.1;
  LauncherPlant plant = FlightModel(SampleDefinition()).PlantFor(inputs);
  plant.environment.density.by_altitude = {{10e3, 14e3}, {1.0, 1.4}};
  const AirData air = LauncherModel(plant).Evaluate(Burning(), 10.0, Above(12e3).data()).air;
  EXPECT_NEAR(air.density_kg_m3 / InstantOf({}, 12e3).air.density_kg_m3, 1.1 * 1.2, 1e-12);
}

TEST(Dispersions, AGustBlowsFromItsAzimuthAtItsAltitudes) {
  FlightInputs inputs;
  inputs.air.gust_speed_m_s = 9.0;
  inputs.air.gust_altitude_m = 11000.0;
  inputs.air.gust_length_m = 2000.0;
  inputs.air.gust_azimuth_rad = 0.5 * kPi;  // from the east, towards -y here
  const auto change = [&](double altitude_m) -> Vector3 {
    return InstantOf(inputs, altitude_m).air.v_AP_I - InstantOf({}, altitude_m).air.v_AP_I;
  };
  // 1 - cosine: its full speed half way.
  EXPECT_NEAR((change(12000.0) - Vector3(0.0, 9.0, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((change(11500.0) - Vector3(0.0, 4.5, 0.0)).norm(), 0.0, 1e-5);
  EXPECT_EQ(change(10900.0), Vector3(0.0, 0.0, 0.0));
  EXPECT_EQ(change(13100.0), Vector3(0.0, 0.0, 0.0));
}

TEST(Dispersions, CgAndInertiaAreMultiplied) {
  FlightInputs inputs;
  inputs.cg_factor = 0.9;
  inputs.inertia_factor = 1.2;
  const LauncherInstant nominal = InstantOf({}, kSpace_m), changed = InstantOf(inputs, kSpace_m);
  EXPECT_DOUBLE_EQ(changed.cg_station_m, 0.9 * nominal.cg_station_m);
  // Inertia is held where the CG moves.
  EXPECT_NEAR((changed.loads.inertia_kg_m2 - 1.2 * nominal.loads.inertia_kg_m2).norm(), 0.0, 1e-9);
  EXPECT_NEAR((changed.loads.inertia_rate_kg_m2_s - 1.2 * nominal.loads.inertia_rate_kg_m2_s).norm(), 0.0,
              1e-9);
}

TEST(Dispersions, BandwidthOfTheActuators) {
  FlightInputs inputs;
  inputs.actuator_bandwidth_factor = 0.5;
  LauncherPhase phase = Burning();
  phase.command_rad = {0.01, 0.01, 0.0, 0.0};
  const FlightModel model(SampleDefinition());
  const auto acceleration = [&](const FlightInputs& in) {
    Layout dydt{};
    LauncherModel(model.PlantFor(in)).Derivative(phase, 10.0, Above(kSpace_m).data(), dydt.data());
    return dydt[kNozzleRate];
  };
  // From rest: w² times the command.
  EXPECT_DOUBLE_EQ(acceleration({}), 25.0 * 25.0 * 0.01);
  EXPECT_DOUBLE_EQ(acceleration(inputs), 12.5 * 12.5 * 0.01);
}

const TickSample& TickAt(const std::vector<TickSample>& ticks, double time_s) {
  return *std::find_if(ticks.begin(), ticks.end(),
                       [&](const TickSample& s) { return s.time_s > time_s - 1e-6; });
}

TEST(Dispersions, TipOffIsAddedAsTheStageSeparates) {
  FlightInputs inputs;
  inputs.stages[0].tip_off_roll_rad_s = 0.01;
  inputs.stages[0].tip_off_pitch_rad_s = -0.02;
  inputs.stages[0].tip_off_yaw_rad_s = 0.03;
  const auto nominal = TicksOf(HighDefinition(), {}), tipped = TicksOf(HighDefinition(), inputs);
  // Burnout at 40 s, separation half a second later, on a tick.
  EXPECT_EQ(TickAt(tipped, 40.49).state.w_IB_B, TickAt(nominal, 40.49).state.w_IB_B);
  const Vector3 added = TickAt(tipped, 40.5).state.w_IB_B - TickAt(nominal, 40.5).state.w_IB_B;
  EXPECT_NEAR((added - Vector3(0.01, -0.02, 0.03)).norm(), 0.0, 1e-16);
}

TEST(Dispersions, AStuckNozzleStaysInItsStageAlone) {
  FlightInputs inputs;
  inputs.stuck_nozzle = 3.0;
  inputs.stuck_nozzle_stage = 1.0;
  inputs.stuck_nozzle_rad = 1.0 * kRadPerDeg;
  const auto ticks = TicksOf(HighDefinition(), inputs);
  double others = 0.0;
  bool second_burned = false;
  for (const TickSample& s : ticks) {
    if (!s.burning) continue;
    if (s.stack == 0) {
      EXPECT_EQ(s.nozzle_rad[2], 1.0 * kRadPerDeg) << s.time_s;
      others = std::max(others, std::fabs(s.nozzle_rad[3]));
    } else if (s.since_ignition_s > 5.0) {
      second_burned = true;
      EXPECT_LT(std::fabs(s.nozzle_rad[2]), 0.1 * kRadPerDeg) << s.time_s;
    }
  }
  // Its twin on the other side holds the yaw and pays with roll.
  EXPECT_GT(others, 0.9 * kRadPerDeg);
  EXPECT_TRUE(second_burned);
}

// The attitude is integrated from the gyros, so a biased autopilot follows the reference in what it measures
// and leaves bias times time in truth.
TEST(Dispersions, AGyroBiasDriftsTheAttitude) {
  FlightInputs inputs;
  inputs.sensors.gyro_bias_yaw_rad_s = 0.01 * kRadPerDeg;
  const auto nominal = TicksOf(HighDefinition(), {}), biased = TicksOf(HighDefinition(), inputs);
  for (const double t : {20.0, 35.0}) {
    const Vector3 drift = TickAt(biased, t).error.angle_rad - TickAt(nominal, t).error.angle_rad;
    EXPECT_NEAR(drift.z() / (0.01 * kRadPerDeg * t), 1.0, 0.02) << t;
    EXPECT_NEAR(drift.y(), 0.0, 1e-5) << t;
  }
}

// At lift-off nothing but the noise differs: it reaches the yaw command through the rate gain.
TEST(Dispersions, GyroNoiseHasItsStandardDeviation) {
  const FlightModel model(HighDefinition());
  FlightInputs inputs;
  inputs.sensors.gyro_noise_rad_s = 0.002;
  // Falls back at once: only the first tick counts.
  inputs.stages[0].thrust_factor = 0.1;
  FlightInputs quiet = inputs;
  quiet.sensors.gyro_noise_rad_s = 0.0;
  const auto command = [&](const FlightInputs& in, std::uint64_t case_index) {
    std::vector<double> yaw;
    FlightOptions options;
    options.case_index = case_index;
    options.observe = [&](const TickSample& sample) { yaw.push_back(sample.gimbal.yaw_rad); };
    Fly(model, in, options);
    return yaw.front();
  };
  const double effectiveness = model.autopilot().stages[0].pitch_effectiveness_1_s2.y.front();
  const double rate_gain = model.definition().autopilot.yaw.gains[0].kd_1_s;
  constexpr int kCases = 200;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kCases; ++i) {
    const double change = command(inputs, static_cast<std::uint64_t>(i)) - command(quiet, 0);
    const double noise = change * effectiveness / rate_gain / 0.002;
    sum += noise;
    squares += noise * noise;
  }
  // Of standard normals: four standard errors of their mean and of their mean square.
  EXPECT_NEAR(sum / kCases, 0.0, 4.0 / std::sqrt(kCases));
  EXPECT_NEAR(squares / kCases, 1.0, 4.0 * std::sqrt(2.0 / kCases));
}

// A gyro that samples at every tick turns the believed attitude by a random walk, in the coast as under
// thrust: sigma sqrt(tick t). The reaction control looks at every fifth tick, and holds what is believed
// within a deadband that is small beside the walk of 0.23 deg.
TEST(Dispersions, GyroNoiseIsARandomWalkOfEveryTickInTheCoastToo) {
  FlightDefinition definition = HighDefinition();
  definition.last_ignition_s = 130.0;
  definition.program.knots.back().time_s = 300.0;
  definition.autopilot.reaction_control = {
      .deadband_rad = 0.05 * kRadPerDeg, .rate_gain_s = 0.1, .hysteresis = 0.5, .cycle_ticks = 5};
  const FlightModel model(definition);
  constexpr int kCases = 60;
  constexpr double kNoise_rad_s = 0.2 * kRadPerDeg;
  double squares = 0.0, time_s = 0.0;
  for (int i = 0; i < kCases; ++i) {
    FlightInputs inputs;
    inputs.sensors.gyro_noise_rad_s = kNoise_rad_s;
    FlightOptions options;
    options.case_index = static_cast<std::uint64_t>(i);
    Vector3 error = Vector3::Zero();
    options.observe = [&](const TickSample& sample) {
      if (!sample.coasting) return;
      error = sample.error.angle_rad;
      time_s = sample.time_s;
    };
    ASSERT_NE(Fly(model, inputs, options).outcome, Outcome::kLostControl);
    squares += error.squaredNorm();
  }
  ASSERT_GT(time_s, 125.0);
  const double walk = kNoise_rad_s * std::sqrt(definition.autopilot.tick_s * time_s);
  // Four standard errors of the mean square of 180 normals; a sample a cycle would give five times as much.
  EXPECT_NEAR(squares / (3 * kCases) / (walk * walk), 1.0, 4.0 * std::sqrt(2.0 / (3 * kCases)));
}

}  // namespace dispersa::flight_dispersions_test
