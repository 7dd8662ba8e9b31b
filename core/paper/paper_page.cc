#include "core/paper/paper_page.h"

#include <fmt/format.h>

#include "core/flight/engine_version.h"
#include "core/pages/histories.h"
#include "core/pages/html_parts.h"
#include "core/pages/trajectory_figures.h"
#include "core/paper/heat_map.h"
#include "core/paper/paper_sections.h"
#include "core/results/file_system.h"
#include "core/results/output_file.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr char kStyle[] = R"css(
dl.findings { display: grid; grid-template-columns: max-content 1fr; gap: 4px 14px; margin: 10px 0 18px; padding: 10px 14px;
  background: var(--panel); border-left: 3px solid var(--blue); border-radius: 4px; font-size: 14px; }
dl.findings dt { font-weight: 650; color: var(--soft); } dl.findings dd { margin: 0; max-width: 92ch; }
.source { font-size: 12.5px; } .warning { border-left: 4px solid var(--open); }
svg .line-4 { stroke: var(--limit); stroke-width: 1.3; } svg .line-5 { stroke: var(--soft); stroke-width: 1.3; }
svg .line-0.thin { stroke-width: 0.8; opacity: 0.75; } details summary { cursor: pointer; }
q { font-style: italic; }
@media print { details > * { display: block; } dl.findings { break-inside: avoid; } }
)css";

constexpr char kNavigation[] =
    "<nav><a href=\"#table1\">Table 1</a><a href=\"#table2\">Table 2</a><a href=\"#fig2\">Fig. 2</a><a "
    "href=\"#fig3\">Fig. "
    "3</a><a href=\"#table3\">Table 3</a><a href=\"#fig5\">Fig. 5</a><a href=\"#fig6\">Figs. 6, 7</a><a "
    "href=\"#fig8\">Figs. 8, 9</a><a href=\"#fig10\">Fig. 10</a><a href=\"#baselines\">Baselines</a><a "
    "href=\"#margins\">Margins</a><a "
    "href=\"#lyapunov\">V</a><a href=\"#completions\">Completions</a><a "
    "href=\"#campaigns\">Campaigns</a></nav>\n";

constexpr char kLimits[] =
    "<div class=\"headline warning\"><p><b>The vehicle is rigid.</b> No bending, no slosh, no inertia of the "
    "nozzles: a launcher "
    "of 27 m has bending modes that a real autopilot must filter, and tracking, limit cycles and margins on "
    "this page are those "
    "of the rigid body only. Guidance is open loop: the pitch profile is tracked, the orbit is not "
    "corrected.</p></div>\n";

std::string Tile(const std::string& value, const std::string& label) {
  return fmt::format("<div class=\"tile\"><b>{}</b><span>{}</span></div>", value, label);
}

std::string Header(const PaperStudy& study) {
  const CaseColumns& cases = study.at("table3").flights.cases;
  const MetricDigest rms = Digested(cases, "pitch_error_rms_deg");
  const MetricDigest peak = Digested(cases, "pitch_error_peak_deg");
  std::size_t flights = 1;
  for (const auto& [name, flown] : study.campaigns) flights += flown.flights.cases.rows();
  std::string html =
      "<header>\n<h1>Adaptive fuzzy attitude control of a launch vehicle: the paper reproduced</h1>\n<p "
      "class=\"soft\">U. "
      "Ansari, S. Alam, S. M. un Nabi Jafri, “Trajectory optimization and Adaptive Fuzzy based Launch "
      "Vehicle Attitude "
      "Control”. Every table and figure from data; Figs. 1 and 4 are drawings without data.</p>\n";
  html += "<div class=\"tiles\">" + Tile(fmt::format("{}", flights), "flights on this page") +
          Tile(fmt::format("{} / {}", rms.lost, rms.n), "lost with Table 3") +
          Tile(Degrees(rms.p50), "median RMS pitch error, Table 3") +
          Tile(Degrees(peak.max), "largest peak pitch error, Table 3") +
          Tile(fmt::format("{:.2g} m", std::fabs(study.optimization.errors.altitude_m)),
               "miss of the target height") +
          "</div>\n</header>\n";
  return html + PaperHeadline(study) + kLimits;
}

