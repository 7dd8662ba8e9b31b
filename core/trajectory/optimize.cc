#include "core/trajectory/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/environment/earth.h"
#include "core/flight/engine_version.h"
#include "core/math/constants.h"
#include "core/optimization/feasibility_rules.h"
#include "core/trajectory/aim.h"
#include "core/trajectory/constraints.h"
#include "core/trajectory/refine.h"
#include "core/trajectory/selection.h"
#include "core/trajectory/shortfall.h"

namespace dispersa {

namespace {

// Number of individuals that one thread flies side by side: enough to keep the lanes busy, few enough to
// share a population among threads.
constexpr std::size_t kTogether = 2 * kAscentWidth;

void Require(bool holds, const char* field, double value, const char* allowed) {
  if (!holds)
    throw std::invalid_argument(
        fmt::format("TrajectoryOptions.{} is {}; allowed is {}", field, value, allowed));
}

void Validate(const TrajectoryOptions& options) {
  const auto positive = [](const char* field, double value) {
    Require(value > 0.0 && std::isfinite(value), field, value, "a finite number above 0");
  };
  positive("tick_s", options.tick_s);
  for (const AscentSteps* steps : {&options.search_steps, &options.steps}) {
    const bool search = steps == &options.search_steps;
    positive(search ? "search_steps.air_s" : "steps.air_s", steps->air_s);
    positive(search ? "search_steps.burn_s" : "steps.burn_s", steps->burn_s);
    positive(search ? "search_steps.coast_s" : "steps.coast_s", steps->coast_s);
  }
  Require(options.tie_tolerance >= 0.0 && std::isfinite(options.tie_tolerance), "tie_tolerance",
          options.tie_tolerance, "a finite number of at least 0");
  Require(options.limit_reserve >= 0.0 && options.limit_reserve <= 1.0, "limit_reserve",
          options.limit_reserve, "0 to 1");
  positive("shortest_ramp_s", options.shortest_ramp_s);
  positive("tolerance.altitude_m", options.tolerance.altitude_m);
  positive("tolerance.velocity_m_s", options.tolerance.velocity_m_s);
  positive("tolerance.flight_path_angle_rad", options.tolerance.flight_path_angle_rad);
}

Evaluation Judge(const TrajectoryProblem& problem, const TrajectoryOptions& options,
                 const FlightProgram& program, const AscentResult& ascent) {
  Evaluation evaluation;
  if (!ascent.completed) {
    // Worse than any violated limit of a program that reaches an orbit. A later fall is better.
    evaluation.constraint_violations = {1e3 + 1e3 / (1.0 + ascent.end_time_s)};
    return evaluation;
  }
  const OrbitErrors errors = ErrorsOf(problem, ascent.orbit);
  evaluation.objective = problem.weight_altitude_1_m * std::fabs(errors.altitude_m) +
                         problem.weight_velocity_s_m * std::fabs(errors.velocity_m_s) +
                         problem.weight_angle_1_rad * std::fabs(errors.flight_path_angle_rad);
  if (problem.target_inclination_rad)
    evaluation.objective += problem.weight_inclination_1_rad * std::fabs(errors.inclination_rad);
  if (problem.target_argument_of_perigee_rad)
    evaluation.objective += problem.weight_argument_1_rad * std::fabs(errors.argument_of_perigee_rad);
  evaluation.constraint_violations =
      Violations(ConstraintsOf(problem, program, ascent), options.limit_reserve);
  evaluation.tie_breaker = ascent.q_alpha_max_pa_rad;
  return evaluation;
}

// The programs are flown side by side.
std::vector<Evaluation> Evaluate(const AscentModel& model, const TrajectoryProblem& problem,
                                 const TrajectoryOptions& options,
                                 const std::vector<FlightProgram>& programs) {
  std::vector<Evaluation> evaluations(programs.size());
  std::vector<FlightProgram> flown;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    if (const double disorder_s = DisorderOf(programs[i], options); disorder_s > 0.0) {
      // A program with its times out of order cannot be flown. It is worse than any that can, the more so the
      // larger the disorder.
      evaluations[i].constraint_violations = {1e4 * (1.0 + disorder_s)};
    } else {
      flown.push_back(programs[i]);
      index.push_back(i);
    }
  }
  const std::vector<AscentResult> ascents =
      FlyAscents(model, flown, AscentOptionsOf(problem, options.search_steps));
  for (std::size_t i = 0; i < flown.size(); ++i)
    evaluations[index[i]] = Judge(problem, options, flown[i], ascents[i]);
  return evaluations;
}

GeneticAlgorithmResult Search(const AscentModel& model, const TrajectoryProblem& problem,
                              const TrajectoryOptions& options, const GeneticAlgorithm::Observer& observer) {
  BoundedProblem bounded;
  const std::vector<ProgramVariable> variables = VariablesOf(model.vehicle, problem);
  for (const ProgramVariable& variable : variables) {
    bounded.lower.push_back(variable.BoundsOf(problem).low);
    bounded.upper.push_back(variable.BoundsOf(problem).high);
  }
  const auto program_of = [&](const std::vector<double>& v) { return ProgramOf(v, variables); };
  bounded.evaluate = [&](const std::vector<double>& v) {
    return Evaluate(model, problem, options, {program_of(v)}).front();
  };
  bounded.evaluate_together = [&](std::span<const std::vector<double>> points) {
    std::vector<FlightProgram> programs;
    for (const std::vector<double>& v : points) programs.push_back(program_of(v));
    return Evaluate(model, problem, options, programs);
  };
  bounded.together = kTogether;
  GeneticAlgorithmOptions genetic;
  genetic.population = problem.population;
  genetic.generations = problem.generations;
  genetic.seed = problem.seed;
  genetic.mutation_probability = options.mutation_probability;
  genetic.threads = options.threads;
  genetic.objective_tolerance = options.tie_tolerance;
  return GeneticAlgorithm(genetic).Minimize(bounded, observer);
}

}  // namespace

