// The head of report.html, which a review board reads and signs: what stands, of which requirement, by how
// much, and on what it rests. It depends on who flew the campaign, when, and on what was flown before.
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/flight/engine_version.h"
#include "core/pages/distribution_charts.h"
#include "core/pages/glossary.h"
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
    case StandingVerdict::kFail: {
      const std::int64_t failed = CountOf(standing, "fail");
      if (failed > 0 && all == 1) return "The one requirement is not met.";
      if (failed > 0)
        return fmt::format("{} of {} requirements {} not met.", failed, all, failed == 1 ? "is" : "are");
      const std::string limit = "Flights went beyond a limit of the vehicle. ";
      if (all == 0) return limit + "The campaign states no requirement.";
      const std::int64_t open = CountOf(standing, "inconclusive");
      if (open == 0) return limit + "No requirement failed.";
      return limit + fmt::format("No requirement failed; {} of {} cannot be decided.", open, all);
    }
    case StandingVerdict::kNotEvidence:
      return "No requirement failed, but these flights are no evidence that all are met: the reasons stand "
             "below.";
    case StandingVerdict::kInconclusive:
      return fmt::format("{} of {} requirements cannot be decided with {} flight{}; none has failed.",
                         CountOf(standing, "inconclusive"), all, summary.flown,
                         summary.flown == 1 ? "" : "s");
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

std::string DrawnBy(const std::string& engine) {
  return engine == EngineVersion()
             ? ""
             : ", page by engine " + Code(EngineVersion().substr(0, 12)) + ", which flew nothing";
}

std::string Facts(const CampaignSummary& summary) {
  const RunInfo& run = summary.standing.run;
  const std::string file = run.vehicle_file.empty() ? "" : " (" + HtmlText(run.vehicle_file) + ")";
  std::string line = fmt::format(
      "vehicle {}{} · {} · {}, {} case{}, seed {}", HtmlText(summary.vehicle), file,
      summary.is_controlled
          ? "reference " + HtmlText(summary.reference) + " · autopilot " + HtmlText(summary.autopilot)
          : "without control",
      SamplingMethodTitle(summary.sampling), summary.cases, summary.cases == 1 ? "" : "s", summary.seed);
  if (!run.started_utc.empty()) {
    std::string date = run.started_utc.substr(0, 16);
    std::replace(date.begin(), date.end(), 'T', ' ');
    line += " · flown " + HtmlText(date) + " UTC";
  }
  if (run.flying_s >= 0.05)
    line += fmt::format(" · in {} s", FixedText(run.flying_s, run.flying_s < 10.0 ? 1 : 0));
  if (!run.user.empty())
    line += " · by " + HtmlText(run.user) + (run.host.empty() ? "" : " on " + HtmlText(run.host));
  return "<p class=\"soft what\">" + line + " · engine " + Code(summary.engine.substr(0, 12)) +
         DrawnBy(summary.engine) + " · campaign id " + Code(summary.id.substr(0, 12)) + "</p>\n";
}

int Rank(const std::string& verdict) {
  return verdict == "fail" ? 0 : verdict == "not_evidence" ? 1 : verdict == "inconclusive" ? 2 : 3;
}

/// `notes`: what must be known beside it.
std::string LimitCell(const RequirementSummary& requirement, const MetricInfo& info,
                      const std::vector<std::string>& notes) {
  std::string cell = "<span class=\"line\"><span>";
  if (!requirement.id.empty()) cell += Code(requirement.id) + " ";
  std::string limit = HtmlText(LimitWords(requirement, info.unit));
  // A unit alone on the next line reads as a number without one.
  if (const std::size_t at = limit.rfind(" " + HtmlText(info.unit)); !info.unit.empty() && at < limit.size())
    limit.replace(at, 1, "&nbsp;");
  cell += fmt::format("<b><a href=\"#{}\">{}</a></b> {}", DistributionId(requirement.metric),
                      HtmlText(info.title), limit);
  cell += "</span>";
  // On a wide screen what fits on the line; the section of requirements has all of it.
  std::string words;
  for (const std::string& text : {requirement.source, requirement.rationale})
    if (!text.empty()) words += " · " + HtmlText(text);
  if (!words.empty()) cell += "<span class=\"soft clip\">&nbsp;" + words + "</span>";
  cell += "</span>";
  for (const std::string& note : notes)
    if (!note.empty()) cell += "<span class=\"definition\"><b>" + HtmlText(note) + "</b></span>";
  return cell;
}

