// The guidance's prediction against closed forms and its own order.
#include "core/guidance/attitude_command.h"
#include "core/guidance/predictor.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "tests/guidance_mission.h"
#include "tests/test.h"

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
  // So little propellant that the acceleration hardly grows: then time and velocity run alike.
  mission.last.burn.vacuum_thrust_n = 1000.0;
  mission.last.burn.full_flow_kg_s = 1e-6;
  mission.last.burn.propellant_mass_kg = 5e-5;
  mission.last.burn.duration_s = 50.0;
  mission.last.ignition_mass_kg = 100.0;
  PlanPrior prior = BuildPrior(mission);
  prior.yaw_half_rad = 0.0;
  Knowledge known;
  known.last = mission.last;
  const NavigatedState from{0.0, {7e6, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  // Late, in between, and early.
  for (const double waste : {0.01, 0.045, 0.1}) {
    Plan plan = prior.nominal;
    plan.value = {0.0, 0.0, 10.0, 0.0, 0.0, 0.0, waste};
    const Injection reached = Predict(mission, prior, known, from, plan, {.burn_s = 0.5});
    const LastBurnAttitude attitude(plan, prior);
    Vector3 gained = Vector3::Zero();
    constexpr int kPieces = 20000;
    for (int i = 0; i < kPieces; ++i)
      gained += 500.0 / kPieces * UnitVector(attitude.At((i + 0.5) * 50.0 / kPieces));
    EXPECT_NEAR(reached.at.velocity_m_s, gained.norm(), 1e-3);
    // 1 - cos is a²/2 but for a⁴/24 of at most a sixth of the loss at 45 degrees.
    EXPECT_NEAR(reached.at.velocity_m_s, 500.0 * (1.0 - waste), 500.0 * waste * waste);
    // About the plan's middle: what it loses across is of third order.
    EXPECT_LT(std::fabs(gained.y()), 500.0 * 0.1 * waste);
  }
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
  PlanPrior prior = BuildPrior(mission);
  prior.yaw_half_rad = 0.0;
  Knowledge known;
  known.phase = GuidancePhase::kLastBurns;
  known.burn_ignition_s = 0.0;
  known.last = mission.last;
  Plan plan = prior.nominal;
  plan.value = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};  // no turn at all
  const NavigatedState from{0.0, {7e6, 0.0, 0.0}, 7000.0 * mission.R_IL.col(0)};
  const Arrival straight = Predict(mission, prior, known, from, plan).at;
  // Against the right-hand side: nose down.
  known.thrust_offset_rad_I = -0.5 * kDeg * mission.R_IL.col(1);
  const Arrival turned = Predict(mission, prior, known, from, plan).at;
  const double down_m_s = IdealVelocity(mission.last) * 0.5 * kDeg;
  EXPECT_NEAR(straight.flight_path_angle_rad - turned.flight_path_angle_rad, down_m_s / straight.velocity_m_s,
              0.02 * down_m_s / straight.velocity_m_s);
}

// Of a way that is known already only the part is taken that the plan has in common with it.
TEST(Predictor, AKnownWayChangesNoBit) {
  GuidanceMission mission = PlainMission();
  mission.moves_ignition = true;
  const PlanPrior prior = BuildPrior(mission);
  for (const GuidancePhase phase : {GuidancePhase::kBelowBurns, GuidancePhase::kCoast}) {
    Knowledge known;
    known.phase = phase;
    known.burn_ignition_s = CoastState().time_s;
    known.below = mission.below;
    known.last = mission.last;
    Plan plan = prior.nominal;
    plan.value[kIgnition] = CoastState().time_s + mission.below.burn.duration_s + 100.0;
    WayToLastBurn way;
    const Injection first = Predict(mission, prior, known, CoastState(), plan, {}, nullptr, &way);
    EXPECT_EQ(first.p_EoC_I, Predict(mission, prior, known, CoastState(), plan).p_EoC_I);
    for (int unknown = 0; unknown <= kWaste; ++unknown) {
      Plan moved = plan;
      moved.value[static_cast<std::size_t>(unknown)] += unknown == kIgnition ? 5.0 : 0.01;
      const Injection anew = Predict(mission, prior, known, CoastState(), moved);
      const Injection shared = Predict(mission, prior, known, CoastState(), moved, {}, &way, nullptr);
      EXPECT_EQ(shared.p_EoC_I, anew.p_EoC_I) << unknown;
      EXPECT_EQ(shared.v_IC_I, anew.v_IC_I) << unknown;
      EXPECT_EQ(shared.time_s, anew.time_s) << unknown;
      EXPECT_EQ(shared.burn_end_speed_m_s, anew.burn_end_speed_m_s) << unknown;
      EXPECT_EQ(shared.burn_end_s, anew.burn_end_s) << unknown;
      // In the coast nothing burns that the first two could turn.
      const bool moves = phase == GuidancePhase::kBelowBurns || unknown >= kIgnition;
      EXPECT_EQ(anew.p_EoC_I != first.p_EoC_I, moves) << unknown;
    }
  }
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
  const GuidanceMission mission = PlainMission();
  PlanPrior prior = BuildPrior(mission);
  EXPECT_EQ(prior.low[kWaste], 0.0);
  prior.nominal.value[kWaste] = prior.high[kWaste];
  EXPECT_NEAR(LastBurnAttitude(prior.nominal, prior).turn_rad(), 45.0 * kDeg, 1e-12);
}

