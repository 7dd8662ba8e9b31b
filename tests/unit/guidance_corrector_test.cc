// The corrector at random states, and at states without a solution.
#include "core/guidance/bounded_step.h"
#include "core/guidance/corrector.h"
#include "core/guidance/motor_estimate.h"
#include "core/math/constants.h"
#include "core/random/draws.h"
#include "tests/guidance_mission.h"
#include "tests/test.h"

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

// Into an ellipse of the size of Soyuz' first orbit, whose perigee may turn in its plane. Many states would
// lead below its perigee, where no direction of the eccentricity vector has the wanted length. Misses along
// both axes of the vector hold its direction there, and no step leads out.
TEST(Corrector, ArrivesInAnEllipseThatMayTurn) {
  GuidanceMission mission = PlainMission();
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.last = mission.last;
  // Fast enough for a low orbit.
  NavigatedState coast = CoastState();
  coast.v_IC_I *= 1.16;
  const Injection nominal = Predict(mission, prior, known, coast, prior.nominal);
  mission.target = nominal.at;
  const double mu = mission.earth.mu_m3_s2, speed_m_s = nominal.at.velocity_m_s;
  const double axis_m = 1.0 / (2.0 / nominal.radius_m - speed_m_s * speed_m_s / mu);
  mission.orbit = TargetOrbit{axis_m, 0.004};
  mission.orbit->semi_major_axis_m = nominal.radius_m / (1.0 - 0.004);
  for (std::uint64_t draw = 0; draw < 200; ++draw) {
    NavigatedState from = Disturbed(draw, 0.5);
    from.v_IC_I += coast.v_IC_I - CoastState().v_IC_I;
    const Correction found = FromCoast(mission, from, 12);
    EXPECT_TRUE(found.arrives) << "state " << draw << ": prioritised miss " << found.prioritised_miss;
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

// For any start, target and number of steps: the prioritised miss of a plan is never larger than that of the
// plan before. 300 m/s are out of reach, 60 m/s are the reserve.
TEST(Corrector, NeverTakesAWorsePlan) {
  int improved = 0;
  for (std::uint64_t draw = 0; draw < 300; ++draw) {
    GuidanceMission mission = ReachableMission();
    const PlanPrior prior = BuildPrior(mission);
    Stream random(11, draw, "starts");
    mission.target.velocity_m_s += 100.0 * random.Normal();
    mission.target.inclination_rad += 2.0 * kRadPerDeg * random.Normal();
    Plan start = prior.nominal;
    for (std::size_t i = kIgnition; i < kPlanUnknowns; ++i)
      start.value[i] = std::fmin(
          std::fmax(start.value[i] + 1.5 * prior.scale[i] * random.Normal(), prior.low[i]), prior.high[i]);
    Knowledge known;
    known.last = mission.last;
    const NavigatedState from = Disturbed(draw, 3.0);
    double last = HUGE_VAL;
    for (int call = 0; call < 6; ++call) {
      const Correction found = Correct(mission, prior, known, from, start, CoastTask(prior, 2));
      if (call > 0) {
        EXPECT_DOUBLE_EQ(found.start_prioritised_miss, last) << draw;
      }
      EXPECT_LE(found.prioritised_miss, std::fmax(found.start_prioritised_miss, kSolvedMiss)) << draw;
      improved += found.prioritised_miss < 0.9 * found.start_prioritised_miss ? 1 : 0;
      last = found.prioritised_miss;
      start = found.plan;
    }
  }
  EXPECT_GT(improved, 300) << "at least once each";
}

// 5 to 120 m/s more than there is. Energy first: as much as no other plan near by has, to 0.2 m/s of orbital
// energy; and a round orbit.
TEST(Corrector, MakesTheBestOfTooLittleEnergy) {
  for (const double beyond_m_s : {5.0, 20.0, 60.0, 120.0}) {
    GuidanceMission mission = ReachableMission();
    mission.target.velocity_m_s += 60.0 + beyond_m_s;
    const PlanPrior prior = BuildPrior(mission);
    Knowledge known;
    known.last = mission.last;
    const auto reached = [&](const Plan& plan) {
      return OrbitMissOf(mission, Predict(mission, prior, known, CoastState(), plan));
    };
    const Plan found = FromCoast(mission, CoastState(), 20).plan;
    const OrbitMiss miss = reached(found);
    EXPECT_EQ(found.value[kWaste], 0.0);
    EXPECT_LT(miss.energy_m_s, -0.5 * beyond_m_s);
    // Any of a thousand plans about it has a greater sum of squares, weighed as the corrector does.
    const auto sum = [](const OrbitMiss& m) {
      return m.energy_m_s * m.energy_m_s + (m.radial_m_s * m.radial_m_s + m.shape_m_s * m.shape_m_s) / 9.0 +
             1e-4 * m.plane_m_s * m.plane_m_s;
    };
    Stream random(13, static_cast<std::uint64_t>(beyond_m_s), "neighbours");
    for (int i = 0; i < 1000; ++i) {
      Plan other = found;
      const double size = i % 2 == 0 ? 0.02 : 0.3;
      for (const PlanUnknown k : {kIgnition, kPitchMiddle, kPitchHalf, kYawMiddle}) {
        const double value = other.value[k] + size * prior.scale[k] * random.Normal();
        other.value[k] = std::fmin(std::fmax(value, prior.low[k]), prior.high[k]);
      }
      EXPECT_GT(sum(reached(other)), (1.0 - 2e-3) * sum(miss)) << beyond_m_s;
    }
  }
}

// Energy before plane: 3 degrees of inclination beside a lack of 30 m/s cost less than a metre a second of
// energy.
TEST(Corrector, LeavesThePlaneWhereEnergyIsMissing) {
  GuidanceMission mission = ReachableMission();
  mission.target.velocity_m_s += 90.0;
  const PlanPrior prior = BuildPrior(mission);
  Knowledge known;
  known.last = mission.last;
  double energies[2];
  for (int tilted = 0; tilted < 2; ++tilted) {
    mission.target.inclination_rad += tilted * 3.0 * kRadPerDeg;
    const Correction found = FromCoast(mission, CoastState(), 20);
    energies[tilted] =
        OrbitMissOf(mission, Predict(mission, prior, known, CoastState(), found.plan)).energy_m_s;
    EXPECT_FALSE(found.arrives);
  }
  EXPECT_LT(energies[0], -10.0);
  EXPECT_NEAR(energies[1], energies[0], 1.0);
}

TEST(OrbitMiss, IsNoneOnTheTargetAndCountsEnergyThenShape) {
  const GuidanceMission mission = ReachableMission();
  const Arrival& target = mission.target;
  const double radius_m = 6378137.0 + target.altitude_m;
  const OrbitMiss none = OrbitMissOf(mission, {target, 0.0, radius_m});
  EXPECT_EQ(none.energy_m_s, 0.0);
  EXPECT_NEAR(none.radial_m_s, 0.0, 1e-9);
  EXPECT_NEAR(none.shape_m_s, 0.0, 1e-9);
  EXPECT_EQ(none.plane_m_s, 0.0);
  Arrival faster = target;
  faster.velocity_m_s += 0.1;
  EXPECT_NEAR(OrbitMissOf(mission, {faster, 0.0, radius_m}).energy_m_s, 0.1, 1e-5);
  // A kilometre of height is 1.1 m/s of energy: v / r.
  Arrival higher = target;
  higher.altitude_m += 1000.0;
  EXPECT_NEAR(OrbitMissOf(mission, {higher, 0.0, radius_m + 1000.0}).energy_m_s,
              mission.earth.mu_m3_s2 / (radius_m * radius_m) * 1000.0 / target.velocity_m_s, 1e-3);
}

// A circle 20 km lower than a circular target has the shape wanted, and an ellipse of the target's perigee
// that lacks 10 m/s of an elliptic one's.
TEST(OrbitMiss, WantsTheBestShapeOfTheEnergyThereIs) {
  GuidanceMission mission = ReachableMission();
  const double mu = mission.earth.mu_m3_s2, radius_m = 6878137.0, lower_m = radius_m - 20e3;
  mission.target = {radius_m - 6378137.0, std::sqrt(mu / radius_m), 0.0, 1.0};
  const OrbitMiss circle =
      OrbitMissOf(mission, {{lower_m - 6378137.0, std::sqrt(mu / lower_m), 0.0, 1.0}, 0.0, lower_m});
  EXPECT_LT(circle.energy_m_s, -10.0);
  EXPECT_NEAR(circle.shape_m_s, 0.0, 1e-6);
  EXPECT_NEAR(circle.radial_m_s, 0.0, 1e-6);
  // A kilometre a second faster: an eccentricity of 0.28, at perigee.
  mission.target.velocity_m_s += 1000.0;
  Arrival slower = mission.target;
  slower.velocity_m_s -= 10.0;
  const OrbitMiss ellipse = OrbitMissOf(mission, {slower, 0.0, radius_m});
  EXPECT_NEAR(ellipse.energy_m_s, -10.0, 0.1);
  EXPECT_NEAR(ellipse.shape_m_s, 0.0, 0.1) << "of -20 if the shape of the target were wanted";
}

// At its perigee, 0.2 rad behind where the target has one.
TEST(OrbitMiss, CountsAPlaceFromThePerigeeThatIsWanted) {
  GuidanceMission mission = ReachableMission();
  const double argument_rad = 0.7, radius_m = 6.8e6, speed_m_s = 8000.0, inclination_rad = 1.0;
  mission.orbit = TargetOrbit{7.5e6, 0.1, argument_rad - 0.2, 0.25};
  mission.target.velocity_m_s = speed_m_s;
  const Vector3 node = Vector3::UnitX(), upward(0.0, std::cos(inclination_rad), std::sin(inclination_rad));
  Injection reached{{radius_m - 6378137.0, speed_m_s, 0.0, inclination_rad}, 0.0, radius_m};
  reached.p_EoC_I = radius_m * (std::cos(argument_rad) * node + std::sin(argument_rad) * upward);
  reached.v_IC_I = speed_m_s * (std::cos(argument_rad) * upward - std::sin(argument_rad) * node);
  EXPECT_NEAR(OrbitMissOf(mission, reached).place_m_s, -0.05 * speed_m_s, 1e-6);
}

// Of plans without cut-off, with two, with an earlier burn; of few and of all misses.
TEST(BoundedStep, IsTheLeastWithinItsBounds) {
  const struct {
    int unknowns, misses;
  } tasks[] = {{kWaste + 1, 4}, {kYawHalf + 1, 4}, {kPlanUnknowns, 6}, {kPlanUnknowns, kMisses}};
  for (const auto& [unknowns, misses] : tasks)
    for (std::uint64_t draw = 0; draw < 200; ++draw) {
      Stream random(17, draw, "models");
      StepModel model;
      Unknowns weight = Unknowns::Ones();
      for (int i = 0; i < unknowns; ++i) {
        const auto k = static_cast<std::size_t>(i);
        model.free[k] = i != static_cast<int>(draw % 9);
        for (int m = 0; m < misses; ++m) model.jacobian(m, i) = 30.0 * random.Normal();
        model.departure(i) = random.Normal();
        model.low(i) = -0.5 * std::fabs(random.Normal());
        model.high(i) = 0.5 * std::fabs(random.Normal());
        weight(i) = 1.0 + std::fabs(random.Normal());
      }
      // Departures that are dear on one side.
      for (const int i : {kCutOff, kBelowCutOff})
        if (i < unknowns) model.dearer(i) = 100.0 * std::fabs(random.Normal());
      for (int m = 0; m < misses; ++m) model.miss(m) = 100.0 * random.Normal();
      const auto value = [&](const Unknowns& s) {
        return model.At(s) + s.cwiseProduct(weight - Unknowns::Ones()).dot(s);
      };
      const Unknowns found = BoundedStep(model, weight);
      for (int i = 0; i < kPlanUnknowns; ++i) {
        EXPECT_GE(found(i), model.low(i));
        EXPECT_LE(found(i), model.high(i));
        if (!model.free[static_cast<std::size_t>(i)]) {
          EXPECT_EQ(found(i), 0.0);
          continue;
        }
        // Convex: where no single unknown does better, nothing does.
        for (const double by : {-1e-3, 1e-3}) {
          Unknowns other = found;
          other(i) = std::fmin(std::fmax(other(i) + by, model.low(i)), model.high(i));
          EXPECT_GE(value(other), value(found) - 1e-9 * value(Unknowns::Zero())) << draw << ", " << i;
        }
      }
    }
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

// A sudden loss of mass does not lie on a line, however straight the readings look.
TEST(MotorEstimate, IsNominalOfAStageThatLosesMass) {
  GuidanceMission mission = PlainMission();
  mission.last.loses_mass = true;
  MotorEstimate estimate(mission.last);
  for (double t = 1.0; t < 10.0; t += 1.0) estimate.Add(t, 1.03 * 30e3 / (910.0 - 540.0 / 46.9 * t));
  EXPECT_EQ(estimate.Stage(0.0).burn.vacuum_thrust_n, 30e3);
}

}  // namespace
}  // namespace dispersa::guidance_corrector_test
