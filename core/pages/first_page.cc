// The head of report.html, which a review board reads and signs: what stands, of which requirement, by how
// much, and on what it rests. It depends on who flew the campaign, when, and on what was flown before.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/pages/html_parts.h"
#include "core/pages/report_sections.h"
#include "core/results/metric_catalogue.h"
#include "core/results/sampling_text.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

std::int64_t CountOf(const Standing& standing, const char* verdict) {
  return std::count_if(standing.requirements.begin(), standing.requirements.end(),
                       [&](const Standing::Requirement& one) { return one.verdict == verdict; });
}

/// What the requirements come to together, in one sentence.
std::string HeadSentence(const CampaignSummary& summary) {
  const Standing& standing = summary.standing;
  const std::size_t all = standing.requirements.size();
  const std::int64_t met = CountOf(standing, "pass");
  switch (standing.verdict) {
    case StandingVerdict::kIncomplete:
      if (summary.flown == summary.cases)
        return fmt::format("{} of the design's {} points were flown.", summary.flown, summary.design_points);
      return fmt::format("{} of {} cases have a result{}.", summary.flown, summary.cases,
                         summary.quarantined.empty()
                             ? "; the campaign can be resumed"
                             : fmt::format("; {} are quarantined", summary.quarantined.size()));
    case StandingVerdict::kFail:
      return fmt::format("{} of {} requirements {} not met.", CountOf(standing, "fail"), all,
                         CountOf(standing, "fail") == 1 ? "is" : "are");
    case StandingVerdict::kNotEvidence:
      return "No requirement failed, but these flights are no evidence that all are met: the reasons stand "
             "below.";
    case StandingVerdict::kInconclusive:
      return fmt::format("{} of {} requirements cannot be decided with {} flights; none has failed.",
                         CountOf(standing, "inconclusive"), all, summary.flown);
    case StandingVerdict::kNothingJudged:
      return all == 0
                 ? "The campaign states no requirement: nothing is judged."
                 : "The campaign states no requirement: nothing is judged. No flight exceeded a limit of "
                   "the vehicle.";
    case StandingVerdict::kPass: {
      const bool open = static_cast<std::size_t>(met) < all;
      // All that may be open in a pass: the limits that nobody asked for, kept by too few flights to say
      // more.
      return (met == 1 ? std::string("The one requirement is met")
                       : fmt::format("All {} requirements are met", met)) +
             (open ? ", and no flight exceeded a limit of the vehicle." : ".");
    }
  }
  return "";
}

std::string Facts(const CampaignSummary& summary) {
  const RunInfo& run = summary.standing.run;
  const std::string file = run.vehicle_file.empty() ? "" : " (" + HtmlText(run.vehicle_file) + ")";
  const std::string line = fmt::format(
      "{} · vehicle {}{} · reference {} · autopilot {} · {}, {} cases, seed {}", HtmlText(summary.name),
      HtmlText(summary.vehicle), file, HtmlText(summary.reference), HtmlText(summary.autopilot),
      SamplingMethodTitle(summary.sampling), summary.cases, summary.seed);
  std::string second;
  const auto add = [&](const std::string& text) { second += (second.empty() ? "" : " · ") + text; };
  if (!run.started_utc.empty()) add("flown " + HtmlText(run.started_utc.substr(0, 16)) + " UTC");
  if (run.flying_s > 0.0) add(fmt::format("in {} s", FixedText(run.flying_s, run.flying_s < 10.0 ? 1 : 0)));
  if (!run.user.empty())
    add("by " + HtmlText(run.user) + (run.host.empty() ? "" : " on " + HtmlText(run.host)));
  add("engine " + Code(summary.engine.substr(0, 12)));
  add("campaign id " + Code(summary.id.substr(0, 12)));
  return "<p class=\"soft\">" + line + "<br>" + second + "</p>\n";
}

int Rank(const std::string& verdict) {
  return verdict == "fail" ? 0 : verdict == "not_evidence" ? 1 : verdict == "inconclusive" ? 2 : 3;
}

