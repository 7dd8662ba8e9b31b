// Rate gyros: start, rounding and sampling of one, and blending of several, stage by stage.
#include "core/flight/lane_sensors.h"
#include "core/flight/tick_sample.h"
#include "core/math/functions.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::flight_gyros_test {
namespace {

constexpr double kTick_s = 0.01;

// One gyro in one lane.
struct Gyro {
  GyroModel model;
  lanes::GyroMemory<double> memory = {};

  double Step(double rate_rad_s, bool fresh = false, bool sampled = true, bool acting = true) {
    lanes::StepGyro<double>(model, acting, fresh, sampled, {rate_rad_s, 2.0 * rate_rad_s, -rate_rad_s},
                            memory);
    return memory.output_rad_s.x;
  }
};
Gyro Filtered(double frequency_rad_s = 40.0, double damping = 0.7) {
  Gyro gyro;
  gyro.model.section = RampInvariant(frequency_rad_s, damping, kTick_s);
  return gyro;
}

TEST(StepGyro, StartsAtRestInItsRate) {
  for (Gyro gyro : {Gyro{}, Filtered(), Filtered(5.0, 0.2)}) {
    gyro.memory = {{7.0, 7.0, 7.0}, {-3.0, -3.0, -3.0}, {9.0, 9.0, 9.0}};  // of the stage before
    EXPECT_NEAR(gyro.Step(0.3, true), 0.3, 1e-14);
    // A gyro of unit gain at rest stays there: 1e-13 is the rounding of 500 steps.
    for (int k = 0; k < 500; ++k) ASSERT_NEAR(gyro.Step(0.3), 0.3, 1e-13) << k;
    EXPECT_NEAR(gyro.memory.output_rad_s.y, 0.6, 1e-13);
    EXPECT_NEAR(gyro.memory.output_rad_s.z, -0.3, 1e-13);
  }
}

// y'' + 2 zeta w y' + w² (y - u) = 0 from rest in u0, u = u0 + r t: y = u0 + r (t - 2 zeta / w) plus what
// rings.
TEST(StepGyro, FollowsARampFromItsStart) {
  const double w = 40.0, zeta = 0.7, u0 = -0.2, r = 0.05;
  Gyro gyro = Filtered(w, zeta);
  const double d = w * std::sqrt(1.0 - zeta * zeta), lag = 2.0 * zeta / w;
  for (int k = 0; k < 60; ++k) {
    const double t = k * kTick_s, e = std::exp(-zeta * w * t);
    const double exact =
        u0 + r * (t - lag + e * (lag * std::cos(d * t) + (zeta * w * lag - 1.0) / d * std::sin(d * t)));
    EXPECT_NEAR(gyro.Step(u0 + r * t, k == 0), exact, 1e-14) << k;
  }
}

TEST(StepGyro, RoundsToTheNearestStep) {
  Gyro gyro;
  gyro.model.quantum_rad_s = 0.01;
  const double shown[][2] = {{0.016, 0.02},   {0.014, 0.01},   {0.004, 0.0},
                             {0.0, 0.0},      {-0.004, 0.0},   {-0.006, -0.01},
                             {-0.014, -0.01}, {-0.016, -0.02}, {123.4567, 123.46}};
  for (const auto& [rate, output] : shown) EXPECT_NEAR(gyro.Step(rate), output, 1e-12) << rate;
  // Over a whole number of steps nearest values err by nothing in the mean; cut-off ones by half a step.
  double sum = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const double rate = -0.05 + 0.1 * (k + 0.5) / 1000.0, error = gyro.Step(rate) - rate;
    EXPECT_LE(std::fabs(error), 0.005 * (1.0 + 1e-9)) << rate;
    sum += error;
  }
  EXPECT_NEAR(sum / 1000.0, 0.0, 1e-9);
}

TEST(StepGyro, HoldsItsOutputBetweenSamplesAndGoesOnInside) {
  Gyro always = Filtered(), sampled = Filtered();
  double held = 0.0;
  for (int k = 0; k < 40; ++k) {
    const double rate = std::sin(0.2 * k);
    const bool is_sample = k % 3 == 0;
    const double shown = sampled.Step(rate, k == 0, is_sample), inside = always.Step(rate, k == 0);
    if (is_sample) held = inside;
    EXPECT_EQ(shown, held) << k;
  }
}

