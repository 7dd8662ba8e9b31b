#include "core/trajectory/optimize.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/engine/version.h"
#include "core/math/constants.h"

namespace dispersa {

namespace {

// Shortest ramp of the programmed incidence.
constexpr double kShortestRamp_s = 1.0;
// Steps of the search and of the refinement, which ends on the finer ones.
constexpr double kSearchStep_s = 0.25;
constexpr double kFineStep_s = 0.1;
constexpr double kFineCoastStep_s = 5.0;

AscentOptions Options(const TrajectoryProblem& problem, double burn_step_s, double coast_step_s) {
  AscentOptions options;
  options.burn_step_s = burn_step_s;
  options.coast_step_s = coast_step_s;
  options.mach_low = problem.transonic_mach_low;
  options.mach_high = problem.transonic_mach_high;
  return options;
}

std::vector<ConstraintMargin> Margins(const TrajectoryProblem& problem, const FlightProgram& program,
                                      const AscentResult& ascent) {
  std::vector<ConstraintMargin> margins;
  const auto add = [&](const char* name, double value, double limit) {
    const bool enforced = limit > 0.0;
    margins.push_back({name, value, limit, enforced ? limit - value : 0.0, enforced});
  };
  add("axial_load_max_g", ascent.axial_load_max_g, problem.axial_load_limit_g);
  add("lateral_load_max_g", ascent.lateral_load_max_g, problem.lateral_load_limit_g);
  add("programmed_alpha_max_deg", program.alpha_max_rad * kDegPerRad, problem.alpha_limit_rad * kDegPerRad);
  add("mach_at_t2", ascent.mach_at_t2, problem.transonic_mach_low);
  // Zero where the program is: only exactly zero passes.
  margins.push_back({"transonic_alpha_max_deg", ascent.transonic_alpha_max_rad * kDegPerRad, 0.0,
                     -ascent.transonic_alpha_max_rad * kDegPerRad, true});
  add("q_max_pa", ascent.q_max_pa, problem.q_max_limit_pa);
  add("q_alpha_max_pa_rad", ascent.q_alpha_max_pa_rad, problem.q_alpha_limit_pa_rad);
  return margins;
}

// How far a program violates the constraints, each as a fraction of its limit.
std::vector<double> Violations(const std::vector<ConstraintMargin>& margins) {
  std::vector<double> violations;
  for (const ConstraintMargin& m : margins)
    if (m.enforced) violations.push_back(m.margin >= 0.0 ? 0.0 : -m.margin / (m.limit > 0.0 ? m.limit : 1.0));
  return violations;
}

Evaluation Evaluate(const AscentModel& model, const TrajectoryProblem& problem,
                    const std::vector<double>& variables) {
  const FlightProgram program = ProgramOf(variables);
  Evaluation evaluation;
  const double disorder = std::max(0.0, program.t1_s + kShortestRamp_s - program.t3_s) +
                          std::max(0.0, program.t3_s + kShortestRamp_s - program.t2_s);
  if (disorder > 0.0) {
    // Such a program cannot be flown; further from order is worse than anything that can.
    evaluation.constraint_violations = {1e3 * (1.0 + disorder)};
    return evaluation;
  }
  const AscentResult ascent = FlyAscent(model, program, Options(problem, kSearchStep_s, 10.0));
  if (!ascent.completed) {
    evaluation.constraint_violations = {10.0 + 1000.0 / (1.0 + ascent.end_time_s)};
    return evaluation;
  }
  const OrbitErrors errors = ErrorsOf(problem, ascent.orbit);
  evaluation.objective = problem.weight_altitude_1_m * std::fabs(errors.altitude_m) +
                         problem.weight_velocity_s_m * std::fabs(errors.velocity_m_s) +
                         problem.weight_angle_1_rad * std::fabs(errors.flight_path_angle_rad);
  evaluation.constraint_violations = Violations(Margins(problem, program, ascent));
  evaluation.tie_breaker = ascent.q_alpha_max_pa_rad;
  return evaluation;
}

// The genetic algorithm's best, refined in (alpha_max, coast, azimuth) with t1, t3 and t2 frozen.
LeastSquaresResult Refine(const AscentModel& model, const TrajectoryProblem& problem,
                          std::vector<double>& variables) {
  const std::vector<std::size_t> free = {0, 4, 5};
  const Bounds bounds[] = {problem.alpha_max_rad, problem.coast_s, problem.launch_azimuth_rad};
  const double scales[] = {0.1 * kRadPerDeg, 1.0, 0.1 * kRadPerDeg};
  LeastSquaresProblem least_squares;
  std::vector<double> start;
  for (std::size_t i = 0; i < free.size(); ++i) {
    Unknown unknown;
    unknown.lower = bounds[i].low;
    unknown.upper = bounds[i].high;
    unknown.scale = scales[i];
    unknown.difference_step = 1e-5 * scales[i];
    least_squares.unknowns.push_back(unknown);
    start.push_back(variables[free[i]]);
  }
  // A metre, a millimetre per second and a millionth of a degree count alike.
  least_squares.residual_scales = {1.0, 1e-3, 1e-6 * kRadPerDeg};
  least_squares.residuals = [&](const std::vector<double>& unknowns) -> std::vector<double> {
    std::vector<double> point = variables;
    for (std::size_t i = 0; i < free.size(); ++i) point[free[i]] = unknowns[i];
    const AscentResult ascent =
        FlyAscent(model, ProgramOf(point), Options(problem, kFineStep_s, kFineCoastStep_s));
    if (!ascent.completed) return std::vector<double>(3, std::nan(""));
    const OrbitErrors errors = ErrorsOf(problem, ascent.orbit);
    return {errors.altitude_m, errors.velocity_m_s, errors.flight_path_angle_rad};
  };
  LevenbergMarquardtOptions options;
  options.residual_tolerance = 0.05;
  options.max_iterations = 60;
  const LeastSquaresResult result = LevenbergMarquardt(options).Solve(least_squares, start);
  for (std::size_t i = 0; i < free.size(); ++i) variables[free[i]] = result.unknowns[i];
  return result;
}

std::string Statement(const TrajectoryProblem& problem, const OptimizationResult& result) {
  const OrbitErrors& e = result.errors;
  char text[512];
  std::snprintf(text, sizeof text,
                "the target was missed by %+.3f km, %+.3f m/s and %+.4f deg", e.altitude_m * 1e-3,
                e.velocity_m_s, e.flight_path_angle_rad * kDegPerRad);
  std::string statement = text;
  std::string causes;
  for (const ConstraintMargin& m : result.reference.constraints)
    if (m.enforced && m.margin < 0.0) {
      std::snprintf(text, sizeof text, "; the constraint %s = %.4g exceeds its limit %.4g", m.name.c_str(),
                    m.value, m.limit);
      causes += text;
    }
  static const char* const names[] = {"alpha_max", "coast", "launch_azimuth"};
  for (const std::size_t held : result.refinement.held_at_bound)
    causes += std::string("; ") + names[held] + " is at the end of its bounds";
  const double speed_short = -e.velocity_m_s;
  if (speed_short > kReachedVelocity_m_s)
    causes += "; the vehicle's energy falls short: at this altitude it lacks speed, whatever the program";
  if (causes.empty()) causes = std::string("; ") + std::string(Describe(result.refinement.status));
  (void)problem;
  return statement + causes;
}

}  // namespace

OrbitErrors ErrorsOf(const TrajectoryProblem& problem, const Orbit& orbit) {
  return {orbit.altitude_m - problem.target_altitude_m, orbit.velocity_m_s - problem.target_velocity_m_s,
          orbit.flight_path_angle_rad - problem.target_flight_path_angle_rad};
}

FlightProgram ProgramOf(const std::vector<double>& v) {
  FlightProgram program;
  program.alpha_max_rad = v[0];
  program.t1_s = v[1];
  program.t3_s = v[2];
  program.t2_s = v[3];
  program.coast_s = v[4];
  program.launch_azimuth_rad = v[5];
  return program;
}

Reference BuildReference(const AscentModel& model, const TrajectoryProblem& problem,
                         const FlightProgram& program, std::vector<AscentSample>* history) {
  // The orbit is that of the refinement's own steps; recording takes finer ones.
  const AscentResult ascent = FlyAscent(model, program, Options(problem, kFineStep_s, kFineCoastStep_s));
  AscentOptions recording = Options(problem, kFineStep_s, kFineCoastStep_s);
  recording.record = true;
  AscentResult recorded = FlyAscent(model, program, recording);
  Reference reference;
  reference.problem = problem;
  reference.program = program;
  reference.last_ignition_s = ascent.last_ignition_s;
  reference.orbit = ascent.orbit;
  reference.constraints = Margins(problem, program, ascent);
  reference.engine = EngineVersion();
  reference.attitude = recorded.attitude;
  if (history) *history = std::move(recorded.samples);
  return reference;
}

OptimizationResult OptimizeTrajectory(const Vehicle& vehicle, const TrajectoryProblem& problem, double tick_s,
                                      int threads, const GeneticAlgorithm::Observer& observer) {
  const AscentModel model = BuildAscentModel(vehicle, tick_s);
  BoundedProblem bounded;
  for (const Bounds& b : {problem.alpha_max_rad, problem.t1_s, problem.t3_s, problem.t2_s, problem.coast_s,
                          problem.launch_azimuth_rad}) {
    bounded.lower.push_back(b.low);
    bounded.upper.push_back(b.high);
  }
  bounded.evaluate = [&](const std::vector<double>& v) { return Evaluate(model, problem, v); };

  GeneticAlgorithmOptions options;
  options.population = problem.population;
  options.generations = problem.generations;
  options.seed = problem.seed;
  options.threads = threads;

  OptimizationResult result;
  result.genetic = GeneticAlgorithm(options).Minimize(bounded, observer);
  std::vector<double> variables = result.genetic.variables;
  result.refinement = Refine(model, problem, variables);
  const FlightProgram program = ProgramOf(variables);
  result.reference = BuildReference(model, problem, program, &result.history);
  result.reference.evaluations =
      static_cast<std::int64_t>(result.genetic.evaluations) + result.refinement.evaluations;
  result.errors = ErrorsOf(problem, result.reference.orbit);
  const AscentResult halved =
      FlyAscent(model, program, Options(problem, 0.5 * kFineStep_s, 0.5 * kFineCoastStep_s));
  result.halved_step_errors = ErrorsOf(problem, halved.orbit);

  bool met = true;
  for (const ConstraintMargin& m : result.reference.constraints) met &= !m.enforced || m.margin >= 0.0;
  result.reached = met && std::fabs(result.errors.altitude_m) <= kReachedAltitude_m &&
                   std::fabs(result.errors.velocity_m_s) <= kReachedVelocity_m_s &&
                   std::fabs(result.errors.flight_path_angle_rad) <= kReachedAngle_rad;
  if (!result.reached) result.statement = Statement(problem, result);
  return result;
}

}  // namespace dispersa
