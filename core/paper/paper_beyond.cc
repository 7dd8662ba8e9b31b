// Additions to the paper: baselines, statistics of dV/dt, our own completions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/analysis/comparison.h"
#include "core/analysis/requirement_summary.h"
#include "core/control/lyapunov.h"
#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/paper/paper_sections.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr char kAdaptive[] = "controllers";
/// V up to that of this error at rest is the residual set, in which V may rise.
constexpr double kResidualError_deg = 0.05;

/// Metrics by which controllers are usually compared. Less is better for each.
const std::vector<std::string> kCompared = {
    "pitch_error_rms_deg", "pitch_error_peak_deg", "yaw_error_rms_deg",          "yaw_error_peak_deg",
    "roll_error_peak_deg", "deflection_peak_deg",  "deflection_limit_cycle_deg", "deflection_travel_deg"};

std::string IntervalText(const Interval& interval) {
  const auto text = [](double value) {
    return std::isinf(value) ? std::string(value > 0.0 ? "∞" : "−∞") : ReadableText(value);
  };
  return text(interval.lower) + " … " + text(interval.upper);
}

std::string ComparisonTable(const Comparison& comparison) {
  const std::string a = HtmlText(comparison.a.autopilot);
  const std::string b = HtmlText(comparison.b.autopilot);
  HtmlTable table({{"Metric"},
                   {"median of the difference", true},
                   {"95 % interval", true},
                   {"median of the ratio", true},
                   {"95 % interval", true},
                   {a + " better", true},
                   {b + " better", true},
                   {"sign test, p", true}});
  for (const MetricComparison& metric : comparison.metrics) {
    table.Row({HtmlText(metric.info.title + (metric.info.unit.empty() ? "" : ",\u00a0" + metric.info.unit)),
               ReadableText(metric.difference), IntervalText(metric.interval), ReadableText(metric.ratio),
               IntervalText(metric.ratio_interval), fmt::format("{}", metric.a_better),
               fmt::format("{}", metric.b_better), ReadableText(metric.p)});
  }
  return table.Html() +
         fmt::format("<p class=\"soft\">Differences are {} less {}, ratios {} over {}; {} pairs.</p>\n", b, a,
                     b, a, comparison.pairing.shared);
}

/// The cases in which the second law is better than the first by most, in the first metric.
std::string LargestGains(const Comparison& comparison) {
  const MetricComparison& metric = comparison.metrics[0];
  std::string list;
  for (const MetricComparison::Pair& pair : metric.gains) {
    list += fmt::format("{}{} ({} against {})", list.empty() ? ": most in " : ", ", pair.case_index,
                        std::isnan(pair.b) ? "lost" : ReadableText(pair.b),
                        std::isnan(pair.a) ? "lost" : ReadableText(pair.a));
  }
  return fmt::format("<p class=\"soft\">{} is better than {} in {} in {} cases{}.</p>\n",
                     HtmlText(comparison.b.autopilot), HtmlText(comparison.a.autopilot),
                     HtmlText(metric.info.title), metric.b_better, list);
}

/// How often V falls, by how large it is.
struct LyapunovStatistics {
  /// Level: the error, at rest, that has the same V; in degrees, so that stages compare.
  std::vector<double> level_deg;  ///< lower edges of the bins, ascending
  std::vector<double> ticks, falling;

  double Share(double above_deg) const { return Sum(ticks, above_deg) / Sum(ticks, 0.0); }
  double Falling(double above_deg) const { return Sum(falling, above_deg) / Sum(ticks, above_deg); }

 private:
  double Sum(const std::vector<double>& counts, double above_deg) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (level_deg[i] >= above_deg * (1.0 - 1e-9)) sum += counts[i];
    }
    return sum;
  }
};