TEST(StepGyro, IsReadAtItsStartWhetherThatIsASampleOrNot) {
  Gyro gyro = Filtered();
  EXPECT_NEAR(gyro.Step(0.25, true, false), 0.25, 1e-15);
}

TEST(StepGyro, StandsStillWhereItDoesNotAct) {
  Gyro gyro = Filtered();
  gyro.Step(0.1, true);
  gyro.Step(0.2);
  const lanes::GyroMemory<double> before = gyro.memory;
  gyro.Step(5.0, false, true, false);
  EXPECT_EQ(gyro.memory.first.x, before.first.x);
  EXPECT_EQ(gyro.memory.second.x, before.second.x);
  EXPECT_EQ(gyro.memory.output_rad_s.x, before.output_rad_s.x);
}

// Neither the attitude nor the time of a lane that does not measure moves.
TEST(InertialUnit, StandsStillInLanesThatDoNotMeasure) {
  lanes::InertialUnit<double> unit{};
  const double believed[] = {1.0, 0.0, 0.0, 0.0};
  const lanes::Turn<double> at_start{1.0, 0.0, 0.0, 0.0}, later{0.0, 1.0, 0.0, 0.0};
  unit.Start(0, at_start, believed);
  unit.drift_rad_s = {0.01, 0.0, 0.0};
  unit.Measure(false, 5.0, later);
  EXPECT_EQ(unit.time_s, 0.0);
  EXPECT_EQ(unit.measured.w, 1.0);
  EXPECT_EQ(unit.truth.w, 1.0);
  // So that its next measurement covers all the time since: twice 0.01 rad in 2 s.
  unit.Measure(true, 2.0, at_start);
  EXPECT_EQ(unit.time_s, 2.0);
  EXPECT_NEAR(2.0 * unit.measured.x, 0.02, 1e-6);
}

TEST(BuildSensors, SharesCountInTheStagesThatTheyName) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  vehicle.sensors.rate_gyros = {{"a", 1.0, 200.0, 0.5, 0.01, 3}, {"b", 2.0, 0.0, 0.7, 0.0, 1}};
  AutopilotConfig autopilot = LoadAutopilot(DISPERSA_CAMPAIGNS "/autopilots/pd.yaml");
  autopilot.rate_gyros = {{"b", 0.25, 1}, {"a", 0.75, 1}, {"a", 1.0, 3}};
  const SensorModel model = BuildSensors(vehicle, autopilot);
  EXPECT_TRUE(model.uses_gyros);
  ASSERT_EQ(model.stages.size(), 4u);
  const double expected[4][3] = {{0.75, 0.25, 0.0}, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  for (std::size_t stage = 0; stage < 4; ++stage) {
    EXPECT_EQ(model.stages[stage].gyro[0], expected[stage][0]) << stage;
    EXPECT_EQ(model.stages[stage].gyro[1], expected[stage][1]) << stage;
    EXPECT_EQ(model.stages[stage].unit, expected[stage][2]) << stage;
  }
  ASSERT_EQ(model.gyros.size(), 2u);
  EXPECT_EQ(model.gyros[0].quantum_rad_s, 0.01);
  EXPECT_EQ(model.gyros[0].sample_ticks, 3);
  EXPECT_EQ(model.gyros[1].sample_ticks, 1);
  EXPECT_LT(model.gyros[0].section.b0, 1.0) << "it lags";
  EXPECT_EQ(model.gyros[1].section.b0, 1.0) << "it follows at once";

  autopilot.rate_gyros = {{"b", 1.0, 0}};
  for (const SensorModel::Weights& weights : BuildSensors(vehicle, autopilot).stages) {
    EXPECT_EQ(weights.gyro[1], 1.0);
    EXPECT_EQ(weights.unit, 0.0);
  }
}