std::string CampaignSection(const PaperStudy& study) {
  HtmlTable table(
      {{"Campaign"}, {"Shows"}, {"flights here", true}, {"in the file", true}, {"Command"}, {"Id"}});
  for (const PaperCampaign& campaign : PaperCampaigns()) {
    const auto found = study.campaigns.find(campaign.name);
    const bool flown = found != study.campaigns.end();
    table.Row({"<code>" + campaign.name + "</code>", campaign.figure,
               flown ? fmt::format("{}", found->second.flights.cases.rows()) : "1",
               flown ? fmt::format("{}", found->second.campaign.sampling.cases) : "1",
               "<code class=\"copy\">dispersa run campaigns/" + campaign.name + ".yaml</code>",
               flown ? "<code>" + found->second.campaign.id.substr(0, 8) + "</code>" : ""});
  }
  return "<h2 id=\"campaigns\">Each figure by its own campaign</h2>\n<p>The page flies the first cases of "
         "these files; a case "
         "has the same bits here, in <code>dispersa run</code> on any number of workers, and in "
         "<code>dispersa replay</code>. "
         "Figs. 2 and 3 and Table 2: <code>dispersa optimize campaigns/slv4_500km.yaml</code>. Two result "
         "folders on the same "
         "cases: <code>dispersa compare DIR_A DIR_B</code>. The data of the figures are in "
         "<code>data/</code> beside this "
         "page.</p>\n" +
         table.Html() + "<p class=\"soft\">Engine <code>" + EngineVersion() + "</code>.</p>\n";
}

/// Cases with their inputs and metrics, as cases.csv has them.
std::string CasesData(const Campaign& campaign, const CaseColumns& cases) {
  std::string csv = "case_index,outcome";
  const std::vector<int> inputs = DispersedInputs(campaign);
  for (const int i : inputs) csv += ",input_" + InputColumns()[static_cast<std::size_t>(i)].name;
  const std::vector<std::size_t> metrics = MeasuredMetrics(campaign);
  for (const std::size_t i : metrics) csv += ",metric_" + MetricNames()[i];
  csv += "\n";
  for (std::size_t row = 0; row < cases.rows(); ++row) {
    csv += fmt::format("{},{}", cases.index[row], OutcomeName(cases.outcome[row]));
    for (const int i : inputs) csv += "," + ShortestText(cases.inputs[static_cast<std::size_t>(i)][row]);
    for (const std::size_t i : metrics) csv += "," + ShortestText(cases.metrics[i][row]);
    csv += "\n";
  }
  return csv;
}

/// The flights' time histories of one column side by side: time_s, case_0, case_1, ...
std::string HistoriesData(const StudyFlights& flights, PaperColumn column) {
  std::string csv = "time_s";
  std::size_t steps = 0;
  for (std::size_t i = 0; i < flights.histories.size(); ++i) {
    csv += fmt::format(",case_{}", i);
    steps = std::max(steps, flights.histories[i][column].size());
  }
  csv += "\n";
  for (std::size_t step = 0; step < steps; ++step) {
    csv += ShortestText(static_cast<double>(step) / 10.0);
    for (const SampledFlight& flight : flights.histories)
      csv += "," + (step < flight[column].size() ? ShortestText(flight[column][step]) : std::string());
    csv += "\n";
  }
  return csv;
}

}  // namespace

std::string PaperPage(const PaperStudy& study) {
  std::string page =
      PageHead("The paper reproduced", "The paper reproduced · engine " + std::string(EngineVersion()),
               std::string(HeatMapStyle()) + kStyle);
  page += Header(study);
  page += kNavigation;
  page += PaperVehicleSection(study);
  page += PaperTrajectorySection(study);
  page += PaperDispersionSection(study);
  page += PaperPnSection(study);
  page += PaperPitchSection(study);
  page += PaperRobustnessSection(study);
  page += PaperComparisonSection(study);
  page += PaperMarginSection(study);
  page += PaperLyapunovSection(study);
  page += PaperCompletionSection(study);
  page += CampaignSection(study);
  return page + "</body>\n</html>\n";
}

void WritePaper(const PaperStudy& study, const std::filesystem::path& directory) {
  const std::filesystem::path data = directory / "data";
  std::error_code error;
  std::filesystem::create_directories(data, error);
  if (error) FailFile(data.string(), "cannot be made", error.value());
  WriteFile(data / "figs2_3_trajectory.csv", AscentCsv(study.optimization.history));
  WriteFile(data / "figs6_9_nominal.csv", HistoryCsv(study.nominal_history, study.nominal_autopilot));
  for (const auto& [name, flown] : study.campaigns) {
    WriteFile(data / (name + "_cases.csv"), CasesData(flown.campaign, flown.flights.cases));
    for (const auto& [column, title] :
         {std::pair{kPitchLaunch, "pitch"}, std::pair{kPitchError, "pitch_error"},
          std::pair{kDeflection, "deflection"}}) {
      WriteFile(data / fmt::format("{}_{}_deg.csv", name, title), HistoriesData(flown.flights, column));
    }
  }
  WriteFile(directory / "paper.html", PaperPage(study));
}

}  // namespace dispersa
