// The requirements of a report: one card each, so that a verdict stays beside its numbers on any screen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/pages/html_parts.h"
#include "core/pages/report_sections.h"
#include "core/pages/svg_chart.h"
#include "core/results/metric_catalogue.h"
#include "core/results/sampling_text.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

std::string Fact(const std::string& title, const std::string& value) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", title, value);
}

const char* LookName(Verdict verdict) {
  return verdict == Verdict::kPass ? "pass" : verdict == Verdict::kFail ? "fail" : "inconclusive";
}

std::string PlanWords(const RequirementSummary& requirement) {
  switch (requirement.plan.kind) {
    case PlanKind::kFixed:
      return fmt::format("judged once, after {} flights", requirement.planned);
    case PlanKind::kGroupSequential:
      return fmt::format("{} looks up to {} cases, {} spending", requirement.plan.looks, requirement.planned,
                         requirement.plan.spending == Spending::kPocock ? "Pocock" : "O’Brien–Fleming");
    case PlanKind::kAnytime:
      return "any time, by a mixture martingale";
  }
  return "";
}

/// The value that the claim is read by, or why there is none.
std::string BoundWords(const RequirementSummary& requirement, const std::string& unit) {
  if (!requirement.bound) return "no bound: too few cases or too many lost";
  return fmt::format("With {} confidence {} of flights keep to {} (margin {}).",
                     PercentText(1.0 - requirement.consumer_risk), PercentText(requirement.probability),
                     WithUnit(*requirement.bound, unit), WithUnit(*requirement.margin, unit));
}

/// The worst of the completed flights, which is no bound of anything but says where the sample ends.
std::string WorstWords(const RequirementSummary& requirement, const CampaignSummary& summary,
                       const std::string& unit) {
  for (const WorstCases& worst : summary.worst_cases) {
    if (worst.metric != requirement.metric) continue;
    for (const WorstCase& one : worst.cases) {
      if (one.outcome == Outcome::kCompleted && one.value)
        return fmt::format("{} (case {})", WithUnit(*one.value, unit), one.case_index);
    }
  }
  return "–";
}

std::string LooksTable(const RequirementSummary& requirement) {
  if (requirement.looks.size() < 2) return "";
  HtmlTable table({{"Look at", true}, {"Failures", true}, {"Verdict"}, {"In the plan"}});
  for (const Look& look : requirement.looks) {
    table.Row({std::to_string(look.n), std::to_string(look.failures), LookName(look.verdict),
               look.planned ? "yes" : "no"});
  }
  return table.Html("narrow");
}

std::string ChanceFigure(const RequirementSummary& requirement) {
  if (requirement.verdict != "inconclusive" || requirement.pass_chances.size() < 2) return "";
  SvgChart chart({.label = "cases of a new campaign", .logarithmic = true},
                 {.label = "probability of a pass", .low = 0.0, .high = 1.0, .percent = true}, 520, 200);
  std::vector<double> cases;
  std::vector<double> chance;
  for (const auto& each : requirement.pass_chances) {
    cases.push_back(static_cast<double>(each.cases));
    chance.push_back(each.probability);
  }
  chart.Line(cases, chance, "line-0", "by what was seen here");
  const std::string caption =
      "Probability that a new campaign passes, against its number of cases, over the failure rates that "
      "these "
      "flights leave possible.";
  return "<div class=\"figures\">" + Figure(chart.Svg(caption), caption) + "</div>\n";
}

/// The failure probability that the first n cases show, as n grows.
std::string ConvergenceFigure(const RequirementSummary& requirement) {
  if (requirement.convergence.size() < 2) return "";
  const MetricInfo info = DescribeMetric(requirement.metric);
  std::vector<double> n, observed, lower, upper;
  double lowest = 1.0 - requirement.probability;
  for (const auto& at : requirement.convergence) {
    n.push_back(static_cast<double>(at.n));
    observed.push_back(static_cast<double>(at.failures) / static_cast<double>(at.n));
    lower.push_back(1.0 - at.success_upper);
    upper.push_back(1.0 - at.success_lower);
    lowest = std::min(lowest, upper.back());
  }
  SvgChart chart({.label = "first cases", .low = n.front(), .high = n.back(), .logarithmic = true},
                 {.label = "probability of a failure",
                  .low = 0.3 * lowest,
                  .high = 1.0,
                  .logarithmic = true,
                  .percent = true},
                 520, 250);
  for (double& share : lower) share = std::max(share, 0.3 * lowest);
  chart.Band(n, lower, upper, "band-outer", "between its bounds");
  chart.Line(n, observed, "line-0", "observed");
  chart.HorizontalLimit(1.0 - requirement.probability,
                        fmt::format("{} allowed", PercentText(1.0 - requirement.probability)), "allowed");
  for (const Look& look : requirement.looks) chart.Mark(static_cast<double>(look.n), LookName(look.verdict));
  const std::string caption = fmt::format(
      "{}: {} in {} cases at the end. Each bound holds with {} confidence at its number of cases taken "
      "alone; the "
      "verdict is read where the plan looks (dotted).",
      info.title, requirement.failures, requirement.n, PercentText(1.0 - requirement.consumer_risk));
  return Figure(chart.Svg(caption), HtmlText(caption));
}

