// Engines that burn again or are cut off at a velocity, and steered upper stages: masses and speeds follow by
// conservation, the point mass and the flight of six degrees of freedom do the same at the same times.
#include "core/campaign_yaml/load.h"
#include "core/flight/flight.h"
#include "core/flight/tick_sample.h"
#include "core/math/constants.h"
#include "core/trajectory/ascent.h"
#include "tests/liquid_stage.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::restart_flight_test {
namespace {

constexpr std::size_t kFirstBurn = 3, kSecondBurn = 4;
constexpr double kPause_s = 100.0;

// The coast before the first burn is shorter than the reference's, which takes most of a flight.
FlightProgram Program() {
  FlightProgram program = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program;
  program.earlier_coast_s[kFirstBurn] = 60.0;
  program.coast_s = kPause_s;
  return program;
}

// SLV-4 with a liquid last stage of the same masses, which burns twice; `end_first` says how the first burn
// ends.
template <class F>
Vehicle Restarting(F end_first, const char* file = "slv4.yaml") {
  Vehicle vehicle = LoadVehicle(std::string(DISPERSA_CAMPAIGNS "/vehicles/") + file);
  MakeLiquid(vehicle.stages[kFirstBurn]);
  Stage again = vehicle.stages[kFirstBurn];
  again.restarts = true;
  end_first(vehicle.stages[kFirstBurn].motor);
  vehicle.stages.push_back(again);
  if (vehicle.structure_beam) vehicle.structure_beam->stages.push_back(vehicle.structure_beam->stages.back());
  return vehicle;
}
Vehicle CutAtHalfTime(const char* file = "slv4.yaml") {
  Vehicle vehicle = Restarting(
      [](Motor& engine) {
        engine.cut_off = CutOff::kAtTime;
        engine.cut_off_s = 0.5 * engine.burning_time_s;
      },
      file);
  Stage& again = vehicle.stages[kSecondBurn];
  again.liftoff_mass_kg -= 0.5 * again.propellant_mass_kg;
  again.propellant_mass_kg *= 0.5;
  again.motor.burning_time_s *= 0.5;
  for (Tank& tank : again.tanks) tank.propellant_mass_kg *= 0.5;
  return vehicle;
}
Vehicle CutAtVelocity(double first_m_s) {
  return Restarting([&](Motor& engine) {
    engine.cut_off = CutOff::kAtVelocity;
    engine.cut_off_velocity_m_s = first_m_s;
  });
}

AscentResult Ascend(const Vehicle& vehicle, const FlightProgram& program = Program(),
                    double step_factor = 1.0) {
  AscentOptions options;
  options.record = true;
  options.steps = {step_factor * options.steps.air_s, step_factor * options.steps.burn_s,
                   step_factor * options.steps.coast_s};
  return FlyAscent(BuildAscentModel(vehicle, 0.01), program, options);
}

// In six degrees of freedom along the point mass's ascent.
FlightDefinition Following(const Vehicle& vehicle, const AscentResult& ascent,
                           const char* autopilot = "adaptive_fuzzy") {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, autopilot);
  definition.vehicle = vehicle;
  definition.program = ascent.attitude;
  definition.last_ignition_s = ascent.last_ignition_s;
  definition.earlier_ignition_s = ascent.earlier_ignition_s;
  definition.cut_off_s = ascent.cut_off_s;
  for (AxisConfig* axis :
       {&definition.autopilot.roll, &definition.autopilot.pitch, &definition.autopilot.yaw}) {
    if (axis->gains.size() == 4) axis->gains.push_back(axis->gains.back());
    if (axis->adaptation.gamma.size() == 4) axis->adaptation.gamma.push_back(axis->adaptation.gamma.back());
    if (axis->integral.ki_1_s3.size() == 4) axis->integral.ki_1_s3.push_back(axis->integral.ki_1_s3.back());
  }
  return definition;
}