/// Of the failures, those that broke no limit.
std::string FailuresCell(const RequirementSummary& requirement) {
  std::string cell = fmt::format("{} of {}", requirement.failures, requirement.n);
  for (const auto& [count, word] :
       {std::pair(requirement.lost_flights, "lost"), std::pair(requirement.not_measured, "not measured")})
    if (count > 0) cell += fmt::format("<span class=\"definition\">{} {}</span>", count, word);
  return cell;
}

/// The share of flights that meet it, as far as these flights show.
std::string ShownCell(const RequirementSummary& requirement) {
  if (!requirement.success_lower) return "–";
  if (requirement.verdict == "fail")
    return "≤ " + HtmlText(ShareText(*requirement.success_upper, Rounding::kUp, requirement.probability));
  return "≥ " + HtmlText(ShareText(*requirement.success_lower, Rounding::kDown, requirement.probability));
}

std::string NominalCell(const CampaignSummary& summary, const RequirementSummary& requirement) {
  if (!summary.nominal) return "–";
  if (summary.nominal->outcome != Outcome::kCompleted) return "lost";
  return ValueText(requirement, summary.nominal->metrics[summary.metric_list.PositionOf(requirement.metric)]);
}

std::string MedianCell(const CampaignSummary& summary, const RequirementSummary& requirement) {
  for (const MetricSummary& metric : summary.metrics)
    if (metric.name == requirement.metric) return ValueText(requirement, metric.statistics.p50);
  return "–";
}

std::string WorstCell(const RequirementSummary& requirement) {
  if (!requirement.worst_completed) return "–";
  return fmt::format("{} <span class=\"soft\">({})</span>",
                     ValueText(requirement, requirement.worst_completed->value),
                     requirement.worst_completed->case_index);
}

/// "required before the flights: below 0.1 for 99.73 % of flights at 10 % risk; verdict: fail".
std::string BeforeWords(const Standing::Dropped& dropped) {
  std::string words = dropped.words;
  if (const std::size_t metric = words.find(' '); metric != std::string::npos) words.erase(0, metric + 1);
  return fmt::format("required before the flights: {}; verdict: {}", words,
                     dropped.verdict.empty() ? "none" : dropped.verdict);
}

/// The requirement that took a dropped one's place: stated after the flights, of the same metric.
std::vector<int> Successors(const CampaignSummary& summary) {
  std::vector<int> of_dropped(summary.standing.dropped.size(), -1);
  for (std::size_t i = 0; i < summary.requirements.size(); ++i) {
    if (!summary.standing.requirements[i].post_hoc) continue;
    for (std::size_t d = 0; d < of_dropped.size(); ++d) {
      if (of_dropped[d] >= 0 ||
          !summary.standing.dropped[d].words.starts_with(summary.requirements[i].metric + " "))
        continue;
      of_dropped[d] = static_cast<int>(i);
      break;
    }
  }
  return of_dropped;
}