std::string Card(const RequirementSummary& requirement, const CampaignSummary& summary) {
  const MetricInfo info = DescribeMetric(requirement.metric);
  const double observed = requirement.n == 0 ? std::nan("")
                                             : static_cast<double>(requirement.n - requirement.failures) /
                                                   static_cast<double>(requirement.n);
  const bool study = requirement.verdict == "study";
  std::string html = fmt::format(
      "<section class=\"requirement\"><p class=\"claim\"><b>{}</b> {} {}<br><code>{}</code>{}</p>\n<p "
      "class=\"sentence\">{}</p>\n<dl class=\"facts\">",
      HtmlText(info.title), HtmlText(LimitWords(requirement, info.unit)),
      requirement.every_case
          ? std::string("in every case")
          : fmt::format("for {} of flights, consumer risk {}", PercentText(requirement.probability),
                        PercentText(requirement.consumer_risk)),
      HtmlText(requirement.metric),
      requirement.by_default ? ", required because the vehicle gives limits"
      : study                ? ""
                             : " <span class=\"value\">" + BoundWords(requirement, info.unit) + "</span>",
      HtmlText(requirement.sentence));
  html += Fact("cases", std::to_string(requirement.n));
  html += Fact("failures", std::to_string(requirement.failures));
  html += Fact("lost flights", std::to_string(requirement.lost_flights));
  html += Fact("observed", PercentText(observed));
  html += Fact("worst completed flight", WorstWords(requirement, summary, info.unit));
  html += Fact("confidence bounds", requirement.success_lower
                                        ? fmt::format("≥ {}, ≤ {}", PercentText(*requirement.success_lower),
                                                      PercentText(*requirement.success_upper))
                                        : "none: design study");
  if (!study) {
    html += Fact("plan", PlanWords(requirement));
    html += Fact(
        "decision rule",
        fmt::format(
            "{}; {}",
            requirement.accepts ? fmt::format("pass with {} failures or fewer", *requirement.accepts)
                                : "no number of failures passes",
            requirement.rejects ? fmt::format("fail with {} or more", *requirement.rejects) : "none fails"));
  }
  return html + "</dl>\n" + LooksTable(requirement) + ChanceFigure(requirement) + "</section>\n";
}

}  // namespace

std::string RequirementsSection(const CampaignSummary& summary) {
  std::string html = "<h2 id=\"requirements\">Requirements</h2>\n";
  if (summary.requirements.empty()) return html + "<p>The campaign states none.</p>\n";
  std::string convergence;
  const bool by_default =
      std::any_of(summary.requirements.begin(), summary.requirements.end(),
                  [](const RequirementSummary& requirement) { return requirement.by_default; });
  for (const RequirementSummary& requirement : summary.requirements) {
    html += Card(requirement, summary);
    convergence += ConvergenceFigure(requirement);
  }
  if (!IsIndependent(summary.sampling)) {
    return html +
           "<p class=\"soft\">The points of this campaign are chosen, not drawn independently, so that no "
           "confidence can be stated: it is a design study, which neither passes nor fails a requirement. A "
           "point that violates one is a fact all the same. A lost flight violates every requirement, and so "
           "does an undefined metric.</p>\n";
  }
  return html + "<p>" + HtmlText(JointRiskSentence(summary)) +
         "</p>\n<p class=\"soft\">Verdicts come from the exact binomial distribution, not from mean ± 3σ "
         "(NASA/TP-2010-216447): a requirement passes when a design that just misses it would have shown so "
         "few failures, at any of the plan’s looks, with no more than the consumer risk, and fails when a "
         "design that just meets it would have shown so many with no more than the same risk. Each "
         "confidence "
         "bound is one-sided. The bound in the metric’s unit is the order statistic that decides: the "
         "requirement passes exactly when it keeps to the limit. A lost flight counts as a failure of every "
         "requirement, and so does an undefined metric" +
         (by_default ? "; of the vehicle’s own limits a loss says nothing: they are held against what the "
                       "flight bore "
                       "until then"
                     : "") +
         ".</p>\n" +
         (convergence.empty()
              ? ""
              : "<h3>How the verdicts converged</h3>\n<div class=\"figures\">\n" + convergence + "</div>\n");
}

}  // namespace dispersa
