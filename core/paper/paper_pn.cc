// Figure 5: what P_n does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/control/lyapunov.h"
#include "core/pages/html_parts.h"
#include "core/pages/svg_chart.h"
#include "core/paper/heat_map.h"
#include "core/paper/paper_sections.h"
#include "core/results/text.h"
#include "core/statistics/summary.h"

namespace dispersa {
namespace {

/// Peak to peak, degrees: what the study of Table 3 accepts as the worst limit cycle.
constexpr double kLimitCycle_deg = 0.2;

std::vector<double> Input(const CaseColumns& cases, const char* name) {
  return cases.inputs[static_cast<std::size_t>(FindInput(name))];
}

std::vector<double> Times(std::size_t steps, double step_s) {
  std::vector<double> time_s(steps);
  for (std::size_t i = 0; i < steps; ++i) time_s[i] = step_s * static_cast<double>(i);
  return time_s;
}

HeatMapCell::Region RegionOf(const CaseColumns& cases, std::size_t row) {
  if (cases.outcome[row] != Outcome::kCompleted) return HeatMapCell::Region::kLost;
  const double cycle = cases.metrics[MetricColumn("deflection_limit_cycle_deg")][row];
  return cycle > kLimitCycle_deg ? HeatMapCell::Region::kLimitCycle : HeatMapCell::Region::kSound;
}

HeatMap Map(const CaseColumns& cases, const std::vector<double>& shown, const char* label) {
  HeatMap map;
  map.x_label = "factor of p12, the weight of the error";
  map.y_label = "factor of p22, the weight of its rate";
  map.value_label = label;
  map.framed_x = map.framed_y = 1.0;
  const std::vector<double> x = Input(cases, "pn_error_factor");
  const std::vector<double> y = Input(cases, "pn_rate_factor");
  const auto levels = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
  };
  map.x = levels(x);
  map.y = levels(y);
  map.cells.resize(map.x.size() * map.y.size());
  for (std::size_t i = 0; i < cases.rows(); ++i) {
    const auto column = std::lower_bound(map.x.begin(), map.x.end(), x[i]) - map.x.begin();
    const auto row = std::lower_bound(map.y.begin(), map.y.end(), y[i]) - map.y.begin();
    map.cells[static_cast<std::size_t>(row) * map.x.size() + static_cast<std::size_t>(column)] = {
        shown[i], RegionOf(cases, i)};
  }
  return map;
}

std::string CurveName(const CaseColumns& cases, std::size_t row) {
  const double error = Input(cases, "pn_error_factor")[row];
  const double rate = Input(cases, "pn_rate_factor")[row];
  return error == rate ? fmt::format("{:g}·P_n", error) : fmt::format("{:g}·p12, {:g}·p22", error, rate);
}

/// The error within +-range; a curve that leaves it has a gap there.
std::string Curves(const PaperStudy& study, double end_s, double range_deg, const std::string& caption) {
  const PaperFlights& curves = study.at("pn_curves");
  SvgChart chart({.label = "time since lift-off, s", .low = 0.0, .high = end_s},
                 {.label = "pitch error, °", .low = -range_deg, .high = range_deg}, 520, 320);
  // The file lists the wildest first, so that the tame are drawn over them.
  const std::size_t count = curves.flights.histories.size();
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> values = curves.flights.histories[i][kPitchError];
    for (double& value : values) {
      if (std::fabs(value) > range_deg) value = kUndefined;
    }
    chart.Line(Times(values.size(), 0.1), values, fmt::format("line-{}", count - 1 - i),
               CurveName(curves.flights.cases, i));
  }
  return Figure(chart.Svg(caption), HtmlText(caption));
}

/// The size of the error on a logarithmic axis, which holds the tame and the lost alike.
std::string WholeCurves(const PaperStudy& study, double end_s, const std::string& caption) {
  const PaperFlights& curves = study.at("pn_curves");
  SvgChart chart({.label = "time since lift-off, s", .low = 0.0, .high = end_s},
                 {.label = "largest pitch error of each second, °", .logarithmic = true}, 520, 320);
  const std::size_t count = curves.flights.histories.size();
  for (std::size_t i = 0; i < count; ++i) {
    constexpr std::size_t kSecond = 10;  // samples
    const std::vector<double>& error = curves.flights.histories[i][kPitchError];
    std::vector<double> time_s, largest;
    for (std::size_t k = 0; k < error.size() && static_cast<double>(k) < kSecond * end_s; k += kSecond) {
      double size = 0.0;
      for (std::size_t j = k; j < std::min(k + kSecond, error.size()); ++j)
        size = std::max(size, std::fabs(error[j]));
      time_s.push_back(0.1 * static_cast<double>(k) + 0.5);
      largest.push_back(size);
    }
    chart.Line(time_s, largest, fmt::format("line-{}", count - 1 - i), CurveName(curves.flights.cases, i));
  }
  return Figure(chart.Svg(caption), HtmlText(caption));
}

