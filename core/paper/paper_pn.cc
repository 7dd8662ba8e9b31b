// Figure 5: what P_n does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/control/lyapunov.h"
#include "core/pages/heat_map.h"
#include "core/pages/svg_chart.h"
#include "core/paper/paper_parts.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

/// Peak to peak, degrees: what the study of Table 3 accepts as the worst limit cycle.
constexpr double kLimitCycle_deg = 0.2;

/// The choices of P_n that were flown: factors of p12 and p22, what became of each, and its RMS error.
std::vector<HeatPoint> Choices(const PaperFlights& flown) {
  using Region = HeatPoint::Region;
  const std::vector<double> x = flown.Input("pn_error_factor"), y = flown.Input("pn_rate_factor");
  const std::vector<double> rms_deg = flown.Metric(kRms), cycle_deg = flown.Metric(kCycle);
  std::vector<HeatPoint> choices;
  for (std::size_t i = 0; i < x.size(); ++i)
    choices.push_back({x[i], y[i], rms_deg[i],
                       flown.cases.outcome[i] != Outcome::kCompleted ? Region::kLost
                       : cycle_deg[i] > kLimitCycle_deg              ? Region::kLimitCycle
                                                                     : Region::kSound,
                       x[i] == 1.0 && y[i] == 1.0});
  return choices;
}

std::string Maps(const PaperFlights& sweep, const std::vector<LeastMargins>& margins) {
  const auto map = [&](const auto& value, const std::string& caption) {
    std::vector<HeatPoint> points = Choices(sweep);
    for (std::size_t i = 0; i < points.size(); ++i) points[i].value = value(i);
    return Figure(HeatMapTable("p22 ↑ p12 →", points), caption);
  };
  const std::vector<double> rms_deg = sweep.Metric(kRms), cycle_deg = sweep.Metric(kCycle);
  return map([&](std::size_t i) { return rms_deg[i]; },
             "RMS pitch error of powered flight, °, over the factors of p12, the weight of the error, and "
             "p22, "
             "the weight of its rate. Framed: the P_n of the Lyapunov equation. ~ limit cycle; × flight "
             "lost.") +
         map([&](std::size_t i) { return cycle_deg[i]; },
             fmt::format("Worst deflection peak to peak within one second, °, away from ignitions and the "
                         "pitch-over. Above {}° it is a limit cycle.",
                         kLimitCycle_deg)) +
         map([&](std::size_t i) { return margins[i].gain_db; },
             fmt::format(
                 "Computed gain margin of the pitch loop with the adaptation at work, dB, the least of "
                 "the flight. The gate is {:g} dB. 0: the linearised loop is unstable.",
                 kGainMarginGate_db)) +
         map([&](std::size_t i) { return margins[i].phase_deg; },
             fmt::format("Computed phase margin likewise, °. The gate is {:g}°.", kPhaseMarginGate_deg));
}

/// The error of each curve over time: as it is, or the largest of each second on a logarithmic axis, which
/// holds the tame and the lost alike.
std::string Curves(const PaperStudy& study, double end_s, bool is_size, const std::string& caption) {
  constexpr double kRange_deg = 0.5;
  const std::size_t step = is_size ? 10 : 1;  // samples
  SvgChart chart({.label = "time since lift-off, s", .low = 0.0, .high = end_s},
                 is_size ? ChartAxis{.label = "largest pitch error of each second, °", .logarithmic = true}
                         : ChartAxis{.label = "pitch error, °", .low = -kRange_deg, .high = kRange_deg},
                 520, 320);
  const std::vector<HeatPoint> factors = Choices(study.at("pn_curves"));
  // The file lists the wildest first, so that the tame are drawn over them.
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const std::vector<double>& error = study.histories.at("pn_curves").flights[i][kPitchError];
    std::vector<double> time_s, values;
    for (std::size_t k = 0; k < error.size() && 0.1 * static_cast<double>(k) < end_s; k += step) {
      double size = 0.0;
      for (std::size_t j = k; j < std::min(k + step, error.size()); ++j)
        size = std::max(size, std::fabs(error[j]));
      time_s.push_back(0.1 * static_cast<double>(k) + (is_size ? 0.5 : 0.0));
      values.push_back(is_size ? size : size > kRange_deg ? kUndefined : error[k]);
    }
    chart.Line(time_s, values, fmt::format("line-{}", factors.size() - 1 - i),
               factors[i].x == factors[i].y ? fmt::format("{:g}·P_n", factors[i].x)
                                            : fmt::format("{:g}·p12, {:g}·p22", factors[i].x, factors[i].y));
  }
  return Figure(chart.Svg(caption), HtmlText(caption));
}

