// Flights that show no more than one of them, with the full sentences.
#include "core/analysis/likeness.h"

#include <gtest/gtest.h>

#include <string>

#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/results/result_folder.h"
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
    "{fin_cant: {distribution: normal, sigma_deg: 0.1}, density: {distribution: normal, sigma_percent: 1}}\n";
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

TEST(WhyNoEvidence, ComparesTheDigestsOfAFolder) {
  const Campaign campaign = With(kRead);
  const InputFiles files;
  const auto alike = [&](const std::string& name, std::vector<std::uint64_t> digests) {
    ResultFolder folder = ResultFolder::Create(files.Path(name), campaign);
    std::vector<CaseResult> results;
    for (const std::uint64_t digest : digests) {
      CaseResult result;
      result.case_index = results.size();
      result.inputs = InputValues(FlightInputs{}, ColumnClass(campaign.vehicle));
      result.metrics.assign(MetricsOf(campaign).size(), kUndefined);
      result.digest = {digest, 1};
      results.push_back(result);
    }
    folder.Append(results);
    return ReadColumns(folder, {}).are_alike;
  };
  EXPECT_FALSE(alike("one", {5}));
  EXPECT_TRUE(alike("two", {5, 5}));
  EXPECT_TRUE(alike("three", {5, 5, 5}));
  EXPECT_FALSE(alike("last", {5, 5, 6}));
  EXPECT_FALSE(alike("first", {6, 5, 5}));
}

}  // namespace
}  // namespace dispersa::analysis_likeness_test
