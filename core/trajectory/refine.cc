#include "core/trajectory/refine.h"

#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/math/constants.h"
#include "core/vehicle/cut_off.h"

namespace dispersa {

namespace {

using Kind = ProgramVariable::Kind;

// Step of forward differences, as a fraction of a variable's scale. Rounding and curvature of the ascent each
// cause an error of about 1e-5 of a derivative, which does not slow Newton's method.
constexpr double kDifference = 1e-5;
// A refinement ends this far inside the tolerance, so that rounding in files, other steps and other compilers
// stay within it.
constexpr double kWithinTolerance = 0.02;
// Far from the target, errors that cost about the same to remove count alike. In units of the tolerances an
// angle would be met first, and the rest along a valley as narrow as its tolerance. Then: the end of this.
constexpr OrbitErrors kFarOff = {1e3, 1.0, 0.05 * kRadPerDeg, 0.05 * kRadPerDeg, 0.5 * kRadPerDeg};
constexpr double kNearEnough = 1e-3;

// Speed (m/s, not positive) that the last engine lacks of its cut-off when its propellant ends.
double LacksOfCutOff(const AscentModel& model, const AscentResult& ascent) {
  if (EndsByVelocity(model, ascent)) return 0.0;
  const Orbit& orbit = ascent.orbit;
  return orbit.velocity_m_s -
         CutOffSpeed(model.vehicle.stages.back().motor, orbit.radius_m, orbit.altitude_m);
}

// What a refinement solves.
struct Refinement {
  const std::vector<ProgramVariable>& freedoms;
  bool with_speed = true;  ///< and plane and perigee, where the target names them
  bool with_all = false;   ///< else as many of the freedoms, from the first on, as there are conditions
  OrbitErrors scale;       ///< errors that count alike
  double within = kWithinTolerance;  ///< of `scale`: where it ends
};

LeastSquaresResult Solve(const AscentModel& model, const TrajectoryProblem& problem,
                         const TrajectoryOptions& options, const Refinement& refinement,
                         FlightProgram* program, AscentResult* ascent = nullptr) {
  const AscentOptions ascent_options = AscentOptionsOf(problem, options.steps);
  const bool with_speed = refinement.with_speed;
  // If the engine is cut off at a velocity, no variable of the program changes the speed. As a condition it
  // would stall the others. The speed that an engine lacks when its propellant ends is a condition: without
  // it the search would go where the engine burns out.
  const bool ends = with_speed && EndsByVelocity(model, FlyAscent(model, *program, ascent_options));
  const bool speed = with_speed && !problem.velocity_is_free && !ends;
  const bool reach = ends && refinement.with_all;
  const bool plane = with_speed && problem.target_inclination_rad.has_value();
  const bool turned = with_speed && problem.target_argument_of_perigee_rad.has_value();
  const bool angle = !problem.is_entered_anywhere;
  const std::size_t conditions = 1 + (angle ? 1 : 0) + (speed ? 1 : 0) + (plane ? 1 : 0) + (turned ? 1 : 0);
  LeastSquaresProblem least_squares;
  std::vector<ProgramVariable> free;
  std::vector<std::size_t> index;
  std::vector<double> start;
  for (std::size_t i = 0; i < refinement.freedoms.size(); ++i) {
    const ProgramVariable& freedom = refinement.freedoms[i];
    const Bounds& bounds = freedom.BoundsOf(problem);
    // A variable with equal bounds is frozen. More unknowns than conditions leave a manifold, of which the
    // damping takes the nearest program.
    if (!(bounds.low < bounds.high) || (!refinement.with_all && free.size() == conditions)) continue;
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
    std::size_t next = 1;
    if (angle) values[next++] = errors.flight_path_angle_rad;
    if (speed) values[next++] = errors.velocity_m_s;
    if (plane) values[next++] = errors.inclination_rad;
    if (turned) values[next++] = errors.argument_of_perigee_rad;
    if (reach) values[next++] = LacksOfCutOff(model, flown);
    for (; next < values.size(); ++next) values[next] = 0.0;
    return values;
  };
  const auto program_at = [&](const std::vector<double>& unknowns) {
    FlightProgram trial = *program;
    for (std::size_t i = 0; i < free.size(); ++i) free[i].Of(trial) = unknowns[i];
    return trial;
  };
  least_squares.residual_scales = {refinement.scale.altitude_m};
  if (angle) least_squares.residual_scales.push_back(refinement.scale.flight_path_angle_rad);
  if (speed) least_squares.residual_scales.push_back(refinement.scale.velocity_m_s);
  if (plane) least_squares.residual_scales.push_back(refinement.scale.inclination_rad);
  if (turned) least_squares.residual_scales.push_back(refinement.scale.argument_of_perigee_rad);
  if (reach) least_squares.residual_scales.push_back(refinement.scale.velocity_m_s);
  // The method needs as many residuals as unknowns: further ones are 0.
  while (least_squares.residual_scales.size() < free.size()) least_squares.residual_scales.push_back(1.0);
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
  settings.residual_tolerance = refinement.within;
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

// Those, the earlier coasts and the end of the pitch-over.
std::vector<ProgramVariable> AllRefinedVariables(const Vehicle& vehicle, const TrajectoryProblem& problem) {
  std::vector<ProgramVariable> variables = {{Kind::kAlphaMax}, {Kind::kCoast}, {Kind::kAzimuth}, {Kind::kT2}};
  for (const std::size_t stage : EarlierCoasts(vehicle)) variables.push_back({Kind::kEarlierCoast, stage});
  const std::vector<ProgramVariable> steering = SteeringVariables(vehicle, problem);
  variables.insert(variables.end(), steering.begin(), steering.end());
  return variables;
}

LeastSquaresResult RefineProgram(const AscentModel& model, const TrajectoryProblem& problem,
                                 const TrajectoryOptions& options, FlightProgram* program,
                                 AscentResult* ascent) {
  const FlightProgram start = *program;
  const std::vector<ProgramVariable> first = RefinedVariables(model.vehicle, problem);
  LeastSquaresResult result =
      Solve(model, problem, options, {first, true, false, options.tolerance}, program, ascent);
  if (result.status == LeastSquaresStatus::kConverged) return result;
  // Some of those variables may be frozen, at a bound, or without effect on what is missing: so with all.
  const std::vector<ProgramVariable> all = AllRefinedVariables(model.vehicle, problem);
  FlightProgram again = start;
  AscentResult flown;
  const LeastSquaresResult near =
      Solve(model, problem, options, {all, true, true, kFarOff, kNearEnough}, &again, &flown);
  LeastSquaresResult more =
      Solve(model, problem, options, {all, true, true, options.tolerance}, &again, &flown);
  more.evaluations += near.evaluations + result.evaluations;
  if (more.status == LeastSquaresStatus::kConverged) {
    *program = again;
    if (ascent) *ascent = std::move(flown);
    more.held_at_bound.clear();  // positions in another list, and of no interest
    return more;
  }
  result.evaluations = more.evaluations;
  return result;
}

LeastSquaresResult RefineAltitudeAndAngle(const AscentModel& model, const TrajectoryProblem& problem,
                                          const TrajectoryOptions& options, FlightProgram* program) {
  const std::vector<ProgramVariable> variables = AltitudeAndAngleVariables(model.vehicle, problem);
  return Solve(model, problem, options, {variables, false, false, options.tolerance}, program);
}

bool EndsByVelocity(const AscentModel& model, const AscentResult& ascent) {
  const std::size_t last = model.vehicle.stages.size() - 1;
  return EndsAtSpeed(model.vehicle.stages[last].motor) && ascent.completed &&
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