struct Burns {
  FlightResult result;
  double begin_s[kMaxStages], end_s[kMaxStages], begin_kg[kMaxStages], end_kg[kMaxStages],
      end_m_s[kMaxStages];
};
Burns FlyBurns(const FlightDefinition& definition, const FlightInputs& inputs,
               Scheme scheme = Scheme::kSimpson) {
  Burns burns{};
  History history;
  history.step_s = 1e6;  // events alone
  FlightOptions options;
  options.scheme = scheme;
  options.history = &history;
  burns.result = Fly(FlightModel(definition), inputs, options);
  const auto column = [](const char* name) { return FindHistoryColumn(name); };
  for (std::size_t row = 1; row < history.rows(); ++row) {
    const auto stage = static_cast<std::size_t>(history.at(row, column("stage"))) - 1;
    const auto at = [&](const char* name) { return history.at(row, column(name)); };
    const double speed_m_s = std::hypot(at("eci_vx_m_s"), at("eci_vy_m_s"), at("eci_vz_m_s"));
    if (burns.begin_s[stage] == 0.0 && at("thrust_n") > 0.0) {
      burns.begin_s[stage] = at("time_s");
      burns.begin_kg[stage] = at("mass_kg");
    } else if (burns.begin_s[stage] > 0.0 && burns.end_s[stage] == 0.0 && at("thrust_n") == 0.0) {
      burns.end_s[stage] = at("time_s");
      burns.end_kg[stage] = at("mass_kg");
      burns.end_m_s[stage] = speed_m_s;
    }
  }
  return burns;
}

// What is left in the tanks is what burns again, and not a gram leaves in between but the reaction control's.
TEST(Restart, BurnsWhatTheFirstBurnLeft) {
  const Vehicle vehicle = CutAtHalfTime();
  ASSERT_TRUE(Problems(vehicle).empty()) << Problems(vehicle).front().message;
  const AscentResult ascent = Ascend(vehicle);
  ASSERT_TRUE(ascent.completed);
  const FlightDefinition definition = Following(vehicle, ascent);
  FlightInputs inputs;
  for (const double flow : {1.0, 1.03}) {
    inputs.stages[kFirstBurn].mass_flow_factor = flow;
    const Burns burns = FlyBurns(definition, inputs);
    ASSERT_EQ(burns.result.outcome, Outcome::kCompleted) << burns.result.reason;
    const Stage& engine = vehicle.stages[kFirstBurn];
    const double expelled_kg = MetricOf(burns.result, "rcs_propellant_kg");
    EXPECT_NEAR(burns.end_s[kFirstBurn] - burns.begin_s[kFirstBurn], 0.5 * engine.motor.burning_time_s, 1e-9);
    EXPECT_NEAR(burns.begin_kg[kFirstBurn] - burns.end_kg[kFirstBurn], 0.5 * flow * engine.propellant_mass_kg,
                1e-6 * engine.propellant_mass_kg);
    EXPECT_LT(burns.end_kg[kFirstBurn] - burns.begin_kg[kSecondBurn], expelled_kg + 1e-9);
    EXPECT_GE(burns.end_kg[kFirstBurn] - burns.begin_kg[kSecondBurn], 0.0);
    // Empty at the end, whatever the first burn took.
    EXPECT_NEAR(burns.end_kg[kSecondBurn], engine.liftoff_mass_kg - engine.propellant_mass_kg - expelled_kg,
                1e-6);
    EXPECT_NEAR(burns.end_s[kSecondBurn] - burns.begin_s[kSecondBurn],
                (1.0 - 0.5 * flow) * engine.motor.burning_time_s, 1e-6);
  }
}

// A stack that bends bends on: nothing leaves at a restart, so its modes go on ringing, and its second burn
// has the modes of the first at the propellant that is left.
TEST(Restart, ABendingStackRingsOn) {
  Vehicle vehicle = CutAtHalfTime("slv4_flexible.yaml");
  // Soft enough for a mode of the last stack to fly.
  for (const std::size_t stage : {kFirstBurn, kSecondBurn})
    for (BeamSection& section : vehicle.structure_beam->stages[stage].sections) section.modulus_pa *= 0.1;
  ASSERT_TRUE(Problems(vehicle).empty()) << Problems(vehicle).front().message;
  const AscentResult ascent = Ascend(vehicle);
  ASSERT_TRUE(ascent.completed);
  const FlightDefinition definition = Following(vehicle, ascent, "flexible");
  const FlightModel model(definition);
  const std::vector<LauncherStack>& stacks = model.nominal_plant().stacks;
  ASSERT_TRUE(stacks[kFirstBurn].bending);
  EXPECT_EQ(stacks[kFirstBurn].bending, stacks[kSecondBurn].bending);
  std::vector<TickSample> samples;
  FlightOptions options;
  options.observe = [&](const TickSample& s) {
    if (s.stack >= static_cast<int>(kFirstBurn)) samples.push_back(s);
  };
  FlightInputs inputs;
  inputs.stages[kFirstBurn].thrust.misalignment_rad.magnitude =
      inputs.stages[kSecondBurn].thrust.misalignment_rad.magnitude = 0.25 * kRadPerDeg;
  ASSERT_EQ(Fly(model, inputs, options).outcome, Outcome::kCompleted);
  const auto next = std::find_if(samples.begin(), samples.end(),
                                 [](const TickSample& s) { return s.stack == int{kSecondBurn}; });
  ASSERT_TRUE(next != samples.begin() && next != samples.end());
  const auto ringing = [](const TickSample& s) {
    double sum = 0.0;
    for (const double value : s.bending) sum += std::fabs(value);
    return sum;
  };
  EXPECT_GT(ringing(*(next - 1)), 0.0);
  EXPECT_GT(ringing(*next), 0.2 * ringing(*(next - 1)));
  // Bent again by the second burn.
  EXPECT_GT(ringing(samples.back()), 1e-9);
}

