#include "core/pages/trajectory_page.h"

#include <fmt/format.h>

#include <cctype>
#include <limits>

#include "core/math/constants.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/pages/trajectory_figures.h"
#include "core/results/text.h"
#include "core/trajectory/aim.h"

namespace dispersa {
namespace {

double Deg(double radians) { return radians / kRadPerDeg; }
std::string Capital(std::string words) {
  words[0] = static_cast<char>(std::toupper(words[0]));
  return words;
}
std::string Signed(double value) { return fmt::format("{:+.2g}", value + 0.0); }

std::string InjectionTable(const OptimizationResult& result, const std::optional<CheckFlight>& check) {
  std::vector<HtmlTable::Column> columns = {{Capital(AscentEndWords(result.history))},
                                            {"desired", true},
                                            {"reached", true},
                                            {"error", true},
                                            {"with half the steps", true}};
  const bool flown = check && check->completed();
  if (flown) columns.push_back({"flown closed loop", true});
  HtmlTable table(columns);
  for (const InjectionRow& row : InjectionRows(result, check)) {
    std::vector<std::string> cells = {HtmlText(row.name), ReadableText(row.desired),
                                      FixedText(row.reached, row.decimals), Signed(row.error),
                                      Signed(row.halved)};
    if (flown) cells.push_back(row.flown ? Signed(*row.flown) : "–");
    table.Row(cells);
  }
  return table.Html();
}

/// A search that ends on a bound was limited by it: the optimum may lie on the bound, or beyond it.
std::string BoundReached(double value, const Bounds& bounds) {
  const double near = 1e-3 * (bounds.high - bounds.low);
  if (!(near > 0.0)) return "fixed";
  return value - bounds.low <= near    ? "at its lower bound"
         : bounds.high - value <= near ? "at its upper bound"
                                       : "";
}

// The azimuth within bounds that may go on beyond north (360°).
double Unwrapped(double azimuth_rad, const Bounds& bounds) {
  return azimuth_rad < bounds.low && azimuth_rad + kTwoPi <= bounds.high * (1.0 + 1e-12)
             ? azimuth_rad + kTwoPi
             : azimuth_rad;
}

std::string VariableTable(const Reference& reference) {
  const TrajectoryProblem& problem = reference.problem;
  const FlightProgram& program = reference.program;
  HtmlTable table("Variable|#value|#from|#to|");
  const auto row = [&](const char* name, double value, const Bounds& bounds, double unit) {
    const std::string bound = BoundReached(value, bounds);
    table.Row({name, FixedText(value / unit, 6), ReadableText(bounds.low / unit),
               ReadableText(bounds.high / unit),
               bound.empty() ? "" : "<span class=\"badge design\">" + bound + "</span>"});
  };
  row("α<sub>max</sub>, °", program.alpha_max_rad, problem.alpha_max_rad, kRadPerDeg);
  row("t1, start of the pitch-over, s", program.t1_s, problem.t1_s, 1.0);
  row("t3, maximum incidence, s", program.t3_s, problem.t3_s, 1.0);
  row("t2, end of the pitch-over, s", program.t2_s, problem.t2_s, 1.0);
  row("Coast before the last stage, s", program.coast_s, problem.coast_s, 1.0);
  for (std::size_t i = 1; i < program.earlier_coast_s.size(); ++i)
    if (reference.earlier_ignition_s[i] > 0.0)
      row(("Coast before stage " + std::to_string(i + 1) + ", s").c_str(), program.earlier_coast_s[i],
          problem.earlier_coast_s[i], 1.0);
  for (std::size_t i = 0; i < program.steering.size(); ++i) {
    if (problem.steering[i].empty()) continue;
    const std::string of_stage = ", incidence of stage " + std::to_string(i + 1) + ", °";
    row(("Begin" + of_stage).c_str(), program.steering[i].begin_rad, problem.steering[i].begin_rad,
        kRadPerDeg);
    row(("End" + of_stage).c_str(), program.steering[i].end_rad, problem.steering[i].end_rad, kRadPerDeg);
  }
  row("Launch azimuth, °", Unwrapped(program.launch_azimuth_rad, problem.launch_azimuth_rad),
      problem.launch_azimuth_rad, kRadPerDeg);
  return table.Html("narrow");
}

std::string ConstraintTable(const Reference& reference) {
  HtmlTable table("Constraint|#value|#limit|#margin");
  for (const ConstraintMargin& c : reference.constraints) {
    table.Row({"<code>" + HtmlText(c.name) + "</code>", ReadableText(c.value),
               c.enforced ? ReadableText(c.limit) : "none", c.enforced ? ReadableText(c.margin) : "–"});
  }
  return table.Html("narrow");
}

std::string DrawSearch(const SvgChart& chart, const std::string& caption) {
  return Figure(chart.Svg(caption), HtmlText(caption));
}

std::string SearchFigures(const OptimizationResult& result) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> generation, best, mean, feasible;
  for (const GenerationRecord& record : result.genetic.log) {
    generation.push_back(record.generation);
    best.push_back(record.best_objective.value_or(kNaN));
    mean.push_back(record.mean_objective.value_or(kNaN));
    feasible.push_back(record.feasible_fraction);
  }
  SvgChart objective({.label = "generation"}, {.label = "weighted miss of the target", .logarithmic = true});
  objective.Line(generation, best, "line-0", "best");
  objective.Line(generation, mean, "line-1", "mean of the feasible");
  SvgChart fraction({.label = "generation"}, {.label = "feasible", .low = 0.0, .high = 1.0, .percent = true});
  fraction.Line(generation, feasible, "line-0", "");
  std::string figures = DrawSearch(objective,
                                   "Search over all variables of the flight program. Misses within the tie "
                                   "tolerance of the best are equal, so the "
                                   "best may rise while the peak of q·α falls.") +
                        DrawSearch(fraction, "Individuals that satisfy every constraint.");
  if (result.selection.log.empty()) return figures;
  std::vector<double> step, load;
  for (const GenerationRecord& record : result.selection.log) {
    step.push_back(record.generation);
    load.push_back(record.best_objective.value_or(kNaN));
  }
  SvgChart selection({.label = "generation"}, {.label = "peak of q·α, Pa rad"});
  selection.Line(step, load, "line-0", "best");
  return figures +
         DrawSearch(selection,
                    "Selection over t1, t3 and t2 among programs that reach the target: the least peak of "
                    "q·α.");
}

std::string CheckFlightParagraph(const std::optional<CheckFlight>& check) {
  if (!check)
    return "<p class=\"soft\">No check flight was flown: whether an autopilot can fly it is not known.</p>\n";
  return "<p>" + VerdictBadge(check->completed() ? "pass" : "fail") + " " +
         HtmlText(CheckFlightText(*check)) + ".</p>\n";
}

// "0.01 a metre of altitude": the weight of a miss, as the file states it.
std::string ObjectiveText(const TrajectoryProblem& problem) {
  std::string text = fmt::format("{} per km of altitude", ReadableText(problem.weight_altitude_1_m * 1e3));
  if (!problem.velocity_is_free)
    text += fmt::format(", {} per m/s of speed", ReadableText(problem.weight_velocity_s_m));
  text += fmt::format(", {} per degree of flight path angle",
                      ReadableText(problem.weight_angle_1_rad * kRadPerDeg));
  if (problem.target_inclination_rad)
    text += fmt::format(", {} per degree of inclination",
                        ReadableText(problem.weight_inclination_1_rad * kRadPerDeg));
  if (problem.target_argument_of_perigee_rad)
    text += fmt::format(", {} per degree of the argument of perigee",
                        ReadableText(problem.weight_argument_1_rad * kRadPerDeg));
  return text;
}

}  // namespace

