#include "core/analysis/markdown.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/results/metric_catalogue.h"
#include "core/results/sampling_text.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

/// Plain text: nothing in it is markup, and it stays on its line and in its cell.
std::string Plain(std::string_view text) {
  constexpr std::string_view kMarkup = "\\`*_[]<>|#&~";
  std::string plain;
  for (const char c : text) {
    if (kMarkup.find(c) != std::string_view::npos) plain += '\\';
    plain += c == '\n' || c == '\r' ? ' ' : c;
  }
  return plain;
}

std::string IdOrMetric(const RequirementSummary& requirement) {
  return requirement.id.empty() ? requirement.metric : requirement.id;
}

std::string Spaced(std::string words) {
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string Head(const CampaignSummary& summary) {
  const std::string flight = summary.is_controlled ? fmt::format(", reference {}, autopilot {}",
                                                                 summary.reference, summary.autopilot)
                                                   : std::string(", without control");
  const auto completed = summary.outcomes[static_cast<std::size_t>(Outcome::kCompleted)];
  return fmt::format("# {}: {}\n\n{}; {} of {} cases flown ({}, seed {}), {} completed.\n",
                     Plain(summary.name), StandingBadge(summary.standing), Plain(summary.vehicle + flight),
                     summary.flown, summary.cases, SamplingMethodTitle(summary.sampling), summary.seed,
                     completed);
}

std::string Notes(const CampaignSummary& summary) {
  std::string text;
  for (const std::string& note : WithWarnings(StandingNotes(summary.standing, summary), summary))
    text += "\n> " + Plain(note) + "\n";
  return text;
}

std::string RequirementRow(const RequirementSummary& requirement, const Standing::Requirement& standing) {
  const auto met = static_cast<double>(requirement.n - requirement.failures);
  const std::string observed = requirement.n == 0 ? "–" : ShareText(met / static_cast<double>(requirement.n));
  const auto number = [](const std::optional<double>& value) {
    return value ? RoundedText(*value) : std::string("–");
  };
  return fmt::format("| {} | **{}**{} | {} of {} | {} | {} | {} |\n", Plain(RequirementWords(requirement)),
                     Spaced(standing.verdict), standing.post_hoc ? " (post hoc)" : "", requirement.failures,
                     requirement.n, observed, number(requirement.bound), number(requirement.margin));
}

std::string Requirements(const CampaignSummary& summary) {
  if (summary.requirements.empty()) return "\nThe campaign states no requirement: nothing is judged.\n";
  std::string rows, sentences;
  for (std::size_t i = 0; i < summary.requirements.size(); ++i) {
    const RequirementSummary& requirement = summary.requirements[i];
    const Standing::Requirement& standing = summary.standing.requirements[i];
    rows += RequirementRow(requirement, standing);
    sentences += fmt::format("- **{}**: {}\n", Plain(IdOrMetric(requirement)),
                             Plain(JudgedSentence(requirement, standing) + AdviceSentence(requirement)));
  }
  return "\n| requirement | verdict | failures | observed | bound | margin |\n|---|---|---|---|---|---|\n" +
         rows + "\n" + sentences + "\n" + Plain(JointRiskSentence(summary)) + "\n";
}

std::string LoadChecks(const CampaignSummary& summary) {
  std::string text;
  for (const LoadCheck& check : summary.load_checks) text += "\n" + Plain(LoadCheckSentence(check)) + "\n";
  return text;
}

std::string Worst(const CampaignSummary& summary) {
  std::string rows;
  for (const WorstCases& worst : summary.worst_cases)
    for (const WorstCase& one : worst.cases)
      rows += fmt::format("| {} | {} | {} | {} | {} |\n", Plain(worst.metric), one.case_index,
                          one.value ? ReadableText(*one.value) : "–", Plain(OutcomeName(one.outcome)),
                          summary.python_law ? std::string("–") : "`" + ReplayCommand(one.case_index) + "`");
  if (rows.empty()) return "";
  return "\n## Worst cases\n\n| metric | case | value | outcome | to fly it again, in the result folder |\n"
         "|---|---|---|---|---|\n" +
         rows;
}

/// Of the metrics that have worst cases: the requirements' and the usual ones.
std::string Statistics(const CampaignSummary& summary) {
  std::string rows;
  for (const WorstCases& worst : summary.worst_cases) {
    const auto metric = std::find_if(summary.metrics.begin(), summary.metrics.end(),
                                     [&](const MetricSummary& one) { return one.name == worst.metric; });
    if (metric == summary.metrics.end() || metric->statistics.n == 0) continue;
    const MetricInfo info = DescribeMetric(metric->name);
    const Summary& of = metric->statistics;
    rows +=
        fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", Plain(metric->name), Plain(info.unit), of.n,
                    ReadableText(of.p50), ReadableText(of.p95), ReadableText(of.p99), ReadableText(of.max));
  }
  if (rows.empty()) return "";
  return "\n## Statistics of completed flights\n\n| metric | unit | flights | median | 95 % | 99 % | largest "
         "|\n"
         "|---|---|---|---|---|---|---|\n" +
         rows;
}

}  // namespace

std::string MarkdownReport(const CampaignSummary& summary) {
  return Head(summary) + Notes(summary) + Requirements(summary) + LoadChecks(summary) + Worst(summary) +
         Statistics(summary) +
         fmt::format("\nCampaign `{}`, flights `{}`, engine `{}`.\n", summary.id, summary.flight_id,
                     summary.engine);
}

}  // namespace dispersa