namespace {

// Of the shape of an ellipse, wherever it is entered. The error of velocity is that of energy, at the place.
OrbitErrors ErrorsOfShape(const TrajectoryProblem& problem, const Orbit& orbit) {
  const double mu = Wgs84().mu_m3_s2;
  const PlaceInOrbit is = PlaceOf(orbit);
  const double perigee_m = is.semi_major_axis_m * (1.0 - is.eccentricity) - Wgs84().equatorial_radius_m;
  const double squared = mu * (2.0 / orbit.radius_m - 1.0 / EllipseOf(problem).semi_major_axis_m);
  OrbitErrors errors;
  errors.altitude_m = perigee_m - problem.target_altitude_m;
  errors.velocity_m_s =
      orbit.velocity_m_s - std::sqrt(std::fmax(squared, 0.0)) - problem.velocity_reserve_m_s;
  if (problem.target_inclination_rad)
    errors.inclination_rad = orbit.inclination_rad - *problem.target_inclination_rad;
  if (problem.target_argument_of_perigee_rad)
    errors.argument_of_perigee_rad = std::remainder(
        orbit.argument_of_latitude_rad - is.true_anomaly_rad - *problem.target_argument_of_perigee_rad,
        kTwoPi);
  return errors;
}

}  // namespace

OrbitErrors ErrorsOf(const TrajectoryProblem& problem, const Orbit& orbit) {
  if (problem.is_entered_anywhere) return ErrorsOfShape(problem, orbit);
  // The altitudes of an ellipse count from the equator's radius, as its elements do.
  const double altitude_m =
      problem.target_apogee_m ? orbit.radius_m - Wgs84().equatorial_radius_m : orbit.altitude_m;
  return {altitude_m - AimedAltitude(problem),
          problem.velocity_is_free ? 0.0 : orbit.velocity_m_s - AimedVelocity(problem),
          orbit.flight_path_angle_rad - problem.target_flight_path_angle_rad,
          problem.target_inclination_rad ? orbit.inclination_rad - *problem.target_inclination_rad : 0.0,
          problem.target_argument_of_perigee_rad
              ? std::remainder(orbit.argument_of_latitude_rad - *problem.target_argument_of_perigee_rad -
                                   problem.target_true_anomaly_rad.value_or(0.0),
                               kTwoPi)
              : 0.0};
}

