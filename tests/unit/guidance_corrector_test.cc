// The corrector over random states, and where there is nothing to be found.
#include <gtest/gtest.h>

#include <cmath>

#include "core/guidance/corrector.h"
#include "core/guidance/motor_estimate.h"
#include "core/random/draws.h"
#include "tests/guidance_mission.h"

namespace dispersa::guidance_corrector_test {
namespace {

CorrectorTask CoastTask(const PlanPrior& prior, int iterations) {
  CorrectorTask task;
  for (const PlanUnknown unknown : {kIgnition, kPitchMiddle, kPitchHalf, kYawMiddle, kWaste})
    task.free[unknown] = true;
  task.prior = prior.nominal;
  task.low = prior.low;
  task.high = prior.high;
  task.iterations = iterations;
  return task;
}

Correction FromCoast(const GuidanceMission& mission, const NavigatedState& from, int iterations = 8) {
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.last = mission.last;
  return Correct(mission, prior, known, from, prior.nominal, CoastTask(prior, iterations));
}

// The state some seconds of coast later or earlier, several kilometres and tens of metres a second off.
NavigatedState Disturbed(std::uint64_t draw, double size) {
  Stream random(7, draw, "states");
  NavigatedState state = CoastState();
  for (int i = 0; i < 3; ++i) {
    state.p_EoC_I[i] += size * 3e3 * random.Normal();
    state.v_IC_I[i] += size * 8.0 * random.Normal();
  }
  return state;
}

TEST(Corrector, LeavesAPlanThatArrivesAsItIs) {
  const GuidanceMission mission = ReachableMission();
  const PlanPrior prior = BuildPrior(mission);
  const Correction found = FromCoast(mission, CoastState());
  EXPECT_TRUE(found.arrives);
  for (std::size_t i = 0; i < kPlanUnknowns; ++i)
    EXPECT_NEAR(found.plan.value[i], prior.nominal.value[i], 1e-6 * prior.scale[i]);
}

TEST(Corrector, ArrivesFromRandomStates) {
  const GuidanceMission mission = ReachableMission();
  int iterations = 0;
  for (std::uint64_t draw = 0; draw < 400; ++draw) {
    const Correction found = FromCoast(mission, Disturbed(draw, 1.0));
    ASSERT_TRUE(found.arrives) << "state " << draw << " misses by " << found.miss.altitude_m << " m, "
                               << found.miss.velocity_m_s << " m/s";
    // Far within what it promises: the departures' own weight hardly shows.
    EXPECT_LT(std::fabs(found.miss.altitude_m), 0.5) << draw;
    EXPECT_LT(std::fabs(found.miss.velocity_m_s), 5e-3) << draw;
    EXPECT_LT(std::fabs(found.miss.flight_path_angle_rad), 1e-4 * kRadPerDeg) << draw;
    EXPECT_LT(std::fabs(found.miss.inclination_rad), 1e-3 * kRadPerDeg) << draw;
    if (found.iterations > iterations) iterations = found.iterations;
  }
  EXPECT_LE(iterations, 8);
}

TEST(Corrector, ASecondLookAtTheSamePlanNeedsNoMore) {
  const GuidanceMission mission = ReachableMission();
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.last = mission.last;
  for (std::uint64_t draw = 0; draw < 20; ++draw) {
    const NavigatedState from = Disturbed(draw, 1.0);
    const Correction first = FromCoast(mission, from);
    const Correction again = Correct(mission, prior, known, from, first.plan, CoastTask(prior, 2));
    EXPECT_TRUE(again.arrives);
    for (std::size_t i = 0; i < kPlanUnknowns; ++i)
      EXPECT_NEAR(again.plan.value[i], first.plan.value[i], 1e-2 * prior.scale[i]) << draw;
  }
}

// 300 m/s that nobody has: the turn in yaw is given up, what can be met is met as well as possible, and it is
// said.
TEST(Corrector, SaysThatATargetIsOutOfReach) {
  GuidanceMission mission = ReachableMission();
  mission.target.velocity_m_s += 300.0;
  const PlanPrior prior = BuildPrior(mission);
  const Correction found = FromCoast(mission, CoastState(), 20);
  EXPECT_FALSE(found.arrives);
  EXPECT_LT(found.miss.velocity_m_s, -50.0);
  EXPECT_EQ(found.plan.value[kWaste], 0.0);
  for (std::size_t i = 0; i < kPlanUnknowns; ++i) {
    EXPECT_TRUE(std::isfinite(found.plan.value[i]));
    EXPECT_GE(found.plan.value[i], prior.low[i]);
    EXPECT_LE(found.plan.value[i], prior.high[i]);
  }
}

TEST(Corrector, KeepsItsBounds) {
  const GuidanceMission mission = ReachableMission();
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.last = mission.last;
  CorrectorTask task = CoastTask(prior, 8);
  // Ignition 3 s late at the earliest: it is taken at the bound, or after, and the rest makes up for it.
  task.low[kIgnition] = prior.nominal.value[kIgnition] + 3.0;
  Plan start = prior.nominal;
  start.value[kIgnition] = task.low[kIgnition];
  const Correction found = Correct(mission, prior, known, CoastState(), start, task);
  EXPECT_GE(found.plan.value[kIgnition], task.low[kIgnition]);
  EXPECT_TRUE(found.arrives);
}

TEST(MotorEstimate, FindsThrustAndFlowOfAMotorByItsAcceleration) {
  const GuidanceMission mission = PlainMission();
  MotorEstimate estimate(mission.last);
  const double thrust_n = 1.03 * 30e3, flow_kg_s = 0.98 * 540.0 / 46.9, mass_kg = 910.0 - 0.4;
  EXPECT_EQ(estimate.Stage(0.0).burn.vacuum_thrust_n, 30e3) << "nominal until something is known";
  for (double t = 1.0; t < 8.5; t += 1.0) estimate.Add(t, thrust_n / (mass_kg - flow_kg_s * t));
  const GuidedStage stage = estimate.Stage(0.4);
  EXPECT_NEAR(stage.burn.vacuum_thrust_n, thrust_n, 1e-6 * thrust_n);
  EXPECT_NEAR(stage.burn.full_flow_kg_s, flow_kg_s, 1e-6 * flow_kg_s);
  EXPECT_NEAR(stage.burn.duration_s, 540.0 / flow_kg_s, 1e-4);
  EXPECT_EQ(stage.ignition_mass_kg, mass_kg);
}

TEST(MotorEstimate, LeavesRampsOut) {
  GuidanceMission mission = PlainMission();
  mission.last.burn.rise_s = 2.0;
  mission.last.burn.duration_s += 1.0;
  MotorEstimate estimate(mission.last);
  const double flow_kg_s = mission.last.burn.full_flow_kg_s;
  for (double t = 0.5; t < 12.0; t += 0.5) {
    const double fraction = t < 2.0 ? 0.5 * t : 1.0;
    const double burnt_s = t < 2.0 ? 0.25 * t * t : t - 1.0;
    estimate.Add(t, 30e3 * fraction / (910.0 - flow_kg_s * burnt_s));
  }
  EXPECT_NEAR(estimate.Stage(0.0).burn.vacuum_thrust_n, 30e3, 0.03);
}

TEST(MotorEstimate, DoesNotBelieveNonsense) {
  const GuidanceMission mission = PlainMission();
  MotorEstimate falling(mission.last), wild(mission.last);
  for (double t = 1.0; t < 10.0; t += 1.0) {
    falling.Add(t, 33.0 - t);
    wild.Add(t, 100.0 + 5.0 * t);
  }
  EXPECT_EQ(falling.Stage(0.0).burn.vacuum_thrust_n, 30e3) << "a motor that gets weaker: nominal";
  EXPECT_LE(wild.Stage(0.0).burn.vacuum_thrust_n, 1.15 * 30e3 + 1e-6);
}

// What gets lighter at once lies on no line, however straight the readings look.
TEST(MotorEstimate, IsNominalOfAStageThatLosesMass) {
  GuidanceMission mission = PlainMission();
  mission.last.loses_mass = true;
  MotorEstimate estimate(mission.last);
  for (double t = 1.0; t < 10.0; t += 1.0) estimate.Add(t, 1.03 * 30e3 / (910.0 - 540.0 / 46.9 * t));
  EXPECT_EQ(estimate.Stage(0.0).burn.vacuum_thrust_n, 30e3);
}

}  // namespace
}  // namespace dispersa::guidance_corrector_test