std::string BadPnTable(const PaperStudy& study) {
  HtmlTable table({{"P_n of pitch"},
                   {"what is said to it"},
                   {"flown with allow_unproven"},
                   {"RMS", true},
                   {"peak", true},
                   {"limit cycle", true}});
  for (const BadPn& bad : study.bad_pn) {
    const auto metric = [&](const char* name) { return Degrees(bad.flight.metrics[MetricColumn(name)]); };
    table.Row(
        {fmt::format("[{}, {}]", ReadableText(bad.p_n.x()), ReadableText(bad.p_n.y())),
         bad.refusal.empty() ? "accepted" : "<q>" + HtmlText(bad.refusal) + "</q>",
         fmt::format("<b>{}</b> after {:.1f} s{}", OutcomeName(bad.flight.outcome), bad.flight.end_time_s,
                     bad.flight.reason.empty() ? "" : ": " + HtmlText(bad.flight.reason)),
         metric("pitch_error_rms_deg"), metric("pitch_error_peak_deg"),
         metric("deflection_limit_cycle_deg")});
  }
  return "<h3>A P_n that is refused</h3>\n" + table.Html();
}

/// P_n of each stage, with the equation that it comes from.
std::string GainTable(const AxisConfig& pitch) {
  HtmlTable table(
      {{"Stage"}, {"kp, 1/s²", true}, {"kd, 1/s", true}, {"p12", true}, {"p22", true}, {"γ", true}});
  for (std::size_t i = 0; i < pitch.gains.size(); ++i) {
    const Matrix2 p = SolveLyapunov(pitch.gains[i], pitch.adaptation.q);
    table.Row({fmt::format("{}", i + 1), ReadableText(pitch.gains[i].kp_1_s2),
               ReadableText(pitch.gains[i].kd_1_s), ReadableText(p(0, 1)), ReadableText(p(1, 1)),
               ReadableText(pitch.adaptation.gamma[i])});
  }
  return fmt::format(
             "<p>P solves AᵀP + PA = −Q for the error dynamics s² + kd s + kp of each stage and Q = [[{}, "
             "{}], [{}, {}]]; its last column is P_n. Below, both components are scaled in all stages at "
             "once.</p>\n",
             ReadableText(pitch.adaptation.q(0, 0)), ReadableText(pitch.adaptation.q(0, 1)),
             ReadableText(pitch.adaptation.q(1, 0)), ReadableText(pitch.adaptation.q(1, 1))) +
         table.Html("narrow");
}

/// The flown metrics over the two components of P_n.
std::string MetricMaps(const CaseColumns& sweep) {
  return Figure(HeatMapSvg(Map(sweep, sweep.metrics[MetricColumn("pitch_error_rms_deg")],
                               "RMS pitch error of powered flight, °"),
                           "RMS pitch error over the two components of P_n"),
                "RMS pitch error of powered flight over the two factors. The frame is the P_n of the "
                "Lyapunov equation.") +
         Figure(HeatMapSvg(Map(sweep, sweep.metrics[MetricColumn("deflection_limit_cycle_deg")],
                               "worst limit cycle, ° peak to peak"),
                           "Worst limit cycle over the two components of P_n"),
                fmt::format("Worst deflection peak to peak within one second, away from ignitions and the "
                            "pitch-over: a limit cycle above {}°.",
                            kLimitCycle_deg));
}

/// The computed margins over the two components of P_n.
std::string MarginMaps(const PaperStudy& study, const CaseColumns& sweep) {
  std::vector<double> gains_db, phases_deg;
  for (const LeastMargins& margins : study.pn_margins) {
    gains_db.push_back(margins.gain_db);
    phases_deg.push_back(margins.phase_deg);
  }
  return Figure(HeatMapSvg(Map(sweep, gains_db, "least computed gain margin, dB"),
                           "Least computed gain margin over the two components of P_n"),
                fmt::format("Gain margin of the pitch loop with the adaptation at work, the least of the "
                            "flight; the gate is {:g} dB. 0: the linearised loop is unstable.",
                            kGainMarginGate_db)) +
         Figure(HeatMapSvg(Map(sweep, phases_deg, "least computed phase margin, °"),
                           "Least computed phase margin over the two components of P_n"),
                fmt::format("Phase margin likewise; the gate is {:g}°.", kPhaseMarginGate_deg));
}

