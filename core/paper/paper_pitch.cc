// Figures 6 to 10: the flights.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/analysis/requirement_summary.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/paper/paper_sections.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr char kTimeAxis[] = "time since lift-off, s";
constexpr double kStep_s = 0.1;

std::vector<double> NominalColumn(const PaperStudy& study, const char* name) {
  const int column = FindHistoryColumn(name);
  std::vector<double> values;
  for (std::size_t row = 0; row < study.nominal_history.rows(); ++row)
    values.push_back(study.nominal_history.at(row, column));
  return values;
}

std::vector<double> Times(std::size_t steps) {
  std::vector<double> time_s(steps);
  for (std::size_t i = 0; i < steps; ++i) time_s[i] = kStep_s * static_cast<double>(i);
  return time_s;
}

/// One column of all flights that have a history.
FlightBands BandsOf(const StudyFlights& flights, PaperColumn column) {
  std::vector<SampledFlight> one;
  for (const SampledFlight& flight : flights.histories) one.push_back({flight[column]});
  return ComputeBands(one, {0}, kStep_s);
}

/// The end of the initial pitch-over as drawn, a little after t2.
double KickEnd(const PaperStudy& study) {
  return 5.0 * std::ceil(0.2 * (study.at("table3").campaign.reference.program.t2_s + 4.0));
}

void MarkStages(const PaperStudy& study, SvgChart* chart) {
  const std::vector<double> time_s = NominalColumn(study, "time_s");
  const std::vector<double> stage = NominalColumn(study, "stage");
  const std::vector<double> thrust_n = NominalColumn(study, "thrust_n");
  double burnout_s = 0.0;
  int marked = 0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (!(thrust_n[i] > 0.0)) continue;
    if (static_cast<int>(stage[i]) != marked) {
      if (marked > 0 && time_s[i] - burnout_s > 10.0) chart->Shade(burnout_s, time_s[i], "coast");
      marked = static_cast<int>(stage[i]);
      chart->Mark(time_s[i], fmt::format("S{}", marked));
    }
    burnout_s = time_s[i];
  }
}

struct BandChart {
  PaperColumn column;
  const char* history_column;
  const char* label;
  bool program = false;  ///< draw the reference pitch
  std::optional<double> to_s = {};
  bool wide = false;  ///< over both columns of the page
};

std::string Draw(const PaperStudy& study, const StudyFlights& flights, const BandChart& view,
                 const std::string& caption) {
  SvgChart chart({.label = kTimeAxis, .low = 0.0, .high = view.to_s}, {.label = view.label},
                 view.wide ? 1060 : 520, 280);
  MarkStages(study, &chart);
  const FlightBands bands = BandsOf(flights, view.column);
  if (!bands.bands.empty()) {
    const Band& band = bands.bands[0];
    chart.Band(bands.time_s, band.min, band.max, "band-outer", "Table 3, min–max");
    chart.Band(bands.time_s, band.p05, band.p95, "band-inner", "5–95 %");
  }
  const std::vector<double> time_s = NominalColumn(study, "time_s");
  chart.Line(time_s, NominalColumn(study, view.history_column), "line-0", "nominal");
  if (view.program) chart.Line(time_s, NominalColumn(study, "pitch_program_deg"), "program", "reference");
  std::string figure = Figure(chart.Svg(caption), HtmlText(caption));
  if (view.wide) figure.replace(0, std::string("<figure").size(), "<figure class=\"wide\"");
  return figure;
}

std::string RequirementRows(const PaperFlights& flown) {
  HtmlTable table({{"Requirement"}, {"what the flights show"}, {"failures", true}, {"verdict"}});
  for (const Requirement& requirement : flown.campaign.requirements) {
    const RequirementSummary verdict =
        Judge(requirement, flown.campaign.sampling.method, flown.flights.cases, 0);
    table.Row({fmt::format("<code>{}</code> {} {}", requirement.metric, LimitWords(verdict, ""),
                           verdict.every_case ? "in every case" : "with " + PercentText(verdict.probability)),
               HtmlText(verdict.sentence), fmt::format("{} / {}", verdict.failures, verdict.n),
               VerdictBadge(verdict.verdict)});
  }
  return table.Html();
}

