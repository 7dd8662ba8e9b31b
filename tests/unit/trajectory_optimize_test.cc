// The optimiser as its users see it: the target met to the metre, the same bytes for any number of threads, a
// plain statement if a target is out of reach.
#include "core/campaign_yaml/load.h"
#include "core/trajectory/optimize.h"
#include "core/trajectory/refine.h"
#include "core/trajectory/selection.h"
#include "tests/test.h"

namespace dispersa::trajectory_optimize_test {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

OptimizationInput ShortSearch(const std::string& campaign) {
  OptimizationInput input = LoadOptimization(DISPERSA_CAMPAIGNS "/" + campaign);
  input.problem.population = 12;
  input.problem.generations = 6;
  return input;
}

TrajectoryOptions OptionsFor(const OptimizationInput& input, int threads) {
  TrajectoryOptions options;
  options.tick_s = input.tick_s;
  options.threads = threads;
  options.selection_population = 8;
  options.selection_generations = 3;
  return options;
}

void ExpectOnTarget(const OrbitErrors& errors, const OrbitErrors& limit) {
  EXPECT_LE(std::fabs(errors.altitude_m), limit.altitude_m);
  EXPECT_LE(std::fabs(errors.velocity_m_s), limit.velocity_m_s);
  EXPECT_LE(std::fabs(errors.flight_path_angle_rad), limit.flight_path_angle_rad);
}

const OrbitErrors kMetre = {1.0, 1e-3, 1e-6 * kRadPerDeg};

// The orbit of a program that is flown anew.
OrbitErrors FlyAgain(const OptimizationInput& input, const Reference& reference) {
  const TrajectoryOptions options = OptionsFor(input, 1);
  const AscentModel model = BuildAscentModel(input.vehicle, options.tick_s);
  return ErrorsOf(reference.problem,
                  BuildReference(model, reference.problem, reference.program, options).orbit);
}

TEST(OptimizeTrajectory, MeetsTheTargetToTheMetreAndStillDoesAfterTheFileIsReadBack) {
  for (const char* campaign : {"slv4_500km.yaml", "orbit400.yaml"}) {
    SCOPED_TRACE(campaign);
    const OptimizationInput input = LoadOptimization(std::string(DISPERSA_CAMPAIGNS "/") + campaign);
    TrajectoryOptions options;
    options.tick_s = input.tick_s;
    options.threads = 2;
    const OptimizationResult result = OptimizeTrajectory(input.vehicle, input.problem, options);
    ASSERT_TRUE(result.reached) << result.statement;
    ExpectOnTarget(result.errors, kMetre);
    ExpectOnTarget(result.halved_step_errors, kMetre);
    for (const ConstraintMargin& constraint : result.reference.constraints) {
      EXPECT_TRUE(!constraint.enforced || constraint.margin >= 0.0) << constraint.name;
    }
    Reference written = result.reference;
    written.name = "again";
    written.vehicle_sha256 = input.vehicle_sha256;
    ExpectOnTarget(FlyAgain(input, LoadReference({"again.yaml", WriteReference(written)})), kMetre);
  }
}

TEST(OptimizeTrajectory, ReturnsTheSameBytesForOneThreadAndTwo) {
  const OptimizationInput input = ShortSearch("slv4_500km.yaml");
  const auto text = [&](int threads) {
    Reference reference =
        OptimizeTrajectory(input.vehicle, input.problem, OptionsFor(input, threads)).reference;
    reference.name = "threads";
    reference.vehicle_sha256 = input.vehicle_sha256;
    return WriteReference(reference);
  };
  EXPECT_EQ(text(1), text(2));
}

TEST(OptimizeTrajectory, SaysHowFarItGotAndWhatItTried) {
  OptimizationInput input = ShortSearch("slv4_500km.yaml");
  input.problem.target_velocity_m_s = 8200.0;
  const OptimizationResult result = OptimizeTrajectory(input.vehicle, input.problem, OptionsFor(input, 2));
  EXPECT_FALSE(result.reached);
  EXPECT_THAT(result.statement, HasSubstr(" Speed: carried to the target's altitude the faster end"));
  EXPECT_THAT(
      result.statement,
      HasSubstr(" m/s less than the target asks. Other bounds, populations and seeds were not tried."));
}

TEST(OptimizeTrajectory, SaysWhichConstraintStoppedIt) {
  OptimizationInput input = ShortSearch("slv4_500km.yaml");
  input.problem.axial_load_limit_g = 5.0;  // the third stage burns out at more than 8 g, whatever the program
  const OptimizationResult result = OptimizeTrajectory(input.vehicle, input.problem, OptionsFor(input, 2));
  EXPECT_FALSE(result.reached);
  EXPECT_THAT(result.statement, HasSubstr(" Constraint: axial_load_max_g = 8."));
}

// Objective (8) of the search's best: each error in its unit times the weight of that unit.
TEST(OptimizeTrajectory, SearchesForTheLeastWeightedSumOfAllErrors) {
  OptimizationInput input = ShortSearch("slv4_500km.yaml");
  TrajectoryProblem& problem = input.problem;
  problem.target_inclination_rad = 80.0 * kRadPerDeg;
  problem.target_argument_of_perigee_rad = 1.0;
  problem.weight_altitude_1_m = 2e-3;
  problem.weight_velocity_s_m = 0.3;
  problem.weight_angle_1_rad = 50.0;
  problem.weight_inclination_1_rad = 70.0;
  problem.weight_argument_1_rad = 11.0;
  const TrajectoryOptions options = OptionsFor(input, 2);
  const GeneticAlgorithmResult found = OptimizeTrajectory(input.vehicle, problem, options).genetic;
  AscentModel model = BuildAscentModel(input.vehicle, options.tick_s);
  model.reaction_control_propellant_kg = problem.reaction_control_propellant_kg;
  const FlightProgram program = ProgramOf(found.variables, VariablesOf(input.vehicle, problem));
  const AscentResult ascent = FlyAscent(model, program, AscentOptionsOf(problem, options.search_steps));
  ASSERT_TRUE(ascent.completed);
  const OrbitErrors errors = ErrorsOf(problem, ascent.orbit);
  const double terms[] = {2e-3 * std::fabs(errors.altitude_m), 0.3 * std::fabs(errors.velocity_m_s),
                          50.0 * std::fabs(errors.flight_path_angle_rad),
                          70.0 * std::fabs(errors.inclination_rad),
                          11.0 * std::fabs(errors.argument_of_perigee_rad)};
  double sum = 0.0;
  for (const double term : terms) {
    EXPECT_GT(term, 1e-3) << "a term that is 0 would show nothing";
    sum += term;
  }
  EXPECT_NEAR(found.evaluation.objective, sum, 1e-9 * sum);
  EXPECT_EQ(found.evaluation.tie_breaker, ascent.q_alpha_max_pa_rad);
}

// The third stage burns out at more than 8 g, whatever the program: none of those that reach the target is
// one to take.
TEST(SelectProgram, LeavesTheProgramWhereNoneHoldsItsConstraints) {
  OptimizationInput input = LoadOptimization(DISPERSA_CAMPAIGNS "/slv4_500km.yaml");
  TrajectoryOptions options = OptionsFor(input, 2);
  options.selection_population = 4;
  options.selection_generations = 1;
  AscentModel model = BuildAscentModel(input.vehicle, options.tick_s);
  model.reaction_control_propellant_kg = input.problem.reaction_control_propellant_kg;
  FlightProgram start = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program;
  start.coast_s += 5.0;
  for (const double limit_g : {5.0, 12.0}) {
    input.problem.axial_load_limit_g = limit_g;
    FlightProgram program = start;
    const Selection selection = SelectProgram(model, input.problem, options, &program);
    EXPECT_GT(selection.ascents, 0);
    const bool is_left = program.alpha_max_rad == start.alpha_max_rad && program.t1_s == start.t1_s &&
                         program.t3_s == start.t3_s && program.t2_s == start.t2_s &&
                         program.coast_s == start.coast_s &&
                         program.launch_azimuth_rad == start.launch_azimuth_rad;
    EXPECT_EQ(is_left, limit_g == 5.0) << limit_g << " g";
  }
}

// The shipped search, all of it.
TrajectoryOptions FullSearch(const OptimizationInput& input) {
  TrajectoryOptions options;
  options.tick_s = input.tick_s;
  options.threads = 2;
  return options;
}

// Azimuth has the inclination to itself once the speed is free: an inclination that the shipped orbit does
// not have is met beside altitude and angle.
TEST(OptimizeTrajectory, MeetsAnInclinationInPlaceOfASpeed) {
  OptimizationInput input = LoadOptimization(DISPERSA_CAMPAIGNS "/slv4_500km.yaml");
  const double inclination = 70.0 * kRadPerDeg;
  input.problem.velocity_is_free = true;
  input.problem.target_velocity_m_s = 0.0;
  input.problem.target_inclination_rad = inclination;
  input.problem.weight_inclination_1_rad = 10.0 / kRadPerDeg;
  const OptimizationResult result = OptimizeTrajectory(input.vehicle, input.problem, FullSearch(input));
  ASSERT_TRUE(result.reached) << result.statement;
  EXPECT_NEAR(result.reference.orbit.inclination_rad, inclination, 1e-6 * kRadPerDeg);
  EXPECT_NEAR(result.reference.orbit.altitude_m, 500e3, 1.0);
  EXPECT_EQ(result.errors.velocity_m_s, 0.0);
  const Reference shipped = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml");
  EXPECT_GT(std::fabs(shipped.orbit.inclination_rad - inclination), 0.1 * kRadPerDeg);
}

// Northwards from the site: an azimuth of 355 to 5 deg is one range, and its answer is written within a turn.
TEST(OptimizeTrajectory, SearchesAzimuthsAcrossNorth) {
  OptimizationInput input = LoadOptimization(DISPERSA_CAMPAIGNS "/slv4_500km.yaml");
  input.problem.velocity_is_free = true;
  input.problem.target_inclination_rad = 92.0 * kRadPerDeg;
  input.problem.weight_inclination_1_rad = 10.0 / kRadPerDeg;
  input.problem.launch_azimuth_rad = {350.0 * kRadPerDeg, 370.0 * kRadPerDeg};
  const OptimizationResult retrograde = OptimizeTrajectory(input.vehicle, input.problem, FullSearch(input));
  ASSERT_TRUE(retrograde.reached) << retrograde.statement;
  // West of north: the orbit goes west, and the Earth's rotation is to be undone.
  EXPECT_GT(retrograde.reference.program.launch_azimuth_rad, 350.0 * kRadPerDeg);
  input.problem.target_inclination_rad = 83.0 * kRadPerDeg;
  const OptimizationResult prograde = OptimizeTrajectory(input.vehicle, input.problem, FullSearch(input));
  ASSERT_TRUE(prograde.reached) << prograde.statement;
  EXPECT_LT(prograde.reference.program.launch_azimuth_rad, 10.0 * kRadPerDeg);
}

// The osculating ellipse of where the search ends, by the elements of the flight's own state.
TEST(OptimizeTrajectory, EntersAnEllipseAtItsPerigee) {
  OptimizationInput input = LoadOptimization(DISPERSA_CAMPAIGNS "/slv4_500km.yaml");
  TrajectoryProblem& problem = input.problem;
  // The shipped orbit's speed at 490 km over the equator's radius.
  const Earth earth = Wgs84();
  problem.target_altitude_m = 490e3;
  const double r = earth.equatorial_radius_m + 490e3;
  problem.target_velocity_m_s = std::sqrt(earth.mu_m3_s2 / r) + 5.0;
  const double axis =
      1.0 / (2.0 / r - problem.target_velocity_m_s * problem.target_velocity_m_s / earth.mu_m3_s2);
  problem.target_apogee_m = 2.0 * axis - r - earth.equatorial_radius_m;
  const OptimizationResult result = OptimizeTrajectory(input.vehicle, problem, FullSearch(input));
  ASSERT_TRUE(result.reached) << result.statement;
  const AscentModel model = BuildAscentModel(input.vehicle, input.tick_s);
  AscentOptions options;
  options.steps = FullSearch(input).steps;
  const AscentResult ascent = FlyAscent(model, result.reference.program, options);
  const OrbitElements e = ElementsOf(earth, ascent.p_EoC_I, ascent.v_IC_I);
  EXPECT_NEAR(e.perigee_altitude_m, 490e3, 5.0);
  EXPECT_NEAR(e.apogee_altitude_m, *problem.target_apogee_m, 20.0);
  EXPECT_GT(*problem.target_apogee_m, 500e3);
}

// A change of the models or of the vehicle needs a new reference: campaigns/slv4_500km.yaml says how.
TEST(ShippedReference, MeetsItsTargetWithTheModelsOfToday) {
  const OptimizationInput input = LoadOptimization(DISPERSA_CAMPAIGNS "/slv4_500km.yaml");
  const Reference reference = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml");
  EXPECT_EQ(reference.vehicle_sha256, input.vehicle_sha256);
  ExpectOnTarget(FlyAgain(input, reference), kMetre);
}

}  // namespace
}  // namespace dispersa::trajectory_optimize_test