std::string PnFigures(const PaperStudy& study, const CaseColumns& sweep) {
  const double kick_end_s =
      10.0 * std::ceil(0.1 * (study.at("pn_curves").campaign.reference.program.t2_s + 5.0));
  return "<div class=\"figures\">\n" +
         Curves(study, kick_end_s, 0.5,
                "Pitch error in the initial pitch-over, as in the paper’s figure. A curve that leaves the "
                "frame diverges or swings beyond it.") +
         WholeCurves(study, 180.0,
                     "The same to the burnout of stage 3, whatever its size: the largest error of each "
                     "second. A curve ends where the vehicle is lost.") +
         MetricMaps(sweep) + MarginMaps(study, sweep) + "</div>\n";
}

/// Rows of the sweep; as many as the sweep has: none.
struct PnChoices {
  std::size_t lost = 0, cycling = 0;  ///< numbers of rows
  std::size_t nominal, best, worst;
};

PnChoices ChoicesOf(const CaseColumns& sweep, const std::vector<double>& rms, const std::vector<double>& x,
                    const std::vector<double>& y) {
  PnChoices found{.nominal = sweep.rows(), .best = sweep.rows(), .worst = sweep.rows()};
  for (std::size_t i = 0; i < sweep.rows(); ++i) {
    if (x[i] == 1.0 && y[i] == 1.0) found.nominal = i;
    const HeatMapCell::Region region = RegionOf(sweep, i);
    found.lost += region == HeatMapCell::Region::kLost;
    found.cycling += region == HeatMapCell::Region::kLimitCycle;
    if (region == HeatMapCell::Region::kLost) continue;
    if (region == HeatMapCell::Region::kSound && (found.best == sweep.rows() || rms[i] < rms[found.best]))
      found.best = i;
    if (found.worst == sweep.rows() || rms[i] > rms[found.worst]) found.worst = i;
  }
  return found;
}

/// The paper's claim is about departures from the optimum.
std::string WhatDeparturesDo(const PaperStudy& study, const CaseColumns& sweep) {
  const std::vector<double>& rms = sweep.metrics[MetricColumn("pitch_error_rms_deg")];
  const std::vector<double> x = Input(sweep, "pn_error_factor");
  const std::vector<double> y = Input(sweep, "pn_rate_factor");
  const PnChoices of = ChoicesOf(sweep, rms, x, y);
  if (of.nominal == sweep.rows() || of.best == sweep.rows() || of.worst == sweep.rows()) return "";
  const auto margins = [&](std::size_t i) {
    return fmt::format("{:.1f} dB and {:.1f}°", study.pn_margins[i].gain_db, study.pn_margins[i].phase_deg);
  };
  return fmt::format(
             "Of {} choices {} lose the vehicle and {} more run into a limit cycle. With the P_n of the "
             "Lyapunov equation the RMS error is {}; the best choice that neither loses the vehicle nor "
             "cycles has {} (factors {:g} and {:g}), the worst completed one {} (factors {:g} and {:g}).",
             sweep.rows(), of.lost, of.cycling, Degrees(rms[of.nominal]), Degrees(rms[of.best]), x[of.best],
             y[of.best], Degrees(rms[of.worst]), x[of.worst], y[of.worst]) +
         fmt::format(
             " <b>{}</b> The computed margins, least of the flight, are {} at the Lyapunov equation’s and {} "
             "at that best choice.",
             rms[of.best] < rms[of.nominal]
                 ? fmt::format("The figure’s claim is not reproduced: departing from the Lyapunov equation’s "
                               "P_n lowers the error to {:.2g} of its own.",
                               rms[of.best] / rms[of.nominal])
                 : "As the figure claims, no departure lowers the error.",
             margins(of.nominal), margins(of.best));
}

}  // namespace

std::string PaperPnSection(const PaperStudy& study) {
  const CaseColumns& sweep = study.at("pn_sweep").flights.cases;
  return "<h2 id=\"fig5\">Fig. 5: the choice of P_n</h2>\n" + PaperSource(study, {"pn_curves", "pn_sweep"}) +
         GainTable(study.at("pn_curves").campaign.autopilot.pitch) + PnFigures(study, sweep) +
         BadPnTable(study) +
         PaperFindings(
             "Performance deteriorates as P_n departs from its optimal values, and a poor choice makes the "
             "loop unstable. P is called positive semi-definite.",
             WhatDeparturesDo(study, sweep),
             "P must be definite, not semi-definite. Any two positive numbers are the last column of some "
             "positive definite P with some Q, so positivity alone proves little: the check here is that P_n "
             "belongs to the configured gains and Q. Only γ·P_n enters the law, so a larger P_n is a larger "
             "adaptation gain: it tracks better until the actuator’s lag turns adaptation into a limit "
             "cycle.");
}

}  // namespace dispersa
