// An engine that guidance cuts off: its levels, the estimate of its thrust, and when its burn ends.
#include "core/guidance/closed_loop.h"
#include "tests/guidance_mission.h"
#include "tests/test.h"

namespace dispersa::guidance_engine_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const Throttle kThrottle{{0.0, 180.0, 365.0}, {0.78, 0.78, 0.55}};

TEST(EngineLevels, AreThoseOfTheThrottleAndTheirIntegral) {
  const EngineLevels levels(kThrottle);
  EXPECT_EQ(levels.At(0.0), 0.78);
  EXPECT_NEAR(levels.At(272.5), 0.5 * (0.78 + 0.55), 1e-12);
  EXPECT_EQ(levels.At(500.0), 0.55) << "the last level holds";
  EXPECT_EQ(levels.bends_s(), (std::vector<double>{180.0, 365.0}));
  double sum_s = 0.0;
  constexpr double kStep_s = 0.25;
  for (double t = 0.0; t < 450.0; t += kStep_s) {
    ASSERT_NEAR(levels.Sum(t), sum_s, 1e-9) << t;
    ASSERT_NEAR(levels.TimeOf(sum_s), t, 1e-9) << t;
    sum_s += kStep_s * levels.At(t + 0.5 * kStep_s);  // exact: linear within a step
  }
}

TEST(EngineLevels, OfAnEngineWithoutAThrottleAreFull) {
  const EngineLevels levels{Throttle{}};
  EXPECT_EQ(levels.At(12.0), 1.0);
  EXPECT_EQ(levels.Sum(12.0), 12.0);
  EXPECT_EQ(levels.TimeOf(12.0), 12.0);
  EXPECT_TRUE(levels.bends_s().empty());
}

TEST(EngineLevels, EndWhereTheThrottleHasClosed) {
  const EngineLevels levels(Throttle{{0.0, 10.0, 20.0}, {1.0, 1.0, 0.0}});
  EXPECT_EQ(levels.At(25.0), 0.0);
  EXPECT_NEAR(levels.Sum(25.0), 15.0, 1e-12);
  EXPECT_NEAR(levels.TimeOf(15.0), 20.0, 1e-9);
  EXPECT_EQ(levels.TimeOf(16.0), 20.0) << "so much is never burnt";
}

// 25.8 kN at full thrust, 2000 kg of 2500, and a battery that leaves after 200 s.
GuidedStage EngineStage() {
  GuidedStage stage;
  stage.burn.vacuum_thrust_n = 25.8e3;
  stage.burn.full_flow_kg_s = 7.67;
  stage.burn.propellant_mass_kg = 2030.0;
  stage.burn.duration_s = 350.0;
  stage.ignition_mass_kg = 2500.0;
  stage.levels.emplace(kThrottle);
  stage.usable_kg = 2000.0;
  stage.drops = {{300.0, 64.0}};
  return stage;
}
constexpr double kIgnition_s = 100.0;

struct Truth {
  double thrust = 1.0, flow = 1.0, mass = 1.0;  // factors

  double At(double since_s) const {
    const GuidedStage stage = EngineStage();
    const double dropped_kg = kIgnition_s + since_s >= 300.0 ? 64.0 : 0.0;
    return thrust * stage.burn.vacuum_thrust_n * stage.levels->At(since_s) /
           (mass * stage.ignition_mass_kg - dropped_kg - flow * stage.Burnt(since_s));
  }
};
double Predicted(const GuidedStage& stage, double since_s) {
  return stage.burn.vacuum_thrust_n * stage.levels->At(since_s) /
         (stage.ignition_mass_kg - stage.DroppedBy(kIgnition_s + since_s) - stage.Burnt(since_s));
}
GuidedStage EstimatedAfter(const Truth& truth, double since_s) {
  EngineEstimate estimate(EngineStage());
  for (double t = 3.0; t <= since_s; t += 1.0) estimate.Add(kIgnition_s + t, t, truth.At(t), 0.0);
  return estimate.Stage(0.0);
}

TEST(EngineEstimate, IsNominalUntilAReading) {
  const GuidedStage stage = EngineEstimate(EngineStage()).Stage(1.5);
  EXPECT_EQ(stage.burn.vacuum_thrust_n, 25.8e3);
  EXPECT_EQ(stage.burn.full_flow_kg_s, 7.67);
  EXPECT_EQ(stage.ignition_mass_kg, 2498.5);
  EngineEstimate none(EngineStage());
  none.Add(103.0, 3.0, kNan, 0.0);
  none.Add(103.0, 3.0, 0.0, 0.0);
  EXPECT_EQ(none.Stage(0.0).burn.vacuum_thrust_n, 25.8e3);
}

// Thrust and flow by the same factor, as a motor of the same impulse has them: known from the first reading.
TEST(EngineEstimate, FindsAnEngineThatBurnsFaster) {
  for (const double since_s : {3.0, 30.0, 190.0, 300.0}) {
    const GuidedStage stage = EstimatedAfter({1.02, 1.02, 1.0}, since_s);
    EXPECT_NEAR(stage.burn.vacuum_thrust_n, 1.02 * 25.8e3, 2e-4 * 25.8e3) << since_s;
    EXPECT_NEAR(stage.burn.full_flow_kg_s, 1.02 * 7.67, 2e-4 * 7.67) << since_s;
  }
}

