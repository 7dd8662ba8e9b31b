// Flights that show no more than one of them, with the full sentences.
#include "core/analysis/likeness.h"

#include "core/analysis/campaign_summary.h"
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/results/result_folder.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::analysis_likeness_test {
namespace {

Campaign With(const std::string& dispersions) {
  const InputFiles files;
  files.Write("alike.yaml",
              "schema: dispersa/campaign/1\nname: alike\n"
              "vehicle: " DISPERSA_CAMPAIGNS
              "/vehicles/slv4.yaml\n"
              "reference: " DISPERSA_CAMPAIGNS
              "/references/slv4_500km.yaml\n"
              "autopilot: " DISPERSA_CAMPAIGNS
              "/autopilots/adaptive_fuzzy.yaml\n"
              "sampling: {method: monte_carlo, cases: 3, seed: 1}\n"
              "dispersions: " +
                  dispersions);
  return LoadCampaign(files.Path("alike.yaml"));
}

CaseColumns Rows(std::size_t count, bool are_alike) {
  CaseColumns cases;
  cases.index.resize(count);
  cases.are_alike = are_alike;
  return cases;
}

constexpr char kRead[] = "{density: {distribution: normal, sigma_percent: 1}}\n";
constexpr char kUnread[] = "{fin_cant: {distribution: normal, sigma_deg: 0.1, per: stage}}\n";
constexpr char kBoth[] =
    "{fin_cant: {distribution: normal, sigma_deg: 0.1, per: stage}, density: {distribution: normal, "
    "sigma_percent: 1}}\n";
constexpr char kConstant[] = "{density: {distribution: constant, value_factor: 1.1}}\n";
constexpr char kNoise[] = "{gyro_noise: {distribution: constant, value_deg_s: 0.01}}\n";
constexpr char kTurbulence[] = "{turbulence: {severity: light}}\n";

TEST(WhyNoEvidence, SaysWhatIsMissing) {
  const std::string none = "No input varies from case to case: 3 flights show no more than one.";
  const struct {
    const char* dispersions;
    bool are_alike;
    std::string why;
  } rows[] = {
      {"{}\n", true, none},
      {kConstant, true, none},
      {kConstant, false, none},
      {kUnread, true,
       "No part of the flight reads what varies (dispersions.fin_cant: no stage that it draws for has fins): "
       "3 flights show no more than one."},
      {kRead, true,
       "All 3 flights are alike to the last bit, although their inputs vary: they show no more than one."},
      {kRead, false, ""},
      {kBoth, false, ""},
      {kNoise, false, ""},
      {kTurbulence, false, ""},
  };
  for (const auto& row : rows) {
    const Campaign campaign = With(row.dispersions);
    EXPECT_EQ(WhyNoEvidence(campaign, Rows(3, row.are_alike)), row.why) << row.dispersions;
    EXPECT_EQ(WhyNoEvidence(campaign, Rows(1, row.are_alike)), "") << "one flight claims nothing";
  }
}

// A folder of results with these digests, whose metrics are all 0.1.
CampaignSummary Summary(const Campaign& campaign, const std::vector<std::uint64_t>& digests) {
  const InputFiles files;
  ResultFolder folder = ResultFolder::Create(files.Path("out"), campaign);
  std::vector<CaseResult> results;
  for (const std::uint64_t digest : digests) {
    CaseResult& result = results.emplace_back();
    result.case_index = results.size() - 1;
    result.outcome = Outcome::kCompleted;
    const RowInputs rows(campaign);
    SetInputs(rows, rows.AllOf(std::vector<double>(rows.positions().size(), 1.0)), result);
    result.metrics.assign(MetricsOf(campaign).size(), 0.1);
    result.digest = {digest, 1};
  }
  folder.Append(results);
  return BuildSummary(folder, campaign);
}

// `probability` 0.4 at a risk of 0.3: one flight passes nothing, two and three would.
std::string Requiring(const char* dispersions, const char* limit) {
  return std::string(dispersions) + "requirements:\n  - {metric: pitch_error_peak_deg, " + limit +
         ", probability: 0.4, consumer_risk: 0.3}\n";
}

TEST(WhyNoEvidence, ComparesAllDigestsOfAFolder) {
  const Campaign campaign = With(Requiring(kRead, "below: 1"));
  Campaign two = campaign;
  two.sampling.cases = 2;
  EXPECT_EQ(Summary(two, {5, 5}).verdict, CampaignVerdict::kNotEvidence);
  EXPECT_EQ(Summary(campaign, {5, 5, 5}).verdict, CampaignVerdict::kNotEvidence);
  EXPECT_EQ(Summary(campaign, {5, 5, 6}).verdict, CampaignVerdict::kPass);
  EXPECT_EQ(Summary(campaign, {6, 5, 5}).verdict, CampaignVerdict::kPass);
}

TEST(WhyNoEvidence, DecidesARequirementThatStatesAProbability) {
  const auto flown = [](const char* dispersions, const char* limit) {
    return Summary(With(Requiring(dispersions, limit)), {1, 2, 3});
  };
  EXPECT_EQ(flown(kRead, "below: 1").standing.verdict, StandingVerdict::kPass);
  const CampaignSummary unread = flown(kUnread, "below: 1");
  EXPECT_EQ(unread.verdict, CampaignVerdict::kNotEvidence);
  EXPECT_EQ(unread.standing.verdict, StandingVerdict::kNotEvidence);
  EXPECT_EQ(unread.standing.requirements[0].verdict, "not_evidence");
  EXPECT_EQ(
      unread.requirements[0].sentence,
      "0 of 3 flights broke the limit. No part of the flight reads what varies (dispersions.fin_cant: no "
      "stage that it draws for has fins): 3 flights show no more than one.");
  EXPECT_EQ(unread.requirements[0].success_lower, std::nullopt);
  EXPECT_EQ(flown(kConstant, "below: 1").standing.verdict, StandingVerdict::kNotEvidence);
  EXPECT_EQ(flown(kUnread, "below: 0.05").standing.verdict, StandingVerdict::kFail) << "a failure is one";
}

}  // namespace
}  // namespace dispersa::analysis_likeness_test