LyapunovStatistics CountFalling(const PaperFlights& flown) {
  constexpr int kPerDecade = 4;
  constexpr int kDecadesBelow = 4;
  constexpr int kBins = 6 * kPerDecade;
  LyapunovStatistics statistics;
  for (int bin = 0; bin < kBins; ++bin)
    statistics.level_deg.push_back(kResidualError_deg *
                                   std::pow(10.0, static_cast<double>(bin) / kPerDecade - kDecadesBelow));
  statistics.ticks.resize(kBins);
  statistics.falling.resize(kBins);
  const AxisConfig& pitch = flown.campaign.autopilot.pitch;
  std::vector<double> p11;
  for (const AxisGains& gains : pitch.gains) p11.push_back(SolveLyapunov(gains, pitch.adaptation.q)(0, 0));
  for (const SampledFlight& flight : flown.flights.histories) {
    for (std::size_t i = 0; i < flight[kLyapunovV].size(); ++i) {
      const double v = flight[kLyapunovV][i];
      if (!std::isfinite(v)) continue;
      const auto stage = static_cast<std::size_t>(flight[kStage][i]) - 1;
      const double level_deg = std::sqrt(2.0 * v / p11[stage]) * kDegPerRad;
      const int bin = level_deg > 0.0
                          ? static_cast<int>(std::floor(
                                (std::log10(level_deg / kResidualError_deg) + kDecadesBelow) * kPerDecade))
                          : 0;
      const auto at = static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1));
      statistics.ticks[at] += 1.0;
      if (flight[kLyapunovSign][i] < 0.0) statistics.falling[at] += 1.0;
    }
  }
  return statistics;
}

std::string Percent(double part) { return std::isfinite(part) ? fmt::format("{:.1f} %", 100.0 * part) : "–"; }

}  // namespace

std::string PaperHeadline(const PaperStudy& study) {
  const CaseColumns& adaptive = study.at(kAdaptive).flights.cases;
  const auto times = [&](const char* name, const char* metric = "pitch_error_rms_deg") {
    return Digested(study.at(name).flights.cases, metric).p50 / Digested(adaptive, metric).p50;
  };
  const CaseColumns& pid = study.at("controllers_pid").flights.cases;
  const std::size_t rms = MetricColumn("pitch_error_rms_deg");
  constexpr char kPeak[] = "pitch_error_peak_deg";
  std::size_t better = 0;
  for (std::size_t i = 0; i < pid.rows(); ++i) {
    if (pid.outcome[i] != Outcome::kCompleted) continue;
    better += adaptive.outcome[i] != Outcome::kCompleted || pid.metrics[rms][i] < adaptive.metrics[rms][i];
  }
  const double of_pid = times("controllers_pid");
  return fmt::format(
      "<div class=\"headline warning\"><p><b>What the adaptive fuzzy law gains over PD is integral "
      "action.</b> On {} "
      "cases of Table 3 that no tuning used, PD’s median RMS pitch error is {:.1f} times the adaptive law’s. "
      "A plain PID, "
      "tuned by the same procedure and budget under the same margins, has {:.2f} of it, the smaller one in "
      "{} of {} cases, and "
      "{:.2f} times its median peak; with an augmentation that adapts its gain, {:.2f} and {:.2f}: {}. "
      "<a href=\"#baselines\">All laws on the same cases</a>.</p></div>\n",
      adaptive.rows(), times("controllers_pd"), of_pid, better, pid.rows(), times("controllers_pid", kPeak),
      times("controllers_pid_aac"), times("controllers_pid_aac", kPeak),
      of_pid < 1.0 ? "by RMS the paper’s law is not the better one"
                   : "by RMS the paper’s law is the better one");
}