// Without a pause the two burns are one: what is gained differs by gravity in the tick that detection takes.
TEST(Restart, WithoutAPauseIsOneBurn) {
  Vehicle twice = CutAtHalfTime();
  twice.stages[kSecondBurn].ignition = IgnitionTrigger::kBurnoutDetection;
  twice.stages[kSecondBurn].ignition_delay_s = twice.stages[kFirstBurn].separation_delay_s = 0.0;
  Vehicle once = twice;
  once.stages.pop_back();
  once.stages[kFirstBurn].motor.cut_off = CutOff::kAtDepletion;
  FlightProgram program = Program();
  const AscentResult of_two = Ascend(twice, program);
  program.coast_s = program.earlier_coast_s[kFirstBurn];
  const AscentResult of_one = Ascend(once, program);
  ASSERT_TRUE(of_two.completed && of_one.completed);
  EXPECT_NEAR(of_two.orbit.velocity_m_s, of_one.orbit.velocity_m_s, 0.1);
  EXPECT_NEAR(of_two.orbit.altitude_m, of_one.orbit.altitude_m, 50.0);
  EXPECT_NEAR(of_two.end_time_s, of_one.end_time_s, 0.0101);
}

// Whatever the engine gives, it ends at that speed; the burn after it has what is left.
TEST(CutOffAtVelocity, EndsAtThatSpeedInBothModels) {
  constexpr double kFirst_m_s = 6300.0, kSecond_m_s = 6900.0;
  Vehicle vehicle = CutAtVelocity(kFirst_m_s);
  Motor& second = vehicle.stages[kSecondBurn].motor;
  second.cut_off = CutOff::kAtVelocity;
  second.cut_off_velocity_m_s = kSecond_m_s;
  ASSERT_TRUE(Problems(vehicle).empty()) << Problems(vehicle).front().message;
  const AscentResult ascent = Ascend(vehicle), fine = Ascend(vehicle, Program(), 0.25);
  ASSERT_TRUE(ascent.completed);
  EXPECT_NEAR(ascent.orbit.velocity_m_s, kSecond_m_s, 1e-6);
  EXPECT_NEAR(fine.cut_off_s[kFirstBurn], ascent.cut_off_s[kFirstBurn], 1e-4);
  EXPECT_EQ(ascent.cut_off_s[0], HUGE_VAL);
  const FlightDefinition definition = Following(vehicle, ascent);
  const Stage& engine = vehicle.stages[kFirstBurn];
  for (const double thrust : {1.0, 0.97, 1.03}) {
    FlightInputs inputs;
    inputs.stages[kFirstBurn].thrust_factor = inputs.stages[kSecondBurn].thrust_factor = thrust;
    const Burns burns = FlyBurns(definition, inputs);
    ASSERT_EQ(burns.result.outcome, Outcome::kCompleted) << burns.result.reason;
    EXPECT_NEAR(burns.end_m_s[kFirstBurn], kFirst_m_s, 1e-3);
    EXPECT_NEAR(burns.end_m_s[kSecondBurn], kSecond_m_s, 1e-3);
    // Not on a tick.
    const double flown_s = burns.end_s[kFirstBurn] - burns.begin_s[kFirstBurn];
    const double flow_kg_s = engine.propellant_mass_kg / engine.motor.burning_time_s;
    EXPECT_NEAR(burns.begin_kg[kFirstBurn] - burns.end_kg[kFirstBurn], flow_kg_s * flown_s, 1e-6);
    const double again_s = burns.end_s[kSecondBurn] - burns.begin_s[kSecondBurn];
    EXPECT_NEAR(burns.begin_kg[kSecondBurn] - burns.end_kg[kSecondBurn], flow_kg_s * again_s, 1e-6);
    if (thrust == 1.0) {
      EXPECT_NEAR(flown_s, ascent.cut_off_s[kFirstBurn], 0.05);
      EXPECT_NEAR(again_s, ascent.cut_off_s[kSecondBurn], 0.05);
    } else {
      EXPECT_GT((flown_s - ascent.cut_off_s[kFirstBurn]) * (1.0 - thrust), 0.0);
    }
  }
  // The judges fly the same burns.
  const Burns own = FlyBurns(definition, {}), judge = FlyBurns(definition, {}, Scheme::kCvode);
  EXPECT_NEAR(own.end_s[kFirstBurn], judge.end_s[kFirstBurn], 1e-6);
  EXPECT_NEAR(own.end_kg[kSecondBurn], judge.end_kg[kSecondBurn], 1e-5);
}

