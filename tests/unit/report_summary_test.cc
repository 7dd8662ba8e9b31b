// The numbers of summary.json against numbers worked out by hand.
#include "core/report/campaign_summary.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/engine/version.h"
#include "tests/unit/report_test_support.h"

namespace dispersa {
namespace {

using report_test::kNaN;
using report_test::MakeCampaign;
using report_test::MakeCase;
using report_test::TemporaryFolder;
using testing::ElementsAre;

const char kPeak[] = "pitch_error_peak_deg";

Requirement PeakBelow(double limit, double probability, double consumer_risk) {
  return {.metric = kPeak,
          .below = limit,
          .above = std::nullopt,
          .probability = probability,
          .consumer_risk = consumer_risk};
}

/// n completed cases whose peak is 0.1, but for the first `failures`, whose peak is 0.9.
CaseColumns Columns(std::size_t n, std::size_t failures) {
  CaseColumns cases;
  cases.inputs.resize(InputColumns().size());
  cases.metrics.resize(MetricNames().size());
  for (std::size_t i = 0; i < n; ++i) {
    cases.index.push_back(i);
    cases.outcome.push_back(Outcome::kCompleted);
    cases.metrics[MetricColumn(kPeak)].push_back(i < failures ? 0.9 : 0.1);
  }
  return cases;
}

TEST(Judge, NeedsTheCasesOfTheExactBinomial) {
  // 99.73 % at 10 % consumer risk: 852 cases without a failure, 1440 with one (0.9973^852 = 0.0999).
  const Requirement requirement = PeakBelow(0.5, 0.9973, 0.10);
  const RequirementSummary enough = Judge(requirement, SamplingMethod::kMonteCarlo, Columns(852, 0), 0);
  EXPECT_EQ(enough.verdict, "pass");
  EXPECT_FALSE(enough.cases_needed.has_value());
  EXPECT_NEAR(*enough.success_lower, std::pow(0.10, 1.0 / 852), 1e-12);  // Clopper-Pearson without a failure
  EXPECT_EQ(enough.sentence,
            "Met: 0 failures in 852 cases show a probability of at least 99.73 % with 90 % confidence; 99.73 "
            "% is required.");

  const RequirementSummary one_less = Judge(requirement, SamplingMethod::kMonteCarlo, Columns(851, 0), 0);
  EXPECT_EQ(one_less.verdict, "inconclusive");
  EXPECT_EQ(one_less.cases_needed, 852);

  const RequirementSummary one_failure = Judge(requirement, SamplingMethod::kMonteCarlo, Columns(852, 1), 0);
  EXPECT_EQ(one_failure.verdict, "inconclusive");
  EXPECT_EQ(one_failure.failures, 1);
  EXPECT_EQ(one_failure.cases_needed, 1440);

  // Ten failures in 200 cases: a design with 99.73 % would show so many with a probability below 1e-9.
  const RequirementSummary failed = Judge(requirement, SamplingMethod::kMonteCarlo, Columns(200, 10), 0);
  EXPECT_EQ(failed.verdict, "fail");
}

TEST(Judge, SaysWhyNothingIsDecided) {
  // 200 cases without a failure: 0.1^(1/200) = 0.98855.
  EXPECT_EQ(Judge(PeakBelow(0.5, 0.9973, 0.10), SamplingMethod::kMonteCarlo, Columns(200, 0), 0).sentence,
            "Not decided: 0 failures in 200 cases show a probability of at least 98.855 % with 90 % "
            "confidence, short of "
            "the 99.73 % required; that takes 852 cases in all if no further one fails.");
}

TEST(Judge, CountsALostFlightWhateverItMeasured) {
  CaseColumns cases = Columns(100, 0);
  cases.outcome[3] = Outcome::kLostControl;
  cases.outcome[4] = Outcome::kImpact;
  cases.metrics[MetricColumn(kPeak)][7] = kNaN;
  const RequirementSummary summary = Judge(PeakBelow(0.5, 0.9, 0.10), SamplingMethod::kMonteCarlo, cases, 0);
  EXPECT_EQ(summary.n, 100);
  EXPECT_EQ(summary.failures, 3);
  EXPECT_EQ(summary.lost_flights, 2);
}

TEST(Judge, TheLimitItselfFails) {
  EXPECT_EQ(Judge(PeakBelow(0.1, 0.9, 0.1), SamplingMethod::kMonteCarlo, Columns(10, 0), 0).failures, 10);
}

TEST(Judge, LooksAboveToo) {
  const Requirement above = {
      .metric = kPeak, .below = std::nullopt, .above = 0.5, .probability = 0.5, .consumer_risk = 0.1};
  const RequirementSummary summary = Judge(above, SamplingMethod::kMonteCarlo, Columns(10, 4), 0);
  EXPECT_FALSE(summary.below);
  EXPECT_EQ(summary.failures, 6);  // those at 0.1
}

TEST(Judge, MissingCasesCountAgainstEitherVerdict) {
  // 852 successes pass, but not beside 100 cases of which nothing is known.
  EXPECT_EQ(Judge(PeakBelow(0.5, 0.9973, 0.10), SamplingMethod::kMonteCarlo, Columns(852, 0), 100).verdict,
            "inconclusive");
  // 3 failures of 20 fail 99 %, but not if 2000 more might all have been successes.
  EXPECT_EQ(Judge(PeakBelow(0.5, 0.99, 0.10), SamplingMethod::kMonteCarlo, Columns(20, 3), 0).verdict,
            "fail");
  EXPECT_EQ(Judge(PeakBelow(0.5, 0.99, 0.10), SamplingMethod::kMonteCarlo, Columns(20, 3), 2000).verdict,
            "inconclusive");
}

TEST(Judge, GivesNoConfidenceToADesign) {
  const RequirementSummary corners =
      Judge(PeakBelow(0.5, 0.9973, 0.10), SamplingMethod::kCorners, Columns(16, 0), 0);
  EXPECT_EQ(corners.verdict, "pass");
  EXPECT_FALSE(corners.success_lower.has_value());
  EXPECT_EQ(corners.sentence,
            "Design study: 16 of 16 flown points meet the limit; 99.73 % of them are required. This says "
            "nothing about the "
            "probability in flight.");
  EXPECT_EQ(Judge(PeakBelow(0.5, 0.9973, 0.10), SamplingMethod::kCorners, Columns(16, 1), 0).verdict, "fail");
  EXPECT_EQ(Judge(PeakBelow(0.5, 0.9973, 0.10), SamplingMethod::kGrid, Columns(15, 0), 1).verdict,
            "inconclusive");
  EXPECT_EQ(Judge(PeakBelow(0.5, 0.95, 0.10), SamplingMethod::kCorners, Columns(320, 16), 0).verdict,
            "pass");  // 95 %
  EXPECT_EQ(Judge(PeakBelow(0.5, 0.95, 0.10), SamplingMethod::kCorners, Columns(320, 17), 0).verdict, "fail");

  const RequirementSummary latin =
      Judge(PeakBelow(0.5, 0.95, 0.10), SamplingMethod::kLatinHypercube, Columns(1000, 0), 0);
  EXPECT_EQ(latin.verdict, "inconclusive");
  EXPECT_FALSE(latin.success_upper.has_value());
  EXPECT_FALSE(latin.cases_needed.has_value());
  EXPECT_EQ(latin.sentence,
            "Design study: 1000 of 1000 points meet the limit. Binomial confidence limits do not hold for "
            "this design; fly "
            "Monte Carlo for a verdict.");
  EXPECT_EQ(Judge(PeakBelow(0.5, 0.95, 0.10), SamplingMethod::kSobol, Columns(1000, 500), 0).verdict, "fail");
}

/// Five cases, peaks 1 2 3 4 of the completed ones; case 2 is lost.
class FiveCases : public testing::Test {
 protected:
  FiveCases() : campaign_(MakeCampaign(5)), folder_(ResultFolder::Create(temporary_ / "out", campaign_)) {
    const double peaks[] = {2.0, 4.0, 0.5, 1.0, 3.0};
    std::vector<CaseResult> results;
    for (std::uint64_t k = 0; k < 5; ++k) {
      CaseResult result = MakeCase(k);
      result.metrics[MetricColumn(kPeak)] = peaks[k];
      if (k == 2) {
        result.outcome = Outcome::kLostControl;
        result.reason = "gone";
        result.end_time_s = 60.0;
        result.end_stage = 2;
        result.metrics[MetricColumn("apogee_km")] = kNaN;
      }
      results.push_back(result);
    }
    folder_.Append(results);
  }