std::string PaperComparisonSection(const PaperStudy& study) {
  const PaperFlights& adaptive = study.at(kAdaptive);
  std::vector<std::string> names = {kAdaptive};
  for (const std::string& name : PaperBaselines()) names.push_back(name);
  std::string html =
      "<h2 id=\"baselines\">Against other controllers, on the same cases</h2>\n" + PaperSource(study, names);

  HtmlTable overview({{"Autopilot"},
                      {"flights", true},
                      {"lost", true},
                      {"RMS, median", true},
                      {"RMS, 99 %", true},
                      {"peak, median", true},
                      {"peak, largest", true},
                      {"limit cycle, largest", true}});
  for (const std::string& name : names) {
    const PaperFlights& flown = study.at(name);
    const MetricDigest rms = Digested(flown.flights.cases, "pitch_error_rms_deg");
    const MetricDigest peak = Digested(flown.flights.cases, "pitch_error_peak_deg");
    const MetricDigest cycle = Digested(flown.flights.cases, "deflection_limit_cycle_deg");
    overview.Row({HtmlText(flown.campaign.autopilot.name), fmt::format("{}", rms.n),
                  fmt::format("{}", rms.lost), Degrees(rms.p50), rms.p99, Degrees(peak.p50),
                  Degrees(peak.max), Degrees(cycle.max)});
  }
  html += overview.Html();

  std::string found;
  for (const std::string& name : PaperBaselines()) {
    const PaperFlights& baseline = study.at(name);
    const Comparison comparison = Compare({"", "", adaptive.campaign, adaptive.flights.cases},
                                          {"", "", baseline.campaign, baseline.flights.cases}, kCompared, {});
    html += "<h3>" + HtmlText(baseline.campaign.autopilot.name) + " against " +
            HtmlText(adaptive.campaign.autopilot.name) + "</h3>\n" + ComparisonTable(comparison) +
            LargestGains(comparison);
    const MetricComparison& rms = comparison.metrics[0];
    found += fmt::format(
        "{}{}: RMS {:.2f} times as large as the adaptive law’s{}, better in {} of {} cases.",
        found.empty() ? "" : " ", HtmlText(baseline.campaign.autopilot.name), rms.ratio,
        std::isfinite(rms.ratio_interval.upper)
            ? fmt::format(" ({:.2f} … {:.2f})", rms.ratio_interval.lower, rms.ratio_interval.upper)
            : std::string(" (too few cases for an interval)"),
        rms.b_better, rms.n_b);
  }
  html += PaperFindings(
      "Better results are achieved with adaptive fuzzy control. No other controller is flown.", found,
      "Median ratios with 95 % intervals. All are tuned by <code>dispersa tune</code> with one budget, on "
      "cases "
      "that no campaign of this page flies. The frozen rules’ consequents lie on a plane over triangular "
      "sets: "
      "within their ranges they are proportional-derivative control, and only the tuning tells the two "
      "apart. "
      "What the adaptive rules gain over both is integral action: their grades sum to 1, so the consequents’ "
      "mean "
      "departs by γ/25 ∫ e<sup>T</sup>P<sub>n</sub> dt, a PID’s integral of the error and a little more of "
      "its "
      "proportional gain. The row of <code>pid</code> is therefore the one to judge adaptation by: a ratio "
      "below 1 "
      "there means that a plain integral tracks better than the paper’s law.");
  return html;
}

std::string PaperLyapunovSection(const PaperStudy& study) {
  const PaperFlights& table3 = study.at("table3");
  const LyapunovStatistics statistics = CountFalling(table3);
  SvgChart chart({.label = "level of V: the error at rest that has the same V, °", .logarithmic = true},
                 {.label = "share", .low = 0.0, .high = 1.0, .percent = true}, 520, 280);
  std::vector<double> middle, fraction, share;
  double all = 0.0;
  for (const double ticks : statistics.ticks) all += ticks;
  const double half_bin = std::sqrt(statistics.level_deg[1] / statistics.level_deg[0]);
  for (std::size_t i = 0; i < statistics.ticks.size(); ++i) {
    if (statistics.ticks[i] < 100.0) continue;  // too few to tell a share
    middle.push_back(statistics.level_deg[i] * half_bin);
    fraction.push_back(statistics.falling[i] / statistics.ticks[i]);
    share.push_back(statistics.ticks[i] / all);
  }
  chart.Line(middle, fraction, "line-0", "dV/dt < 0 at this level");
  chart.Line(middle, share, "line-1", "powered flight spent there");
  HtmlTable table(
      {{"V outside the level of"}, {"powered flight spent there", true}, {"of it with dV/dt < 0", true}});
  for (const double level : {0.0, 0.01 * kResidualError_deg, 0.1 * kResidualError_deg, kResidualError_deg}) {
    table.Row({level > 0.0 ? fmt::format("{:g}° of error", level) : std::string("0 (everything)"),
               Percent(statistics.Share(level)), Percent(statistics.Falling(level))});
  }
  const std::string caption =
      "How often V = ½ eᵀPe falls, by its level; levels with fewer than 100 samples are left out.";
  return "<h2 id=\"lyapunov\">How often V falls</h2>\n" + PaperSource(study, {"table3"}) +
         "<div class=\"figures\">\n" + Figure(chart.Svg(caption), HtmlText(caption)) + "<div>" +
         table.Html("narrow") + "</div></div>\n" +
         PaperFindings(
             "dV/dt &lt; 0: the system is asymptotically stable, since the approximation error is very small "
             "(34).",
             fmt::format(
                 "Outside the residual set, where V is above that of {:g}° of error and where {} of powered "
                 "flight is spent, V falls {} of the time; over all levels {}.",
                 kResidualError_deg, Percent(statistics.Share(kResidualError_deg)),
                 Percent(statistics.Falling(kResidualError_deg)), Percent(statistics.Falling(0.0))),
             "With disturbances, an actuator and a projection, (34) can hold only outside a residual set: "
             "the honest claim is "
             "uniform ultimate boundedness. V here is the part of (29) that can be measured; the part of the "
             "parameter error "
             "is unknown in flight, so a rise of this V refutes nothing by itself. At small levels V follows "
             "the disturbances: it "
             "rises while the wind or a transient grows, however slowly, and falls when the law has learnt "
             "it.");
}

