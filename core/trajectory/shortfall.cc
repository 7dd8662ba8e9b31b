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

// Text about a variable that a refinement holds at a bound. `best` is the program that is reported.
std::string HeldText(const TrajectoryProblem& problem, const FlightProgram& program,
                     const FlightProgram& best, const ProgramVariable& held) {
  const double value = held.Of(program), reported = held.Of(best);
  const Bounds& bounds = held.BoundsOf(problem);
  const bool upper = value - bounds.low > bounds.high - value;
  const std::string elsewhere =
      std::fabs(reported - value) > 1e-3 * (bounds.high - bounds.low)
          ? fmt::format("; the best program has {:.6g} {}", reported / held.unit(), held.unit_name())
          : "";
  return fmt::format(" {} stops at the {} end of its bounds ({:.6g} {}){}.", held.Name(),
                     upper ? "upper" : "lower", value / held.unit(), held.unit_name(), elsewhere);
}
// Rounded to what is shown, without a negative zero.
double Shown(double value, int decimals) {
  double scale = 1.0;
  for (int i = 0; i < decimals; ++i) scale *= 10.0;
  return std::round(value * scale) / scale + 0.0;
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
                       const TrajectoryOptions& options, FlightProgram program, const FlightProgram& best) {
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
    text += " Bound: for altitude and angle" + HeldText(problem, program, best, variables[held]);
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
      return CutOffText(model, problem, options, one, best);
  const Bounds& azimuth = problem.launch_azimuth_rad;
  SpeedAtTarget slow = SpeedToward(model, problem, options, program, azimuth.high);
  SpeedAtTarget fast = SpeedToward(model, problem, options, program, azimuth.low);
  if (slow.velocity_m_s > fast.velocity_m_s) std::swap(slow, fast);
  std::string text;
  if (!fast.on_target) {
    const std::vector<ProgramVariable> variables = AltitudeAndAngleVariables(model.vehicle, problem);
    for (const std::size_t held : fast.held)
      text += " Bound: for altitude and angle" + HeldText(problem, fast.program, best, variables[held]);
  }
  if (problem.velocity_is_free) return text;
  const double asked = AimedVelocity(problem);
  const auto speed = [&](const SpeedAtTarget& found, const char* end, const char* than) {
    text += fmt::format(
        " Speed: {} the {} end of the launch azimuth's bounds ({:.6g} deg) gives {:.1f} m/s, {:.1f} m/s {} "
        "than the target asks.",
        Where(found), end, Deg(found.program.launch_azimuth_rad), found.velocity_m_s,
        std::fabs(asked - found.velocity_m_s), than);
  };
  if (fast.velocity_m_s < asked) speed(fast, "faster", "less");
  if (slow.velocity_m_s > asked) speed(slow, "slower", "more");
  return text;
}

}  // namespace

std::string DescribeShortfall(const AscentModel& model, const TrajectoryProblem& problem,
                              const TrajectoryOptions& options, const OptimizationResult& result) {
  const FlightProgram& program = result.reference.program;
  const AscentResult ascent = FlyAscent(model, program, AscentOptionsOf(problem, options.steps));
  const std::int64_t tried = result.reference.evaluations;
  constexpr const char* kUntried = " Other bounds, populations and seeds were not tried.";
  if (!ascent.completed)
    return fmt::format(
               "The target is not reached: none of {} ascents within the bounds comes to an orbit; the best "
               "flies {:.1f} s.",
               tried, ascent.end_time_s) +
           kUntried;
  const OrbitErrors& e = result.errors;
  constexpr OrbitErrors kNear = {100.0, 0.5, 0.01 * kRadPerDeg, 0.01 * kRadPerDeg, 0.1 * kRadPerDeg};
  std::string text =
      IsWithin(e, result.tolerance)
          ? fmt::format("The target is reached, but by none of {} ascents with every constraint met.", tried)
          : fmt::format(
                "The target is {}: the best of {} ascents within the bounds ends {:+.3f} km, {:+.3f} m/s and "
                "{:+.4f} deg from it.",
                IsWithin(e, kNear) ? "narrowly missed" : "not reached", tried, Shown(e.altitude_m * 1e-3, 3),
                Shown(e.velocity_m_s, 3), Shown(Deg(e.flight_path_angle_rad), 4));
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
    if (text.size() > before) return text + kUntried;
    const std::vector<ProgramVariable> variables = RefinedVariables(model.vehicle, problem);
    for (const std::size_t held : result.refinement.held_at_bound)
      text += " Bound:" + HeldText(problem, result.refined, program, variables[held]);
  }
  if (text.size() == before) text += fmt::format(" The refinement {}.", Describe(result.refinement.status));
  return text + kUntried;
}

}  // namespace dispersa