double NominalMetric(const PaperStudy& study, const char* name) {
  return study.nominal.metrics[MetricColumn(name)];
}

/// Campaigns of Figure 10, with Table 3 off and on.
struct RobustnessSet {
  const char* title;
  const char* quiet;
  const char* disturbed;
};
constexpr RobustnessSet kRobustnessSets[] = {
    {"all 16 corners", "aero20_quiet", "aero20"},
    {"one at a time", "aero20_one_at_a_time_quiet", "aero20_one_at_a_time"},
    {"Monte Carlo, uniform", "aero20_monte_carlo_quiet", "aero20_monte_carlo"}};

/// Every varied flight in the initial pitch-over.
std::string VariedFlights(const PaperStudy& study, const char* name, PaperColumn column, const char* label,
                          const std::string& caption) {
  SvgChart chart({.label = kTimeAxis, .low = 0.0, .high = KickEnd(study)}, {.label = label}, 520, 280);
  const std::vector<SampledFlight>& flights = study.at(name).flights.histories;
  for (std::size_t i = 0; i < flights.size(); ++i)
    chart.Line(Times(flights[i][column].size()), flights[i][column], "line-0 thin",
               i == 0 ? "varied flights" : "");
  const std::vector<double> time_s = NominalColumn(study, "time_s");
  const bool pitch = column == kPitchLaunch;
  chart.Line(time_s, NominalColumn(study, pitch ? "pitch_program_deg" : "pitch_error_deg"),
             pitch ? "program" : "line-1", pitch ? "reference" : "nominal");
  return Figure(chart.Svg(caption), HtmlText(caption));
}

std::string WholeFlightBands(const PaperStudy& study, const char* name) {
  const StudyFlights& flights = study.at(name).flights;
  const FlightBands bands = BandsOf(flights, kPitchError);
  SvgChart chart({.label = kTimeAxis}, {.label = "pitch error, °"}, 520, 280);
  MarkStages(study, &chart);
  if (!bands.bands.empty()) {
    chart.Band(bands.time_s, bands.bands[0].min, bands.bands[0].max, "band-outer", "min–max");
    chart.Band(bands.time_s, bands.bands[0].p05, bands.bands[0].p95, "band-inner", "5–95 %");
    chart.Line(bands.time_s, bands.bands[0].p50, "line-0", "median");
  }
  const std::string caption = fmt::format("Whole flight: {}, {} flights.", name, flights.histories.size());
  return Figure(chart.Svg(caption), HtmlText(caption));
}

std::string RobustnessFigures(const PaperStudy& study) {
  std::string html =
      "<div class=\"figures\">\n" +
      VariedFlights(study, "aero20_quiet", kPitchLaunch, "pitch, °",
                    "As in the paper: pitch in the initial pitch-over, the 16 corners.") +
      VariedFlights(study, "aero20_quiet", kPitchError, "pitch error, °", "Their pitch errors.") +
      VariedFlights(study, "aero20_one_at_a_time_quiet", kPitchError, "pitch error, °",
                    "One factor at a time.");
  for (const char* name : {"aero20_monte_carlo_quiet", "aero20_monte_carlo", "aero20"})
    html += WholeFlightBands(study, name);
  return html + "</div>\n";
}

/// A row for each campaign, and what all of them have in common.
struct RobustnessResults {
  std::string table;
  std::size_t lost = 0, flown = 0;
  double worst_peak_deg = 0.0;  ///< of the completed flights
};