std::string PaperCompletionSection(const PaperStudy& study) {
  const PaperFlights& swept = study.at("completions");
  const PaperFlights& table3 = study.at("table3");
  const CaseColumns& cases = swept.flights.cases;
  const std::vector<std::string>& factors = PaperCompletions();
  const char* const titles[] = {"inertia", "centre of pressure", "centre of gravity", "actuator bandwidth"};
  HtmlTable table({{"Completion"},
                   {"times", true},
                   {"flights", true},
                   {"lost", true},
                   {"RMS, median", true},
                   {"peak, median", true},
                   {"peak, largest", true},
                   {"limit cycle, largest", true},
                   {"requirements of table3 that fail"},
                   {"least computed margins"},
                   {"least measured"},
                   {"gates"}});
  std::size_t changed = 0, settings = 0, failing_gates = 0;
  const auto row = [&](const std::string& title, const std::string& factor, const CaseColumns& flown,
                       const CompletionMargins& margins) {
    const MetricDigest rms = Digested(flown, "pitch_error_rms_deg");
    const MetricDigest peak = Digested(flown, "pitch_error_peak_deg");
    const MetricDigest cycle = Digested(flown, "deflection_limit_cycle_deg");
    std::string failed;
    for (const Requirement& requirement : table3.campaign.requirements) {
      if (Judge(requirement, SamplingMethod::kMonteCarlo, flown, 0).verdict != "fail") continue;
      failed += (failed.empty() ? "" : ", ") + requirement.metric;
    }
    table.Row({title, factor, fmt::format("{}", rms.n), fmt::format("{}", rms.lost), Degrees(rms.p50),
               Degrees(peak.p50), Degrees(peak.max), Degrees(cycle.max),
               failed.empty() ? "none" : "<code>" + failed + "</code>",
               fmt::format("{:.1f} dB, {:.1f}°, {:.0f} ms", margins.computed.gain_db,
                           margins.computed.phase_deg, 1e3 * margins.computed.delay_s),
               fmt::format("{:.1f} dB, {:.0f} ms", margins.measured.gain_db, 1e3 * margins.measured.delay_s),
               VerdictBadge(margins.passed ? "pass" : "fail")});
    return failed;
  };
  auto margins = study.completion_margins.begin();
  const std::string as_shipped = row("as shipped (table3)", "1", table3.flights.cases, *margins);
  for (std::size_t f = 0; f < factors.size(); ++f) {
    const std::vector<double>& column = cases.inputs[static_cast<std::size_t>(FindInput(factors[f]))];
    std::map<double, CaseColumns> groups;
    for (std::size_t i = 0; i < cases.rows(); ++i) {
      if (column[i] == 1.0) continue;
      CaseColumns& group = groups[column[i]];
      if (group.metrics.empty()) group.metrics.resize(cases.metrics.size());
      group.index.push_back(cases.index[i]);
      group.outcome.push_back(cases.outcome[i]);
      for (std::size_t m = 0; m < cases.metrics.size(); ++m) group.metrics[m].push_back(cases.metrics[m][i]);
    }
    for (const auto& [factor, group] : groups) {
      ++settings;
      ++margins;
      DISPERSA_ASSERT(margins->input == factors[f] && margins->factor == factor);
      failing_gates += !margins->passed;
      changed += row(titles[f], fmt::format("{:g}", factor), group, *margins) != as_shipped;
    }
  }
  return "<h2 id=\"completions\">How much depends on what we added</h2>\n" +
         PaperSource(study, {"completions"}) +
         "<p>Table 1 gives no mass distribution, aerodynamics or actuators. Each completion is moved by 30 % "
         "with the "
         "autopilot unchanged and Table 3’s disturbances on; CG and CP by 30 % of their distance from the "
         "nose. The margins are those of the changed vehicle along its own undisturbed flight, all axes and "
         "stages, with "
         "gains frozen and adapting; measured ones as above.</p>\n" +
         table.Html() +
         PaperFindings(
             "Aerodynamics from DATCOM; inertia, centres and actuators are not given.",
             fmt::format(
                 "{} of {} settings change which requirements of table3 fail; {} miss a gate of the margins.",
                 changed, settings, failing_gates),
             "A setting that changes a verdict marks where a reader with the real vehicle’s data should look "
             "first. "
             "With few flights a setting only fails a requirement that it misses clearly.");
}

}  // namespace dispersa
