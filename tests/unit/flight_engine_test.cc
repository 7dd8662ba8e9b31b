// The engine at the joints of a flight: between thruster cycles, at ignition and burnout, and at its end.
#include "core/flight/flight.h"
#include "core/flight/lane_engine.h"
#include "core/flight/tick_sample.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_engine_test {
namespace {

struct Watched {
  FlightResult result;
  std::vector<TickSample> ticks;
};

Watched Watch(const FlightModel& model, const FlightInputs& inputs = {}) {
  Watched flight;
  FlightOptions options;
  options.observe = [&](const TickSample& s) { flight.ticks.push_back(s); };
  flight.result = Fly(model, inputs, options);
  return flight;
}

double MetricOf(const FlightResult& result, const char* name) { return result.metrics[MetricColumn(name)]; }

// Tumbling as it comes from the separation, so that thrusters fire through the whole coast.
FlightDefinition Busy(int cycle_ticks) {
  FlightDefinition definition = HighDefinition();
  definition.autopilot.reaction_control.cycle_ticks = cycle_ticks;
  definition.autopilot.reaction_control.deadband_rad = 1e-7;
  definition.last_ignition_s = 45.23;  // in the middle of a cycle
  return definition;
}
FlightInputs TipOff() {
  FlightInputs inputs;
  inputs.stages[0].tip_off_pitch_rad_s = 0.001;
  inputs.stages[0].tip_off_yaw_rad_s = -0.002;
  return inputs;
}

TEST(ReactionControl, ItsFlowCountsForAsLongAsItFires) {
  for (const int cycle : {1, 5, 7}) {
    const FlightModel model(Busy(cycle));
    const Watched flight = Watch(model, TipOff());
    ASSERT_EQ(flight.result.outcome, Outcome::kCompleted) << flight.result.reason;
    const ReactionControl& rcs = model.definition().vehicle.reaction_control;
    const double flow_kg_s = 2.0 * rcs.thrust_n / (rcs.specific_impulse_s * kStandardGravity);
    double expelled_kg = 0.0;
    bool longer_than_a_tick = false;
    for (std::size_t i = 0; i + 1 < flight.ticks.size(); ++i) {
      const TickSample& s = flight.ticks[i];
      if (!s.coasting) continue;
      const double lasts_s = flight.ticks[i + 1].time_s - s.time_s;
      longer_than_a_tick |= lasts_s > 0.011;
      for (const int direction : s.thrusters) expelled_kg += std::abs(direction) * flow_kg_s * lasts_s;
    }
    EXPECT_EQ(longer_than_a_tick, cycle > 1);
    EXPECT_GT(expelled_kg, 10.0 * flow_kg_s * 0.01);
    EXPECT_NEAR(MetricOf(flight.result, "rcs_propellant_kg"), expelled_kg, 1e-12);
  }
}

TEST(ReactionControl, IsShutAtIgnition) {
  const FlightModel model(Busy(5));
  const Watched flight = Watch(model, TipOff());
  const LauncherPlant& plant = model.nominal_plant();
  bool fired_to_the_end = false, burned = false;
  for (std::size_t i = 1; i < flight.ticks.size(); ++i) {
    const TickSample& before = flight.ticks[i - 1];
    const TickSample& s = flight.ticks[i];
    if (before.coasting && s.burning)
      for (const int direction : before.thrusters) fired_to_the_end |= direction != 0;
    if (s.stack == 0 || !s.burning) continue;
    burned = true;
    EXPECT_EQ(s.thrusters, (std::array<int, kAxes>{})) << s.time_s;
    // No moment is left of them either.
    double y[kLauncherSize];
    WriteState(s.state, y);
    for (std::size_t k = 0; k < kNozzles; ++k) {
      y[kNozzleAngle + k] = s.nozzle_rad[k];
      y[kNozzleRate + k] = s.nozzle_rate_rad_s[k];
    }
    LauncherPhase phase;
    phase.stack = s.stack;
    phase.burning = true;
    phase.ignition_s = s.time_s - s.since_ignition_s;
    phase.expelled_mass_kg = s.expelled_mass_kg;
    const Vector3 without = LauncherModel(plant).Evaluate(phase, s.time_s, y).loads.moment_n_m;
    ASSERT_LT((s.instant.loads.moment_n_m - without).norm(), 1e-9) << s.time_s;
  }
  EXPECT_TRUE(fired_to_the_end) << "the test is to find them open";
  EXPECT_TRUE(burned);
}

TEST(Loads, AreTakenAtBurnoutBetweenTicks) {
  FlightDefinition definition = HighDefinition();
  definition.vehicle.stages[1].motor.burning_time_s = 20.005;  // constant thrust to the end: lightest there
  const FlightModel model(definition);
  const Watched flight = Watch(model);
  ASSERT_EQ(flight.result.outcome, Outcome::kCompleted) << flight.result.reason;
  double at_ticks = 0.0;
  for (const TickSample& s : flight.ticks)
    if (!s.coasting)
      at_ticks = std::max(
          at_ticks, std::fabs(s.instant.loads.force_n.x() / (s.instant.loads.mass_kg * kStandardGravity)));
  const double at_burnout = 50e3 / (2000.0 * kStandardGravity);
  EXPECT_GT(at_burnout, at_ticks * (1.0 + 1e-5));
  EXPECT_NEAR(MetricOf(flight.result, "axial_load_max_g"), at_burnout, 1e-6 * at_burnout);
}

TEST(Digest, IsOfTheMetricsToo) {
  FlightDefinition definition = HighDefinition();
  const FlightModel a(definition);
  definition.kick_end_s = 39.0;  // deflections of stage 1 say nothing of ripple: the states do not know
  const FlightModel b(definition);
  FlightInputs inputs;
  for (StageInputs& stage : inputs.stages) stage.thrust.misalignment_rad.magnitude = 0.2 * kRadPerDeg;
  inputs.sensors.gyro_noise_rad_s = 0.05 * kRadPerDeg;
  const FlightResult one = Fly(a, inputs), other = Fly(b, inputs);
  ASSERT_NE(MetricOf(one, "deflection_ripple_deg"), MetricOf(other, "deflection_ripple_deg"));
  EXPECT_EQ(one.end_state.p_EoC_I, other.end_state.p_EoC_I);
  EXPECT_NE(one.digest, other.digest);
}

// A program that turns at a constant acceleration for the first 20 s, as long as it lasts.
FlightDefinition Turning(double acceleration_rad_s2) {
  FlightDefinition definition = HighDefinition();
  definition.program.knots.clear();
  for (int i = 0; i <= 4; ++i) {
    const double t = 5.0 * i;
    definition.program.knots.push_back({.time_s = t,
                                        .pitch = 0.5 * kPi + 0.5 * acceleration_rad_s2 * t * t,
                                        .pitch_rate = acceleration_rad_s2 * t});
  }
  return definition;
}

TEST(FeedForward, IsTheProgramsAccelerationOfTheAxesThatHaveIt) {
  FlightDefinition definition = Turning(0.002);
  EXPECT_TRUE(FlightModel(definition).feed_forward_rows().rows.empty());
  definition.autopilot.pitch.feed_forward = FeedForward{0.5};
  const FlightModel model(definition);
  const AlignedRows& rows = model.feed_forward_rows().rows;
  ASSERT_EQ(rows.size(), (model.reference_rows().last_tick + 1) * FeedForwardRows::kRowSize);
  // Each row is read 0.5 s ahead: to 19.49 s there is an acceleration, from then on the attitude is held.
  const auto pitch = [&](std::size_t tick) { return rows[FeedForwardRows::kRowSize * tick + kPitch]; };
  for (const std::size_t tick : {0u, 700u, 1948u}) EXPECT_NEAR(pitch(tick), 0.002, 1e-12) << tick;
  for (const std::size_t tick : {1951u, 2000u}) EXPECT_EQ(pitch(tick), 0.0) << tick;
  double of_others = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (i % FeedForwardRows::kRowSize != kPitch) of_others += std::fabs(rows[i]);
  EXPECT_EQ(of_others, 0.0);
  AutopilotConfig without = definition.autopilot;
  without.pitch.feed_forward.reset();
  EXPECT_TRUE(model.WithAutopilot(without).feed_forward_rows().rows.empty());
}

TEST(FeedForward, TakesTheErrorOfAnAcceleratingProgram) {
  FlightDefinition definition = Turning(0.002);
  definition.autopilot.pitch.law = ControlLaw::kPd;
  const auto error_at_15_s = [&] {
    return Watch(FlightModel(definition)).ticks[1500].error.angle_rad[kPitch];
  };
  // A PD law settles where kp e is the acceleration.
  const double kp = definition.autopilot.pitch.gains[0].kp_1_s2;
  EXPECT_NEAR(error_at_15_s(), 0.002 / kp, 0.1 * 0.002 / kp);
  definition.autopilot.pitch.feed_forward = FeedForward{0.066};
  EXPECT_LT(std::fabs(error_at_15_s()), 0.1 * 0.002 / kp);
}

TEST(EngineFor, HoldsTheFlightsInNoMoreLanesThanTheyNeed) {
  EXPECT_EQ(EngineFor(1).lanes, 1);
  EXPECT_EQ(EngineFor(3).lanes, 4);
  EXPECT_EQ(EngineFor(4).lanes, 4);
  for (const std::size_t flights : {1, 4, 5, 8, 1000}) {
    EXPECT_STREQ(EngineFor(flights).isa, ChosenEngine().isa);
    EXPECT_LE(EngineFor(flights).lanes, ChosenEngine().lanes);
  }
  EXPECT_EQ(EngineFor(1000).lanes, ChosenEngine().lanes);
}

TEST(FlyAll, KeepsTheOrderOfItsOrders) {
  const FlightModel model(HighDefinition());
  std::vector<FlightOrder> orders(11);
  for (std::size_t i = 0; i < orders.size(); ++i) {
    orders[i].inputs.stages[0].thrust_factor = 1.0 + 0.01 * static_cast<double>(i);
    if (i % 3 == 1) orders[i].inputs.stages[0].tip_off_yaw_rad_s = 61.0 * kRadPerDeg;  // ends early
  }
  const std::vector<FlightResult> flown = FlyAll(model, orders);
  ASSERT_EQ(flown.size(), orders.size());
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const FlightResult alone = Fly(model, orders[i].inputs);
    EXPECT_EQ(flown[i].digest, alone.digest) << i;
    EXPECT_EQ(flown[i].outcome, alone.outcome) << i;
  }
}

TEST(FlyAll, OfNothingIsNothing) { EXPECT_TRUE(FlyAll(FlightModel(HighDefinition()), {}).empty()); }

}  // namespace
}  // namespace dispersa::flight_engine_test
