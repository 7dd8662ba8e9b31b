// Times of ignition, burnout and separation of stages.
#include "core/flight/sequence.h"

#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_sequence_test {
namespace {

constexpr double kTick_s = 0.01;

std::vector<StageTimes> Timeline(const Vehicle& vehicle, double flow_factor, double last_ignition_s) {
  std::vector<MotorBurn> burns;
  for (const Stage& stage : vehicle.stages) burns.push_back(BuildBurn(stage, 1.0, flow_factor));
  return BuildTimeline(vehicle, burns, kTick_s, last_ignition_s);
}

TEST(BuildTimeline, BurnoutOnATickIsDetectedOnThatTick) {
  const auto t = Timeline(SampleVehicle(), 1.0, 60.0);
  EXPECT_EQ(t[0].ignition_s, 0.0);
  EXPECT_DOUBLE_EQ(t[0].burnout_s, 40.0);
  EXPECT_DOUBLE_EQ(t[0].separation_s, 40.5);
  EXPECT_EQ(t[1].ignition_s, 60.0);
  EXPECT_DOUBLE_EQ(t[1].burnout_s, 80.0);
  EXPECT_EQ(t[1].separation_s, t[1].burnout_s) << "the flight ends there";
}

TEST(BuildTimeline, BurnoutBetweenTicksIsExactAndDetectedOnTheNextOne) {
  const auto t = Timeline(SampleVehicle(), 40.0 / 40.003, 60.0);
  EXPECT_NEAR(t[0].burnout_s, 40.003, 1e-12);
  EXPECT_NEAR(t[0].separation_s, 40.01 + 0.5, 1e-12);
}

TEST(BuildTimeline, RoundingBehindATickDoesNotCostATick) {
  // Burnout within kSameInstant_s after the tick counts as on it.
  const auto t = Timeline(SampleVehicle(), 40.0 / (40.0 + 0.5e-9), 60.0);
  EXPECT_NEAR(t[0].separation_s, 40.5, 1e-12);
  const auto later = Timeline(SampleVehicle(), 40.0 / (40.0 + 1e-8), 60.0);
  EXPECT_NEAR(later[0].separation_s, 40.51, 1e-12);
}

TEST(BuildTimeline, DetectionTriggersIgnitionAfterSeparationAndDelay) {
  Vehicle vehicle = SampleVehicle();
  vehicle.stages[1].ignition = IgnitionTrigger::kBurnoutDetection;
  vehicle.stages[1].ignition_delay_s = 0.75;
  const auto t = Timeline(vehicle, 40.0 / 40.003, 60.0);
  EXPECT_NEAR(t[1].ignition_s, 40.01 + 0.5 + 0.75, 1e-12);
}

TEST(BuildTimeline, TimerIsExactAndNeverBeforeSeparation) {
  EXPECT_EQ(Timeline(SampleVehicle(), 1.0, 60.00314)[1].ignition_s, 60.00314);
  EXPECT_DOUBLE_EQ(Timeline(SampleVehicle(), 1.0, 10.0)[1].ignition_s, 40.5);
}

// The sample's second stage between its first and a third that is like it.
TEST(BuildTimeline, EveryStageButTheFirstMayHaveATimer) {
  Vehicle vehicle = SampleVehicle();
  vehicle.stages.push_back(vehicle.stages[1]);
  std::vector<MotorBurn> burns;
  for (const Stage& stage : vehicle.stages) burns.push_back(BuildBurn(stage, 1.0, 1.0));
  const auto t = BuildTimeline(vehicle, burns, kTick_s, 200.0, {0.0, 70.00314});
  EXPECT_EQ(t[1].ignition_s, 70.00314);
  EXPECT_DOUBLE_EQ(t[1].burnout_s, 90.00314);
  EXPECT_NEAR(t[1].separation_s, 90.01 + 0.5, 1e-12);
  EXPECT_EQ(t[2].ignition_s, 200.0);
  // Neither before the stage below has gone.
  const auto early = BuildTimeline(vehicle, burns, kTick_s, 50.0, {0.0, 10.0});
  EXPECT_DOUBLE_EQ(early[1].ignition_s, 40.5);
  EXPECT_DOUBLE_EQ(early[2].ignition_s, 61.0);
}

TEST(BuildTimeline, HoldDownIgnitesBeforeLiftOff) {
  Vehicle vehicle = SampleVehicle();
  vehicle.hold_down_s = 1.5;
  const auto t = Timeline(vehicle, 1.0, 60.0);
  EXPECT_EQ(t[0].ignition_s, -1.5);
  EXPECT_DOUBLE_EQ(t[0].burnout_s, 38.5);
}

TEST(BuildTimeline, FlowFactorMovesEverythingBelowTheTimer) {
  const auto t = Timeline(SampleVehicle(), 1.25, 60.0);
  EXPECT_DOUBLE_EQ(t[0].burnout_s, 32.0);
  EXPECT_DOUBLE_EQ(t[1].ignition_s, 60.0);
  EXPECT_DOUBLE_EQ(t[1].burnout_s, 76.0);
}

}  // namespace
}  // namespace dispersa::flight_sequence_test
