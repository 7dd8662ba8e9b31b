#include "core/pages/report_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/flight/engine_version.h"
#include "core/math/constants.h"
#include "core/pages/flight_charts.h"
#include "core/pages/glossary.h"
#include "core/pages/html_parts.h"
#include "core/results/metric_catalogue.h"
#include "core/results/sampling_text.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

std::string ReplayCell(const CampaignSummary& summary, std::uint64_t case_index) {
  if (summary.python_law) return fmt::format("<span data-case=\"{}\">–</span>", case_index);
  return fmt::format("<code class=\"copy\" data-case=\"{}\">{}</code>", case_index,
                     ReplayCommand(case_index));
}

std::string OutcomeWords(Outcome outcome) {
  std::string words = OutcomeName(outcome);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

/// The axis that has the peak, and when.
std::string WorstWhere(const std::string& metric, const WorstCase& worst, const FlightHistories& histories) {
  const std::string quantity = WorstQuantity(metric, worst.case_index, histories);
  return quantity.empty() ? "" : "<span class=\"definition\">in " + HtmlText(quantity) + "</span>";
}

/// An estimate with its limits below it, or the bound that is all the sample gives.
std::string PercentileCell(const MetricSummary& metric, const std::string& name) {
  const auto text = [&](double value) { return ScatterText(value, metric.statistics.std); };
  for (const Percentile& percentile : metric.percentiles) {
    if (percentile.name != name) continue;
    const Interval& limits = percentile.limits;
    const bool above = std::isfinite(limits.lower);
    const bool below = std::isfinite(limits.upper);
    if (!std::isfinite(percentile.estimate)) return above ? "≥ " + text(limits.lower) : "–";
    return text(percentile.estimate) + "<span class=\"definition\">" +
           (above && below ? text(limits.lower) + " … " + text(limits.upper)
            : above        ? "≥ " + text(limits.lower)
            : below        ? "≤ " + text(limits.upper)
                           : "no limits") +
           "</span>";
  }
  return "–";
}

std::string LimitsTable(const CampaignSummary& summary) {
  if (summary.limits.empty()) return "";
  HtmlTable table("!Load|#Limit|#Largest|#of case|#Flights beyond");
  for (const CampaignSummary::Limit& one : summary.limits) {
    const MetricInfo info = DescribeMetric(one.metric);
    table.Row({HtmlText(info.title), StatedText(one.limit) + (info.unit.empty() ? "" : " " + info.unit),
               one.largest ? RoundedText(*one.largest, Rounding::kNearest, one.limit) +
                                 (info.unit.empty() ? "" : " " + info.unit)
                           : "–",
               one.largest ? std::to_string(one.largest_case) : "–",
               one.exceeded == 0 ? "0" : fmt::format("<span class=\"badge fail\">{}</span>", one.exceeded)});
  }
  return "<h3>Limits of the vehicle</h3>\n" + table.Html("narrow");
}

double NominalValue(const CampaignSummary& summary, const std::string& metric) {
  return summary.nominal ? summary.nominal->metrics[summary.metric_list.PositionOf(metric)] : std::nan("");
}

std::string OwnDefinition(const CampaignSummary& summary, const std::string& metric) {
  for (const OwnMetric& own : summary.own_metrics)
    if (own.name == metric) return own.meaning + (own.meaning.empty() ? "" : "; ") + own.expression;
  return "";
}

}  // namespace

