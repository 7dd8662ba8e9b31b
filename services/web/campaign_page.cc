#include <fmt/format.h>

#include "core/pages/html_parts.h"
#include "core/results/text.h"
#include "services/web/flying_section.h"
#include "services/web/pages.h"
#include "services/web/web_parts.h"

namespace dispersa {
namespace {

constexpr std::size_t kMostAttempts = 20;

std::string Minutes(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

std::string Bounds(const RequirementOutcome& one) {
  if (!one.success_lower || !one.success_upper) return "";
  return PercentText(*one.success_lower) + " to " + PercentText(*one.success_upper);
}

std::string RequirementTable(const CampaignRow& row) {
  if (row.requirements.empty()) return "";
  std::vector<HtmlTable::Column> columns = {
      {"Requirement"}, {row.has_ended ? "Verdict" : "So far"}, {"Failures", true}};
  if (row.has_ended) columns.push_back({"Flights that meet it"});
  columns.push_back({""});
  HtmlTable table(columns);
  for (const RequirementOutcome& one : row.requirements) {
    const std::string verdict = row.has_ended ? VerdictBadge(HtmlText(one.verdict)) : HtmlText(one.verdict);
    std::vector<std::string> cells = {HtmlText(one.words), verdict,
                                      fmt::format("{} of {}", one.failures, one.n)};
    if (row.has_ended) cells.push_back(Bounds(one));
    cells.push_back(fmt::format("<a href=\"/trend?metric={}\">trend</a>", UrlText(one.metric)));
    table.Row(cells);
  }
  return "<h2>Requirements</h2>\n" + table.Html();
}

/// Other campaigns of the same design: whoever sees a pass wants to know how often it was tried.
std::string OthersOfDesign(const CampaignIndex& index, const CampaignRow& row) {
  if (row.design_id.empty()) return "";
  HtmlTable table("Campaign|Verdict|Owner|#Cases|Launched, UTC|");
  std::size_t found = 0;
  for (const CampaignIndex::Row& other : index.rows()) {
    if (other->design_id != row.design_id || other->id == row.id || ++found > kMostAttempts) continue;
    table.Row({NameOf(*other), StandingOfRow(*other), HtmlText(other->owner), std::to_string(other->done),
               TimeText(other->launched_unix_s),
               fmt::format("<a href=\"/difference?id={}&amp;id={}\">difference</a>", other->id, row.id)});
  }
  if (found == 0) return "";
  return fmt::format(
             "<h2>Other campaigns of this design</h2>\n<p class=\"soft\">{} here; the report counts all "
             "attempts.</p>\n",
             found) +
         table.Html();
}

}  // namespace

std::string CampaignPart(const CampaignIndex& index, const CampaignRow& row, bool has_report) {
  std::string html =
      fmt::format("<div class=\"headline\">{} <p>{}{}</p></div>\n", StandingOfRow(row),
                  row.owner.empty() ? "" : "of <b>" + HtmlText(row.owner) + "</b> ", LabelsOf(row));
  if (!row.problem.empty()) html += "<ul class=\"warnings\"><li>" + HtmlText(row.problem) + "</li></ul>\n";
  if (!row.has_ended)
    html +=
        fmt::format("<progress class=\"wide\" max=\"{}\" value=\"{}\"></progress>\n", row.cases, row.done);
  html += "<div class=\"tiles\">" + Tile(fmt::format("{} of {}", row.done, row.cases), "cases with a result");
  if (!row.has_ended) {
    html += Tile(fmt::format("{:.1f}", row.rate_per_s), "results per second") +
            Tile(row.eta_s ? Minutes(*row.eta_s) : "–", "left");
  } else {
    html += Tile(std::to_string(row.code), "exit code") + Tile(TimeText(row.ended_unix_s), "ended, UTC");
  }
  if (row.quarantined > 0) html += Tile(std::to_string(row.quarantined), "cases quarantined");
  if (row.attempts > 0) html += Tile(std::to_string(row.attempts), "attempts at this design");
  html += Tile(TimeText(row.launched_unix_s), "launched, UTC") + Tile(BytesText(row.bytes), "on the disk") +
          "</div>\n";
  if (has_report)
    html += fmt::format("<p class=\"act\"><a class=\"button\" href=\"{}/report\">Open the report</a></p>\n",
                        LinkTo(row));
  html += RequirementTable(row);
  if (!row.has_ended) html += FlyingSection(index, row);
  html += OthersOfDesign(index, row);
  html += fmt::format(
      "<h2>Identity</h2>\n<p>Campaign {}</p>\n{}<p class=\"soft\">This address is permanent while the "
      "coordinator "
      "keeps the campaign. <code>dispersa fetch {} --out DIR</code> copies its results.</p>\n",
      Code(row.id), row.engine.empty() ? "" : "<p>Engine " + Code(row.engine) + "</p>\n",
      row.id.substr(0, 12));
  return html;
}

std::string CampaignPage(const CampaignIndex& index, const CampaignRow& row, bool has_report) {
  const std::string head =
      row.has_ended ? "" : "<noscript><meta http-equiv=\"refresh\" content=\"5\"></noscript>\n";
  return Frame(row.name,
               fmt::format("<h1>{}</h1>\n<div id=\"part\"{}>\n{}</div>\n", HtmlText(row.name),
                           row.has_ended ? "" : " data-live", CampaignPart(index, row, has_report)),
               "", head);
}

}  // namespace dispersa