// Velocity spent before the motor is known cannot be recovered. 60 m/s can wait for the estimate, 6 s after
// ignition, except for a rounded corner. Twice the excess cannot wait, at 3 degrees per second.
TEST(LastBurnAttitude, TurnsOnlyOnceTheMotorIsKnown) {
  const GuidanceMission mission = PlainMission();
  PlanPrior prior = BuildPrior(mission);
  prior.yaw_half_rad = 0.0;
  EXPECT_EQ(prior.turn.from_s, 6.0);
  Plan plan = prior.nominal;
  plan.value[kYawMiddle] = 0.0;
  const LastBurnAttitude late(plan, prior);
  EXPECT_GT(late.turn_rad(), 20.0 * kDeg);
  for (const double time_s : {-1.0, 0.0, 3.0, 4.4}) {
    EXPECT_LT(std::fabs(late.At(time_s).yaw_rad), 2.0 * kDeg) << time_s;
    EXPECT_EQ(late.RateAt(time_s).yaw_rad, 0.0) << time_s;
  }
  plan.value[kWaste] *= 2.5;
  EXPECT_GT(LastBurnAttitude(plan, prior).At(0.0).yaw_rad, 20.0 * kDeg);
  // Without an estimate there is no wait: a burn as planned, a thrust curve, a stage that loses mass.
  GuidanceMission other = mission;
  other.config.steers_last_burn = false;
  EXPECT_EQ(BuildPrior(other).turn.from_s, 0.0);
  other = mission;
  other.last.loses_mass = true;
  EXPECT_EQ(BuildPrior(other).turn.from_s, 0.0);
  // Looking seldom, it takes longer.
  other = mission;
  other.config.period_s = 2.0;
  EXPECT_EQ(BuildPrior(other).turn.from_s, 9.0);
}

TEST(LastBurnAttitude, TurnsNoFasterThanTheCommandCan) {
  const GuidanceMission mission = PlainMission();
  PlanPrior prior = BuildPrior(mission);
  prior.yaw_half_rad = 0.0;
  Plan plan = prior.nominal;
  for (int i = 0; i <= 100; ++i) {
    plan.value[kWaste] = 0.01 * i * prior.high[kWaste];
    const LastBurnAttitude attitude(plan, prior);
    for (double time_s = 0.0; time_s < 46.9; time_s += 0.5) {
      // Seven tenths of 3 deg/s; at the very end of what is allowed a little more.
      EXPECT_LE(std::fabs(attitude.RateAt(time_s).yaw_rad), 2.25 * kDeg) << i << ", " << time_s;
      const double slope = (attitude.At(time_s + 0.01).yaw_rad - attitude.At(time_s + 1e-9).yaw_rad) / 0.01;
      if (std::fabs(time_s - 6.0) > 0.4 && std::fabs(time_s - prior.turn.back_s) > 0.4) {
        EXPECT_NEAR(attitude.RateAt(time_s + 0.005).yaw_rad, slope, 1e-5) << i << ", " << time_s;
      }
    }
  }
}

// A command 20 degrees behind its plan closes in at 3 degrees a second: what that loses is predicted.
TEST(Predictor, KnowsThatTheCommandIsBehindThePlan) {
  GuidanceMission mission = PlainMission();
  mission.earth.mu_m3_s2 = 0.0;
  PlanPrior prior = BuildPrior(mission);
  prior.yaw_half_rad = 0.0;
  Knowledge known;
  known.phase = GuidancePhase::kLastBurns;
  known.last = mission.last;
  Plan plan = prior.nominal;
  plan.value = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const NavigatedState from{10.0, {7e6, 0.0, 0.0}, 7000.0 * mission.R_IL.col(0)};
  const auto angle = [&](double behind_rad) {
    known.commanded = Direction{behind_rad, 0.0};
    return Predict(mission, prior, known, from, plan, {.burn_s = 0.25}).at;
  };
  for (const double behind_rad : {20.0 * kDeg, -20.0 * kDeg, 3.0 * kDeg}) {
    // As the command itself would move.
    AttitudeCommand command;
    command.Start(10.0, {behind_rad, 0.0}, {});
    Vector3 v = from.v_IC_I;
    constexpr double kStep_s = 0.01;
    for (double time_s = 10.0; time_s < 46.9 - 0.5 * kStep_s; time_s += kStep_s) {
      command.Follow(time_s + kStep_s, {0.0, 0.0}, {}, mission.limits.turn_rate_rad_s,
                     mission.limits.turn_acceleration_rad_s2);
      const double middle_s = time_s + 0.5 * kStep_s;
      v += kStep_s * 30e3 / (910.0 - 540.0 / 46.9 * middle_s) *
           (mission.R_IL * UnitVector(command.direction()));
    }
    const Arrival at = angle(behind_rad), straight = angle(0.0);
    const double down_m_s = v.dot(mission.R_IL.col(2));
    // Flight path angles of 7 km/s and more along x: of the velocity down, what half a second of the
    // command's start is worth at 43 m/s² is left.
    const double predicted_m_s =
        at.velocity_m_s * (straight.flight_path_angle_rad - at.flight_path_angle_rad);
    EXPECT_NEAR(predicted_m_s, down_m_s, 0.1 * std::fabs(down_m_s) + 0.5 * 43.0 * std::fabs(behind_rad))
        << behind_rad;
    EXPECT_GT(std::fabs(down_m_s), 0.5);
  }
}

}  // namespace
}  // namespace dispersa::guidance_predictor_test