// Six stages: three burns of the last one.
TEST(CutOffAtVelocity, OfThreeBurns) {
  Vehicle vehicle = CutAtVelocity(6200.0);
  vehicle.stages.push_back(vehicle.stages[kSecondBurn]);
  const double speeds_m_s[] = {6200.0, 6500.0, 6900.0};
  for (std::size_t i = 0; i < 3; ++i) {
    Motor& engine = vehicle.stages[kFirstBurn + i].motor;
    engine.cut_off = CutOff::kAtVelocity;
    engine.cut_off_velocity_m_s = speeds_m_s[i];
  }
  FlightProgram program = Program();
  program.earlier_coast_s[kSecondBurn] = 40.0;
  const AscentResult ascent = Ascend(vehicle, program);
  ASSERT_TRUE(ascent.completed);
  FlightDefinition definition = Following(vehicle, ascent);
  for (AxisConfig* axis :
       {&definition.autopilot.roll, &definition.autopilot.pitch, &definition.autopilot.yaw}) {
    if (axis->gains.size() == 5) axis->gains.push_back(axis->gains.back());
    if (axis->adaptation.gamma.size() == 5) axis->adaptation.gamma.push_back(axis->adaptation.gamma.back());
    if (axis->integral.ki_1_s3.size() == 5) axis->integral.ki_1_s3.push_back(axis->integral.ki_1_s3.back());
  }
  const Burns burns = FlyBurns(definition, {});
  ASSERT_EQ(burns.result.outcome, Outcome::kCompleted) << burns.result.reason;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(burns.end_m_s[kFirstBurn + i], speeds_m_s[i], 1e-3) << i;
  ASSERT_EQ(burns.result.metrics.size(), MetricNames().size());
  EXPECT_GT(MetricOf(burns.result, "pitch_error_peak_stage6_deg"), 0.0);
}

// A speed that it cannot reach is none: it burns to depletion, and nothing is left to burn again.
TEST(CutOffAtVelocity, OutOfReachIsDepletion) {
  const Vehicle vehicle = CutAtVelocity(20e3);
  const AscentResult ascent = Ascend(vehicle);
  ASSERT_TRUE(ascent.completed);
  EXPECT_EQ(ascent.cut_off_s[kFirstBurn], HUGE_VAL);
  const Burns burns = FlyBurns(Following(vehicle, ascent), {});
  EXPECT_EQ(burns.result.outcome, Outcome::kCompleted) << burns.result.reason;
  EXPECT_NEAR(burns.end_s[kFirstBurn] - burns.begin_s[kFirstBurn],
              vehicle.stages[kFirstBurn].motor.burning_time_s, 1e-9);
}

