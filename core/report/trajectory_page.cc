#include "core/report/trajectory_page.h"

#include <fmt/format.h>

#include <limits>

#include "core/math/constants.h"
#include "core/report/html_parts.h"
#include "core/report/paper_table2.h"
#include "core/report/svg_chart.h"
#include "core/report/text.h"
#include "core/report/trajectory_figures.h"

namespace dispersa {
namespace {

double Deg(double radians) { return radians / kRadPerDeg; }
std::string Signed(double value) { return fmt::format("{:+.2g}", value + 0.0); }

std::string InjectionTable(const OptimizationResult& result, const std::optional<OrbitErrors>& flown) {
  const Reference& reference = result.reference;
  const TrajectoryProblem& problem = reference.problem;
  const bool paper = IsPaperTarget(problem);
  std::vector<HtmlTable::Column> columns = {{"Injection"}, {"desired", true}};
  if (paper) columns.insert(columns.end(), {{"paper", true}, {"its error", true}});
  columns.insert(columns.end(), {{"reached", true}, {"error", true}, {"with half the steps", true}});
  if (flown) columns.push_back({"flown closed loop", true});
  HtmlTable table(columns);
  const auto row = [&](const char* name, int decimals, double desired, double published, double reached,
                       double error, double halved, double arrived) {
    std::vector<std::string> cells = {name, ReadableText(desired)};
    if (paper) {
      cells.push_back(fmt::format("{:.{}f}", published, decimals));
      cells.push_back(Signed(published - desired));
    }
    cells.push_back(FixedText(reached, decimals));
    cells.push_back(Signed(error));
    cells.push_back(Signed(halved));
    if (flown) cells.push_back(Signed(arrived));
    table.Row(cells);
  };
  const OrbitErrors& halved = result.halved_step_errors;
  const OrbitErrors arrived = flown.value_or(OrbitErrors{});
  row("Height, km", 6, problem.target_altitude_m * 1e-3, kPaperHeight_km, reference.orbit.altitude_m * 1e-3,
      result.errors.altitude_m * 1e-3, halved.altitude_m * 1e-3, arrived.altitude_m * 1e-3);
  row("Velocity, m/s", 6, AimedVelocity(problem), kPaperVelocity_m_s, reference.orbit.velocity_m_s,
      result.errors.velocity_m_s, halved.velocity_m_s, arrived.velocity_m_s);
  row("Angle of injection, °", 9, Deg(problem.target_flight_path_angle_rad), kPaperAngle_deg,
      Deg(reference.orbit.flight_path_angle_rad), Deg(result.errors.flight_path_angle_rad),
      Deg(halved.flight_path_angle_rad), Deg(arrived.flight_path_angle_rad));
  return table.Html();
}

/// A search that ends on a bound was held back by it: the optimum within it may lie there, or beyond.
std::string BoundReached(double value, const Bounds& bounds) {
  const double near = 1e-3 * (bounds.high - bounds.low);
  if (!(near > 0.0)) return "fixed";
  return value - bounds.low <= near    ? "at its lower bound"
         : bounds.high - value <= near ? "at its upper bound"
                                       : "";
}

std::string VariableTable(const Reference& reference) {
  const TrajectoryProblem& problem = reference.problem;
  const FlightProgram& program = reference.program;
  HtmlTable table({{"Variable"}, {"value", true}, {"from", true}, {"to", true}, {""}});
  const auto row = [&](const char* name, double value, const Bounds& bounds, double unit) {
    const std::string bound = BoundReached(value, bounds);
    table.Row({name, FixedText(value / unit, 6), ReadableText(bounds.low / unit), ReadableText(bounds.high / unit),
               bound.empty() ? "" : "<span class=\"badge design\">" + bound + "</span>"});
  };
  row("α<sub>max</sub>, °", program.alpha_max_rad, problem.alpha_max_rad, kRadPerDeg);
  row("t1, begin of the pitch-over, s", program.t1_s, problem.t1_s, 1.0);
  row("t3, maximum incidence, s", program.t3_s, problem.t3_s, 1.0);
  row("t2, end of the pitch-over, s", program.t2_s, problem.t2_s, 1.0);
  row("Coast before the last stage, s", program.coast_s, problem.coast_s, 1.0);
  row("Launch azimuth, °", program.launch_azimuth_rad, problem.launch_azimuth_rad, kRadPerDeg);
  return table.Html("narrow");
}

std::string ConstraintTable(const Reference& reference) {
  HtmlTable table({{"Constraint"}, {"value", true}, {"limit", true}, {"margin", true}});
  for (const ConstraintMargin& c : reference.constraints) {
    table.Row({"<code>" + HtmlText(c.name) + "</code>", ReadableText(c.value),
               c.enforced ? ReadableText(c.limit) : "none", c.enforced ? ReadableText(c.margin) : "–"});
  }
  return table.Html("narrow");
}

std::string Draw(const SvgChart& chart, const std::string& caption) {
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
  SvgChart objective({.label = "generation"}, {.label = "objective (8)", .logarithmic = true});
  objective.Line(generation, best, "line-0", "best");
  objective.Line(generation, mean, "line-1", "mean of the feasible");
  SvgChart fraction({.label = "generation"}, {.label = "feasible", .low = 0.0, .high = 1.0, .percent = true});
  fraction.Line(generation, feasible, "line-0", "");
  std::string figures =
      Draw(objective,
           "Search over all six variables. Objectives within the tie tolerance of the best are equal, so the "
           "best may rise while the peak of q·α falls.") +
      Draw(fraction, "Individuals that break no constraint.");
  if (result.selection.log.empty()) return figures;
  std::vector<double> step, load;
  for (const GenerationRecord& record : result.selection.log) {
    step.push_back(record.generation);
    load.push_back(record.best_objective.value_or(kNaN));
  }
  SvgChart selection({.label = "generation"}, {.label = "peak of q·α, Pa rad"});
  selection.Line(step, load, "line-0", "best");
  return figures + Draw(selection,
                        "Selection over t1, t3 and t2 among programs that reach the target: the least peak of "
                        "q·α.");
}

}  // namespace

std::string LimitsThatDoNotBind(const Reference& reference) {
  std::string text;
  for (const ConstraintMargin& c : reference.constraints) {
    if (!c.enforced || !(c.limit > 0.0) || c.value > 0.1 * c.limit) continue;
    text += fmt::format("{}{} does not bind: its value is {:.2g} % of the limit", text.empty() ? "" : "; ", c.name,
                        100.0 * c.value / c.limit);
  }
  return text;
}

std::string TrajectoryPage(const OptimizationResult& result, const std::optional<OrbitErrors>& flown) {
  const Reference& reference = result.reference;
  const TrajectoryProblem& problem = reference.problem;
  const std::string title = fmt::format("{}: trajectory to {} km", reference.name,
                                        ReadableText(problem.target_altitude_m * 1e-3));
  std::string page = PageHead(title, fmt::format("{} · engine {}", title, reference.engine)) + "<h1>" +
                     HtmlText(title) + "</h1>\n";
  page += fmt::format(
      "<p>Genetic algorithm on objective (8) with {} individuals, selection of the least peak of q·α along the "
      "programs that reach the target, refinement by least squares. Seed {}, {} ascents flown, engine {}.</p>\n",
      problem.population, problem.seed, reference.evaluations, HtmlText(reference.engine));
  if (!result.reached)
    page += "<p>" + VerdictBadge("fail") + " The target is missed: " + HtmlText(result.statement) + "</p>\n";
  page += "<h2>Table 2: injection</h2>\n" + InjectionTable(result, flown);
  page += fmt::format("<p>Inclination {:.3f}°.{}</p>\n", Deg(reference.orbit.inclination_rad),
                      flown ? " Flown closed loop: the errors of the nominal flight with six degrees of freedom "
                              "under the campaign’s autopilot, reaction control included."
                            : "");
  page += "<h2>Flight program</h2>\n" + VariableTable(reference);
  page += "<p class=\"soft\">A variable at a bound was held back by it: what lies beyond was not searched, and may be "
          "better.</p>\n";
  page += "<h2>Constraints</h2>\n" + ConstraintTable(reference);
  if (const std::string text = LimitsThatDoNotBind(reference); !text.empty())
    page += "<p>" + HtmlText(text) + ".</p>\n";
  page += "<h2>Fig. 2: flight program</h2>\n<div class=\"figures\">\n" +
          FlightProgramFigures(reference.program, result.history) + "</div>\n";
  page += "<h2>Fig. 3: reference trajectories</h2>\n<div class=\"figures\">\n" + ReferenceFigures(result.history) +
          "</div>\n";
  page += "<h2>The search</h2>\n<div class=\"figures\">\n" + SearchFigures(result) + "</div>\n";
  return page + "</body>\n</html>\n";
}

}  // namespace dispersa