std::string OutcomesSection(const CampaignSummary& summary) {
  std::string html = "<h2 id=\"outcomes\">Outcomes</h2>\n";
  HtmlTable table("!Outcome|#Cases|#Share of those flown");
  for (int i = 0; i < kOutcomeCount; ++i) {
    const std::uint64_t count = summary.outcomes[static_cast<std::size_t>(i)];
    const double share =
        summary.flown == 0 ? std::nan("") : static_cast<double>(count) / static_cast<double>(summary.flown);
    // A limit of the vehicle that ends no flight is exceeded without this outcome.
    const bool beside = static_cast<Outcome>(i) == Outcome::kStructuralLimit && summary.beyond_limits > count;
    table.Row(
        {OutcomeWords(static_cast<Outcome>(i)) +
             (beside ? fmt::format("<span class=\"definition\">ended by it; {} more exceeded a limit and "
                                   "flew on</span>",
                                   summary.beyond_limits - count)
                     : ""),
         std::to_string(count), ShareText(share)});
  }
  if (!summary.limits.empty()) {
    const double share =
        summary.flown == 0 ? std::nan("")
                           : static_cast<double>(summary.beyond_limits) / static_cast<double>(summary.flown);
    table.Row({"a limit of the structure exceeded, however it ended",
               summary.beyond_limits == 0
                   ? "0"
                   : fmt::format("<span class=\"badge fail\">{}</span>", summary.beyond_limits),
               ShareText(share)});
  }
  if (summary.near_step_limit > 0)
    table.Row({"near the limit of the integration's step, however it ended",
               std::to_string(summary.near_step_limit),
               ShareText(static_cast<double>(summary.near_step_limit) / static_cast<double>(summary.flown))});
  html += table.Html("narrow");
  html += LimitsTable(summary);
  if (!summary.lost_flights.empty()) {
    const std::uint64_t lost =
        summary.flown - summary.outcomes[static_cast<std::size_t>(Outcome::kCompleted)];
    html += fmt::format("<h3>Lost flights: {}</h3>\n", lost);
    HtmlTable lost_table("!#Case|Outcome|#Time, s|#Stage|Reason|To fly it again");
    for (const LostFlight& flight : summary.lost_flights) {
      lost_table.Row({std::to_string(flight.case_index), OutcomeWords(flight.outcome),
                      ReadableText(flight.end_time_s), std::to_string(flight.end_stage),
                      HtmlText(flight.reason), ReplayCell(summary, flight.case_index)});
    }
    // A long list is folded away on screen and printed in full.
    const std::string which =
        lost > summary.lost_flights.size()
            ? fmt::format("the first {}; <code>cases.csv</code> has all of them", summary.lost_flights.size())
            : "all of them";
    html += lost > 20 ? "<details><summary>" + which + "</summary>\n" + lost_table.Html() + "</details>\n"
                      : lost_table.Html();
  }
  if (!summary.quarantined.empty()) {
    html +=
        "<h3>Quarantined cases</h3>\n<p>They killed or hung their workers and are not flown any more. They "
        "have no result: verdicts count them as failed for a pass and as met for a failure.</p>\n";
    HtmlTable quarantine("!#Case|Reason");
    for (const QuarantinedCase& one : summary.quarantined) {
      quarantine.Row({std::to_string(one.case_index), HtmlText(one.reason)});
    }
    html += quarantine.Html();
  }
  return html;
}

std::string WorstCasesSection(const CampaignSummary& summary, const FlightHistories& histories) {
  std::string html =
      "<h2 id=\"worst\">Worst cases</h2>\n<p>A lost flight first, if there is one; all are listed under "
      "Outcomes.";
  html += summary.python_law
              ? "</p>\n"
              : " The commands run in the result folder. They check that the case has the same " +
                    Term("digest") +
                    " to the last bit; <code>--history FILE</code> adds its time history.</p>\n";
  HtmlTable table("Metric|!#Case|#Value|Outcome|To fly it again|Time history");
  constexpr std::size_t kPrinted = 2;
  for (const WorstCases& worst : summary.worst_cases) {
    const MetricInfo info = DescribeMetric(worst.metric);
    const auto known = std::find_if(summary.metrics.begin(), summary.metrics.end(),
                                    [&](const MetricSummary& one) { return one.name == worst.metric; });
    const double std = known == summary.metrics.end() ? std::nan("") : known->statistics.std;
    const std::string unit = info.unit.empty() ? "" : " " + info.unit;
    // As many digits as the scatter or the distance to a limit asks for.
    const auto value_text = [&](double value) {
      std::string text = ScatterText(value, std);
      for (const RequirementSummary& requirement : summary.requirements) {
        if (requirement.metric != worst.metric) continue;
        const std::string beside = RoundedText(value, Rounding::kNearest, LimitBeside(requirement, value));
        if (beside.size() > text.size()) text = beside;
      }
      return text;
    };
    for (std::size_t i = 0; i < worst.cases.size(); ++i) {
      const WorstCase& one = worst.cases[i];
      const bool written =
          std::binary_search(histories.written_cases.begin(), histories.written_cases.end(), one.case_index);
      table.Row({i == 0 ? HtmlText(info.title) : "", std::to_string(one.case_index),
                 one.value ? value_text(*one.value) + unit + WorstWhere(worst.metric, one, histories) : "–",
                 OutcomeWords(one.outcome), ReplayCell(summary, one.case_index),
                 written ? Code(fmt::format("histories/case_{}.csv.gz", one.case_index)) : ""},
                i < kPrinted ? "" : "screen");
    }
  }
  return html + table.Html();
}

