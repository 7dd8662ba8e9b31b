#include "core/trajectory/refine.h"

#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/math/constants.h"

namespace dispersa {

namespace {

using Kind = ProgramVariable::Kind;

// Step of forward differences, as a fraction of a variable's scale. Rounding and curvature of the ascent each
// cause an error of about 1e-5 of a derivative, which does not slow Newton's method.
constexpr double kDifference = 1e-5;
// A refinement ends this far inside the tolerance, so that rounding in files, other steps and other compilers
// stay within it.
constexpr double kWithinTolerance = 0.02;

LeastSquaresResult Solve(const AscentModel& model, const TrajectoryProblem& problem,
                         const TrajectoryOptions& options, const std::vector<ProgramVariable>& freedoms,
                         bool with_speed, FlightProgram* program, AscentResult* ascent = nullptr) {
  const AscentOptions ascent_options = AscentOptionsOf(problem, options.steps);
  // If the engine is cut off at a velocity, no variable of the program changes the speed. As a condition it
  // would stall the others.
  const bool speed = with_speed && !problem.velocity_is_free &&
                     !EndsByVelocity(model, FlyAscent(model, *program, ascent_options));
  const bool plane = with_speed && problem.target_inclination_rad.has_value();
  const bool turned = with_speed && problem.target_argument_of_perigee_rad.has_value();
  const std::size_t conditions = 2 + (speed ? 1 : 0) + (plane ? 1 : 0) + (turned ? 1 : 0);
  LeastSquaresProblem least_squares;
  std::vector<ProgramVariable> free;
  std::vector<std::size_t> index;
  std::vector<double> start;
  for (std::size_t i = 0; i < freedoms.size(); ++i) {
    const ProgramVariable& freedom = freedoms[i];
    const Bounds& bounds = freedom.BoundsOf(problem);
    // A variable with equal bounds is frozen. More unknowns than conditions would leave a manifold.
    if (!(bounds.low < bounds.high) || free.size() == conditions) continue;
    Unknown unknown;
    unknown.lower = bounds.low;
    unknown.upper = bounds.high;
    unknown.scale = freedom.scale();
    unknown.difference = Difference::kForward;
    unknown.difference_step = std::fmin(kDifference * freedom.scale(), 0.5 * (bounds.high - bounds.low));
    least_squares.unknowns.push_back(unknown);
    free.push_back(freedom);
    index.push_back(i);
    start.push_back(freedom.Of(*program));
  }
  const auto residuals = [&](const AscentResult& flown) {
    std::vector<double> values(least_squares.residual_scales.size(),
                               std::numeric_limits<double>::quiet_NaN());
    if (!flown.completed) return values;
    const OrbitErrors errors = ErrorsOf(problem, flown.orbit);
    values[0] = errors.altitude_m;
    values[1] = errors.flight_path_angle_rad;
    std::size_t next = 2;
    if (speed) values[next++] = errors.velocity_m_s;
    if (plane) values[next++] = errors.inclination_rad;
    if (turned) values[next] = errors.argument_of_perigee_rad;
    return values;
  };
  const auto program_at = [&](const std::vector<double>& unknowns) {
    FlightProgram trial = *program;
    for (std::size_t i = 0; i < free.size(); ++i) free[i].Of(trial) = unknowns[i];
    return trial;
  };
  least_squares.residual_scales = {options.tolerance.altitude_m, options.tolerance.flight_path_angle_rad};
  if (speed) least_squares.residual_scales.push_back(options.tolerance.velocity_m_s);
  if (plane) least_squares.residual_scales.push_back(options.tolerance.inclination_rad);
  if (turned) least_squares.residual_scales.push_back(options.tolerance.argument_of_perigee_rad);
  // The ascent of every point tried. One of them is the end.
  std::vector<std::pair<std::vector<double>, AscentResult>> tried;
  least_squares.residuals = [&](const std::vector<double>& unknowns) {
    tried.emplace_back(unknowns, FlyAscent(model, program_at(unknowns), ascent_options));
    return residuals(tried.back().second);
  };
  least_squares.residuals_together = [&](std::span<const std::vector<double>> points) {
    std::vector<FlightProgram> programs;
    for (const std::vector<double>& unknowns : points) programs.push_back(program_at(unknowns));
    const std::vector<AscentResult> ascents = FlyAscents(model, programs, ascent_options);
    tried.emplace_back(points.front(), ascents.front());
    std::vector<std::vector<double>> all;
    for (const AscentResult& flown : ascents) all.push_back(residuals(flown));
    return all;
  };
  const auto end_at = [&](const std::vector<double>& unknowns) {
    if (!ascent) return;
    for (const auto& [point, flown] : tried)
      if (point == unknowns) *ascent = flown;
  };
  if (free.empty()) {
    LeastSquaresResult result;
    result.residuals = least_squares.residuals(start);
    end_at(start);
    result.status = LeastSquaresStatus::kAtBound;
    return result;
  }
  LevenbergMarquardtOptions settings;
  settings.residual_tolerance = kWithinTolerance;
  settings.max_iterations = options.refinement_iterations;
  LeastSquaresResult result = LevenbergMarquardt(settings).Solve(least_squares, start);
  end_at(result.unknowns);
  *program = program_at(result.unknowns);
  for (std::size_t& held : result.held_at_bound) held = index[held];
  return result;
}

}  // namespace

std::vector<ProgramVariable> AltitudeAndAngleVariables(const Vehicle& vehicle,
                                                       const TrajectoryProblem& problem) {
  std::vector<ProgramVariable> variables = {{Kind::kAlphaMax}, {Kind::kCoast}};
  const std::vector<ProgramVariable> steering = SteeringVariables(vehicle, problem);
  variables.insert(variables.end(), steering.begin(), steering.end());
  return variables;
}

// Three conditions have three unknowns. An inclination beside a speed is a fourth condition, an argument of
// perigee a fifth. The earlier coasts serve them. Without earlier coasts the end of the pitch-over (t2) does,
// which changes the losses a little. The steering of upper stages always helps.
std::vector<ProgramVariable> RefinedVariables(const Vehicle& vehicle, const TrajectoryProblem& problem) {
  std::vector<ProgramVariable> variables = {{Kind::kAlphaMax}, {Kind::kCoast}, {Kind::kAzimuth}};
  const std::vector<ProgramVariable> steering = SteeringVariables(vehicle, problem);
  if (problem.target_inclination_rad && !problem.velocity_is_free) {
    const std::vector<std::size_t> coasts = EarlierCoasts(vehicle);
    for (const std::size_t stage : coasts) variables.push_back({Kind::kEarlierCoast, stage});
    if (coasts.empty() && steering.empty()) variables.push_back({Kind::kT2});
  }
  variables.insert(variables.end(), steering.begin(), steering.end());
  return variables;
}

LeastSquaresResult RefineProgram(const AscentModel& model, const TrajectoryProblem& problem,
                                 const TrajectoryOptions& options, FlightProgram* program,
                                 AscentResult* ascent) {
  return Solve(model, problem, options, RefinedVariables(model.vehicle, problem), true, program, ascent);
}

LeastSquaresResult RefineAltitudeAndAngle(const AscentModel& model, const TrajectoryProblem& problem,
                                          const TrajectoryOptions& options, FlightProgram* program) {
  return Solve(model, problem, options, AltitudeAndAngleVariables(model.vehicle, problem), false, program);
}

bool EndsByVelocity(const AscentModel& model, const AscentResult& ascent) {
  const std::size_t last = model.vehicle.stages.size() - 1;
  return model.vehicle.stages[last].motor.cut_off == CutOff::kAtVelocity && ascent.completed &&
         std::isfinite(ascent.cut_off_s[last]);
}

AscentOptions AscentOptionsOf(const TrajectoryProblem& problem, const AscentSteps& steps) {
  AscentOptions options;
  options.steps = steps;
  options.mach_low = problem.transonic_mach_low;
  options.mach_high = problem.transonic_mach_high;
  return options;
}

}  // namespace dispersa
