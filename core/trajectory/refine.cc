#include "core/trajectory/refine.h"

#include <cmath>
#include <limits>

#include "core/math/constants.h"

namespace dispersa {

namespace {

// One unknown of the refinement.
struct Freedom {
  double FlightProgram::*variable;
  Bounds TrajectoryProblem::*bounds;
  double scale;
};

constexpr Freedom kAlphaMax = {&FlightProgram::alpha_max_rad, &TrajectoryProblem::alpha_max_rad,
                               0.1 * kRadPerDeg};
constexpr Freedom kCoast = {&FlightProgram::coast_s, &TrajectoryProblem::coast_s, 1.0};
constexpr Freedom kAzimuth = {&FlightProgram::launch_azimuth_rad, &TrajectoryProblem::launch_azimuth_rad,
                              0.1 * kRadPerDeg};
// Forward differences over this fraction of a scale: the ascent's rounding and its curvature both spoil about
// 1e-5 of a derivative, which costs Newton's method nothing.
constexpr double kDifference = 1e-5;
// A refinement ends this far inside the tolerance, so that text, other steps and other compilers keep it.
constexpr double kWithinTolerance = 0.02;

LeastSquaresResult Solve(const AscentModel& model, const TrajectoryProblem& problem,
                         const TrajectoryOptions& options, const std::vector<Freedom>& freedoms,
                         bool with_speed, FlightProgram* program) {
  LeastSquaresProblem least_squares;
  std::vector<Freedom> free;
  std::vector<std::size_t> index;
  std::vector<double> start;
  for (std::size_t i = 0; i < freedoms.size(); ++i) {
    const Freedom& freedom = freedoms[i];
    const Bounds& bounds = problem.*freedom.bounds;
    // Equal bounds freeze a variable.
    if (!(bounds.low < bounds.high)) continue;
    Unknown unknown;
    unknown.lower = bounds.low;
    unknown.upper = bounds.high;
    unknown.scale = freedom.scale;
    unknown.difference = Difference::kForward;
    unknown.difference_step = std::fmin(kDifference * freedom.scale, 0.5 * (bounds.high - bounds.low));
    least_squares.unknowns.push_back(unknown);
    free.push_back(freedom);
    index.push_back(i);
    start.push_back(program->*freedom.variable);
  }
  const auto fly = [&](const std::vector<double>& unknowns) {
    FlightProgram trial = *program;
    for (std::size_t i = 0; i < free.size(); ++i) trial.*free[i].variable = unknowns[i];
    return FlyAscent(model, trial, AscentOptionsOf(problem, options.steps));
  };
  least_squares.residual_scales = {options.tolerance.altitude_m, options.tolerance.flight_path_angle_rad};
  if (with_speed) least_squares.residual_scales.push_back(options.tolerance.velocity_m_s);
  least_squares.residuals = [&](const std::vector<double>& unknowns) {
    const AscentResult ascent = fly(unknowns);
    std::vector<double> residuals(least_squares.residual_scales.size(),
                                  std::numeric_limits<double>::quiet_NaN());
    if (!ascent.completed) return residuals;
    const OrbitErrors errors = ErrorsOf(problem, ascent.orbit);
    residuals[0] = errors.altitude_m;
    residuals[1] = errors.flight_path_angle_rad;
    if (with_speed) residuals[2] = errors.velocity_m_s;
    return residuals;
  };
  if (free.empty()) {
    LeastSquaresResult result;
    result.residuals = least_squares.residuals(start);
    result.status = LeastSquaresStatus::kAtBound;
    return result;
  }
  LevenbergMarquardtOptions settings;
  settings.residual_tolerance = kWithinTolerance;
  settings.max_iterations = options.refinement_iterations;
  LeastSquaresResult result = LevenbergMarquardt(settings).Solve(least_squares, start);
  for (std::size_t i = 0; i < free.size(); ++i) program->*free[i].variable = result.unknowns[i];
  for (std::size_t& held : result.held_at_bound) held = index[held];
  return result;
}

}  // namespace

LeastSquaresResult RefineProgram(const AscentModel& model, const TrajectoryProblem& problem,
                                 const TrajectoryOptions& options, FlightProgram* program) {
  return Solve(model, problem, options, {kAlphaMax, kCoast, kAzimuth}, true, program);
}

LeastSquaresResult RefineAltitudeAndAngle(const AscentModel& model, const TrajectoryProblem& problem,
                                          const TrajectoryOptions& options, FlightProgram* program) {
  return Solve(model, problem, options, {kAlphaMax, kCoast}, false, program);
}

AscentOptions AscentOptionsOf(const TrajectoryProblem& problem, const AscentSteps& steps) {
  AscentOptions options;
  options.steps = steps;
  options.mach_low = problem.transonic_mach_low;
  options.mach_high = problem.transonic_mach_high;
  return options;
}

}  // namespace dispersa