std::string StatisticsSection(const CampaignSummary& summary) {
  std::string html =
      "<h2 id=\"statistics\">Statistics of every metric</h2>\n<p>Over the completed flights that define "
      "the metric; n says how many, and lost flights are listed under Outcomes. Under each percentile stand "
      "its limits of 95 %, of any distribution. One that so few flights cannot reach is shown as a bound. "
      "Values have two digits of the standard deviation; <code>summary.json</code> has all digits. Attitude "
      "and deflection metrics cover powered flight, ignition to burnout of each stage with its transients; "
      "the "
      "coast has its own. Words: " +
      Term("max q") + ", " + Term("q·α") + ", " + Term("limit cycle") + ".</p>\n";
  HtmlTable table("#Nominal|#n|#Mean|#Std|#Skewness|#Min|#p50|#p95|#p99|#p99.73|#Max");
  for (const char* group : kMetricGroupTitles) {
    bool titled = false;
    std::string same, around, undefined;  // what does not vary needs no row of eleven equal numbers
    for (const MetricSummary& metric : summary.metrics) {
      const MetricInfo info = DescribeMetric(metric.name);
      if (info.group != group) continue;
      if (!titled) table.Wide(group, "group");
      titled = true;
      const std::string text = info.is_part ? ""
                               : info.known ? info.definition
                                            : OwnDefinition(summary, metric.name);
      const std::string definition =
          text.empty() ? "" : " <span class=\"soft screen\">" + HtmlText(text) + "</span>";
      const Summary& s = metric.statistics;
      const std::string unit = info.unit.empty() ? "" : " " + HtmlText(info.unit);
      if (s.n > 1 && s.min == s.max) {
        same +=
            fmt::format("{}{} {}{}{}", same.empty() ? "" : "; ", HtmlText(info.title), ReadableText(s.min),
                        unit, s.n == summary.flown ? "" : fmt::format(" (n = {})", s.n));
        continue;
      }
      if (s.n == 0) {
        undefined += (undefined.empty() ? "" : "; ") + HtmlText(info.title);
        continue;
      }
      if (IsAllAround(s)) {
        around += fmt::format("{}{} (n = {})", around.empty() ? "" : "; ", HtmlText(info.title), s.n);
        continue;
      }
      const auto value = [&](double number) {
        return ScatterText(NearTo(s.mean, number, info.circle), s.std);
      };
      // Above its numbers: beside twelve of them no name finds room.
      table.Wide("<div><b>" + HtmlText(info.title) + (info.unit.empty() ? "" : ", " + HtmlText(info.unit)) +
                     "</b>" + definition + "</div>",
                 info.is_part ? "name screen" : "name");
      table.Row({value(NominalValue(summary, metric.name)), std::to_string(s.n), value(s.mean),
                 RoundedText(s.std), RoundedText(metric.skewness), value(s.min),
                 PercentileCell(metric, "p50"), PercentileCell(metric, "p95"), PercentileCell(metric, "p99"),
                 PercentileCell(metric, "p99_73"), value(s.max)},
                info.is_part ? "numbers screen" : "numbers");
    }
    if (!same.empty()) table.Wide("<div>The same in all flights: " + same + ".</div>", "name same");
    if (!around.empty())
      table.Wide("<div>All around the circle, so without a mean: " + around + ".</div>", "name same");
    if (!undefined.empty()) table.Wide("<div>In no flight: " + undefined + ".</div>", "name same");
  }
  return html + table.Html("statistics");
}

