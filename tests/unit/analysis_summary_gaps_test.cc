// Campaigns with gaps and losses: case indices that differ from rows, several lost flights, several
// requirements.
#include "core/analysis/campaign_summary.h"
#include "core/analysis/stopping_rule.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_summary_gaps_test {

using namespace report_test;

/// Of twelve cases those that are listed have a result.
CampaignSummary SummaryOf(const Campaign& campaign, const std::vector<CaseResult>& results) {
  const TemporaryFolder temporary;
  ResultFolder folder = ResultFolder::Create(temporary / "out", campaign);
  folder.Append(results);
  return BuildSummary(folder, campaign);
}

TEST(SummaryWithGaps, NamesCasesByIndexAndNotByRow) {
  Campaign campaign = MakeCampaign(12);
  campaign.vehicle.limits.q_max_pa = 100.0;
  std::vector<CaseResult> results;
  for (const std::uint64_t index : {2, 5, 9}) {
    CaseResult result = MakeCase(index);
    result.metrics[MetricColumn("q_max_pa")] = index == 5 ? 120.0 : 80.0;
    result.metrics[MetricColumn("structural_limit_exceeded")] = index == 5 ? 1.0 : 0.0;
    result.metrics[MetricColumn(kPeak)] = 1.0;
    results.push_back(result);
  }
  const CampaignSummary summary = SummaryOf(campaign, results);
  EXPECT_EQ(summary.verdict, CampaignVerdict::kIncomplete);
  ASSERT_EQ(summary.limits.size(), 1u);
  EXPECT_EQ(summary.limits[0].largest_case, 5u);
  EXPECT_THAT(Warnings(summary), ElementsAre("Incomplete: 3 of 12 cases have a result.",
                                             "Structural limits of the vehicle were exceeded in 1 of 3 "
                                             "flights: q_max_pa above 100 Pa in 1, up to 120 Pa in case 5."));
  ASSERT_EQ(summary.worst_cases[1].metric, kPeak);
  ASSERT_EQ(summary.worst_cases[1].cases.size(), 3u);
  EXPECT_EQ(summary.worst_cases[1].cases[0].case_index, 2u);
  EXPECT_EQ(summary.worst_cases[1].cases[2].case_index, 9u);
}

// Lost flights have a list of their own: one of them stands for all, and four that were completed follow.
TEST(SummaryWithLosses, ShowsOneOfThemAmongTheWorst) {
  std::vector<CaseResult> results;
  for (std::uint64_t index = 0; index < 9; ++index) {
    CaseResult result = MakeCase(index);
    result.metrics[MetricColumn(kPeak)] = static_cast<double>(index);
    if (index % 3 == 1) result.outcome = Outcome::kLostControl;
    results.push_back(result);
  }
  const CampaignSummary summary = SummaryOf(MakeCampaign(9), results);
  EXPECT_EQ(summary.lost_flights.size(), 3u);
  std::vector<std::uint64_t> order;
  for (const WorstCase& worst : summary.worst_cases[0].cases) order.push_back(worst.case_index);
  EXPECT_THAT(order, ElementsAre(7, 8, 6, 5, 3));  // of the lost ones 7 measured the worst
}

TEST(JointRisk, IsTheSumOfTheRisksAndOfHolmTheLargest) {
  Campaign campaign = MakeCampaign(3);
  campaign.requirements = {PeakBelow(10.0, 0.9, 0.1), PeakBelow(11.0, 0.9, 0.2), PeakBelow(12.0, 0.9, 0.05)};
  const std::vector<CaseResult> results = {MakeCase(0), MakeCase(1), MakeCase(2)};
  CampaignSummary summary = SummaryOf(campaign, results);
  EXPECT_EQ(summary.overall_risk, 0.2);
  EXPECT_DOUBLE_EQ(summary.any_risk, 0.35);
  EXPECT_EQ(JointRiskSentence(summary),
            "A design that misses any requirement passes them all with a probability of at most 20 %. The "
            "risks that the 3 requirements allow add up to 35 %; joint: holm keeps them together at the "
            "largest one.");
  campaign.verdicts.holm = true;
  summary = SummaryOf(campaign, results);
  EXPECT_EQ(summary.any_risk, 0.2);
  EXPECT_THAT(JointRiskSentence(summary),
              HasSubstr("The risk that any of the 3 passes is wrong is at most 20 % (Holm)."));
  campaign.verdicts.holm = false;
  campaign.requirements.assign(4, PeakBelow(10.0, 0.9, 0.4));
  EXPECT_EQ(SummaryOf(campaign, results).any_risk, 1.0);
}

/// Cases after which a campaign of 400 stops, whose first `bad` flights end so, with such a peak.
std::uint64_t StopsAt(std::uint64_t bad, Outcome outcome, double peak) {
  Campaign campaign = MakeCampaign(400);
  campaign.verdicts.stop_when_decided = true;
  campaign.requirements = {PeakBelow(0.5, 0.97, 0.1)};
  campaign.requirements[0].plan.kind = PlanKind::kAnytime;
  StoppingRule rule(campaign, 400, {});
  for (std::uint64_t index = 0; index < 400; ++index) {
    while (rule.Advance({})) {
    }
    if (index >= rule.target()) break;
    CaseResult result = MakeCase(index);
    result.metrics[MetricColumn(kPeak)] = index < bad ? peak : 0.1;
    if (index < bad) result.outcome = outcome;
    rule.Add(result);
  }
  return rule.target();
}

// A lost flight fails, whatever it measured until then.
TEST(StoppingRule, TakesALostFlightForAFailure) {
  const std::uint64_t none = StopsAt(0, Outcome::kCompleted, 0.1), one = StopsAt(1, Outcome::kCompleted, 0.9);
  EXPECT_LT(none, one);
  EXPECT_LT(one, 400u);
  EXPECT_EQ(StopsAt(1, Outcome::kLostControl, 0.1), one);
  EXPECT_EQ(StopsAt(2, Outcome::kImpact, 0.1), StopsAt(2, Outcome::kCompleted, 0.9));
}

}  // namespace dispersa::analysis_summary_gaps_test