std::string RequirementsTable(const CampaignSummary& summary) {
  const Standing& standing = summary.standing;
  if (summary.requirements.empty() && standing.dropped.empty()) return "";
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < summary.requirements.size(); ++i) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return Rank(standing.requirements[a].verdict) < Rank(standing.requirements[b].verdict);
  });
  const std::vector<int> successors = Successors(summary);
  HtmlTable table("Verdict|!Requirement|#Failures|#Shown|#Required|#Nominal|#Median|#Worst (case)|#" +
                  Term("bound", "Bound") + "|#" + Term("margin", "Margin"));
  for (std::size_t d = 0; d < successors.size(); ++d) {
    const Standing::Dropped& dropped = standing.dropped[d];
    if (successors[d] >= 0) continue;
    table.Row(
        {VerdictBadge("post hoc"),
         HtmlText(dropped.words) +
             fmt::format("<span class=\"definition\"><b>left out after the first flight; its last verdict: "
                         "{}</b></span>",
                         dropped.verdict.empty() ? "none" : dropped.verdict),
         "–", "–", "–", "–", "–", "–", "–", "–"});
  }
  for (const std::size_t i : order) {
    const RequirementSummary& requirement = summary.requirements[i];
    const Standing::Requirement& one = standing.requirements[i];
    const MetricInfo info = DescribeMetric(requirement.metric);
    std::string before = one.post_hoc ? "not required before the flights" : "";
    for (std::size_t d = 0; d < successors.size(); ++d)
      if (successors[d] == static_cast<int>(i)) before = BeforeWords(standing.dropped[d]);
    table.Row({VerdictBadge(one.post_hoc && one.verdict == "not_evidence" ? "post hoc" : one.verdict),
               LimitCell(requirement, info, {before, one.post_hoc ? "" : one.reason}),
               FailuresCell(requirement), ShownCell(requirement),
               requirement.every_case ? "every case" : HtmlText(PercentText(requirement.probability)),
               NominalCell(summary, requirement), MedianCell(summary, requirement), WorstCell(requirement),
               requirement.bound ? BoundText(requirement) : "–",
               requirement.bound ? RoundedText(*requirement.margin, Rounding::kDown, 0.0) : "–"});
  }
  constexpr std::size_t kMany = 12;  // rows, from which on they stand closer
  return table.Html(order.size() > kMany ? "first judged dense" : "first judged");
}

/// What must be known before any number, each thing once. The changes of requirements stand in their rows.
std::vector<std::string> Notes(const CampaignSummary& summary) {
  const Standing& standing = summary.standing;
  std::vector<std::string> notes;
  const auto changed = std::count_if(standing.requirements.begin(), standing.requirements.end(),
                                     [](const Standing::Requirement& one) { return one.post_hoc; });
  if (changed > 0 || !standing.dropped.empty())
    notes.push_back(
        "Post hoc: requirements were changed after the first flight. Their rows say how. Flights with "
        "another "
        "seed can show that they are met.");
  for (std::string& note : CampaignNotes(standing)) notes.push_back(std::move(note));
  return WithWarnings(std::move(notes), summary);
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
  std::string html = fmt::format("<header>\n<h1>Dispersion campaign {}</h1>\n", HtmlText(summary.name));
  html += Facts(summary);
  html += fmt::format(
      "<div class=\"headline{}\">{}{}{}{}<p>{}</p></div>\n", summary.beyond_limits == 0 ? "" : " exceeded",
      VerdictBadge(StandingBadge(standing)),
      IsIndependent(summary.sampling) ? "" : "<span class=\"badge design\">design study</span>",
      summary.beyond_limits == 0 ? "" : "<span class=\"badge fail\">structural limit exceeded</span>",
      certain_fail ? VerdictBadge("fail") : "",
      HeadSentence(summary) + (standing.verdict != StandingVerdict::kNotEvidence
                                   ? ""
                                   : " (" + Term(standing.is_post_hoc ? "post hoc" : "not evidence") + ")"));
  html += List("warnings", Notes(summary));
  html += RequirementsTable(summary);
  for (const LoadCheck& check : summary.load_checks)
    html +=
        fmt::format("<p class=\"load-check\">{}{}</p>\n",
                    check.failures > 0 ? VerdictBadge("fail") + " " : "", HtmlText(LoadCheckSentence(check)));
  if (const std::string advice = AdviceTogether(summary); !advice.empty())
    html += "<p class=\"advice\">" + HtmlText(advice) + "</p>\n";
  if (!campaign.assumptions.empty())
    html += "<div class=\"assumed\"><b>Assumptions of the campaign</b>" +
            List("assumptions", campaign.assumptions) + "</div>\n";
  if (IsIndependent(summary.sampling) && !summary.requirements.empty())
    html += "<p class=\"soft small\">" + Term("attempt", "Attempts") +
            " made in other folders are not known here.</p>\n";
  html += "<p class=\"sign\">Reviewed by: <span></span> Date: <span></span></p>\n";
  return html + "</header>\n";
}

}  // namespace dispersa