std::string DispersionsTable(const CampaignSummary& summary) {
  if (summary.dispersions.empty())
    return "<p>The campaign disperses nothing: every case is the nominal flight.</p>\n";
  const std::string html =
      "<p>What was drawn is read back from the inputs as each flight applied them. “Agrees” means that mean "
      "and "
      "standard deviation lie within five standard errors of the declared ones. A direction from anywhere "
      "has "
      "no mean.</p>\n";
  HtmlTable table("!Input|Declared|#Expected mean|#drawn|#Expected std|#drawn|#Min|#Max|Check");
  for (const DispersionSummary& one : summary.dispersions) {
    const double std = one.drawn.std;
    const auto text = [&](const std::optional<double>& value) {
      return value ? ScatterText(*value, std) : "–";
    };
    const auto scale = [](const std::optional<double>& value) { return value ? RoundedText(*value) : "–"; };
    table.Row({InputNames(one.key, one.input), HtmlText(one.declared), text(one.expected_mean),
               text(one.drawn.mean), scale(one.expected_std), scale(one.drawn.std), text(one.drawn.min),
               text(one.drawn.max),
               !one.unread.empty() ? "<span class=\"badge fail\">not read</span> " + HtmlText(one.unread)
               : !one.consistent   ? "–"
               : *one.consistent   ? "agrees"
                                   : "<span class=\"badge fail\">differs</span>"});
  }
  return html + table.Html();
}

std::string DispersionsSection(const CampaignSummary& summary) {
  return "<h2 id=\"dispersions\">Dispersions, declared and drawn</h2>\n" + DispersionsTable(summary);
}

std::string NotModelledSection(const Campaign& campaign) {
  const std::optional<StructureBeam>& beam = campaign.vehicle.structure_beam;
  const bool has_turbulence =
      std::any_of(campaign.dispersions.begin(), campaign.dispersions.end(),
                  [](const Dispersion& d) { return d.name.starts_with("turbulence"); });
  std::string html = "<h2 id=\"limits\">What is not modelled</h2>\n<ul>\n";
  html +=
      beam && beam->flown_modes > 0
          ? R"html(<li>The vehicle bends by the modes of its file; they are only as good as that stiffness and damping. There is
no slosh, no torsion, no local mode, and the body's acceleration does not move the nozzles.</li>
)html"
          : R"html(<li>The vehicle is rigid: no bending modes, no slosh. Gain and phase margins against
flexible modes cannot be read from this report.</li>
)html";
  if (!campaign.course.is_controlled)
    html +=
        R"html(<li>Nothing controls the flight. The vehicle leaves its rail at once, without tip-off; fins follow linear theory
or the file's tables, and do not bend. After the apogee the vehicle falls as a point mass that tumbles.</li>
)html";
  else
    html +=
        campaign.guidance.closed_loop
            ? R"html(<li>Guidance knows each motor's shape of thrust exactly, and is told its state with the constant errors that
the campaign declares: no navigation filter, no error that grows.</li>
)html"
            : R"html(<li>Guidance is open loop: the pitch program is flown over time, and nothing steers out errors of speed or
altitude. Thrust, mass flow and drag therefore spread the orbit by tens of kilometres whatever the autopilot
does; injection metrics are reported for that spread and are no measure of the autopilot.</li>
)html";
  if (CutsOffInFlight(campaign.vehicle))
    html +=
        R"html(<li>Engines are cut off at the true inertial velocity: that speeds at injection hardly differ is the
