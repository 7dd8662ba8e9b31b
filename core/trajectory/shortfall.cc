#include "core/trajectory/shortfall.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <optional>

#include "core/math/constants.h"
#include "core/trajectory/aim.h"
#include "core/trajectory/refine.h"

namespace dispersa {

namespace {

double Deg(double radians) { return radians / kRadPerDeg; }

// Text about a variable that the refinement holds at a bound.
std::string HeldText(const TrajectoryProblem& problem, const FlightProgram& program,
                     const ProgramVariable& held) {
  const double value = held.Of(program);
  const Bounds& bounds = held.BoundsOf(problem);
  const bool upper = value - bounds.low > bounds.high - value;
  return fmt::format(" {} is at the {} end of its bounds ({:.6g} {}).", held.Name(),
                     upper ? "upper" : "lower", value / held.unit(), held.unit_name());
}

struct SpeedAtTarget {
  double velocity_m_s = 0.0;
  bool on_target = false;  ///< altitude and angle reach the target
  std::vector<std::size_t> held;
  FlightProgram program;
};

// The speed at the target's altitude and angle toward one azimuth. If they cannot be reached, the energy of
// the nearest orbit gives the speed at the target's radius.
SpeedAtTarget SpeedToward(const AscentModel& model, const TrajectoryProblem& problem,
                          const TrajectoryOptions& options, FlightProgram program, double azimuth_rad) {
  program.launch_azimuth_rad = azimuth_rad;
  SpeedAtTarget speed;
  const LeastSquaresResult refined = RefineAltitudeAndAngle(model, problem, options, &program);
  const AscentResult ascent = FlyAscent(model, program, AscentOptionsOf(problem, options.steps));
  const double mu = model.plant.environment.earth.mu_m3_s2;
  const double radius_m = ascent.p_EoC_I.norm();
  const double target_radius_m = radius_m - ascent.orbit.altitude_m + AimedAltitude(problem);
  const double squared = ascent.v_IC_I.squaredNorm() + 2.0 * mu * (1.0 / target_radius_m - 1.0 / radius_m);
  speed.on_target = refined.status == LeastSquaresStatus::kConverged;
  speed.velocity_m_s = std::sqrt(std::fmax(squared, 0.0));
  speed.held = refined.held_at_bound;
  speed.program = program;
  return speed;
}

const char* Where(const SpeedAtTarget& speed) {
  return speed.on_target ? "at the target's altitude and angle" : "carried to the target's altitude";
}

// For an engine with a cut-off velocity: that velocity, and the bounds that keep altitude and angle from the
// target.
std::string CutOffText(const AscentModel& model, const TrajectoryProblem& problem,
                       const TrajectoryOptions& options, FlightProgram program) {
  std::string text;
  const Motor& engine = model.vehicle.stages.back().motor;
  const double ends_m_s = engine.cut_off_velocity_m_s;
  const double asked_m_s = AimedVelocity(problem);
  if (engine.cut_off == CutOff::kAtVelocity && !problem.velocity_is_free && !problem.is_entered_anywhere &&
      std::fabs(ends_m_s - asked_m_s) > kCutOffTolerance_m_s)
    text +=
        fmt::format(" Cut-off: the last engine is cut off at {:.3f} m/s, {:.3f} m/s {} than the target asks.",
                    ends_m_s, std::fabs(ends_m_s - asked_m_s), ends_m_s < asked_m_s ? "less" : "more");
  const LeastSquaresResult refined = RefineAltitudeAndAngle(model, problem, options, &program);
  if (refined.status == LeastSquaresStatus::kConverged) return text;
  const std::vector<ProgramVariable> variables = AltitudeAndAngleVariables(model.vehicle, problem);
  for (const std::size_t held : refined.held_at_bound)
    text += " Bound: for altitude and angle" + HeldText(problem, program, variables[held]);
  return text;
}

// The cause for altitude and angle, then for speed, each on its own. The refinement ends at a compromise
// between the three, at bounds that are not the cause.
std::string CauseText(const AscentModel& model, const TrajectoryProblem& problem,
                      const TrajectoryOptions& options, const FlightProgram& program,
                      const FlightProgram& best) {
  // An engine with a cut-off velocity could burn on, so energy is not the cause. The refinement may have
  // ended where the propellant does, and the best program not.
  for (const FlightProgram& one : {program, best})
    if (EndsByVelocity(model, FlyAscent(model, one, AscentOptionsOf(problem, options.steps))))
      return CutOffText(model, problem, options, one);
  const Bounds& azimuth = problem.launch_azimuth_rad;
  SpeedAtTarget slow = SpeedToward(model, problem, options, program, azimuth.high);
  SpeedAtTarget fast = SpeedToward(model, problem, options, program, azimuth.low);
  if (slow.velocity_m_s > fast.velocity_m_s) std::swap(slow, fast);
  std::string text;
  if (!fast.on_target) {
    const std::vector<ProgramVariable> variables = AltitudeAndAngleVariables(model.vehicle, problem);
    for (const std::size_t held : fast.held)
      text += " Bound: for altitude and angle" + HeldText(problem, fast.program, variables[held]);
  }
  if (problem.velocity_is_free) return text;
  const double asked = AimedVelocity(problem);
  if (fast.velocity_m_s < asked)
    text += fmt::format(
        " Energy: {} the vehicle has at most {:.1f} m/s (launch azimuth {:.6g} deg), {:.1f} m/s less than "
        "the "
        "target asks.",
        Where(fast), fast.velocity_m_s, Deg(fast.program.launch_azimuth_rad), asked - fast.velocity_m_s);
  if (slow.velocity_m_s > asked)
    text += fmt::format(
        " Energy: {} the vehicle has at least {:.1f} m/s (launch azimuth {:.6g} deg), {:.1f} m/s more than "
        "the "
        "target asks; the bounds of the launch azimuth do not let it spend the surplus.",
        Where(slow), slow.velocity_m_s, Deg(slow.program.launch_azimuth_rad), slow.velocity_m_s - asked);
  return text;
}

}  // namespace

std::string DescribeShortfall(const AscentModel& model, const TrajectoryProblem& problem,
                              const TrajectoryOptions& options, const OptimizationResult& result) {
  const FlightProgram& program = result.reference.program;
  const AscentResult ascent = FlyAscent(model, program, AscentOptionsOf(problem, options.steps));
  if (!ascent.completed)
    return fmt::format(
        "The target is out of reach: every program falls back to the ground; the best flies {:.1f} s.",
        ascent.end_time_s);
  const OrbitErrors& e = result.errors;
  // A miss this small does not mean that the target is out of reach.
  constexpr OrbitErrors kNear = {100.0, 0.5, 0.01 * kRadPerDeg, 0.01 * kRadPerDeg, 0.1 * kRadPerDeg};
  std::string text =
      fmt::format("The target is {}: the best program ends {:+.3f} km, {:+.3f} m/s and {:+.4f} deg from it.",
                  IsWithin(e, kNear) ? "narrowly missed" : "out of reach", e.altitude_m * 1e-3,
                  e.velocity_m_s, Deg(e.flight_path_angle_rad));
  if (problem.target_inclination_rad)
    text += fmt::format(" Its inclination is off by {:+.4f} deg.", Deg(e.inclination_rad));
  if (problem.target_argument_of_perigee_rad)
    text += fmt::format(" Its argument of perigee is off by {:+.3f} deg.", Deg(e.argument_of_perigee_rad));
  const std::size_t before = text.size();
  for (const ConstraintMargin& c : result.reference.constraints)
    if (c.enforced && c.margin < 0.0)
      text += fmt::format(" Constraint: {} = {:.6g} exceeds its limit of {:.6g}.", c.name, c.value, c.limit);
  // The speed is no residual of an engine with a cut-off velocity.
  if (result.refinement.status != LeastSquaresStatus::kConverged || EndsByVelocity(model, ascent)) {
    text += CauseText(model, problem, options, result.refined, program);
    if (text.size() > before) return text;
    const std::vector<ProgramVariable> variables = RefinedVariables(model.vehicle, problem);
    for (const std::size_t held : result.refinement.held_at_bound)
      text += " Bound:" + HeldText(problem, result.refined, variables[held]);
  }
  if (text.size() == before) text += fmt::format(" The refinement {}.", Describe(result.refinement.status));
  return text;
}

}  // namespace dispersa
