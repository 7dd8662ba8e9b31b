#include "core/paper/paper_page.h"

#include <fmt/format.h>

#include "core/flight/engine_version.h"
#include "core/pages/embedded.h"
#include "core/pages/heat_map.h"
#include "core/pages/html_parts.h"
#include "core/paper/paper_parts.h"
#include "core/results/sampling_text.h"

namespace dispersa {
namespace {

constexpr char kStyle[] = R"css(
table.claims td, table.claims th { padding: 7px 8px; } table.claims tbody th { width: 9%; font-weight: 650; }
table.claims td:nth-child(2) { width: 18%; } table.claims td:nth-child(3) { width: 27%; } table.claims td:nth-child(4) { width: 29%; }
svg .line-4 { stroke: var(--limit); stroke-width: 1.3; } svg .line-5 { stroke: var(--soft); stroke-width: 1.3; }
@media screen and (max-width: 960px) { table.claims, table.claims tbody, table.claims tr { display: block; }
  table.claims td, table.claims tbody th { display: block; width: auto !important; border: 0; padding: 2px 0; }
  table.claims thead { display: none; } table.claims tr { padding: 8px 0; border-bottom: 1px solid var(--rule); }
  table.claims td::before { color: var(--soft); } table.claims td:nth-child(2)::before { content: "The paper: "; }
  table.claims td:nth-child(3)::before { content: "Found: "; } table.claims td:nth-child(4):not(:empty)::before { content: "Difference: "; }
  table.claims td:nth-child(6)::before { content: "Shown by: "; } }
@media print { details > * { display: block; } header { break-after: auto; } }
)css";

std::string VerdictHtml(PaperVerdict verdict) {
  switch (verdict) {
    case PaperVerdict::kReproduced:
      return "<span class=\"badge pass\">✓ reproduced</span>";
    case PaperVerdict::kInPart:
      return "<span class=\"badge inconclusive\">◇ in part</span>";
    case PaperVerdict::kNotReproduced:
      return "<span class=\"badge fail\">✗ not reproduced</span>";
    case PaperVerdict::kNoClaim:
      break;
  }
  return "<span class=\"badge nothing-judged\">⊘ no claim</span>";
}

std::string Header(const PaperStudy& study) {
  const CaseColumns& cases = study.at("table3").cases;
  std::size_t flights = 0;
  for (const auto& [name, flown] : study.campaigns) flights += flown.cases.rows();
  return "<header>\n<h1>Adaptive fuzzy attitude control of a launch vehicle: the paper reproduced</h1>\n"
         "<p class=\"soft\">U. Ansari, S. Alam, S. M. un Nabi Jafri, “Trajectory optimization and Adaptive "
         "Fuzzy based Launch Vehicle Attitude Control”. Every table and figure from data. Figs. 1 and 4 are "
         "drawings without data.</p>\n<div class=\"tiles\">" +
         Tile(fmt::format("{}", flights), "flights in the reports below") +
         Tile(fmt::format("{} / {}", LostCount(cases), cases.rows()), "lost with Table 3") +
         Tile(Degrees(Digested(cases, kRms).p50), "median RMS pitch error, Table 3") +
         Tile(Degrees(Digested(cases, kPeak).max), "largest peak pitch error, Table 3") +
         Tile(fmt::format("{:.2g} m", std::fabs(study.optimization.errors.altitude_m)),
              "miss of the target height") +
         "</div>\n</header>\n<p class=\"advice\"><b>The vehicle is rigid.</b> It has no bending, no slosh "
         "and "
         "no inertia of the nozzles. A launcher of 27 m has bending modes that a real autopilot must filter. "
         "Tracking, limit cycles and margins are those of the rigid body only. Guidance is open loop: the "
         "pitch profile is tracked, the orbit is not corrected.</p>\n";
}

std::string ClaimsTable(const std::vector<PaperPart>& parts) {
  HtmlTable table("!Part|The paper|Found|Difference|Verdict|Shown by");
  for (const PaperPart& part : parts) {
    const std::string name = part.title.substr(0, part.title.find(':'));
    const std::string below = "<a href=\"#" + part.id + "\">";
    table.Row({part.shown.empty() ? name : below + name + "</a>", part.claim, part.found, part.difference,
               VerdictHtml(part.verdict), part.shown_by.empty() ? below + "below</a>" : part.shown_by});
  }
  return "<h2 id=\"claims\">What the paper claims, and what was found</h2>\n" + table.Html("claims") +
         "<p class=\"soft\">Reproduced: the flights show the claim. In part: they show a part of it. No "
         "claim: "
         "the paper states nothing that flights could show.</p>\n";
}

std::string CampaignSection(const PaperStudy& study) {
  HtmlTable table("!Report|Shows|Sampling|#flights here|#in the file|All of them");
  for (const PaperCampaign& campaign : PaperCampaigns()) {
    const PaperFlights& flown = study.at(campaign.name);
    table.Row({ReportLink(campaign.name), campaign.shows,
               fmt::format("{}, seed {}", SamplingMethodTitle(flown.campaign.sampling.method),
                           flown.campaign.sampling.seed),
               fmt::format("{}", flown.cases.rows()), fmt::format("{}", flown.file_cases),
               "<code class=\"copy\">dispersa run campaigns/" + campaign.name + ".yaml</code>"});
  }
  return "<h2 id=\"campaigns\">The campaigns</h2>\n<p>Each has a result folder beside this page, with the "
         "first cases of its file. A case has the same bits here, in <code>dispersa run</code> on any number "
         "of workers, and in <code>dispersa replay DIR --case N --history FILE</code>, which writes its time "
         "history. <code>cases.csv</code> has the inputs and metrics of every case, "
         "<code>histories/</code> the bands and the worst cases.</p>\n" +
         table.Html() + "<p class=\"soft\">Engine " + Code(std::string(EngineVersion())) + ".</p>\n";
}

}  // namespace

