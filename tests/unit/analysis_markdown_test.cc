// A summary as Markdown: every text of a campaign stays text, and each requirement has its own line.
#include "core/analysis/markdown.h"

#include "core/results/metric_catalogue.h"
#include "tests/test.h"

namespace dispersa::analysis_markdown_test {

CampaignSummary MadeUp() {
  CampaignSummary summary;
  summary.name = "made_up";
  summary.id = "1a";
  summary.flight_id = "2b";
  summary.engine = "3c";
  summary.vehicle = "two | stages";
  summary.reference = "orbit";
  summary.autopilot = "pd";
  summary.cases = 40;
  summary.flown = 40;
  summary.seed = 7;
  summary.outcomes[static_cast<std::size_t>(Outcome::kCompleted)] = 39;
  summary.verdict = CampaignVerdict::kFail;
  summary.standing.verdict = StandingVerdict::kFail;
  for (const char* id : {"", "R-1 <b>"}) {
    RequirementSummary requirement;
    requirement.id = id;
    requirement.metric = "pitch_error_peak_deg";
    requirement.below = true;
    requirement.limit = 0.5;
    requirement.probability = 0.9;
    requirement.consumer_risk = 0.1;
    requirement.n = 40;
    requirement.failures = *id ? 30 : 0;
    requirement.sentence = *id ? "Broken." : "Kept.";
    if (*id == 0) requirement.bound = 0.4, requirement.margin = 0.1;
    summary.requirements.push_back(requirement);
    summary.standing.requirements.push_back({*id ? "fail" : "not_evidence", *id == 0, "", 0, 0});
  }
  summary.worst_cases.push_back(
      {"pitch_error_peak_deg", {{3, std::nullopt, Outcome::kLostControl}, {11, 0.875, Outcome::kCompleted}}});
  MetricSummary metric;
  metric.name = "pitch_error_peak_deg";
  metric.statistics.n = 39;
  metric.statistics.p50 = 0.25;
  metric.statistics.p95 = 0.5;
  metric.statistics.p99 = 0.75;
  metric.statistics.max = 0.875;
  summary.metrics.push_back(metric);
  metric.name = "q_max_pa";  // has no worst cases: no metric that reviewers read
  summary.metrics.push_back(metric);
  return summary;
}

TEST(Markdown, HasALineForEachRequirement) {
  const std::string text = MarkdownReport(MadeUp());
  EXPECT_THAT(text, StartsWith("# made\\_up: fail\n\ntwo \\| stages, reference orbit, autopilot pd; 40 of 40 "
                               "cases flown (Monte Carlo, seed 7), 39 completed.\n"));
  EXPECT_THAT(text, HasSubstr("| pitch\\_error\\_peak\\_deg below 0.5 for 90 % of flights at 10 % risk | "
                              "**not evidence** (post hoc) | 0 of 40 | 100 % | 0.4 | 0.1 |\n"));
  EXPECT_THAT(text, HasSubstr("| pitch\\_error\\_peak\\_deg below 0.5 for 90 % of flights at 10 % risk | "
                              "**fail** | 30 of 40 | 25 % | – | – |\n"));
  EXPECT_THAT(text, HasSubstr("- **pitch\\_error\\_peak\\_deg**: Kept."));
  EXPECT_THAT(text, HasSubstr("- **R-1 \\<b\\>**: Broken."));
}

TEST(Markdown, HasTheWorstCasesAndTheirStatistics) {
  const std::string text = MarkdownReport(MadeUp());
  EXPECT_THAT(
      text,
      HasSubstr("| pitch\\_error\\_peak\\_deg | 3 | – | lost\\_control | `dispersa replay . --case 3` |\n"
                "| pitch\\_error\\_peak\\_deg | 11 | 0.875 | completed | `dispersa replay . --case 11` |\n"));
  EXPECT_THAT(text, HasSubstr("| pitch\\_error\\_peak\\_deg | ° | 39 | 0.25 | 0.5 | 0.75 | 0.875 |\n"));
  EXPECT_THAT(text, Not(HasSubstr("q\\_max\\_pa")));
  EXPECT_THAT(text, EndsWith("\nCampaign `1a`, flights `2b`, engine `3c`.\n"));
}

TEST(Markdown, PromisesNoReplayOfALawThatIsNotInTheFile) {
  CampaignSummary summary = MadeUp();
  summary.python_law = CampaignSummary::PythonLaw{"pd", "00"};
  EXPECT_THAT(MarkdownReport(summary), HasSubstr("| 11 | 0.875 | completed | – |\n"));
}

TEST(Markdown, SaysThatNothingIsRequired) {
  CampaignSummary summary = MadeUp();
  summary.requirements.clear();
  summary.standing.requirements.clear();
  summary.worst_cases.clear();
  summary.is_controlled = false;
  const std::string text = MarkdownReport(summary);
  EXPECT_THAT(text, HasSubstr("two \\| stages, without control; 40 of 40"));
  EXPECT_THAT(text, HasSubstr("\nThe campaign states no requirement: nothing is judged.\n"));
  EXPECT_THAT(text, Not(HasSubstr("Worst cases")));
  EXPECT_THAT(text, Not(HasSubstr("Statistics")));
}

}  // namespace dispersa::analysis_markdown_test