std::string LimitCell(const RequirementSummary& requirement, const MetricInfo& info) {
  std::string cell = requirement.id.empty() ? "" : Code(requirement.id) + " ";
  cell += "<b>" + HtmlText(info.title) + "</b> " + HtmlText(LimitWords(requirement, info.unit));
  cell += requirement.every_case ? " in every case"
                                 : fmt::format(" for {} of flights", PercentText(requirement.probability));
  std::string words = requirement.by_default ? "required because the vehicle gives limits" : "";
  for (const auto& [name, text] : {std::pair<const char*, const std::string&>{"why", requirement.rationale},
                                   {"source", requirement.source}}) {
    if (!text.empty()) words += fmt::format("{}{}: {}", words.empty() ? "" : "; ", name, HtmlText(text));
  }
  if (!words.empty()) cell += "<span class=\"definition\">" + words + "</span>";
  return cell;
}

std::string MarginCell(const RequirementSummary& requirement, const MetricInfo& info) {
  if (!requirement.bound) return "–";
  return fmt::format("{}<span class=\"definition\">{} keep to {}</span>",
                     WithUnit(*requirement.margin, info.unit), PercentText(requirement.probability),
                     WithUnit(*requirement.bound, info.unit));
}

std::string RequirementsTable(const CampaignSummary& summary) {
  if (summary.requirements.empty()) return "";
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < summary.requirements.size(); ++i) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return Rank(summary.standing.requirements[a].verdict) < Rank(summary.standing.requirements[b].verdict);
  });
  HtmlTable table({{"Verdict"}, {"Requirement"}, {"Result"}, {"Margin", true}, {"Attained risk", true}});
  for (const std::size_t i : order) {
    const RequirementSummary& requirement = summary.requirements[i];
    const Standing::Requirement& standing = summary.standing.requirements[i];
    const MetricInfo info = DescribeMetric(requirement.metric);
    std::string result = HtmlText(requirement.sentence);
    if (!standing.reason.empty()) result = "<b>" + HtmlText(standing.reason) + "</b> " + result;
    table.Row({VerdictBadge(standing.post_hoc && standing.verdict == "not_evidence" ? "post hoc"
                                                                                    : standing.verdict),
               LimitCell(requirement, info), result, MarginCell(requirement, info),
               requirement.attained_risk ? PercentText(*requirement.attained_risk) : "–"});
  }
  return table.Html("first");
}

std::string List(const char* list_class, const std::vector<std::string>& items) {
  if (items.empty()) return "";
  std::string html = fmt::format("<ul class=\"{}\">", list_class);
  for (const std::string& item : items) html += "<li>" + HtmlText(item) + "</li>";
  return html + "</ul>\n";
}

}  // namespace

std::string FirstPage(const Campaign& campaign, const CampaignSummary& summary) {
  const Standing& standing = summary.standing;
  const bool certain_fail = standing.verdict == StandingVerdict::kIncomplete && CountOf(standing, "fail") > 0;
  std::string html =
      fmt::format("<!-- run:begin -->\n<header>\n<h1>Dispersion campaign {}</h1>\n", HtmlText(summary.name));
  html += Facts(summary);
  html += fmt::format(
      "<div class=\"headline{}\">{}{}{}{}<p>{}</p></div>\n", summary.beyond_limits == 0 ? "" : " exceeded",
      VerdictBadge(StandingBadge(standing)),
      IsIndependent(summary.sampling) ? "" : "<span class=\"badge design\">design study</span>",
      summary.beyond_limits == 0 ? "" : "<span class=\"badge fail\">structural limit exceeded</span>",
      certain_fail ? VerdictBadge("fail") : "", HeadSentence(summary));
  std::vector<std::string> notes = StandingNotes(standing, summary);
  for (std::string& warning : Warnings(summary)) notes.push_back(std::move(warning));
  html += List("warnings", notes);
  html += RequirementsTable(summary);
  if (!campaign.assumptions.empty())
    html += "<p class=\"assumed\"><b>Assumptions of the campaign</b></p>\n" +
            List("assumptions", campaign.assumptions);
  if (IsIndependent(summary.sampling) && !summary.requirements.empty())
    html += "<p class=\"soft\">Attempts made in other folders are not known here.</p>\n";
  return html + "</header>\n<!-- run:end -->\n";
}

}  // namespace dispersa