TEST(GyroProblems, RefuseWeightsAboveAndBelowOneInAnyStage) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  vehicle.sensors.rate_gyros = {{"a", 1.0, 0.0, 0.7, 0.0, 1}, {"b", 2.0, 0.0, 0.7, 0.0, 1}};
  AutopilotConfig autopilot = LoadAutopilot(DISPERSA_CAMPAIGNS "/autopilots/pd.yaml");
  const auto text = [&](std::vector<GyroShare> shares) {
    autopilot.rate_gyros = std::move(shares);
    std::string all;
    for (const StructProblem& p : GyroProblems(vehicle, autopilot))
      all += p.path + ": " + p.message + ", allowed: " + p.allowed + "\n";
    return all;
  };
  const std::string allowed =
      ", allowed: weights that sum to 1 in each stage, or none: then the inertial unit gives the rates\n";
  EXPECT_EQ(text({{"a", 0.75, 2}, {"b", 0.25, 2}}), "");
  EXPECT_EQ(text({{"a", 1.25, 2}, {"b", -0.25, 2}}), "") << "weights may be extrapolations";
  EXPECT_EQ(text({{"a", 0.75, 2}, {"b", 0.5, 2}}),
            "rate_gyros: the weights of stage 2 sum to 1.250000" + allowed);
  EXPECT_EQ(text({{"a", 1.0, 0}, {"b", 0.01, 3}}),
            "rate_gyros: the weights of stage 3 sum to 1.010000" + allowed);
  EXPECT_EQ(text({{"a", 0.99, 4}}), "rate_gyros: the weights of stage 4 sum to 0.990000" + allowed);
}

FlightDefinition WithGyros(std::vector<RateGyro> gyros, std::vector<GyroShare> shares) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "pd");
  definition.vehicle.sensors.rate_gyros = std::move(gyros);
  definition.autopilot.rate_gyros = std::move(shares);
  return definition;
}

// A rigid body turns everywhere alike, so gyros without lag and steps measure what the inertial unit
// measures: the same flight to the bit, in the coasts too, whichever stages they serve and however they
// share.
TEST(FlightGyros, PerfectOnesFlyAsTheInertialUnitDoes) {
  const FlightResult by_unit = Fly(FlightModel(Slv4Definition(DISPERSA_CAMPAIGNS, "pd")), Table3Inputs());
  ASSERT_EQ(by_unit.outcome, Outcome::kCompleted);
  const std::vector<RateGyro> gyros = {{"a", 1.0, 0.0, 0.7, 0.0, 1}, {"b", 2.0, 0.0, 0.7, 0.0, 1}};
  const std::vector<std::vector<GyroShare>> all = {
      {{"a", 1.0, 0}}, {{"a", 1.0, 3}}, {{"b", 0.25, 1}, {"a", 0.75, 1}, {"b", 1.0, 3}}};
  for (const std::vector<GyroShare>& shares : all)
    EXPECT_EQ(Fly(FlightModel(WithGyros(gyros, shares)), Table3Inputs()).digest, by_unit.digest)
        << shares.size();
}

// A gyro with steps coarser than any rate measures zero, so its weight reduces the rate by that share. The PD
// law's command shows the rate that it got.
TEST(FlightGyros, WeightsAreThoseOfTheStageThatBurns) {
  const double kCoarse_rad_s = 1e3;
  const FlightDefinition definition =
      WithGyros({{"perfect", 1.0, 0.0, 0.7, 0.0, 1}, {"blind", 2.0, 0.0, 0.7, kCoarse_rad_s, 1}},
                {{"perfect", 1.2, 1}, {"blind", -0.2, 1}, {"perfect", 0.9, 2}, {"blind", 0.1, 2}});
  const double part[] = {1.2, 0.9, 1.0, 1.0};
  const FlightModel model(definition);
  double compared[4] = {};
  FlightOptions options;
  options.observe = [&](const TickSample& s) {
    if (!s.burning) return;
    const std::size_t stage = static_cast<std::size_t>(s.stack);
    const AxisGains& gains = definition.autopilot.pitch.gains[stage];
    const double measured = s.error.rate_rad_s.y() + (1.0 - part[stage]) * s.state.w_IB_B.y();
    const double command = gains.kp_1_s2 * s.error.angle_rad.y() + gains.kd_1_s * measured;
    // Rounding of an error that is the difference of nearly equal attitudes.
    EXPECT_NEAR(s.gimbal.telemetry[kPitch].command_rad_s2, command, 1e-10) << s.time_s;
    compared[stage] += std::fabs(s.state.w_IB_B.y());
  };
  EXPECT_EQ(Fly(model, Table3Inputs(), options).outcome, Outcome::kCompleted);
  for (const double sum : compared) EXPECT_GT(sum, 0.1) << "the vehicle turns, so the weights show";
}

}  // namespace
}  // namespace dispersa::flight_gyros_test
