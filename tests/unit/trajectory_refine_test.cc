// The refinement finds the one program that meets the target, from any end of the search, in a few steps. Its
// attitude program has a knot at every kink.
#include "core/trajectory/refine.h"

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/trajectory/aim.h"
#include "tests/test.h"

namespace dispersa::trajectory_refine_test {
namespace {

struct Shipped {
  const OptimizationInput input = LoadOptimization(DISPERSA_CAMPAIGNS "/slv4_500km.yaml");
  const FlightProgram program = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program;
  const TrajectoryOptions options;
  const AscentModel model = BuildAscentModel(input.vehicle, options.tick_s);
};

TEST(RefineProgram, FindsTheSameProgramFromAroundInAFewSteps) {
  const Shipped shipped;
  for (const double way : {-1.0, 1.0}) {
    FlightProgram program = shipped.program;
    program.alpha_max_rad += way * 0.3 * kRadPerDeg;
    program.coast_s -= way * 15.0;
    program.launch_azimuth_rad += way * 2.0 * kRadPerDeg;
    AscentResult ascent;
    const LeastSquaresResult refined =
        RefineProgram(shipped.model, shipped.input.problem, shipped.options, &program, &ascent);
    EXPECT_EQ(refined.status, LeastSquaresStatus::kConverged);
    EXPECT_TRUE(refined.held_at_bound.empty());
    EXPECT_TRUE(IsWithin(ErrorsOf(shipped.input.problem, ascent.orbit), shipped.options.tolerance));
    // A metre of altitude, a millimetre a second and a microdegree: what the tolerances leave of each
    // unknown.
    EXPECT_NEAR(program.alpha_max_rad, shipped.program.alpha_max_rad, 1e-6);
    EXPECT_NEAR(program.coast_s, shipped.program.coast_s, 1e-3);
    EXPECT_NEAR(program.launch_azimuth_rad, shipped.program.launch_azimuth_rad, 1e-6);
    // Four flights a step of three unknowns; Newton's method doubles the right digits with each.
    EXPECT_LE(refined.evaluations, 40);
  }
}

// The speed at which the last engine is cut off is a centimetre a second from the target's: altitude and
// angle are met as near as ever.
TEST(RefineProgram, LeavesTheSpeedToAnEngineThatIsCutOffAtOne) {
  const AscentModel model =
      BuildAscentModel(LoadVehicle(DISPERSA_CAMPAIGNS "/gallery/electron/vehicle.yaml"), 0.01);
  const Reference shipped = LoadReference(DISPERSA_CAMPAIGNS "/gallery/electron/reference.yaml");
  TrajectoryProblem problem = shipped.problem;
  problem.target_velocity_m_s += 0.01;
  FlightProgram program = shipped.program;
  program.alpha_max_rad += 0.05 * kRadPerDeg;
  AscentResult ascent;
  const LeastSquaresResult refined = RefineProgram(model, problem, {}, &program, &ascent);
  EXPECT_EQ(refined.status, LeastSquaresStatus::kConverged);
  EXPECT_TRUE(EndsByVelocity(model, ascent));
  const OrbitErrors errors = ErrorsOf(problem, ascent.orbit);
  EXPECT_LT(std::fabs(errors.altitude_m), 1.0);
  EXPECT_LT(std::fabs(errors.flight_path_angle_rad), 1e-6 * kRadPerDeg);
  EXPECT_LT(std::fabs(errors.velocity_m_s), 0.1);
}

// Falcon 9 to a transfer orbit by two burns of stage 2. The first variables, the incidence of stage 1 and the
// azimuth, are frozen: coast and the incidence of stage 2 meet the perigee and its argument.
TEST(RefineProgram, FindsATransferOrbitFromWideBoundsBesideACutOff) {
  AscentModel model = BuildAscentModel(LoadVehicle(DISPERSA_CAMPAIGNS "/gallery/falcon9/vehicle.yaml"), 0.01);
  const Reference shipped = LoadReference(DISPERSA_CAMPAIGNS "/gallery/falcon9/reference.yaml");
  TrajectoryProblem problem = shipped.problem;
  AimAt(problem, model.vehicle);
  problem.coast_s = {600.0, 1500.0};
  problem.steering[1] = {{-5.0 * kRadPerDeg, 30.0 * kRadPerDeg}, {-20.0 * kRadPerDeg, 10.0 * kRadPerDeg}};
  for (const double off : {-1.0, 1.0}) {
    FlightProgram program = shipped.program;
    program.coast_s += 60.0 * off;
    program.steering[1].begin_rad += 2.0 * off * kRadPerDeg;
    program.steering[1].end_rad -= 2.0 * off * kRadPerDeg;
    AscentResult ascent;
    const LeastSquaresResult refined = RefineProgram(model, problem, {}, &program, &ascent);
    EXPECT_EQ(refined.status, LeastSquaresStatus::kConverged) << Describe(refined.status);
    EXPECT_TRUE(EndsByVelocity(model, ascent));
    EXPECT_TRUE(IsWithin(ErrorsOf(problem, ascent.orbit), TrajectoryOptions().tolerance));
  }
}

// Electron with a frozen coast and pitch-over, far off: with the variables that come first the refinement
// ends at a bound (10 degrees), or they do nothing for what is missing (15). It goes on with all that is
// free.
TEST(RefineProgram, GoesOnWithAllVariablesWhereTheFirstAreNotEnough) {
  const AscentModel model =
      BuildAscentModel(LoadVehicle(DISPERSA_CAMPAIGNS "/gallery/electron/vehicle.yaml"), 0.01);
  const Reference shipped = LoadReference(DISPERSA_CAMPAIGNS "/gallery/electron/reference.yaml");
  TrajectoryProblem problem = shipped.problem;
  problem.alpha_max_rad = {shipped.program.alpha_max_rad, shipped.program.alpha_max_rad};
  for (const double off_deg : {10.0, 15.0}) {
    FlightProgram program = shipped.program;
    program.steering[1].begin_rad += off_deg * kRadPerDeg;
    AscentResult ascent;
    const LeastSquaresResult refined = RefineProgram(model, problem, {}, &program, &ascent);
    EXPECT_EQ(refined.status, LeastSquaresStatus::kConverged) << off_deg << ": " << Describe(refined.status);
    const OrbitErrors errors = ErrorsOf(problem, ascent.orbit);
    EXPECT_LT(std::fabs(errors.altitude_m), 1.0);
    EXPECT_LT(std::fabs(errors.flight_path_angle_rad), 1e-6 * kRadPerDeg);
  }
}

// One condition is tight and the others loose, in turn: a residual in another's scale would end too early.
TEST(RefineProgram, MeetsEachConditionToItsOwnToleranceFromSeveralStarts) {
  const AscentModel model = BuildAscentModel(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml"), 0.01);
  const Reference shipped = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml");
  const OrbitErrors loose = {100.0, 0.1, 1e-4 * kRadPerDeg, 1.0, 1.0};
  std::vector<OrbitErrors> tolerances(3, loose);
  tolerances[0].altitude_m = 1.0;
  tolerances[1].velocity_m_s = 1e-3;
  tolerances[2].flight_path_angle_rad = 1e-6 * kRadPerDeg;
  TrajectoryOptions options;
  options.steps = options.search_steps;
  for (const OrbitErrors& tolerance : tolerances) {
    options.tolerance = tolerance;
    for (const double off : {-1.0, 0.5, 1.0}) {
      FlightProgram program = shipped.program;
      program.alpha_max_rad += 0.2 * off * kRadPerDeg;
      program.coast_s -= 20.0 * off;
      program.launch_azimuth_rad += 5.0 * off * kRadPerDeg;
      AscentResult ascent;
      const LeastSquaresResult refined = RefineProgram(model, shipped.problem, options, &program, &ascent);
      EXPECT_EQ(refined.status, LeastSquaresStatus::kConverged) << Describe(refined.status);
      // Flown anew, and what the refinement says that it flew.
      const AscentResult again = FlyAscent(model, program, AscentOptionsOf(shipped.problem, options.steps));
      EXPECT_TRUE(IsWithin(ErrorsOf(shipped.problem, again.orbit), tolerance)) << off;
      EXPECT_EQ(again.p_EoC_I, ascent.p_EoC_I);
    }
  }
}

TEST(AscentRecord, HasAKnotWhereTheProgramsSlopeChanges) {
  const Shipped shipped;
  AscentOptions options;
  options.record = true;
  const AscentResult ascent = FlyAscent(shipped.model, shipped.program, options);
  for (const double kink_s :
       {shipped.program.t1_s, shipped.program.t3_s, shipped.program.t2_s, ascent.last_ignition_s}) {
    const auto& knots = ascent.attitude.knots;
    EXPECT_TRUE(std::any_of(knots.begin(), knots.end(), [&](const AttitudeKnot& knot) {
      return std::fabs(knot.time_s - kink_s) < 1e-9;
    })) << kink_s;
  }
}

}  // namespace
}  // namespace dispersa::trajectory_refine_test