  TemporaryFolder temporary_;
  Campaign campaign_;
  ResultFolder folder_;
};

TEST_F(FiveCases, StatisticsAreThoseWorkedOutByHand) {
  const CampaignSummary summary = BuildSummary(folder_, campaign_);
  EXPECT_EQ(summary.flown, 5u);
  EXPECT_EQ(summary.outcomes[static_cast<std::size_t>(Outcome::kCompleted)], 4u);
  EXPECT_EQ(summary.outcomes[static_cast<std::size_t>(Outcome::kLostControl)], 1u);
  const Summary& peak = summary.metrics[MetricColumn(kPeak)].statistics;
  EXPECT_EQ(peak.n, 5u);
  EXPECT_DOUBLE_EQ(peak.mean, 2.1);
  // Deviations -1.6 -1.1 -0.1 0.9 1.9: squares 2.56 1.21 0.01 0.81 3.61, sum 8.2.
  EXPECT_NEAR(peak.std, std::sqrt(8.2 / 4.0), 1e-15);
  EXPECT_EQ(peak.p50, 2.0);
  EXPECT_EQ(peak.max, 4.0);
  EXPECT_EQ(summary.metrics[MetricColumn("apogee_km")].statistics.n, 4u);
  EXPECT_EQ(summary.metrics[MetricColumn("apogee_km")].statistics.undefined, 1u);
}

TEST_F(FiveCases, WorstCasesBeginWithALostOne) {
  const CampaignSummary summary = BuildSummary(folder_, campaign_);
  ASSERT_FALSE(summary.worst_cases.empty());
  EXPECT_EQ(summary.worst_cases[0].metric, kPeak);
  std::vector<std::uint64_t> order;
  for (const WorstCase& worst : summary.worst_cases[0].cases) order.push_back(worst.case_index);
  EXPECT_THAT(order, ElementsAre(2, 1, 4, 0, 3));
  EXPECT_EQ(summary.worst_cases[0].cases[1].value, 4.0);
  ASSERT_EQ(summary.lost_flights.size(), 1u);
  EXPECT_EQ(summary.lost_flights[0].end_stage, 2);
}

TEST_F(FiveCases, RanksByTheSideOfTheRequirement) {
  campaign_.requirements = {
      {.metric = kPeak, .below = std::nullopt, .above = 0.1, .probability = 0.5, .consumer_risk = 0.1}};
  const CampaignSummary summary = BuildSummary(folder_, campaign_);
  std::vector<std::uint64_t> order;
  for (const WorstCase& worst : summary.worst_cases[0].cases) order.push_back(worst.case_index);
  EXPECT_THAT(order, ElementsAre(2, 3, 0, 4, 1));
}

TEST_F(FiveCases, TheVerdictAndItsExitCode) {
  EXPECT_EQ(BuildSummary(folder_, campaign_).verdict, CampaignVerdict::kPass);  // nothing is required
  campaign_.requirements = {PeakBelow(10.0, 0.5, 0.40)};  // 1 failure of 5: P(X <= 1 | 0.5) = 6/32 < 0.4
  EXPECT_EQ(BuildSummary(folder_, campaign_).verdict, CampaignVerdict::kPass);
  campaign_.requirements.push_back(PeakBelow(10.0, 0.99, 0.10));  // P(X >= 1 | 0.99) = 0.049 <= 0.1
  campaign_.requirements.push_back(PeakBelow(10.0, 0.9, 0.10));
  CampaignSummary summary = BuildSummary(folder_, campaign_);
  EXPECT_EQ(summary.requirements[1].verdict, "fail");
  EXPECT_EQ(summary.requirements[2].verdict, "inconclusive");
  EXPECT_EQ(summary.verdict, CampaignVerdict::kFail);
  campaign_.requirements.erase(campaign_.requirements.begin() + 1);
  EXPECT_EQ(BuildSummary(folder_, campaign_).verdict, CampaignVerdict::kInconclusive);
  campaign_.sampling.cases = 6;
  EXPECT_EQ(BuildSummary(folder_, campaign_).verdict, CampaignVerdict::kIncomplete);

  EXPECT_EQ(VerdictExitCode(CampaignVerdict::kPass), 0);
  EXPECT_EQ(VerdictExitCode(CampaignVerdict::kFail), 3);
  EXPECT_EQ(VerdictExitCode(CampaignVerdict::kInconclusive), 4);
  EXPECT_EQ(VerdictExitCode(CampaignVerdict::kIncomplete), 5);
}

TEST_F(FiveCases, JsonHoldsTheContract) {
  campaign_.sampling.cases = 6;
  campaign_.requirements = {PeakBelow(3.5, 0.9, 0.10)};
  folder_.Quarantine({5, "killed 3 workers"});
  const std::string text = SummaryJson(BuildSummary(folder_, campaign_));
  const nlohmann::json json = nlohmann::json::parse(text);
  EXPECT_EQ(json["schema"], "dispersa/summary/1");
  EXPECT_EQ(json["campaign"]["name"], "made_up");
  EXPECT_EQ(json["campaign"]["id"], std::string(64, '1'));
  EXPECT_EQ(json["campaign"]["flight_id"], std::string(64, '2'));
  EXPECT_EQ(json["campaign"]["seed"], 7);
  EXPECT_EQ(json["campaign"]["cases"], 6);
  EXPECT_EQ(json["engine"], EngineVersion());
  EXPECT_EQ(json["verdict"], "incomplete");
  EXPECT_EQ(json["outcomes"],
            nlohmann::json::parse(R"({"completed": 4, "lost_control": 1, "structural_limit": 0, "impact": 0,
                                                        "numerical_failure": 0, "timeout": 0})"));
  EXPECT_EQ(json["metrics"].size(), MetricNames().size());
  EXPECT_EQ(json["metrics"][kPeak]["n"], 5);
  EXPECT_EQ(json["metrics"][kPeak]["p50"], 2.0);
  EXPECT_EQ(json["metrics"][kPeak]["min"], 0.5);
  const nlohmann::json& requirement = json["requirements"][0];
  EXPECT_EQ(requirement["metric"], kPeak);
  EXPECT_EQ(requirement["limit"], 3.5);
  EXPECT_EQ(requirement["probability"], 0.9);
  EXPECT_EQ(requirement["consumer_risk"], 0.1);
  EXPECT_EQ(requirement["n"], 5);
  EXPECT_EQ(requirement["failures"], 2);
  EXPECT_EQ(requirement["verdict"], "inconclusive");
  EXPECT_TRUE(requirement["cases_needed"].is_number_integer());
  EXPECT_EQ(json["quarantined"],
            nlohmann::json::parse(R"([{"case_index": 5, "reason": "killed 3 workers"}])"));
  EXPECT_EQ(json["worst_cases"][0]["case_index"], 2);
  EXPECT_EQ(json["worst_cases"][0]["replay"], "dispersa replay . --case 2");
  EXPECT_EQ(json["nominal"], nullptr);
  EXPECT_EQ(text.back(), '\n');
}

TEST(SummaryJson, WritesUndefinedAsNull) {
  TemporaryFolder temporary;
  const Campaign campaign = MakeCampaign(2);
  const ResultFolder folder = ResultFolder::Create(temporary / "out", campaign);
  const nlohmann::json json = nlohmann::json::parse(SummaryJson(BuildSummary(folder, campaign)));
  EXPECT_EQ(json["metrics"][kPeak]["mean"], nullptr);
  EXPECT_EQ(json["metrics"][kPeak]["n"], 0);
  EXPECT_EQ(json["verdict"], "incomplete");
}

TEST(SummaryJson, DoesNotDependOnTheOrderOfArrival) {
  TemporaryFolder temporary;
  const Campaign campaign = MakeCampaign(30);
  ResultFolder ascending = ResultFolder::Create(temporary / "ascending", campaign);
  ResultFolder descending = ResultFolder::Create(temporary / "descending", campaign);
  for (std::uint64_t k = 0; k < 30; ++k) {
    ascending.Append({{MakeCase(k)}});
    descending.Append({{MakeCase(29 - k)}});
  }
  EXPECT_EQ(SummaryJson(BuildSummary(ascending, campaign)), SummaryJson(BuildSummary(descending, campaign)));
}

}  // namespace
}  // namespace dispersa