std::vector<InjectionRow> InjectionRows(const OptimizationResult& result,
                                        const std::optional<CheckFlight>& check) {
  const Reference& reference = result.reference;
  const TrajectoryProblem& problem = reference.problem;
  const Orbit& orbit = reference.orbit;
  const OrbitErrors &error = result.errors, &halved = result.halved_step_errors;
  const auto arrived = [&](double OrbitErrors::*of, double unit) {
    return check && check->completed() ? std::optional<double>(check->errors.*of * unit) : std::nullopt;
  };
  std::vector<InjectionRow> rows;
  // The altitudes of an ellipse count from the equator's radius. The flight's geodetic altitude is no measure
  // of them.
  const bool ellipse = problem.target_apogee_m.has_value();
  const double altitude_m = AimedAltitude(problem);
  const char* const at = problem.target_true_anomaly_rad ? "altitude at the true anomaly, km"
                         : ellipse                       ? "perigee altitude, km"
                                                         : "altitude, km";
  rows.push_back({at, 6, altitude_m * 1e-3, (altitude_m + error.altitude_m) * 1e-3, error.altitude_m * 1e-3,
                  halved.altitude_m * 1e-3,
                  ellipse ? std::nullopt : arrived(&OrbitErrors::altitude_m, 1e-3)});
  if (problem.is_entered_anywhere)
    rows.push_back({"velocity there, m/s", 6, orbit.velocity_m_s - error.velocity_m_s, orbit.velocity_m_s,
                    error.velocity_m_s, halved.velocity_m_s, std::nullopt});
  else if (!problem.velocity_is_free)
    rows.push_back({"velocity, m/s", 6, AimedVelocity(problem), orbit.velocity_m_s, error.velocity_m_s,
                    halved.velocity_m_s, arrived(&OrbitErrors::velocity_m_s, 1.0)});
  if (!problem.is_entered_anywhere)
    rows.push_back({"flight path angle, deg", 9, Deg(problem.target_flight_path_angle_rad),
                    Deg(orbit.flight_path_angle_rad), Deg(error.flight_path_angle_rad),
                    Deg(halved.flight_path_angle_rad),
                    arrived(&OrbitErrors::flight_path_angle_rad, kDegPerRad)});
  if (problem.target_inclination_rad)
    rows.push_back({"inclination, deg", 6, Deg(*problem.target_inclination_rad), Deg(orbit.inclination_rad),
                    Deg(error.inclination_rad), Deg(halved.inclination_rad),
                    arrived(&OrbitErrors::inclination_rad, kDegPerRad)});
  if (problem.target_argument_of_perigee_rad)
    rows.push_back({"argument of perigee, deg", 4, Deg(*problem.target_argument_of_perigee_rad),
                    problem.is_entered_anywhere
                        ? Deg(*problem.target_argument_of_perigee_rad + error.argument_of_perigee_rad)
                        : Deg(orbit.argument_of_latitude_rad - problem.target_true_anomaly_rad.value_or(0.0)),
                    Deg(error.argument_of_perigee_rad), Deg(halved.argument_of_perigee_rad), std::nullopt});
  return rows;
}