bool IsWithin(const OrbitErrors& errors, const OrbitErrors& tolerance) {
  return std::fabs(errors.altitude_m) <= tolerance.altitude_m &&
         std::fabs(errors.velocity_m_s) <= tolerance.velocity_m_s &&
         std::fabs(errors.flight_path_angle_rad) <= tolerance.flight_path_angle_rad &&
         std::fabs(errors.inclination_rad) <= tolerance.inclination_rad &&
         std::fabs(errors.argument_of_perigee_rad) <= tolerance.argument_of_perigee_rad;
}

double DisorderOf(const FlightProgram& program, const TrajectoryOptions& options) {
  return std::max(0.0, program.t1_s + options.shortest_ramp_s - program.t3_s) +
         std::max(0.0, program.t3_s + options.shortest_ramp_s - program.t2_s);
}

Reference BuildReference(const AscentModel& model, const TrajectoryProblem& problem,
                         const FlightProgram& program, const TrajectoryOptions& options,
                         std::vector<AscentSample>* history) {
  AscentOptions recording = AscentOptionsOf(problem, options.steps);
  recording.record = true;
  AscentResult ascent = FlyAscent(model, program, recording);
  Reference reference;
  reference.problem = problem;
  reference.program = program;
  reference.last_ignition_s = ascent.last_ignition_s;
  reference.earlier_ignition_s = ascent.earlier_ignition_s;
  reference.orbit = ascent.orbit;
  reference.constraints = ConstraintsOf(problem, program, ascent);
  reference.engine = EngineVersion();
  reference.attitude = std::move(ascent.attitude);
  if (history) *history = std::move(ascent.samples);
  return reference;
}

OptimizationResult OptimizeTrajectory(const Vehicle& vehicle, const TrajectoryProblem& problem,
                                      const TrajectoryOptions& options,
                                      const GeneticAlgorithm::Observer& observer) {
  Validate(options);
  AscentModel model = BuildAscentModel(vehicle, options.tick_s);
  AimAt(problem, model.vehicle);
  model.reaction_control_propellant_kg = problem.reaction_control_propellant_kg;
  OptimizationResult result;
  result.genetic = Search(model, problem, options, observer);
  const std::vector<ProgramVariable> variables = VariablesOf(vehicle, problem);
  FlightProgram program = ProgramOf(result.genetic.variables, variables);
  std::int64_t ascents = static_cast<std::int64_t>(result.genetic.evaluations);
  result.refinement = RefineProgram(model, problem, options, &program);
  ascents += result.refinement.evaluations;
  if (result.refinement.status == LeastSquaresStatus::kConverged) {
    Selection selection = SelectProgram(model, problem, options, &program);
    result.selection = std::move(selection.genetic);
    result.refinement = RefineProgram(model, problem, options, &program);
    ascents += selection.ascents + result.refinement.evaluations;
  }
  result.refined = program;
  if (result.refinement.status != LeastSquaresStatus::kConverged) {
    // The refinement knows neither constraints nor weights, so its end may be worse than the best of the
    // search.
    const FlightProgram searched = ProgramOf(result.genetic.variables, variables);
    const std::vector<Evaluation> both = Evaluate(model, problem, options, {searched, program});
    if (IsBetter(MeritOf(both[0]), MeritOf(both[1]), 0.0)) program = searched;
  }
  // Bounds of the azimuth may go on beyond north.
  if (program.launch_azimuth_rad >= kTwoPi) program.launch_azimuth_rad -= kTwoPi;
  result.reference = BuildReference(model, problem, program, options, &result.history);
  result.reference.evaluations = ascents;
  result.errors = ErrorsOf(problem, result.reference.orbit);

  result.tolerance = options.tolerance;
  if (EndsByVelocity(model, FlyAscent(model, program, AscentOptionsOf(problem, options.steps))))
    result.tolerance.velocity_m_s = std::max(result.tolerance.velocity_m_s, kCutOffTolerance_m_s);
  const AscentOptions halved = AscentOptionsOf(problem, HalvedSteps(options.steps));
  result.halved_step_errors = ErrorsOf(problem, FlyAscent(model, program, halved).orbit);

  result.reached = AreSatisfied(result.reference.constraints) && IsWithin(result.errors, result.tolerance);
  if (!result.reached) result.statement = DescribeShortfall(model, problem, options, result);
  return result;
}

}  // namespace dispersa
