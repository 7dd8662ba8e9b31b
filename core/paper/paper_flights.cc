// Figures 6 to 10: the flights.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/pages/flight_charts.h"
#include "core/paper/paper_parts.h"

namespace dispersa {
namespace {

/// The end of the initial pitch-over as drawn, a little after t2.
double KickEnd(const PaperStudy& study) {
  return 5.0 * std::ceil(0.2 * (study.at("table3").campaign.reference.program.t2_s + 4.0));
}

std::string Draw(const PaperStudy& study, const char* name, const char* column, const char* label,
                 std::optional<double> to_s, const std::string& caption) {
  const bool is_pitch = std::string(column) == "pitch_launch_deg";
  return BandFigure({.column = column, .label = label, .from_s = 0.0, .to_s = to_s, .program = is_pitch},
                    study.histories.at(name).drawn, study.at(name).summary, caption);
}

PaperPart PitchOverPart(const PaperStudy& study) {
  constexpr double kAccurate_deg = 0.5;  // what table3 requires of the peak
  const double end_s = KickEnd(study);
  const FlightBands& bands = study.histories.at("table3").drawn.bands;
  const History& nominal = study.histories.at("table3").drawn.nominal_history;
  const auto largest = [&](const char* name) {
    double size = 0.0;
    for (std::size_t i = 0; i < nominal.rows() && nominal.at(i, FindHistoryColumn("time_s")) <= end_s; ++i)
      size = std::max(size, std::fabs(nominal.at(i, FindHistoryColumn(name))));
    return Degrees(size);
  };
  double dispersed_deg = 0.0;
  const Band& error = bands.bands[kPitchError];
  for (std::size_t i = 0; i < bands.time_s.size() && bands.time_s[i] <= end_s; ++i)
    dispersed_deg = std::max({dispersed_deg, std::fabs(error.min[i]), std::fabs(error.max[i])});
  return {
      "fig6",
      "Figs. 6, 7: the initial pitch-over",
      "The pitch angle follows the reference accurately in the initial pitch-over.",
      fmt::format("Nominal: at most {} of error with {} of deflection in the first {:.0f} s. With Table 3’s "
                  "disturbances the error stays within {}. <code>table3</code> allows {}.",
                  largest("pitch_error_deg"), largest("deflection_pitch_deg"), end_s, Degrees(dispersed_deg),
                  Degrees(kAccurate_deg)),
      "The paper prints one flight and does not say with which disturbances. Here the nominal flight "
      "stands before the spread of the dispersed ones.",
      dispersed_deg < kAccurate_deg ? PaperVerdict::kReproduced : PaperVerdict::kNotReproduced,
      PaperLink("table3/report.html#envelope", "table3: pitch error"),
      Figures(Draw(study, "table3", "pitch_launch_deg", "pitch, °", end_s,
                   fmt::format("Fig. 6: pitch in the initial pitch-over. Bands: the first {} flights.",
                               bands.flights)) +
              Draw(study, "table3", "deflection_pitch_deg", "pitch deflection, °", end_s,
                   "Fig. 7: control deflection in the initial pitch-over."))};
}

PaperPart WholeFlightPart(const PaperStudy& study) {
  const CaseColumns& cases = study.at("table3").cases;
  const MetricDigest rms = Digested(cases, kRms), peak = Digested(cases, kPeak);
  const auto nominal = [&](const char* name) { return Degrees(study.nominal().metrics[MetricColumn(name)]); };
  const std::vector<RequirementSummary>& required = study.at("table3").summary.requirements;
  const auto count = [&](const char* verdict) {
    return std::count_if(required.begin(), required.end(),
                         [&](const RequirementSummary& each) { return each.verdict == verdict; });
  };
  const bool holds = LostCount(cases) == 0 && count("fail") == 0;
  return {
      "fig8",
      "Figs. 8, 9: lift-off to injection",
      "The controller tracks the whole profile from launch to injection in the presence of Table 3’s "
      "disturbances.",
      fmt::format(
          "Nominal: RMS {}, peak {}, limit cycle {}. Table 3, {} flights: {} lost; median RMS {} "
          "(largest {}), median peak {} (largest {}), worst limit cycle {} peak to peak. Of {} requirements "
          "{} passed, {} failed.",
          nominal(kRms), nominal(kPeak), nominal(kCycle), cases.rows(), LostCount(cases), Degrees(rms.p50),
          Degrees(rms.max), Degrees(peak.p50), Degrees(peak.max), Degrees(Digested(cases, kCycle).max),
          required.size(), count("pass"), count("fail")),
      "The paper gives neither numbers nor a coast. Errors are those of powered flight with every ignition "
      "transient. A probability of 99.73 % needs thousands of flights. <code>dispersa run "
      "campaigns/table3.yaml</code> decides what is inconclusive with fewer.",
      holds ? PaperVerdict::kReproduced : PaperVerdict::kNotReproduced,
      ReportLink("table3") + ", " + PaperLink("table3/report.html#nominal", "nominal flight"),
      Figures(
          Draw(study, "table3", "pitch_launch_deg", "pitch, °", {}, "Fig. 8: pitch over the whole flight.") +
          Draw(study, "table3", "deflection_pitch_deg", "pitch deflection, °", {},
               "Fig. 9: control deflection over the whole flight. In the coast reaction control "
               "points the stage."))};
}

/// Which corner is worst, with Table 3 off.
std::string WorstCorner(const PaperFlights& corners) {
  std::vector<double> peaks = CompletedValues(corners.cases, kPeak);
  for (double& peak : peaks) peak = std::isfinite(peak) ? peak : HUGE_VAL;
  const auto worst = std::max_element(peaks.begin(), peaks.end());
  if (worst == peaks.end()) return "";
  const auto input = [&](const char* name) { return corners.Input(name)[worst - peaks.begin()]; };
  return fmt::format("drag {:g}, lift {:g}, CG {:g}, CP {:g} times nominal: {}", input("drag_factor"),
                     input("lift_factor"), input("cg_factor"), input("cp_factor"),
                     std::isfinite(*worst) ? "peak " + Degrees(*worst) : "lost");
}

PaperPart RobustnessPart(const PaperStudy& study) {
  struct Set {
    const char *title, *quiet, *disturbed;
  };
  HtmlTable table("!Set|Table 3|" + kDigestTitles + "|Report");
  std::size_t lost = 0, flown = 0;
  double worst_deg = 0.0;
  for (const Set& set : {Set{"all 16 corners", "aero20_quiet", "aero20"},
                         Set{"one at a time", "aero20_one_at_a_time_quiet", "aero20_one_at_a_time"},
                         Set{"Monte Carlo, uniform", "aero20_monte_carlo_quiet", "aero20_monte_carlo"}}) {
    for (const char* name : {set.quiet, set.disturbed}) {
      const CaseColumns& cases = study.at(name).cases;
      lost += LostCount(cases);
      flown += cases.rows();
      worst_deg = std::fmax(worst_deg, Digested(cases, kPeak).max);
      DigestRow(table, {set.title, name == set.disturbed ? "on" : "off"}, cases, {ReportLink(name)});
    }
  }
  const double end_s = KickEnd(study);
  return {
      "fig10",
      "Fig. 10: drag, lift, CG and CP ±20 %",
      "The controller follows the reference pitch for all variations of ±20 %.",
      fmt::format("{} of {} flights are lost. The largest peak error of the completed ones is {}. The worst "
                  "corner without Table 3 is {}.",
                  lost, flown, Degrees(worst_deg), WorstCorner(study.at("aero20_quiet"))),
      "The paper shows the pitch angle of some variations in the pitch-over. At that scale errors of "
      "tenths of a degree do not show. “±20 % of CG and CP” is read as their distance from the nose of "
      "the current stack, with the inertia held. The paper does not say from where.",
      lost == 0 ? PaperVerdict::kReproduced : PaperVerdict::kNotReproduced,
      ReportLink("aero20_quiet") + " and five more",
      Figures(Draw(study, "aero20_quiet", "pitch_launch_deg", "pitch, °", end_s,
                   "Fig. 10: pitch in the initial pitch-over, the 16 corners.") +
              Draw(study, "aero20_quiet", "pitch_error_deg", "pitch error, °", end_s,
                   "Pitch error of the corners. The reports have whole flights and worst cases.")) +
          table.Html()};
}

}  // namespace

std::vector<PaperPart> FlownParts(const PaperStudy& study) {
  return {PitchOverPart(study), WholeFlightPart(study), RobustnessPart(study)};
}

}  // namespace dispersa
