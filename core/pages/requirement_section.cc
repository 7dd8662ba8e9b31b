// The requirements of a report: one card each, so that a verdict stays beside its numbers on any screen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/pages/glossary.h"
#include "core/pages/html_parts.h"
#include "core/pages/report_sections.h"
#include "core/pages/svg_chart.h"
#include "core/results/metric_catalogue.h"
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
      return fmt::format("judged once, after {} flight{}", requirement.planned,
                         requirement.planned == 1 ? "" : "s");
    case PlanKind::kGroupSequential:
      return fmt::format("judged at {} {} up to {} flights, {} spending", requirement.plan.looks,
                         Term("look", "looks"), requirement.planned,
                         requirement.plan.spending == Spending::kPocock ? "Pocock" : "O’Brien–Fleming");
    case PlanKind::kAnytime:
      return "judged at any time, by a mixture martingale";
  }
  return "";
}

std::string WorstWords(const RequirementSummary& requirement, const std::string& unit) {
  if (!requirement.worst_completed) return "–";
  const auto& [case_index, value] = *requirement.worst_completed;
  return fmt::format("{}{} (case {})", ValueText(requirement, value), unit.empty() ? "" : " " + unit,
                     case_index);
}

std::string LooksTable(const RequirementSummary& requirement) {
  if (requirement.looks.size() < 2) return "";
  HtmlTable table("!#Flights at the look|#Failures|Verdict|In the plan");
  for (const Look& look : requirement.looks) {
    table.Row({std::to_string(look.n), std::to_string(look.failures), LookName(look.verdict),
               look.planned ? "yes" : "no"});
  }
  return table.Html("narrow");
}

/// Requirements with the same figure.
struct Sharing {
  const RequirementSummary* first;
  std::string names;
};

template <typename Wanted, typename Same>
std::vector<Sharing> Share(const CampaignSummary& summary, const Wanted& wanted, const Same& same) {
  std::vector<Sharing> shared;
  for (const RequirementSummary& requirement : summary.requirements) {
    if (!wanted(requirement)) continue;
    const std::string name = DescribeMetric(requirement.metric).title;
    const auto known = std::find_if(shared.begin(), shared.end(),
                                    [&](const Sharing& one) { return same(*one.first, requirement); });
    if (known == shared.end())
      shared.push_back({&requirement, name});
    else
      known->names += "; " + name;
  }
  return shared;
}

constexpr int kSmallWidth = 380, kSmallHeight = 200;

std::string ChanceFigure(const Sharing& sharing) {
  SvgChart chart({.label = "flights of a new campaign", .logarithmic = true},
                 {.label = "probability of a pass", .low = 0.0, .high = 1.0, .percent = true}, kSmallWidth,
                 kSmallHeight);
  std::vector<double> cases;
  std::vector<double> chance;
  for (const auto& each : sharing.first->pass_chances) {
    cases.push_back(static_cast<double>(each.cases));
    chance.push_back(each.probability);
  }
  chart.Line(cases, chance, "line-0", "by what was seen here");
  const std::string caption =
      sharing.names +
      ": probability that a new campaign passes, over the failure rates that these flights "
      "leave possible." +
      AdviceSentence(*sharing.first);
  return Figure(chart.Svg(caption), HtmlText(caption));
}

std::string ChanceFigures(const CampaignSummary& summary) {
  std::string figures;
  for (const Sharing& sharing : Share(
           summary,
           [](const RequirementSummary&one) {
             return one.verdict == "inconclusive" && one.pass_chances.size() > 1;
           },
           [](const RequirementSummary&a, const RequirementSummary&b) {
             return a.failures == b.failures && a.probability == b.probability &&
                    a.consumer_risk == b.consumer_risk;
           }))
    figures += ChanceFigure(sharing);
  return figures.empty() ? ""
                         : "<h3>How many flights could decide</h3>\n<div class=\"figures small\">\n" +
                               figures + "</div>\n";
}