/// P_n of each stage with the equation that it comes from, and those that are refused.
std::string PnTables(const AxisConfig& pitch, const std::vector<BadPn>& refused) {
  HtmlTable gains("!Stage|#kp, 1/s²|#kd, 1/s|#p12|#p22|#γ");
  for (std::size_t i = 0; i < pitch.gains.size(); ++i) {
    const Matrix2 p = SolveLyapunov(pitch.gains[i], pitch.adaptation.q);
    gains.Row({fmt::format("{}", i + 1), ReadableText(pitch.gains[i].kp_1_s2),
               ReadableText(pitch.gains[i].kd_1_s), ReadableText(p(0, 1)), ReadableText(p(1, 1)),
               ReadableText(pitch.adaptation.gamma[i])});
  }
  HtmlTable table("!P_n that is refused|answer|flown with allow_unproven");
  for (const BadPn& bad : refused)
    table.Row({fmt::format("[{}, {}]", ReadableText(bad.p_n.x()), ReadableText(bad.p_n.y())),
               HtmlText(bad.refusal),
               fmt::format("<b>{}</b> after {:.1f} s: {}", OutcomeName(bad.flight.outcome),
                           bad.flight.end_time_s, HtmlText(bad.flight.reason))});
  const Matrix2& q = pitch.adaptation.q;
  return fmt::format(
             "<p>P solves AᵀP + PA = −Q for the error dynamics s² + kd s + kp of each stage and Q = [[{}, "
             "{}], [{}, {}]]. Its last column is P_n. The maps scale its components in all stages at "
             "once.</p>\n",
             ReadableText(q(0, 0)), ReadableText(q(0, 1)), ReadableText(q(1, 0)), ReadableText(q(1, 1))) +
         gains.Html("narrow") + table.Html();
}

/// The paper's claim is about departures from the optimum.
void JudgeDepartures(const std::vector<HeatPoint>& all, const std::vector<LeastMargins>& least,
                     PaperPart& part) {
  const HeatPoint *nominal = nullptr, *best = nullptr, *worst = nullptr;
  std::size_t lost = 0, cycling = 0;
  for (const HeatPoint& one : all) {
    if (one.framed) nominal = &one;
    cycling += one.region == HeatPoint::Region::kLimitCycle;
    if (one.region == HeatPoint::Region::kLost) {
      ++lost;
      continue;
    }
    if (one.region == HeatPoint::Region::kSound && (!best || one.value < best->value)) best = &one;
    if (!worst || one.value > worst->value) worst = &one;
  }
  if (!nominal || !best || !worst) return;
  const auto choice = [](const HeatPoint& one) {
    return fmt::format("{} (factors {:g} and {:g})", Degrees(one.value), one.x, one.y);
  };
  const auto margins = [&](const HeatPoint& one) {
    const LeastMargins& of = least[static_cast<std::size_t>(&one - all.data())];
    return fmt::format("{:.1f} dB and {:.1f}°", of.gain_db, of.phase_deg);
  };
  const bool lowers = best->value < nominal->value;
  part.verdict = !lowers    ? PaperVerdict::kReproduced
                 : lost > 0 ? PaperVerdict::kInPart
                            : PaperVerdict::kNotReproduced;
  part.found = fmt::format(
      "Of {} choices {} lose the vehicle and {} more run into a limit cycle. With the P_n of the Lyapunov "
      "equation the RMS error is {}. The best choice that neither loses the vehicle nor cycles has {}, the "
      "worst completed one {}. <b>{}</b> The computed margins, least of the flight, are {} at the Lyapunov "
      "equation’s and {} at that best choice.",
      all.size(), lost, cycling, Degrees(nominal->value), choice(*best), choice(*worst),
      lowers
          ? fmt::format("Departing from the Lyapunov equation’s P_n lowers the error to {:.2g} of its own.",
                        best->value / nominal->value)
          : "No departure lowers the error.",
      margins(*nominal), margins(*best));
}

}  // namespace

PaperPart PnPart(const PaperStudy& study) {
  const PaperFlights &curves = study.at("pn_curves"), &sweep = study.at("pn_sweep");
  PaperPart part{
      "fig5",
      "Fig. 5: the choice of P_n",
      "Performance deteriorates as P_n departs from its optimal values. A poor choice makes the "
      "loop unstable. P is called positive semi-definite.",
      "",
      "P must be definite. Any two positive numbers are the last column of some positive definite P "
      "with some Q, so positivity alone proves little. The check here is that P_n belongs to the "
      "configured gains and Q. Only γ·P_n enters the law, so a larger P_n is a larger adaptation "
      "gain. It tracks better until the actuator’s lag turns adaptation into a limit cycle.",
      PaperVerdict::kNoClaim,
      ReportLink("pn_curves") + ", " + ReportLink("pn_sweep")};
  JudgeDepartures(Choices(sweep), study.pn_margins, part);
  const double kick_end_s = 10.0 * std::ceil(0.1 * (curves.campaign.reference.program.t2_s + 5.0));
  part.shown = Figures(Curves(study, kick_end_s, false,
                              "Pitch error in the initial pitch-over, as in the paper’s figure. A curve that "
                              "leaves the frame diverges or swings beyond it.") +
                       Curves(study, 180.0, true,
                              "The same to the burnout of stage 3, whatever its size. A curve ends where the "
                              "vehicle is lost.") +
                       Maps(sweep, study.pn_margins)) +
               PnTables(curves.campaign.autopilot.pitch, study.bad_pn);
  return part;
}

}  // namespace dispersa