// Thrust, flow and mass apart from each other: the acceleration of the rest of the burn is what counts.
TEST(EngineEstimate, PredictsTheAccelerationOfAnyEngine) {
  for (const Truth& truth : {Truth{0.98, 1.0, 1.0}, Truth{1.0, 0.98, 1.0}, Truth{1.0, 1.0, 1.01}}) {
    for (const double since_s : {60.0, 150.0, 250.0}) {
      const GuidedStage stage = EstimatedAfter(truth, since_s);
      const double nominal = std::fabs(Predicted(EngineStage(), 340.0) / truth.At(340.0) - 1.0);
      EXPECT_NEAR(Predicted(stage, since_s + 1.0) / truth.At(since_s + 1.0), 1.0, 1e-4) << since_s;
      if (since_s >= 150.0) {
        EXPECT_LT(std::fabs(Predicted(stage, 340.0) / truth.At(340.0) - 1.0), 0.3 * nominal) << since_s;
      }
    }
  }
}

TEST(GuidedStage, ARestartHasWhatTheBurnBeforeLeft) {
  const GuidedStage below = EngineStage();
  GuidedStage last = below;
  last.drops = {};
  const GuidedStage left = AfterBurn(below, last, 200.0);
  EXPECT_NEAR(left.ignition_mass_kg, 2500.0 - 64.0 - below.Burnt(200.0), 1e-9);
  EXPECT_NEAR(left.usable_kg, 2000.0 - below.Burnt(200.0), 1e-9);
  EXPECT_NEAR(below.Depletes(), below.levels->TimeOf(2000.0 / 7.67), 1e-12);
  // It leaves in the second burn: it is still there when that begins.
  last.drops = below.drops;
  EXPECT_NEAR(AfterBurn(below, last, 150.0).ignition_mass_kg, 2500.0 - below.Burnt(150.0), 1e-9);
}

// A last stage without coast, whose nominal plan reaches the target.
GuidanceMission EngineMission() {
  GuidanceMission mission = PlainMission();
  mission.last = EngineStage();
  mission.last_ignition_s = kIgnition_s;
  mission.below_burnout_s = kIgnition_s - 7.0;
  mission.steers_below = mission.moves_ignition = false;
  mission.velocity_reserve_m_s = 0.0;
  return mission;
}
NavigatedState AtIgnition() {
  const Matrix3 R_IL = PlainMission().R_IL;
  return {kIgnition_s + 3.0, R_IL * Vector3(3.0e5, 0.0, -6.48e6), R_IL * Vector3(2.4e3, 0.0, -0.9e3)};
}
void Aim(GuidanceMission& mission) {
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.phase = GuidancePhase::kLastBurns;
  known.burn_ignition_s = kIgnition_s;
  known.last = mission.last;
  mission.target = Predict(mission, prior, known, AtIgnition(), prior.nominal).at;
}
GuidanceSight SightAt(const NavigatedState& state) {
  GuidanceSight sight;
  sight.state = state;
  sight.phase = GuidancePhase::kLastBurns;
  sight.burn_ignition_s = kIgnition_s;
  sight.specific_force_m_s2 = Truth{}.At(state.time_s - kIgnition_s);
  return sight;
}

// Without gravitation a burn gains exhaust velocity times the logarithm of the masses, apart where a body
// leaves.
TEST(Predictor, AnEnginesBurnGainsTheIdealVelocity) {
  GuidanceMission mission = EngineMission();
  mission.earth.mu_m3_s2 = 0.0;
  mission.program.at.assign(2, Direction{});
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.phase = GuidancePhase::kLastBurns;
  known.burn_ignition_s = kIgnition_s;
  known.last = mission.last;
  const NavigatedState from{kIgnition_s, {7e6, 0.0, 0.0}, 1000.0 * mission.R_IL.col(0)};
  const double exhaust_m_s = 25.8e3 / 7.67, before_kg = mission.last.Burnt(200.0);
  const auto ideal = [&](double duration_s) {
    const double then_kg = 2500.0 - before_kg;
    return 1000.0 + exhaust_m_s * (std::log(2500.0 / then_kg) +
                                   std::log((then_kg - 64.0) / (2436.0 - mission.last.Burnt(duration_s))));
  };
  Plan plan = prior.nominal;
  for (const double duration_s : {250.0, 300.0}) {
    plan.value[kCutOff] = duration_s;
    const Injection reached = Predict(mission, prior, known, from, plan);
    EXPECT_NEAR(reached.at.velocity_m_s, ideal(duration_s), 2e-3);
    EXPECT_NEAR(reached.time_s, kIgnition_s + duration_s, 1e-9);
    EXPECT_EQ(reached.burn_end_speed_m_s, reached.at.velocity_m_s);
  }
  // No burn outlasts the propellant.
  plan.value[kCutOff] = 1000.0;
  EXPECT_NEAR(Predict(mission, prior, known, from, plan).time_s, kIgnition_s + mission.last.Depletes(), 1e-9);
}

