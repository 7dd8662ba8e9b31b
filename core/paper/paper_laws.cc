// Beyond the paper's figures: other laws, margins, the decay of V, what we added to the vehicle.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/control/lyapunov.h"
#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/paper/paper_parts.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

const MetricComparison* RmsOf(const Comparison& comparison) {
  for (const MetricComparison& metric : comparison.metrics)
    if (metric.metric == kRms) return &metric;
  return nullptr;
}

/// "4.39 (4.14 … 4.57)": the median of the ratios with its interval.
std::string RatioText(const MetricComparison& metric) {
  const Interval& limits = metric.ratio_interval;
  return FixedText(metric.ratio, 2) + (std::isfinite(limits.upper)
                                           ? fmt::format(" ({:.2f} … {:.2f})", limits.lower, limits.upper)
                                           : " (too few cases for limits)");
}

/// What the law's adaptation is worth, against PD, PID and an augmented PID.
std::string WorthOfAdaptation(const PaperStudy& study) {
  const CaseColumns& law = study.at(kPaperLaw).cases;
  const auto times = [&](const char* name, const char* metric) {
    return Digested(study.at(name).cases, metric).p50 / Digested(law, metric).p50;
  };
  const MetricComparison* pid = RmsOf(study.comparisons.at("controllers_pid"));
  return fmt::format(
      "<b>What the adaptive fuzzy law gains over PD is integral action.</b> On {} cases of Table 3 that no "
      "tuning used, PD’s median RMS pitch error is {:.1f} times the adaptive law’s. A plain PID, tuned by "
      "the "
      "same procedure and budget under the same margins, has {:.2f} of it, the smaller one in {} of {} "
      "cases, "
      "and {:.2f} times its median peak. With an augmentation that adapts its gain it has {:.2f} and {:.2f}.",
      law.rows(), times("controllers_pd", kRms), times("controllers_pid", kRms), pid ? pid->b_better : 0,
      pid ? pid->n_b : 0, times("controllers_pid", kPeak), times("controllers_pid_aac", kRms),
      times("controllers_pid_aac", kPeak));
}

PaperPart BaselinePart(const PaperStudy& study) {
  HtmlTable table("!Autopilot|" + kDigestTitles +
                  "|#RMS over the adaptive law’s|#smaller in|Report|Compared");
  const PaperFlights& law = study.at(kPaperLaw);
  DigestRow(table, {HtmlText(law.campaign.autopilot.name)}, law.cases, {"", "", ReportLink(kPaperLaw), ""});
  bool is_best = true;
  for (const std::string& name : PaperBaselines()) {
    const MetricComparison* rms = RmsOf(study.comparisons.at(name));
    is_best = is_best && !(rms && rms->ratio < 1.0);
    DigestRow(table, {HtmlText(study.at(name).campaign.autopilot.name)}, study.at(name).cases,
              {rms ? RatioText(*rms) : "", rms ? fmt::format("{} of {}", rms->b_better, rms->n_b) : "",
               ReportLink(name), PaperLink(name + "/compare.html", "with the adaptive law")});
  }
  return {
      "baselines",
      "Other controllers: the same cases",
      "Better results are achieved with adaptive fuzzy control. No other controller is flown.",
      WorthOfAdaptation(study),
      "All are tuned by <code>dispersa tune</code> with one budget, on cases that no campaign of this page "
      "flies. The frozen rules’ consequents lie on a plane over triangular sets. Within their ranges they "
      "are proportional-derivative control, and only the tuning tells the two apart. The grades of the "
      "adaptive rules sum to 1, so the mean of the consequents departs by γ/25 ∫ e<sup>T</sup>P<sub>n</sub> "
      "dt. That is a PID’s integral of the error and a little more of its proportional gain. So the row of "
      "<code>pid</code> is the one to judge adaptation by.",
      is_best ? PaperVerdict::kReproduced : PaperVerdict::kNotReproduced,
      ReportLink(kPaperLaw),
      "<p>Ratios are the median over the pairs of cases, with 95 % limits. <code>compare.json</code> beside "
      "each comparison has those of every metric.</p>\n" +
          table.Html()};
}