std::optional<double> LiftOffSidereal(const Reference& reference) {
  if (!reference.problem.target_node_rad) return std::nullopt;
  const double angle_rad = *reference.problem.target_node_rad - reference.orbit.node_longitude_rad;
  return angle_rad < 0.0 ? angle_rad + kTwoPi : angle_rad;
}

std::string OrbitSentence(const Reference& reference) {
  const Orbit& orbit = reference.orbit;
  std::string text =
      fmt::format("inclination {:.4f} deg, ascending node {:.4f} deg east of Greenwich at lift-off",
                  Deg(orbit.inclination_rad), Deg(orbit.node_longitude_rad));
  if (reference.problem.velocity_is_free) text += fmt::format(", velocity {:.3f} m/s", orbit.velocity_m_s);
  if (const std::optional<double> sidereal_rad = LiftOffSidereal(reference))
    text += fmt::format(
        "; for the node at {:.6g} deg lift off at {:.4f} deg ({:.4f} h) of Greenwich sidereal time",
        Deg(*reference.problem.target_node_rad), Deg(*sidereal_rad), Deg(*sidereal_rad) / 15.0);
  return text;
}

std::string LimitsThatDoNotBind(const Reference& reference) {
  std::string text;
  for (const ConstraintMargin& c : reference.constraints) {
    if (!c.enforced || !(c.limit > 0.0) || c.value > 0.1 * c.limit) continue;
    text += fmt::format("{}{} does not bind: its value is {:.2g} % of the limit", text.empty() ? "" : "; ",
                        c.name, 100.0 * c.value / c.limit);
  }
  return text;
}

std::string TrajectoryPage(const OptimizationResult& result, const std::optional<CheckFlight>& check) {
  const Reference& reference = result.reference;
  const TrajectoryProblem& problem = reference.problem;
  const std::string title =
      fmt::format("{}: trajectory to {} km", reference.name, ReadableText(problem.target_altitude_m * 1e-3));
  std::string page = PageHead(title, fmt::format("{} · engine {}", title, reference.engine)) +
                     "<main>\n<h1>" + HtmlText(title) + "</h1>\n";
  page += fmt::format(
      "<p>Genetic algorithm on the weighted miss of the target ({}) with {} individuals, selection of the "
      "least peak "
      "of q·α along the programs that reach the target, refinement by least squares. Seed {}, {} ascents "
      "flown, "
      "engine {}.</p>\n",
      ObjectiveText(problem), problem.population, problem.seed, reference.evaluations,
      HtmlText(reference.engine));
  if (!result.reached)
    page += "<p>" + VerdictBadge("fail") + " The target is missed: " + HtmlText(result.statement) + "</p>\n";
  page += CheckFlightParagraph(check);
  page += "<h2>" + Capital(AscentEndWords(result.history)) + "</h2>\n" + InjectionTable(result, check);
  page +=
      fmt::format("<p>The orbit reached: {}.{}</p>\n", HtmlText(OrbitSentence(reference)),
                  check && check->completed()
                      ? " Flown closed loop: the errors of the nominal flight with six degrees of freedom "
                        "under the campaign’s autopilot, reaction control included."
                      : "");
  if (const std::string events = AscentEventsTable(result.history); !events.empty())
    page += "<h2>Events</h2>\n" + events;
  page += "<h2>Flight program</h2>\n" + VariableTable(reference);
  page +=
      "<p class=\"soft\">A variable at its bound was limited by it. A better value may lie beyond the bound, "
      "which was not searched.</p>\n";
  page += "<h2>Constraints</h2>\n" + ConstraintTable(reference);
  if (const std::string text = LimitsThatDoNotBind(reference); !text.empty())
    page += "<p>" + HtmlText(text) + ".</p>\n";
  page += "<h2>Programmed incidence</h2>\n<div class=\"figures\">\n" +
          FlightProgramFigures(reference.program, result.history) + "</div>\n";
  page += "<h2>Trajectory</h2>\n<div class=\"figures\">\n" + ReferenceFigures(result.history) + "</div>\n";
  page += "<h2>The search</h2>\n<div class=\"figures\">\n" + SearchFigures(result) + "</div>\n";
  return page + "</main>\n</body>\n</html>\n";
}

}  // namespace dispersa