RobustnessResults ResultsOf(const PaperStudy& study) {
  HtmlTable table({{"Set"},
                   {"Table 3"},
                   {"flights", true},
                   {"lost", true},
                   {"RMS, median", true},
                   {"RMS, largest", true},
                   {"peak, median", true},
                   {"peak, largest", true},
                   {"limit cycle, largest", true}});
  RobustnessResults results;
  for (const RobustnessSet& set : kRobustnessSets) {
    for (const char* name : {set.quiet, set.disturbed}) {
      const CaseColumns& cases = study.at(name).flights.cases;
      const MetricDigest rms = Digested(cases, "pitch_error_rms_deg");
      const MetricDigest peak = Digested(cases, "pitch_error_peak_deg");
      const MetricDigest cycle = Digested(cases, "deflection_limit_cycle_deg");
      results.lost += rms.lost;
      results.flown += rms.n;
      if (std::isfinite(peak.max)) results.worst_peak_deg = std::max(results.worst_peak_deg, peak.max);
      table.Row({set.title, name == set.disturbed ? "on" : "off", fmt::format("{}", rms.n),
                 fmt::format("{}", rms.lost), Degrees(rms.p50), Degrees(rms.max), Degrees(peak.p50),
                 Degrees(peak.max), Degrees(cycle.max)});
    }
  }
  results.table = table.Html();
  return results;
}

/// Which corner is worst, with Table 3 off.
std::string WorstCorner(const CaseColumns& corners) {
  const std::vector<double> peaks = CompletedValues(corners, "pitch_error_peak_deg");
  const auto badness = [](double value) { return std::isfinite(value) ? value : HUGE_VAL; };
  const auto worst = std::max_element(peaks.begin(), peaks.end(),
                                      [&](double a, double b) { return badness(a) < badness(b); });
  if (worst == peaks.end()) return "";
  const auto row = static_cast<std::size_t>(worst - peaks.begin());
  const auto input = [&](const char* name) {
    return corners.inputs[static_cast<std::size_t>(FindInput(name))][row];
  };
  return fmt::format(
      " The worst corner without Table 3 is drag {:g}, lift {:g}, CG {:g}, CP {:g} times nominal: {}.",
      input("drag_factor"), input("lift_factor"), input("cg_factor"), input("cp_factor"),
      std::isfinite(*worst) ? "peak " + Degrees(*worst) : std::string("lost"));
}

}  // namespace

