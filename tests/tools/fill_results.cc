// Writes a result folder with any number of cases, to measure the programs that read it. Inputs are drawn by
// the campaign; metrics are made up from those of a few flights. Make its reports with --no-histories: the
// flights were not flown.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/random/draws.h"
#include "core/results/result_folder.h"

namespace dispersa {
namespace {

constexpr std::uint64_t kFlown = 16;

/// A flown case's metrics, moved by a tenth as the first inputs and chance have it. One in 5000 is lost.
CaseResult MadeUp(const CampaignFlights& flights, const std::vector<CaseResult>& flown, std::uint64_t index,
                  std::uint64_t seed) {
  CaseResult result = flown[index % flown.size()];
  result.case_index = index;
  SetInputs(flights.rows(), InputValues(flights.Draw(index), flights.rows().column_class()), result);
  Stream chance(seed, index, "made up");
  for (double& metric : result.metrics) metric *= 1.0 + 0.1 * chance.Normal();
  if (chance.Uniform() < 2e-4) {
    result.outcome = Outcome::kLostControl;
    result.end_time_s = 100.0 * chance.Uniform();
    result.end_stage = 1;
    result.reason = "made up";
  }
  result.digest = {index + 1, seed};
  return result;
}

void Fill(const std::string& file, const std::string& directory, std::uint64_t cases) {
  CampaignOverrides overrides;
  overrides.cases = cases;
  const Campaign campaign = LoadCampaign(file, overrides);
  const CampaignFlights flights(campaign);
  std::vector<CaseResult> flown;
  for (std::uint64_t i = 0; i < kFlown; ++i) flown.push_back(flights.FlyCase(i));
  ResultFolder folder = ResultFolder::Create(directory, campaign);
  std::vector<CaseResult> batch;
  for (std::uint64_t i = 0; i < cases; ++i) {
    batch.push_back(MadeUp(flights, flown, i, campaign.sampling.seed));
    if (batch.size() < 5000 && i + 1 < cases) continue;
    folder.Append(batch);
    batch.clear();
  }
}

}  // namespace
}  // namespace dispersa

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: fill_results CAMPAIGN DIR CASES\n");
    return 2;
  }
  try {
    dispersa::Fill(argv[1], argv[2], std::strtoull(argv[3], nullptr, 10));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
