// Limits that the vehicle brings and the campaign does not require, and what shows nothing: flights that do
// not define the metric, and cases of another engine.
#include "core/analysis/load_check.h"

#include <nlohmann/json.hpp>

#include "core/analysis/campaign_summary.h"
#include "core/analysis/junit.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_load_check_test {
namespace {

using namespace report_test;

/// All flights with a peak of 0.1; of the first `beyond` a dynamic pressure beyond the limit.
CampaignSummary Flown(Campaign campaign, std::uint64_t beyond, std::uint64_t unmeasured = 0,
                      const std::vector<AttemptRecord>& earlier = {}) {
  const TemporaryFolder temporary;
  ResultFolder folder = ResultFolder::Create(temporary / "out", campaign);
  std::vector<CaseResult> results;
  for (std::uint64_t k = 0; k < campaign.sampling.cases; ++k) {
    results.push_back(MakeCase(k));
    results.back().metrics[MetricColumn(kPeak)] =
        k < unmeasured ? std::numeric_limits<double>::quiet_NaN() : 0.1;
    results.back().metrics[MetricColumn("q_max_pa")] = k < beyond ? 120.0 : 80.0;
    results.back().metrics[MetricColumn("structural_limit_exceeded")] = k < beyond ? 1.0 : 0.0;
  }
  folder.Append(results);
  const AttemptLedger ledger(folder.directory() / kFolderLedgerName);
  for (const AttemptRecord& one : earlier) ledger.Write(one);
  ledger.Write(RecordOf(campaign));
  return BuildSummary(folder, campaign);
}

Campaign WithLimit() {
  Campaign campaign = MakeCampaign(40);
  campaign.design_id = "design";
  campaign.vehicle.limits.q_max_pa = 100.0;
  campaign.requirements = {PeakBelow(0.5, 0.9, 0.1)};
  return campaign;
}

struct Checked {
  std::string name;
  std::uint64_t beyond;
  bool is_required;  ///< of the campaign anything
  StandingVerdict standing;
};
class LoadChecks : public testing::TestWithParam<Checked> {};

TEST_P(LoadChecks, StandApartFromTheRequirementsAndFailByAnyFlight) {
  Campaign campaign = WithLimit();
  if (!GetParam().is_required) campaign.requirements.clear();
  const CampaignSummary summary = Flown(campaign, GetParam().beyond);
  EXPECT_EQ(summary.requirements.size(), campaign.requirements.size());
  EXPECT_STREQ(StandingVerdictName(summary.standing.verdict), StandingVerdictName(GetParam().standing));
  const auto json = nlohmann::json::parse(SummaryJson(summary));
  EXPECT_EQ(json["load_checks"],
            nlohmann::json::array(
                {{{"metric", "structural_limit_exceeded"}, {"n", 40}, {"failures", GetParam().beyond}}}));
  const std::string junit = JUnitXml(summary);
  EXPECT_THAT(junit, HasSubstr(GetParam().beyond > 0 ? "failures=\"1\"" : "failures=\"0\""));
  EXPECT_THAT(junit, HasSubstr(std::to_string(GetParam().beyond) + " of 40 flights went beyond a limit"));
}

INSTANTIATE_TEST_SUITE_P(
    All, LoadChecks,
    testing::Values(Checked{"None", 0, true, StandingVerdict::kPass},
                    Checked{"One", 1, true, StandingVerdict::kFail},
                    Checked{"Three", 3, true, StandingVerdict::kFail},
                    Checked{"NothingRequired", 0, false, StandingVerdict::kNothingJudged},
                    Checked{"OneWhereNothingIsRequired", 1, false, StandingVerdict::kFail}),
    [](const auto& row) { return row.param.name; });

TEST(UndefinedMetric, OfACompletedFlightIsAFailure) {
  const CampaignSummary three = Flown(WithLimit(), 0, 3);
  EXPECT_EQ(three.requirements[0].failures, 3);
  EXPECT_EQ(three.requirements[0].lost_flights, 0);
  EXPECT_EQ(three.requirements[0].not_measured, 3);
  EXPECT_THAT(three.requirements[0].sentence, HasSubstr("not measured in 3"));
  const CampaignSummary all = Flown(WithLimit(), 0, 40);
  EXPECT_EQ(all.standing.verdict, StandingVerdict::kFail);
  EXPECT_THAT(JUnitXml(all), HasSubstr("not measured in 40 flights"));
}

// 100 flights without failure, of another engine or of this one, and 40 of the campaign's own that pass.
TEST(AnotherEngine, ShowsNothing) {
  Campaign campaign = WithLimit();
  AttemptRecord earlier = RecordOf(campaign);
  earlier.id = "earlier";
  earlier.seed = 8;
  earlier.planned = earlier.cases = 100;
  earlier.requirements[0].verdict = "pass";
  EXPECT_EQ(Flown(campaign, 0, 0, {earlier}).standing.requirements[0].pool_cases, 140);
  earlier.engine = "another";
  const CampaignSummary other = Flown(campaign, 0, 0, {earlier});
  EXPECT_EQ(other.standing.requirements[0].pool_cases, 40);
  // Two failures of 40 are open by themselves; what the other engine flew does not decide.
  const CampaignSummary open = Flown(campaign, 0, 2, {earlier});
  EXPECT_EQ(open.requirements[0].verdict, "inconclusive");
  EXPECT_NE(open.standing.verdict, StandingVerdict::kPass);
  EXPECT_THAT(open.standing.requirements[0].reason, Not(HasSubstr("140")));
}

// Two of the cases again: this engine has flown two, whatever the other one showed with all of them.
TEST(AnotherEngine, DoesNotPassItsOwnCasesFlownAgain) {
  Campaign campaign = WithLimit();
  AttemptRecord earlier = RecordOf(campaign);
  earlier.id = "earlier";
  earlier.planned = earlier.cases = 100;
  earlier.requirements[0].verdict = "pass";
  campaign.sampling.cases = 2;
  EXPECT_EQ(Flown(campaign, 0, 0, {earlier}).standing.verdict, StandingVerdict::kPass);
  earlier.engine = "another";
  const CampaignSummary other = Flown(campaign, 0, 0, {earlier});
  EXPECT_EQ(other.standing.verdict, StandingVerdict::kInconclusive);
  EXPECT_EQ(other.standing.requirements[0].pool_cases, 2);
}

}  // namespace
}  // namespace dispersa::analysis_load_check_test