/// The failure probability that the first n cases show, as n grows.
std::string ConvergenceFigure(const Sharing& sharing) {
  const RequirementSummary& requirement = *sharing.first;
  std::vector<double> n, observed, lower, upper;
  double lowest = 1.0 - requirement.probability;
  for (const auto& at : requirement.convergence) {
    n.push_back(static_cast<double>(at.n));
    observed.push_back(static_cast<double>(at.failures) / static_cast<double>(at.n));
    lower.push_back(1.0 - at.success_upper);
    upper.push_back(1.0 - at.success_lower);
    lowest = std::min(lowest, upper.back());
  }
  SvgChart chart({.label = "first flights", .low = n.front(), .high = n.back(), .logarithmic = true},
                 {.label = "probability of a failure",
                  .low = 0.3 * lowest,
                  .high = 1.0,
                  .logarithmic = true,
                  .percent = true},
                 kSmallWidth, kSmallHeight);
  for (double& share : lower) share = std::max(share, 0.3 * lowest);
  chart.Band(n, lower, upper, "band-outer", "between its bounds");
  if (requirement.failures > 0) chart.Line(n, observed, "line-0", "observed");
  chart.HorizontalLimit(1.0 - requirement.probability,
                        fmt::format("{} allowed", PercentText(1.0 - requirement.probability)), "allowed");
  for (const Look& look : requirement.looks) chart.Mark(static_cast<double>(look.n), LookName(look.verdict));
  const std::string caption =
      fmt::format("{}: {} of {} flights at the end.", sharing.names, requirement.failures, requirement.n);
  return Figure(chart.Svg(caption), HtmlText(caption));
}

/// Where every flight or none broke the limit, and that decided, a curve says no more than these numbers.
bool IsTrivial(const RequirementSummary& requirement) {
  const bool mixed = requirement.failures > 0 && requirement.failures < requirement.n;
  return !mixed && requirement.verdict != "inconclusive";
}

std::string ConvergenceFigures(const CampaignSummary& summary) {
  if (!IsIndependent(summary.sampling)) return "";
  std::string figures;
  for (const Sharing& sharing : Share(
           summary,
           [](const RequirementSummary&one) { return one.convergence.size() > 1 && !IsTrivial(one); },
           [](const RequirementSummary&a, const RequirementSummary&b) {
             return a.probability == b.probability && a.consumer_risk == b.consumer_risk &&
                    a.plan == b.plan &&
                    std::equal(a.convergence.begin(), a.convergence.end(), b.convergence.begin(),
                               b.convergence.end(), [](const auto& x, const auto& y) {
                                 return x.n == y.n && x.failures == y.failures;
                               });
           }))
    figures += ConvergenceFigure(sharing);
  if (figures.empty()) return "";
  return fmt::format(
      "<h3>How the verdicts converged</h3>\n<p class=\"soft\">Each bound holds at its number of flights "
      "taken "
      "alone. The verdict is read where the plan looks (dotted). A requirement that no flight broke, and "
      "that "
      "passed, has no chart.</p>\n<div class=\"figures small\">\n{}</div>\n",
      figures);
}

