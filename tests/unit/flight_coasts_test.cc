// Coasts before stages other than the last: timed ignition and reaction control, in six degrees of freedom
// and in the optimiser's point mass.
#include "core/flight/flight.h"
#include "core/flight/tick_sample.h"
#include "core/math/constants.h"
#include "core/trajectory/ascent.h"
#include "core/trajectory/optimize.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_coasts_test {

// The sample with a small third stage: burns of 40, 20 and 10 s.
FlightDefinition ThreeStages() {
  FlightDefinition definition = HighDefinition();
  Vehicle& vehicle = definition.vehicle;
  Stage third = vehicle.stages[1];
  third.name = "third";
  third.liftoff_mass_kg = 1200.0;
  third.propellant_mass_kg = 400.0;
  third.bottom_station_m = 5.0;
  third.motor = {};
  third.motor.thrust_n = 30e3;
  third.motor.burning_time_s = 10.0;
  third.grain = {2.0, 4.0, 0.8, 0.3};
  third.structure = {{"all", 1.0, 1.0, 4.8, 0.9, 0.8}};
  third.gimbal.pivot_station_m = 4.7;
  vehicle.stages.push_back(third);
  vehicle.aerodynamics.push_back(SampleTable());
  for (AxisConfig* axis :
       {&definition.autopilot.roll, &definition.autopilot.pitch, &definition.autopilot.yaw}) {
    axis->gains.push_back({25.0, 9.0});
    axis->adaptation.gamma.push_back(1000.0);
    axis->integral.ki_1_s3.push_back(12.0);
  }
  vehicle.reaction_control.thrust_n = 100.0;
  definition.earlier_ignition_s = {0.0, 60.0};
  definition.last_ignition_s = 95.0;
  return definition;
}

struct Flown {
  FlightResult result;
  std::vector<TickSample> ticks;
};
Flown FlyWithTipOff(const FlightDefinition& definition) {
  Flown flown;
  FlightInputs inputs;
  inputs.stages[0].tip_off_pitch_rad_s = inputs.stages[0].tip_off_roll_rad_s = 1.0 * kRadPerDeg;
  FlightOptions options;
  options.observe = [&](const TickSample& s) { flown.ticks.push_back(s); };
  flown.result = Fly(FlightModel(definition), inputs, options);
  return flown;
}

TEST(Coasts, ATimerOfAnyStageBeginsAfterACoastThatTheReactionControlHolds) {
  const FlightDefinition definition = ThreeStages();
  EXPECT_TRUE(Problems(definition.vehicle).empty());
  const Flown flown = FlyWithTipOff(definition);
  ASSERT_EQ(flown.result.outcome, Outcome::kCompleted) << flown.result.reason;
  double worst = 0.0, burning_s[3] = {}, begins_s[3] = {1e9, 1e9, 1e9};
  bool fired[3] = {};
  for (const TickSample& s : flown.ticks) {
    const std::size_t stage = static_cast<std::size_t>(s.stack);
    if (s.burning) {
      burning_s[stage] += definition.autopilot.tick_s;
      begins_s[stage] = std::min(begins_s[stage], s.time_s);
      continue;
    }
    // From separation to ignition, of both upper stages; not from burnout to separation.
    EXPECT_EQ(s.coasting, s.stack == 2 || (s.stack == 1 && s.time_s < 60.0)) << s.time_s;
    if (s.coasting && s.time_s > 50.0) worst = std::max(worst, s.error.angle_rad.norm());
    for (const int thruster : s.thrusters) fired[stage] |= thruster != 0;
  }
  EXPECT_NEAR(begins_s[1], 60.0, 0.011);
  EXPECT_NEAR(begins_s[2], 95.0, 0.011);
  EXPECT_NEAR(burning_s[1], 20.0, 0.03);
  EXPECT_NEAR(burning_s[2], 10.0, 0.03);
  EXPECT_TRUE(fired[1]);
  EXPECT_FALSE(fired[0]);
  EXPECT_LT(worst, 1.0 * kRadPerDeg);
}

// The same pause without a timer is none of the reaction control's business: a degree a second for 20 s.
TEST(Coasts, ADelayIsNoCoast) {
  FlightDefinition definition = ThreeStages();
  definition.vehicle.stages[1].ignition = IgnitionTrigger::kBurnoutDetection;
  definition.vehicle.stages[1].ignition_delay_s = 19.5;
  const Flown flown = FlyWithTipOff(definition);
  EXPECT_EQ(flown.result.outcome, Outcome::kLostControl);
  for (const TickSample& s : flown.ticks) EXPECT_FALSE(s.coasting);
}

// Both models burn the same seconds, and the point mass's timers are what the flight is given.
TEST(Coasts, ThePointMassCoastsBeforeTheSameStages) {
  const FlightDefinition definition = ThreeStages();
  EXPECT_EQ(EarlierCoasts(definition.vehicle), std::vector<std::size_t>{1});
  const AscentModel model = BuildAscentModel(definition.vehicle, definition.autopilot.tick_s);
  FlightProgram program =
      ProgramOf({0.02, 5.0, 8.0, 15.0, 15.0, 0.5 * kPi, 20.0}, VariablesOf(definition.vehicle, {}));
  EXPECT_EQ(program.earlier_coast_s[1], 20.0);
  AscentOptions options;
  options.record = true;
  const AscentResult ascent = FlyAscent(model, program, options);
  ASSERT_TRUE(ascent.completed);
  EXPECT_DOUBLE_EQ(ascent.earlier_ignition_s[1], 60.0);  // 20 s after the burnout at 40 s
  EXPECT_DOUBLE_EQ(ascent.last_ignition_s, 95.0);        // 15 s after that at 80 s
  EXPECT_NEAR(ascent.end_time_s, 105.0, 1e-9);
  bool thrust_in_coast = false, thrust_after = false;
  for (const AscentSample& s : ascent.samples) {
    if (s.time_s > 41.0 && s.time_s < 59.0) thrust_in_coast |= s.axial_load_g > 0.01;
    if (s.time_s > 60.5 && s.time_s < 79.5) thrust_after |= s.axial_load_g > 1.0;
  }
  EXPECT_FALSE(thrust_in_coast);
  EXPECT_TRUE(thrust_after);
  // A longer coast of the middle stage moves what follows by as much.
  program.earlier_coast_s[1] = 22.0;
  EXPECT_DOUBLE_EQ(FlyAscent(model, program, options).last_ignition_s, 97.0);
}

}  // namespace dispersa::flight_coasts_test