cut-off's doing, and no measure of guidance or autopilot.</li>
)html";
  if (campaign.course.is_controlled)
    html +=
        R"html(<li>The attitude is measured without other errors than the gyro bias and noise that a campaign declares: no
filter, no alignment error.</li>
)html";
  html +=
      R"html(<li>Separation is instantaneous: no contact forces and no re-contact analysis; what disturbs it is the
declared tip-off rate.</li>
<li>Motors burn with constant thrust between two ramps, along a thrust curve, or as their throttle commands, shared out
among the nozzles, without thrust oscillation. The reaction control gives ideal couples.</li>
<li>Aerodynamic coefficients come from one table or build-up for each stack, without plume interaction or
hysteresis; their uncertainty is what the campaign disperses.</li>
)html";
  html +=
      has_turbulence
          ? R"html(<li>Turbulence is a frozen field over altitude, the same all over the vehicle. The)html"
          : R"html(<li>Wind stands still during a flight: a profile and a discrete gust, no continuous turbulence. The)html";
  return html +
         R"html( atmosphere is the US Standard Atmosphere 1976 with the density factor that the campaign declares.</li>
</ul>
)html";
}

std::string ProvenanceSection(const Campaign& campaign, const CampaignSummary& summary) {
  std::string html = "<h2 id=\"provenance\">Provenance</h2>\n";
  HtmlTable table("!|");
  table.Row({"Campaign id", Code(summary.id)});
  table.Row({"Flight id", Code(summary.flight_id) +
                              "<span class=\"definition\">of what decides a case: vehicle, reference, "
                              "autopilot, tables, dispersions, sampling and seed, engine</span>"});
  table.Row({"Engine", Code(summary.engine)});
  if (summary.engine != EngineVersion())
    table.Row({"Report by engine", Code(EngineVersion()) + ", which flew nothing"});
  table.Row({"Sampling", fmt::format("{}, {} cases, seed {}", SamplingMethodTitle(summary.sampling),
                                     summary.cases, summary.seed)});
  table.Row(
      {"Vehicle", fmt::format("{}, {} stages", HtmlText(summary.vehicle), campaign.vehicle.stages.size())});
  const Orbit& orbit = summary.reference_orbit;
  if (!campaign.course.is_controlled)
    table.Row({"Control", fmt::format("none; steps of {} s", ReadableText(campaign.course.step_s))});
  else
    table.Row(
        {"Reference",
         fmt::format("{}: {} km, {} m/s, {}° flight path angle, {}° inclination; found by engine {}",
                     HtmlText(summary.reference), ReadableText(orbit.altitude_m * 1e-3),
                     ReadableText(orbit.velocity_m_s), ReadableText(orbit.flight_path_angle_rad * kDegPerRad),
                     ReadableText(orbit.inclination_rad * kDegPerRad), HtmlText(campaign.reference.engine))});
  if (campaign.course.is_controlled)
    table.Row({"Autopilot", fmt::format("{}, tick {} s", HtmlText(summary.autopilot),
                                        ReadableText(campaign.autopilot.tick_s))});
  if (summary.python_law)
    table.Row({"Control law", fmt::format("written in Python: {}, SHA-256 {} of what it does",
                                          Code(summary.python_law->name), Code(summary.python_law->sha256))});
  else if (const auto& plugin = campaign.autopilot.plugin)
    table.Row({"Control law", fmt::format("shared object {} {}, SHA-256 {}", HtmlText(plugin->name),
                                          HtmlText(plugin->version), Code(plugin->sha256))});
  html += table.Html();
  if (summary.python_law)
    return html +
           "<p>This folder does not hold the law, so it does not hold all that it takes to fly the campaign "
           "again.</p>\n";
  return html +
         "<p>To fly the campaign again, in this folder; <code>campaign.yaml</code> holds everything that it "
         "needs, and "
         "<code>cases.csv</code> comes out the same byte for byte:</p>\n"
         "<code class=\"command\">dispersa run campaign.yaml</code>\n";
}

}  // namespace dispersa