PaperPart MarginPart(const PaperStudy& study) {
  std::size_t sets = 0, passed = 0;
  for (const ComputedMargins& at : study.computed_margins) {
    sets += at.learnt ? 3 : 2;
    passed += PassesGates(at.frozen) + PassesGates(at.adapting) + (at.learnt && LearntPasses(at));
  }
  bool all_measured = true;
  double gain_db = HUGE_VAL, delay_s = HUGE_VAL;
  for (const MeasuredMargins& m : study.measured_margins) {
    all_measured = all_measured && PassesGates(m);
    gain_db = std::min({gain_db, m.gain_up_db, m.gain_down_db});
    delay_s = std::min(delay_s, m.delay_s);
  }
  return {
      "margins",
      "Margins: of gain, phase and delay",
      "Stability follows from the Lyapunov function. Margins are not given.",
      fmt::format(
          "Measured in flight: at least {:.1f} dB of gain either way and {:.0f} ms of delay. {} phase "
          "passes the gates of {:g} dB and {:g} ms. Linearised, {} of {} sets pass those of {:g} dB, "
          "{:g}° and {:g} ms: all axes, every few seconds of powered flight, with gains frozen, "
          "adapting, and with what was learnt by then.",
          gain_db, 1e3 * delay_s, all_measured ? "Every" : "Not every", kGainMarginGate_db,
          1e3 * kDelayMarginGate_s, passed, sets, kGainMarginGate_db, kPhaseMarginGate_deg,
          1e3 * kDelayMarginGate_s),
      "Classical margins do not describe a loop that adapts, hence the measured ones. Gain or delay of one "
      "stage’s loop is changed until the flight is lost or a limit cycle begins. A steady misalignment "
      "keeps the adaptation at work.",
      PaperVerdict::kNoClaim,
      PaperLink("margins.txt", "each instant and stage")};
}

/// How often V falls, by its level: the error, at rest, that has the same V. In degrees stages compare. Bins
/// are quarters of a decade, from the residual set on, in which V may rise.
constexpr double kResidual_deg = 0.05;
constexpr int kLeastBin = -16, kMostBin = 7;
struct Ticks {
  double all = 0.0, falling = 0.0;
};

std::map<int, Ticks> CountFalling(const AxisConfig& pitch, const std::vector<SampledFlight>& flights) {
  std::vector<double> p11;
  for (const AxisGains& gains : pitch.gains) p11.push_back(SolveLyapunov(gains, pitch.adaptation.q)(0, 0));
  std::map<int, Ticks> bins;
  for (const SampledFlight& flight : flights) {
    for (std::size_t i = 0; i < flight[kV].size(); ++i) {
      if (!std::isfinite(flight[kV][i])) continue;
      const double level =
          std::sqrt(2.0 * flight[kV][i] / p11[static_cast<std::size_t>(flight[kStage][i]) - 1]);
      const double quarters = 4.0 * std::log10(std::max(1e-9, level * kDegPerRad / kResidual_deg));
      Ticks& ticks = bins[std::clamp(static_cast<int>(std::floor(quarters)), kLeastBin, kMostBin)];
      ticks.all += 1.0;
      ticks.falling += flight[kVSign][i] < 0.0;
    }
  }
  return bins;
}

PaperPart LyapunovPart(const PaperStudy& study) {
  const std::map<int, Ticks> bins =
      CountFalling(study.at("table3").campaign.autopilot.pitch, study.histories.at("table3").flights);
  const auto level_deg = [](double bin) { return kResidual_deg * std::pow(10.0, 0.25 * bin); };
  const auto from = [&](int least) {
    Ticks sum;
    for (const auto& [bin, ticks] : bins)
      if (bin >= least) sum = {sum.all + ticks.all, sum.falling + ticks.falling};
    return sum;
  };
  const double all = from(kLeastBin).all;
  SvgChart chart({.label = "level of V: the error at rest that has the same V, °", .logarithmic = true},
                 {.label = "share", .low = 0.0, .high = 1.0, .percent = true}, 520, 280);
  std::vector<double> middle, falling, share;
  for (const auto& [bin, ticks] : bins) {
    if (ticks.all < 100.0) continue;  // too few to tell a share
    middle.push_back(level_deg(bin + 0.5));
    falling.push_back(ticks.falling / ticks.all);
    share.push_back(ticks.all / all);
  }
  chart.Line(middle, falling, "line-0", "dV/dt < 0 at this level");
  chart.Line(middle, share, "line-1", "powered flight spent there");
  const auto percent = [](double part, double of) {
    return of > 0.0 ? fmt::format("{:.1f} %", 100.0 * part / of) : "–";
  };
  HtmlTable table("!V outside the level of|#powered flight spent there|#of it with dV/dt &lt; 0");
  for (const int bin : {kLeastBin, -8, -4, 0})
    table.Row({bin > kLeastBin ? fmt::format("{:g}° of error", level_deg(bin)) : "0 (everything)",
               percent(from(bin).all, all), percent(from(bin).falling, from(bin).all)});
  const std::string caption =
      "How often V = ½ eᵀPe falls, by its level; levels with fewer than 100 samples are left out.";
  return {
      "lyapunov",
      "The Lyapunov function: how often V falls",
      "dV/dt &lt; 0: the system is asymptotically stable, since the approximation error is very small "
      "(34).",
      fmt::format("Outside the residual set V falls {} of the time. There V is above that of {:g}° of error; "
                  "{} of powered flight is spent there. Over all levels V falls {} of the time.",
                  percent(from(0).falling, from(0).all), kResidual_deg, percent(from(0).all, all),
                  percent(from(kLeastBin).falling, all)),
      "With disturbances, an actuator and a projection, (34) can hold only outside a residual set: what can "
      "be claimed is uniform ultimate boundedness. V here is the part of (29) that can be measured. The "
      "part of the parameter error is unknown in flight, so a rise of this V refutes nothing by itself. At "
      "small levels V follows the disturbances. It rises while the wind or a transient grows, and falls "
      "when the law has learnt it.",
      from(kLeastBin).falling < all ? PaperVerdict::kNotReproduced : PaperVerdict::kReproduced,
      ReportLink("table3"),
      Figures(Figure(chart.Svg(caption), HtmlText(caption)) + "<div>" + table.Html("narrow") + "</div>")};
}