std::string PaperPitchSection(const PaperStudy& study) {
  const PaperFlights& table3 = study.at("table3");
  const double kick_end_s = KickEnd(study);
  const auto draw = [&](const BandChart& view, const std::string& caption) {
    return Draw(study, table3.flights, view, caption);
  };
  const std::string bands =
      fmt::format(" Bands: the first {} flights of table3.", table3.flights.histories.size());
  std::string html = "<h2 id=\"fig6\">Figs. 6 and 7: the initial pitch-over</h2>\n" +
                     PaperSource(study, {"nominal", "table3"}) + "<div class=\"figures\">\n" +
                     draw({kPitchLaunch, "pitch_launch_deg", "pitch, °", true, kick_end_s},
                          "Fig. 6: pitch in the initial pitch-over." + bands) +
                     draw({kDeflection, "deflection_pitch_deg", "pitch deflection, °", false, kick_end_s},
                          "Fig. 7: control deflection in the initial pitch-over.") +
                     draw({kPitchError, "pitch_error_deg", "pitch error, °", false, kick_end_s, true},
                          "What Fig. 6 cannot show at its scale: the pitch error.") +
                     "</div>\n";
  const std::vector<double> time_s = NominalColumn(study, "time_s");
  const std::vector<double> error_deg = NominalColumn(study, "pitch_error_deg");
  const std::vector<double> deflection_deg = NominalColumn(study, "deflection_pitch_deg");
  double worst_error = 0.0, worst_deflection = 0.0;
  for (std::size_t i = 0; i < time_s.size() && time_s[i] <= kick_end_s; ++i) {
    worst_error = std::max(worst_error, std::fabs(error_deg[i]));
    worst_deflection = std::max(worst_deflection, std::fabs(deflection_deg[i]));
  }
  const FlightBands kick = BandsOf(table3.flights, kPitchError);
  double dispersed = 0.0;
  for (std::size_t i = 0; i < kick.time_s.size() && kick.time_s[i] <= kick_end_s; ++i)
    dispersed = std::max({dispersed, std::fabs(kick.bands[0].min[i]), std::fabs(kick.bands[0].max[i])});
  html += PaperFindings(
      "The pitch angle follows the reference accurately in the initial pitch-over.",
      fmt::format("Nominal: at most {} of error with {} of deflection in the first {:.0f} s. With Table 3’s "
                  "disturbances the "
                  "error stays within {}.",
                  Degrees(worst_error), Degrees(worst_deflection), kick_end_s, Degrees(dispersed)),
      "The paper prints one flight and does not say with which disturbances; here the nominal flight stands "
      "before the "
      "spread of the dispersed ones.");

  html += "<h2 id=\"fig8\">Figs. 8 and 9: lift-off to injection</h2>\n" +
          PaperSource(study, {"nominal", "table3"}) + "<div class=\"figures\">\n" +
          draw({kPitchLaunch, "pitch_launch_deg", "pitch, °", true, {}},
               "Fig. 8: pitch over the whole flight." + bands) +
          draw({kDeflection, "deflection_pitch_deg", "pitch deflection, °", false, {}},
               "Fig. 9: control deflection over the whole flight. In the coast reaction control points the "
               "stage.") +
          draw({kPitchError, "pitch_error_deg", "pitch error, °", false, {}, true},
               "Pitch error over the whole flight.") +
          "</div>\n" + RequirementRows(table3);
  const CaseColumns& cases = table3.flights.cases;
  const MetricDigest rms = Digested(cases, "pitch_error_rms_deg");
  const MetricDigest peak = Digested(cases, "pitch_error_peak_deg");
  const MetricDigest cycle = Digested(cases, "deflection_limit_cycle_deg");
  html += PaperFindings(
      "The controller tracks the whole profile from launch to injection in the presence of Table 3’s "
      "disturbances.",
      fmt::format("Nominal: RMS {}, peak {}, limit cycle {}. Table 3, {} flights: {} lost; median RMS {} "
                  "(largest {}), median "
                  "peak {} (largest {}), worst limit cycle {} peak to peak.",
                  Degrees(NominalMetric(study, "pitch_error_rms_deg")),
                  Degrees(NominalMetric(study, "pitch_error_peak_deg")),
                  Degrees(NominalMetric(study, "deflection_limit_cycle_deg")), rms.n, rms.lost,
                  Degrees(rms.p50), Degrees(rms.max), Degrees(peak.p50), Degrees(peak.max),
                  Degrees(cycle.max)),
      "The paper gives neither numbers nor a coast. Errors are those of powered flight with every ignition "
      "transient; a "
      "probability of 99.73 % needs thousands of flights, so the verdict is that of <code>dispersa run "
      "campaigns/table3.yaml</code> wherever the table above says inconclusive.");
  return html;
}

std::string PaperRobustnessSection(const PaperStudy& study) {
  std::vector<std::string> names;
  for (const RobustnessSet& set : kRobustnessSets) {
    names.push_back(set.quiet);
    names.push_back(set.disturbed);
  }
  const RobustnessResults results = ResultsOf(study);
  return "<h2 id=\"fig10\">Fig. 10: drag, lift, CG and CP ±20 %</h2>\n" + PaperSource(study, names) +
         RobustnessFigures(study) + results.table +
         PaperFindings(
             "The controller follows the reference pitch for all variations of ±20 %.",
             fmt::format("{} of {} flights are lost; the largest peak error of the completed ones is {}.{}",
                         results.lost, results.flown, Degrees(results.worst_peak_deg),
                         WorstCorner(study.at("aero20_quiet").flights.cases)),
             "The paper shows the pitch angle of some variations in the pitch-over; at that scale errors of "
             "tenths of a degree do not show. “±20 % of CG and CP” is read as their distance from the nose "
             "of the current stack, with the inertia held; the paper does not say from where.");
}

}  // namespace dispersa
