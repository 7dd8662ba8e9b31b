// The guidance's prediction against closed forms and its own order.
#include <gtest/gtest.h>

#include <cmath>

#include "core/guidance/predictor.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "tests/guidance_mission.h"

namespace dispersa::guidance_predictor_test {
namespace {

constexpr double kDeg = kRadPerDeg;

// A motor whose thrust rises and falls: 600 kg of 1000 in 60 s and two half ramps.
GuidedStage RampedStage() {
  GuidedStage stage;
  stage.burn.vacuum_thrust_n = 28e3;
  stage.burn.full_flow_kg_s = 10.0;
  stage.burn.propellant_mass_kg = 600.0;
  stage.burn.rise_s = 0.7;
  stage.burn.tail_s = 3.1;
  stage.burn.duration_s = 60.0 + 0.5 * (0.7 + 3.1);
  stage.ignition_mass_kg = 1000.0;
  return stage;
}

TEST(Predictor, ABurnWithoutGravitationGainsTheIdealVelocity) {
  GuidanceMission mission = PlainMission();
  mission.earth.mu_m3_s2 = 0.0;
  mission.last = RampedStage();
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.last = mission.last;
  Plan plan = prior.nominal;
  plan.value[kIgnition] = 100.0;
  plan.value[kPitchMiddle] = plan.value[kPitchHalf] = plan.value[kYawMiddle] = plan.value[kWaste] = 0.0;
  const NavigatedState from{0.0, {7e6, 0.0, 0.0}, 1000.0 * mission.R_IL.col(0)};
  const double ideal_m_s = 1000.0 + 2800.0 * std::log(1000.0 / 400.0);
  const auto error_of = [&](double burn_s) {
    return Predict(mission, prior, known, from, plan, {.burn_s = burn_s}).at.velocity_m_s - ideal_m_s;
  };
  const Injection reached = Predict(mission, prior, known, from, plan);
  // A fiftieth of what the corrector calls arrived, and of fourth order.
  EXPECT_NEAR(reached.at.velocity_m_s, ideal_m_s, 1e-2);
  // Pieces hold whole numbers of steps, 30 and 59 in the longest: 15. Third order would give 8.
  EXPECT_GT(error_of(2.0) / error_of(1.0), 12.0);
  EXPECT_LT(error_of(2.0) / error_of(1.0), 18.0);
  EXPECT_NEAR(error_of(0.1), 0.0, 1e-7);
  EXPECT_NEAR(reached.time_s, 100.0 + mission.last.burn.duration_s, 1e-9);
}

TEST(Predictor, ATurnInYawTakesAwayWhatItsPlanSays) {
  GuidanceMission mission = PlainMission();
  mission.earth.mu_m3_s2 = 0.0;
  // So little propellant that the acceleration hardly grows: then time and velocity run alike, and the chord
  // of the arc is sin(a)/a of its length.
  mission.last.burn.vacuum_thrust_n = 1000.0;
  mission.last.burn.full_flow_kg_s = 1e-6;
  mission.last.burn.propellant_mass_kg = 5e-5;
  mission.last.burn.duration_s = 50.0;
  mission.last.ignition_mass_kg = 100.0;
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.last = mission.last;
  Plan plan = prior.nominal;
  plan.value = {0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.03};
  const double turn = plan.TurnHalf() - prior.yaw_half_rad;
  const NavigatedState from{0.0, {7e6, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  const Injection reached = Predict(mission, prior, known, from, plan, {.burn_s = 0.5});
  EXPECT_NEAR(reached.at.velocity_m_s, 500.0 * std::sin(turn) / turn, 1e-3);
  EXPECT_NEAR(turn, std::sqrt(0.18), 1e-2) << "the reference itself hardly turns";
}

TEST(Predictor, ACoastKeepsEnergyAndMomentumAndConvergesAtFourthOrder) {
  const GuidanceMission mission = PlainMission();
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.last = mission.last;
  Plan plan = prior.nominal;
  const NavigatedState from = CoastState();
  const auto arrive = [&](double burn_s, double coast_s) {
    return Predict(mission, prior, known, from, plan, {burn_s, coast_s}).at;
  };
  const Arrival exact = arrive(0.125, 1.25), shipped = arrive(2.5, 40.0), halved = arrive(1.25, 20.0);
  const double error_m = std::fabs(shipped.altitude_m - exact.altitude_m);
  const double halved_m = std::fabs(halved.altitude_m - exact.altitude_m);
  // A hundredth of the corrector's tolerance of 50 m, and a sixteenth of it with half the steps.
  EXPECT_LT(error_m, 0.5);
  EXPECT_LT(halved_m, error_m / 8.0);
  EXPECT_NEAR(shipped.velocity_m_s, exact.velocity_m_s, 5e-3);
  EXPECT_NEAR(shipped.flight_path_angle_rad, exact.flight_path_angle_rad, 1e-4 * kDeg);
}

TEST(Predictor, ThrustThatPointsElsewhereByASmallRotationIsTurnedByIt) {
  GuidanceMission mission = PlainMission();
  mission.earth.mu_m3_s2 = 0.0;
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.phase = GuidancePhase::kLastBurns;
  known.burn_ignition_s = 0.0;
  known.last = mission.last;
  Plan plan = prior.nominal;
  plan.value = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, Square(prior.yaw_half_rad) / 6.0};  // no turn at all
  const NavigatedState from{0.0, {7e6, 0.0, 0.0}, 7000.0 * mission.R_IL.col(0)};
  const Arrival straight = Predict(mission, prior, known, from, plan).at;
  // Against the right-hand side: nose down.
  known.thrust_offset_rad_I = -0.5 * kDeg * mission.R_IL.col(1);
  const Arrival turned = Predict(mission, prior, known, from, plan).at;
  const double down_m_s = IdealVelocity(mission.last) * 0.5 * kDeg;
  EXPECT_NEAR(straight.flight_path_angle_rad - turned.flight_path_angle_rad, down_m_s / straight.velocity_m_s,
              0.02 * down_m_s / straight.velocity_m_s);
}

// The plan's offsets of the burn below are added to the program: a program that has them already needs none.
TEST(Predictor, OffsetsOfTheBurnBelowAreThoseOfItsProgram) {
  const GuidanceMission mission = PlainMission();
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.phase = GuidancePhase::kBelowBurns;
  known.burn_ignition_s = CoastState().time_s;
  known.below = mission.below;
  known.last = mission.last;
  const Injection straight = Predict(mission, prior, known, CoastState(), prior.nominal);
  for (const Direction& offset : {Direction{0.02, 0.0}, Direction{0.0, 0.03}, Direction{-0.01, -0.02}}) {
    Plan plan = prior.nominal;
    plan.value[kBelowPitch] = offset.pitch_rad;
    plan.value[kBelowYaw] = offset.yaw_rad;
    const Injection found = Predict(mission, prior, known, CoastState(), plan);
    GuidanceMission moved = mission;
    for (Direction& at : moved.program.at) {
      at.pitch_rad += offset.pitch_rad;
      at.yaw_rad += offset.yaw_rad;
    }
    // The rest of the plan is that of the program as it was.
    const Injection expected = Predict(moved, prior, known, CoastState(), prior.nominal);
    EXPECT_NEAR(found.at.velocity_m_s, expected.at.velocity_m_s, 1e-6);
    EXPECT_NEAR(found.at.flight_path_angle_rad, expected.at.flight_path_angle_rad, 1e-9);
    EXPECT_NEAR(found.at.inclination_rad, expected.at.inclination_rad, 1e-9);
    EXPECT_GT(std::fabs(found.at.velocity_m_s - straight.at.velocity_m_s) +
                  1e3 * std::fabs(found.at.inclination_rad - straight.at.inclination_rad),
              0.1)
        << "it does something";
  }
}

TEST(DirectionTable, HasItsSlopeFromItsFirstPointOnAndNoneOutside) {
  DirectionTable table;
  table.start_s = 10.0;
  table.step_s = 2.0;
  table.at = {{0.1, -0.2}, {0.3, -0.1}, {0.2, 0.5}};
  EXPECT_DOUBLE_EQ(table.RateAt(10.0).pitch_rad, 0.1);
  EXPECT_DOUBLE_EQ(table.RateAt(10.0).yaw_rad, 0.05);
  EXPECT_DOUBLE_EQ(table.RateAt(13.0).pitch_rad, -0.05);
  EXPECT_DOUBLE_EQ(table.At(11.0).pitch_rad, 0.2);
  EXPECT_DOUBLE_EQ(table.At(13.0).yaw_rad, 0.2);
  for (const double outside_s : {9.999, 14.0, 20.0}) {
    EXPECT_EQ(table.RateAt(outside_s).pitch_rad, 0.0) << outside_s;
    EXPECT_EQ(table.RateAt(outside_s).yaw_rad, 0.0) << outside_s;
    const Direction& end = outside_s < 10.0 ? table.at.front() : table.at.back();
    EXPECT_EQ(table.At(outside_s).pitch_rad, end.pitch_rad) << outside_s;
    EXPECT_EQ(table.At(outside_s).yaw_rad, end.yaw_rad) << outside_s;
  }
}

TEST(BuildPrior, TurnsTheLastBurnByFortyFiveDegreesAtMost) {
  PlanPrior prior = BuildPrior(PlainMission());
  EXPECT_EQ(prior.low[kWaste], 0.0);
  prior.nominal.value[kWaste] = prior.high[kWaste];
  EXPECT_NEAR(prior.nominal.TurnHalf(), 45.0 * kRadPerDeg, 1e-12);
  // What a turn from +a to -a takes away of the velocity along its middle is 1 - sin(a)/a; the next term is -a⁴/120.
  const double a = 0.25 * kPi;
  EXPECT_NEAR(prior.high[kWaste], 1.0 - std::sin(a) / a, std::pow(a, 4) / 120.0);
}

}  // namespace
}  // namespace dispersa::guidance_predictor_test