// Nose up by so much more than the gravity turn, from ignition to depletion; it climbs the higher for it.
TEST(Steering, IsTheIncidenceOfTheBurn) {
  const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  FlightProgram program = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program;
  const AscentResult straight = Ascend(vehicle, program);
  const double begin_rad = 6.0 * kRadPerDeg, end_rad = 2.0 * kRadPerDeg;
  program.steering[2] = {begin_rad, end_rad};
  const AscentResult steered = Ascend(vehicle, program);
  ASSERT_TRUE(straight.completed && steered.completed);
  EXPECT_GT(steered.orbit.altitude_m, straight.orbit.altitude_m + 10e3);
  const double whole_s = vehicle.stages[2].motor.burning_time_s;
  double ignition_s = 0.0, seen = 0.0;
  for (const AscentSample& s : steered.samples) {
    if (s.stage < 3) {
      EXPECT_TRUE(s.time_s < program.t2_s || s.alpha_rad == 0.0);
      continue;
    }
    if (s.stage > 3 || s.axial_load_g < 0.1) continue;
    if (ignition_s == 0.0) ignition_s = s.time_s;
    if (s.time_s < ignition_s + kSteeringRise_s) continue;
    const double part = (s.time_s - ignition_s) / whole_s;
    EXPECT_NEAR(s.alpha_rad, begin_rad + part * (end_rad - begin_rad), 1e-4);
    // Of the body's axis over the way through the air, in the plane of the ascent.
    const Vector3 relative = s.v_IC_I - Vector3(0.0, 0.0, Wgs84().rotation_rate_rad_s).cross(s.p_EoC_I);
    const LaunchFrame frame = BuildLaunchFrame(Wgs84(), vehicle.site, program.launch_azimuth_rad);
    const Vector3 axis =
        frame.R_IL * RotationMatrix(FromPitchYawRoll({s.pitch_rad, s.yaw_rad, s.roll_rad})).col(0);
    EXPECT_NEAR(std::acos(axis.dot(relative.normalized())), s.alpha_rad, 1e-6);
    EXPECT_GT(axis.dot(s.p_EoC_I.normalized()), relative.normalized().dot(s.p_EoC_I.normalized()));
    ++seen;
  }
  EXPECT_GT(seen, 20.0);
  // Faded before the last burn, after a long coast.
  for (const AscentSample& s : steered.samples) {
    if (s.stage == 4 && s.time_s > steered.last_ignition_s) {
      EXPECT_EQ(s.alpha_rad, 0.0);
    }
  }
  // The autopilot follows.
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  definition.program = steered.attitude;
  definition.last_ignition_s = steered.last_ignition_s;
  const FlightResult flown = Fly(FlightModel(definition), {}, {});
  ASSERT_EQ(flown.outcome, Outcome::kCompleted) << flown.reason;
  EXPECT_NEAR(MetricOf(flown, "injection_altitude_km"), 1e-3 * steered.orbit.altitude_m, 2.0);
}

// A burn after a cut-off at a velocity: how long it can last is known only when the burn before has ended.
TEST(Steering, OfARestartIsOverWhatTheBurnBeforeLeft) {
  const Vehicle vehicle = CutAtVelocity(6300.0);
  FlightProgram program = Program();
  const double begin_rad = 3.0 * kRadPerDeg, end_rad = 1.0 * kRadPerDeg;
  program.steering[kSecondBurn] = {begin_rad, end_rad};
  const AscentResult steered = Ascend(vehicle, program);
  ASSERT_TRUE(steered.completed);
  const double first_s = steered.cut_off_s[kFirstBurn];
  const double whole_s = vehicle.stages[kFirstBurn].motor.burning_time_s - first_s;
  ASSERT_GT(whole_s, 10.0);
  int seen = 0;
  for (const AscentSample& s : steered.samples) {
    ASSERT_TRUE(std::isfinite(s.alpha_rad)) << s.time_s;
    const double since_s = s.time_s - steered.last_ignition_s;
    if (s.stage != 5 || since_s <= 0.0) continue;
    const double x = std::min(since_s / kSteeringRise_s, 1.0),
                 risen = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
    EXPECT_NEAR(s.alpha_rad, risen * (begin_rad + since_s / whole_s * (end_rad - begin_rad)), 1e-6)
        << since_s;
    ++seen;
  }
  EXPECT_GT(seen, 10);
}

// Nothing is left to burn: nothing is steered.
TEST(Steering, OfARestartWithoutPropellantIsNone) {
  FlightProgram program = Program();
  program.steering[kSecondBurn] = {0.05, 0.02};
  const AscentResult depleted = Ascend(CutAtVelocity(20e3), program);
  ASSERT_TRUE(depleted.completed);
  for (const AscentSample& s : depleted.samples) ASSERT_TRUE(std::isfinite(s.alpha_rad)) << s.time_s;
}

}  // namespace
}  // namespace dispersa::restart_flight_test
