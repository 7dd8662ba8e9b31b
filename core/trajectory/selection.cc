#include "core/trajectory/selection.h"

#include <algorithm>
#include <atomic>

#include "core/math/constants.h"
#include "core/trajectory/constraints.h"
#include "core/trajectory/refine.h"

namespace dispersa {

namespace {

// Factor of the tolerances: individuals are flown with the steps of the search and need only its accuracy.
constexpr double kLooser = 1e3;
constexpr int kIterations = 12;
// Times that need more incidence than allowed are judged by the excess, up to this.
constexpr double kSteepest_rad = 45.0 * kRadPerDeg;

FlightProgram WithTimes(FlightProgram program, const std::vector<double>& times) {
  program.t1_s = times[0];
  program.t3_s = times[1];
  program.t2_s = times[2];
  return program;
}

}  // namespace

Selection SelectProgram(const AscentModel& model, const TrajectoryProblem& problem,
                        const TrajectoryOptions& options, FlightProgram* program) {
  TrajectoryOptions coarse = options;
  coarse.steps = options.search_steps;
  coarse.tolerance = {kLooser * options.tolerance.altitude_m, kLooser * options.tolerance.velocity_m_s,
                      kLooser * options.tolerance.flight_path_angle_rad,
                      kLooser * options.tolerance.inclination_rad,
                      kLooser * options.tolerance.argument_of_perigee_rad};
  coarse.refinement_iterations = kIterations;
  TrajectoryProblem steep = problem;
  steep.alpha_max_rad.high = std::max(problem.alpha_max_rad.high, kSteepest_rad);
  const FlightProgram start = *program;
  std::atomic<std::int64_t> ascents = 0;

  // Every refinement begins at the same start, so that it depends on the individual alone.
  const auto refined = [&](const std::vector<double>& times, FlightProgram* trial,
                           AscentResult* ascent = nullptr) {
    *trial = WithTimes(start, times);
    const LeastSquaresResult result = RefineProgram(model, steep, coarse, trial, ascent);
    ascents += result.evaluations;
    return result;
  };
  BoundedProblem bounded;
  for (const Bounds& b : {problem.t1_s, problem.t3_s, problem.t2_s}) {
    bounded.lower.push_back(b.low);
    bounded.upper.push_back(b.high);
  }
  bounded.known_points = {{start.t1_s, start.t3_s, start.t2_s}};
  bounded.evaluate = [&](const std::vector<double>& times) {
    Evaluation evaluation;
    const double disorder_s = DisorderOf(WithTimes(start, times), options);
    if (disorder_s > 0.0) {
      evaluation.constraint_violations = {1e4 * (1.0 + disorder_s)};
      return evaluation;
    }
    FlightProgram trial;
    AscentResult ascent;
    const LeastSquaresResult result = refined(times, &trial, &ascent);
    if (result.status != LeastSquaresStatus::kConverged) {
      evaluation.constraint_violations = {1e3};
      return evaluation;
    }
    evaluation.objective = ascent.q_alpha_max_pa_rad;
    evaluation.constraint_violations =
        Violations(ConstraintsOf(problem, trial, ascent), options.limit_reserve);
    evaluation.constraint_violations.push_back(
        std::max(0.0, trial.alpha_max_rad / problem.alpha_max_rad.high - 1.0 + options.limit_reserve));
    return evaluation;
  };

  GeneticAlgorithmOptions genetic;
  genetic.population = options.selection_population;
  genetic.generations = options.selection_generations;
  genetic.seed = problem.seed;
  genetic.final_mutation_eta = 1e3;
  genetic.threads = options.threads;
  Selection selection;
  selection.genetic = GeneticAlgorithm(genetic).Minimize(bounded);
  const Evaluation& best = selection.genetic.evaluation;
  bool feasible = true;
  for (const double violation : best.constraint_violations) feasible &= violation <= 0.0;
  if (feasible) refined(selection.genetic.variables, program);
  selection.ascents = ascents;
  return selection;
}

}  // namespace dispersa