std::string Degrees(double value) {
  if (!std::isfinite(value)) return "–";
  const double magnitude = std::fabs(value);
  return fmt::format("{:.{}f}°", value, magnitude < 0.1 ? 4 : magnitude < 10.0 ? 3 : 1);
}

MetricDigest Digested(const CaseColumns& cases, const std::string& metric) {
  const std::vector<double> sorted = SortedFinite(CompletedValues(cases, metric));
  return {Quantile(sorted, 0.5), Quantile(sorted, 1.0)};
}

void DigestRow(HtmlTable& table, Cells before, const CaseColumns& cases, const Cells& after) {
  const MetricDigest rms = Digested(cases, kRms), peak = Digested(cases, kPeak);
  for (const std::string& cell :
       {fmt::format("{}", cases.rows()), fmt::format("{}", LostCount(cases)), Degrees(rms.p50),
        Degrees(rms.max), Degrees(peak.p50), Degrees(peak.max), Degrees(Digested(cases, kCycle).max)})
    before.push_back(cell);
  before.insert(before.end(), after.begin(), after.end());
  table.Row(before);
}

std::string PaperPage(const PaperStudy& study) {
  std::vector<PaperPart> parts = TrajectoryParts(study);
  parts.push_back(PnPart(study));
  for (const auto& more : {FlownParts(study), LawParts(study)})
    parts.insert(parts.end(), more.begin(), more.end());
  std::string page =
      PageHead("The paper reproduced", "The paper reproduced · engine " + std::string(EngineVersion()),
               std::string(HeatMapStyle()) + kStyle) +
      "<main>\n" + Header(study) + ClaimsTable(parts);
  for (const PaperPart& part : parts)
    if (!part.shown.empty()) page += "<h2 id=\"" + part.id + "\">" + part.title + "</h2>\n" + part.shown;
  page += CampaignSection(study);
  return page + "</main>\n<script>" + std::string(ChartScript()) + "</script>\n</body>\n</html>\n";
}

}  // namespace dispersa