/// The cases in which the input has each value other than 1.
std::map<double, CaseColumns> Settings(const PaperFlights& swept, const std::string& input) {
  const std::vector<double> column = swept.Input(input);
  std::map<double, CaseColumns> settings;
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (column[i] == 1.0) continue;
    CaseColumns& setting = settings[column[i]];
    setting.index.push_back(swept.cases.index[i]);
    setting.outcome.push_back(swept.cases.outcome[i]);
  }
  for (auto& [factor, setting] : settings) {
    for (const CaseColumn& metric : swept.cases.metrics) {
      const std::vector<double> values = metric;
      setting.metrics.emplace_back();
      for (std::size_t i = 0; i < values.size(); ++i)
        if (column[i] == factor) setting.metrics.back().push_back(values[i]);
    }
  }
  return settings;
}

PaperPart CompletionPart(const PaperStudy& study) {
  const PaperFlights& table3 = study.at("table3");
  HtmlTable table("!Completion|#times|" + kDigestTitles +
                  "|requirements of table3 that fail|least computed margins|least measured|gates");
  const auto row = [&](const std::string& title, const CaseColumns& flown, const CompletionMargins& margins) {
    const auto& [input, factor, computed, measured, passed] = margins;
    std::string failed;
    for (const Requirement& requirement : table3.campaign.requirements)
      if (Judge(requirement, SamplingMethod::kMonteCarlo, flown, 0).verdict == "fail")
        failed += (failed.empty() ? "" : ", ") + requirement.metric;
    DigestRow(table, {title, fmt::format("{:g}", factor)}, flown,
              {failed.empty() ? "none" : Code(failed),
               fmt::format("{:.1f} dB, {:.1f}°, {:.0f} ms", computed.gain_db, computed.phase_deg,
                           1e3 * computed.delay_s),
               fmt::format("{:.1f} dB, {:.0f} ms", measured.gain_db, 1e3 * measured.delay_s),
               VerdictBadge(passed ? "pass" : "fail")});
    return failed;
  };
  auto margins = study.completion_margins.begin();
  const std::string as_shipped = row("as shipped (table3)", table3.cases, *margins);
  const char* const titles[] = {"inertia", "centre of pressure", "centre of gravity", "actuator bandwidth"};
  std::size_t changed = 0, settings = 0, failing_gates = 0;
  for (std::size_t f = 0; f < PaperCompletions().size(); ++f) {
    for (const auto& [factor, flown] : Settings(study.at("completions"), PaperCompletions()[f])) {
      ++settings;
      ++margins;
      DISPERSA_ASSERT(margins->input == PaperCompletions()[f] && margins->factor == factor);
      failing_gates += !margins->passed;
      changed += row(titles[f], flown, *margins) != as_shipped;
    }
  }
  return {
      "completions",
      "Completions: how much depends on what we added",
      "Aerodynamics from DATCOM. Inertia, centres and actuators are not given.",
      fmt::format(
          "{} of {} settings change which requirements of table3 fail; {} miss a gate of the margins.",
          changed, settings, failing_gates),
      "A setting that changes a verdict marks where a reader with the real vehicle’s data should look "
      "first. With few flights a setting fails only a requirement that it misses clearly.",
      PaperVerdict::kNoClaim,
      ReportLink("completions"),
      "<p>Each completion is moved by 30 % with the autopilot unchanged and Table 3’s disturbances on; CG "
      "and "
      "CP by 30 % of their distance from the nose. The margins are those of the changed vehicle along its "
      "own undisturbed flight, all axes and stages, with gains frozen and adapting.</p>\n" +
          table.Html()};
}

}  // namespace

std::vector<PaperPart> LawParts(const PaperStudy& study) {
  return {BaselinePart(study), MarginPart(study), LyapunovPart(study), CompletionPart(study)};
}

}  // namespace dispersa