TEST(ClosedLoopGuidance, MeetsEnergyByTheCutOff) {
  GuidanceMission mission = EngineMission();
  Aim(mission);
  ClosedLoopGuidance guidance(mission);
  NavigatedState state = AtIgnition();
  state.v_IC_I *= 1.0 + 20.0 / state.v_IC_I.norm();
  EXPECT_FALSE(guidance.cuts_off());
  guidance.See(SightAt(state));
  EXPECT_TRUE(guidance.steers());
  ASSERT_TRUE(guidance.cuts_off());
  EXPECT_TRUE(guidance.outcome().arrives);
  EXPECT_EQ(guidance.plan().value[kWaste], 0.0);
  // 20 m/s more at 20 m/s² save about a second.
  EXPECT_LT(guidance.plan().value[kCutOff], 350.0 - 0.3);
  EXPECT_GT(guidance.plan().value[kCutOff], 350.0 - 3.0);

  const double end_s = kIgnition_s + guidance.plan().value[kCutOff], speed_m_s = mission.target.velocity_m_s;
  EXPECT_NEAR(guidance.CutOffIn(end_s - 10.0, kIgnition_s, speed_m_s, 20.0, 20.0), 10.0, 1e-6)
      << "too far off for its speed";
  EXPECT_NEAR(guidance.CutOffIn(end_s - 1.0, kIgnition_s, speed_m_s - 4.0, 20.0, 20.0), 0.2, 1e-3);
  EXPECT_NEAR(guidance.CutOffIn(end_s - 1.0, kIgnition_s, speed_m_s + 4.0, -20.0, 20.0), 0.2, 1e-3)
      << "speed falls";
  EXPECT_NEAR(guidance.CutOffIn(end_s - 1.0, kIgnition_s, speed_m_s - 4.0, 2.0, 20.0), 1.0, 1e-6)
      << "thrust across";
  EXPECT_GT(guidance.CutOffIn(end_s + 2.0, kIgnition_s, speed_m_s - 4.0, 2.1e1, 20.0), 0.1)
      << "a weak engine burns on";
}

// Out of reach: it burns until the propellant ends, or the energy is there after all.
TEST(ClosedLoopGuidance, DoesNotCutOffAnEngineThatLacksEnergy) {
  GuidanceMission mission = EngineMission();
  Aim(mission);
  mission.target.velocity_m_s += 2000.0;
  ClosedLoopGuidance guidance(mission);
  guidance.See(SightAt(AtIgnition()));
  EXPECT_FALSE(guidance.outcome().arrives);
  EXPECT_NEAR(guidance.plan().value[kCutOff], mission.last.Depletes(), 0.5);
  const double end_s = kIgnition_s + mission.last.Depletes();
  EXPECT_GT(guidance.CutOffIn(end_s, kIgnition_s, mission.target.velocity_m_s - 1900.0, 20.0, 20.0), 50.0);
}

// Navigation that is no number gives no plan: the reference's attitude is flown, and the engine's own cut-off
// stands. It recovers with the navigation.
TEST(ClosedLoopGuidance, WithoutAPlanFliesTheReference) {
  GuidanceMission mission = EngineMission();
  Aim(mission);
  ClosedLoopGuidance guidance(mission);
  NavigatedState lost = AtIgnition();
  lost.v_IC_I.x() = kNan;
  for (int second = 0; second < 5; ++second) {
    guidance.See(SightAt(lost));
    for (int tick = 0; tick < 20; ++tick) guidance.Command(lost.time_s + 0.05 * tick);
    lost.time_s += 1.0;
  }
  EXPECT_FALSE(guidance.cuts_off());
  EXPECT_FALSE(guidance.outcome().arrives);
  const Direction reference = mission.program.At(lost.time_s - 0.05), at = guidance.command().direction();
  // A tick behind a reference that turns by 0.065 deg/s.
  EXPECT_NEAR(at.pitch_rad, reference.pitch_rad, 4e-3 * kRadPerDeg);
  EXPECT_NEAR(at.yaw_rad, reference.yaw_rad, 4e-3 * kRadPerDeg);
  NavigatedState found = AtIgnition();
  guidance.See(SightAt(found));
  EXPECT_TRUE(guidance.cuts_off());
  EXPECT_TRUE(guidance.outcome().arrives);
}

// A reference of another vehicle may leave its last burn nothing.
TEST(LastBurnAttitude, IsANumberOfABurnOfNothing) {
  GuidanceMission mission = EngineMission();
  mission.last.burn.duration_s = 0.0;
  const PlanPrior prior = BuildPrior(mission);
  Plan plan = prior.nominal;
  plan.value[kPitchHalf] = 0.1;
  const LastBurnAttitude burn(plan, prior);
  for (const double since_s : {0.0, 0.3, 2.0}) {
    EXPECT_TRUE(std::isfinite(burn.At(since_s).pitch_rad)) << since_s;
    EXPECT_TRUE(std::isfinite(burn.RateAt(since_s).pitch_rad)) << since_s;
  }
}

}  // namespace
}  // namespace dispersa::guidance_engine_test