std::string Card(const RequirementSummary& requirement) {
  const MetricInfo info = DescribeMetric(requirement.metric);
  const double observed = requirement.n == 0 ? std::nan("")
                                             : static_cast<double>(requirement.n - requirement.failures) /
                                                   static_cast<double>(requirement.n);
  // Points that are chosen, or flights that show no more than one.
  const bool shows_nothing = requirement.verdict == "study" || requirement.verdict == "not_evidence";
  std::string html = fmt::format(
      "<section class=\"requirement\"><p class=\"claim\">{}<b>{}</b> {} {}<br><code>{}</code></p>\n",
      requirement.id.empty() ? "" : Code(requirement.id) + " ", HtmlText(info.title),
      HtmlText(LimitWords(requirement, info.unit)),
      requirement.every_case ? std::string("in every case")
                             : fmt::format("for {} of flights, {} {}", PercentText(requirement.probability),
                                           Term("consumer risk"), PercentText(requirement.consumer_risk)),
      HtmlText(requirement.metric));
  for (const auto& [name, text] : {std::pair<const char*, const std::string&>{"Why", requirement.rationale},
                                   {"Source", requirement.source}})
    if (!text.empty()) html += fmt::format("<p>{}: {}</p>\n", name, HtmlText(text));
  html += "<p class=\"sentence\">" + HtmlText(requirement.sentence) + "</p>\n";
  if (requirement.bound) {
    html += "<p class=\"value\">" + HtmlText(BoundSentence(requirement, info.unit)) + "</p>\n";
  } else if (!shows_nothing) {
    html += "<p class=\"sentence\">No " + Term("bound") +
            (requirement.accepts ? ": in the flight that would be it the metric is undefined, or it was lost"
                                 : ": with so few cases no flight bounds the required share") +
            ".</p>\n";
  }
  html += "<dl class=\"facts\">";
  html += Fact("cases", std::to_string(requirement.n));
  html += Fact("failures", std::to_string(requirement.failures));
  html += Fact("lost flights", std::to_string(requirement.lost_flights));
  html += Fact("not measured", std::to_string(requirement.not_measured));
  html += Fact("observed", ShareText(observed));
  html += Fact("worst completed flight", HtmlText(WorstWords(requirement, info.unit)));
  html +=
      Fact("confidence bounds",
           requirement.success_lower
               ? fmt::format("≥ {}, ≤ {}",
                             ShareText(*requirement.success_lower, Rounding::kDown, requirement.probability),
                             ShareText(*requirement.success_upper, Rounding::kUp, requirement.probability))
           : requirement.verdict == "study" ? "none: design study"
                                            : "none: no evidence");
  // A probability that doubles round to 0 is small, not 0.
  if (requirement.attained_risk)
    html += Fact(Term("attained risk"), HtmlText(ShareText(std::max(*requirement.attained_risk, 1e-300))));
  if (!shows_nothing) {
    html += Fact("plan", PlanWords(requirement));
    html += Fact(
        "decision rule",
        fmt::format(
            "{}; {}",
            !requirement.accepts        ? "no number of failures passes"
            : *requirement.accepts == 0 ? "pass without any failure"
                                        : fmt::format("pass with {} or fewer failures", *requirement.accepts),
            requirement.rejects ? fmt::format("fail with {} or more", *requirement.rejects) : "none fails"));
  }
  return html + "</dl>\n" + LooksTable(requirement) + "</section>\n";
}

}  // namespace

std::string RequirementsSection(const CampaignSummary& summary) {
  std::string html = "<h2 id=\"requirements\">Requirements</h2>\n";
  if (summary.requirements.empty()) return html + "<p>The campaign states none.</p>\n";
  html += "<div class=\"cards\">\n";
  for (const RequirementSummary& requirement : summary.requirements) html += Card(requirement);
  html += "</div>\n";
  if (!IsIndependent(summary.sampling)) {
    return html +
           "<p class=\"soft\">The points of this campaign are chosen, not drawn independently. So no "
           "confidence can be stated: it is a " +
           Term("design study") +
           ". A point that violates a requirement is a fact all the same. A lost flight violates every "
           "requirement, and so does an undefined metric.</p>\n";
  }
  return html + ConvergenceFigures(summary) + ChanceFigures(summary) + "<p>" +
         HtmlText(JointRiskSentence(summary)) +
         "</p>\n<p class=\"soft\">Verdicts come from the exact binomial distribution, not from mean ± 3σ "
         "(NASA/TP-2010-216447). A requirement passes when a design that just misses it would show so few "
         "failures, at any of the plan’s looks, with no more than the consumer risk. It fails when a design "
         "that just meets it would show so many with no more than the same risk. Each confidence bound is "
         "one-sided. The bound in the metric’s unit is the order statistic that decides: the requirement "
         "passes exactly when it is inside the limit. A lost flight counts as a failure of every "
         "requirement, "
         "and so does an undefined metric.</p>\n";
}

}  // namespace dispersa
