#include "core/pages/report_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/analysis/footprints.h"
#include "core/pages/case_data.h"
#include "core/pages/distribution_charts.h"
#include "core/pages/embedded.h"
#include "core/pages/flight_charts.h"
#include "core/pages/glossary.h"
#include "core/pages/ground_map.h"
#include "core/pages/html_parts.h"
#include "core/pages/report_sections.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr char kNavigation[] =
    "<nav><a href=\"#requirements\">Requirements</a><a href=\"#outcomes\">Outcomes</a><a "
    "href=\"#events\">Events</a><a href=\"#envelope\">Envelope</a><a href=\"#map\">Map</a>"
    "<a href=\"#distributions\">Distributions</a><a href=\"#causes\">Causes</a><a href=\"#worst\">Worst "
    "cases</a><a "
    "href=\"#nominal\">Nominal flight</a>"
    "<a href=\"#statistics\">Statistics</a><a href=\"#dispersions\">Dispersions</a><a href=\"#limits\">Not "
    "modelled</a><a href=\"#credibility\">Credibility</a>"
    "<a href=\"#provenance\">Provenance</a><a href=\"#glossary\">Glossary</a></nav>\n"
    "<p class=\"paper soft\">In print the page leaves out: histograms, curves of the nominal flight, all but "
    "one "
    "chart of worst cases, and the statistics of single stages. The file itself and "
    "<code>summary.json</code> "
    "have them.</p>\n";

/// Of the first element, so that links lead to it.
std::string WithId(std::string html, const std::string& id) {
  html.insert(html.find_first_of(" >"), fmt::format(" id=\"{}\"", id));
  return html;
}

std::string MapSection(const Campaign& campaign, const CampaignSummary& summary,
                       const FlightHistories& histories) {
  std::string html = "<h2 id=\"map\">Map</h2>\n";
  const std::vector<Footprint> footprints = GatherFootprints(histories.impacts);
  const std::string figure = MapFigure(campaign, histories, footprints);
  if (figure.empty()) return html + "<p>A map needs time histories.</p>\n";
  if (!footprints.empty())
    html += fmt::format(
        "<p>What falls from the first {} flights of the envelope is followed to the ground as a tumbling "
        "body. "
        "<code>dispersa export --format geojson</code> does so for all {} flights.</p>\n",
        std::min(histories.bands.flights, kMostFallen), summary.flown);
  return html + figure;
}

/// Of each cut-off, where a command ends a burn.
std::string PropellantFigures(const CampaignSummary& summary, const CaseColumns& cases) {
  std::string figures;
  for (const MetricSummary& metric : summary.metrics)
    if (metric.name.starts_with("propellant_left_stage") && metric.statistics.n > 0)
      figures += DistributionFigures(metric.name, summary, cases);
  return figures.empty()
             ? ""
             : "<h3>Propellant left at cut-off</h3>\n<div class=\"figures\">\n" + figures + "</div>\n";
}

}  // namespace

std::string ReportPage(const Campaign& campaign, const CampaignSummary& summary, const CaseColumns& cases,
                       const FlightHistories& histories) {
  std::string page = PageHead(
      summary.name, fmt::format("Dispersion campaign {} · {}", summary.name, summary.id.substr(0, 16)));
  page += "<main>\n<!-- run:begin -->\n" + FirstPage(campaign, summary) +
          GlanceSection(campaign, summary, histories) + "<!-- run:end -->\n";
  page += kNavigation;
  page += RequirementsSection(summary);
  page += OutcomesSection(summary);
  page += EventsSection(campaign, summary);

  page += "<h2 id=\"envelope\">Envelope of the dispersed flights</h2>\n";
  const bool flown_again = histories.nominal_history.rows() > 0;
  if (summary.flown == 0) {
    page += "<p>No case has a result.</p>\n";
  } else if (!flown_again || histories.bands.flights == 0) {
    page += summary.python_law ? "<p>This report was made without time histories.</p>\n"
                               : "<p>This report was made without time histories: <code>dispersa report "
                                 ".</code> adds them.</p>\n";
  } else {
    const FlightBands& bands = histories.bands;
    const std::string sample =
        bands.flights == summary.flown
            ? fmt::format("all {} flown cases", summary.flown)
            : fmt::format("the first {} of {} flown cases", bands.flights, summary.flown);
    const std::string extremes = bands.extreme_flights == 0
                                     ? std::string(" Minimum and maximum are over the same flights.")
                                     : fmt::format(
                                           " Minimum and maximum are over these and {} more, which are the "
                                           "least or the largest of all "
                                           "in some metric: no case’s peak of a stage lies outside, but at "
                                           "other times a case that was "
                                           "not flown again may.",
                                           bands.extreme_flights);
    page += fmt::format(
        "<p>Pointwise percentiles over {}, flown again and sampled every {} s; a lost flight counts until it "
        "is "
        "lost.{} S1 to S{} mark ignitions. Peaks between the samples are in the metrics, not here. Attitude "
        "errors count while a flight has thrust. Numbers: "
        "<code>histories/bands.csv.gz</code>.</p>\n",
        sample, ReadableText(bands.step_s), extremes, campaign.vehicle.stages.size());
    if (bands.flights < 371) page += "<p>Curves of 0.27 % and 99.73 % need 371 flights or more.</p>\n";
    page += EnvelopeFigures(histories, summary, campaign.reference.program.t2_s);
  }
  page += MapSection(campaign, summary, histories);

  page +=
      "<h2 id=\"distributions\">Distribution of key metrics</h2>\n<p>Each curve of shares has its exact "
      "confidence of 95 % at each value taken alone (Clopper and Pearson). Of a requirement the curve should "
      "fall below the allowed share before the limit; the " +
      Term("bound") + " is the value that decides.</p>\n<div class=\"figures\">\n";
  for (const WorstCases& worst : summary.worst_cases)
    page += WithId(DistributionFigures(worst.metric, summary, cases), DistributionId(worst.metric));
  page += "</div>\n";
  if (summary.flown > 0 && campaign.course.ends == FlightEnd::kImpact)
    page +=
        "<h3>Impact dispersion</h3>\n<div class=\"figures\">\n" + ImpactFigures(summary, cases) + "</div>\n";
  if (summary.flown > 0 && campaign.course.is_controlled) {
    page += "<h3>Spread of the orbit</h3>\n<p>";
    page +=
        campaign.guidance.closed_loop
            ? "Guidance is closed loop: it steers the last stages by a navigated state to the orbit."
            : "Guidance is open loop: the autopilot follows the pitch program, and nothing corrects what "
              "dispersed thrust, flow and drag do to speed and altitude. No requirement should rest on it.";
    page += "</p>\n<div class=\"figures trio\">\n" + InjectionFigures(summary, cases) + "</div>\n";
    if (summary.injection) page += InjectionSection(*summary.injection);
    page += PropellantFigures(summary, cases);
  }

  page += CausesSection(summary);
  page += WorstCasesSection(summary, histories);
  if (flown_again && histories.bands.flights > 0) page += WorstFigures(histories, summary);
  page += "<div class=\"screen\">\n<h2 id=\"nominal\">Nominal flight</h2>\n<p>The flight without dispersions";
  page += campaign.course.is_controlled ? ", through the same closed loop." : ".";
  page +=
      " It is not one of the cases. The charts of the envelope have more of it. Numbers: "
      "<code>histories/nominal.csv.gz</code>.";
  if (campaign.course.ends != FlightEnd::kInjection)
    page +=
        " The curves end where the flight goes on as a point mass: at the end of the last burn above the "
        "air, or at "
        "the apogee.";
  page += "</p>\n";
  page += flown_again ? NominalFigures(histories.nominal_history)
                      : "<p>This report was made without time histories.</p>\n";
  page += "</div>\n" + StatisticsSection(summary);
  page += DispersionsSection(summary);
  page += NotModelledSection(campaign);
  page += CredibilitySection(summary);
  page += ProvenanceSection(campaign, summary);
  // The first page differs from run to run, and so may its words: those that it can use are always explained.
  const std::size_t after_first_page = page.find(kNavigation);
  page += GlossarySection(std::string_view(page).substr(after_first_page),
                          {"attained risk", "attempt", "margin", "not evidence", "post hoc"});
  page += "</main>\n<script type=\"application/json\" id=\"cases\">" + CaseData(summary, cases) +
          "</script>\n<script>";
  page += ChartScript();
  page += ReportScript();
  return page + "</script>\n</body>\n</html>\n";
}

}  // namespace dispersa
