// A row of cases.csv is a flight: flown again as a list's table it has the same inputs, to the bit, and the
// same digest.
#include "core/campaign/case_design.h"
#include "core/campaign/case_result.h"
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/math/constants.h"
#include "core/random/draws.h"
#include "core/results/cases_csv.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::cases_rows_again_test {
namespace {

constexpr std::uint64_t kRows = 3;

// What a folder of these results has in cases.csv.
std::string CasesCsvOf(const Campaign& campaign, const std::vector<CaseResult>& results) {
  CsvColumns columns;
  const RowInputs rows(campaign);
  for (std::size_t i = 0; i < rows.positions().size(); ++i) columns.inputs.push_back(i);
  columns.metrics = MeasuredMetrics(campaign);
  std::string text = CasesCsvHeader(rows, MetricsOf(campaign), columns);
  for (const CaseResult& result : results) text += CasesCsvLine(result, columns);
  return text;
}

// Rows as drawn, with metrics that nothing measured, and a reason that needs quotes.
std::vector<CaseResult> DrawnRows(const Campaign& campaign, const CaseDesign& design) {
  const RowInputs rows(campaign);
  std::vector<CaseResult> drawn;
  for (std::uint64_t i = 0; i < kRows; ++i) {
    CaseResult row;
    row.case_index = i;
    row.reason = i == 1 ? "lost, at \"once\"\nand for good" : "";
    SetInputs(rows, InputValues(design.Draw(i), rows.column_class()), row);
    row.metrics.assign(MetricsOf(campaign).size(), std::nan(""));
    drawn.push_back(row);
  }
  return drawn;
}

std::string Without(std::string text, std::initializer_list<const char*> keys) {
  for (const std::string key : keys) {
    const std::size_t at = text.find("\n" + key + ":");
    if (at == std::string::npos) continue;
    std::size_t end = text.find('\n', at + 1);
    while (end + 1 < text.size() && text[end + 1] == ' ') end = text.find('\n', end + 1);
    text.erase(at, end - at);
  }
  return text;
}

// The campaign of a text without `sampling`, whose cases are the table's rows.
Campaign Listed(const std::string& text, const std::string& table, std::uint64_t seed = 1) {
  const InputFiles files;
  files.Write("cases.csv", table);
  files.Write("again.yaml", text + "sampling: {method: list, cases: " + std::to_string(kRows) +
                                ", seed: " + std::to_string(seed) + ", table: cases.csv}\n");
  return LoadCampaign(files.Path("again.yaml"));
}
// The same campaign; by the rows alone, or beside the dispersions that drew them.
Campaign Listed(const Campaign& campaign, const std::string& table, bool alone) {
  std::string text = Without("\n" + campaign.canonical_yaml, {"sampling", "requirements", "verdicts"});
  if (alone) text = Without(text, {"dispersions", "derived", "correlations"});
  return Listed(text, table, campaign.sampling.seed);
}

void ExpectSameInputs(const CaseDesign& first, const CaseDesign& again, const std::string& what) {
  for (std::uint64_t i = 0; i < kRows; ++i) {
    FlightInputs a = first.Draw(i), b = again.Draw(i);
    for (std::size_t column = 0; column < InputColumns().size(); ++column) {
      const double x = InputValue(a, static_cast<int>(column)), y = InputValue(b, static_cast<int>(column));
      EXPECT_EQ(std::memcmp(&x, &y, sizeof x), 0)
          << what << ", case " << i << ": " << InputColumns()[column].name << " " << x << " " << y;
    }
  }
}

TEST(RowsAgain, HaveTheSameInputsInEveryShippedCampaign) {
  int campaigns = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(DISPERSA_CAMPAIGNS)) {
    if (entry.path().extension() != ".yaml") continue;
    Campaign campaign;
    try {
      campaign = LoadCampaign(entry.path().string());
    } catch (const InputError&) {
      continue;  // one to optimise, or no campaign
    }
    if (campaign.dispersions.empty()) continue;
    const CaseDesign design(campaign);
    const std::string table = CasesCsvOf(campaign, DrawnRows(campaign, design));
    for (const bool alone : {true, false})
      ExpectSameInputs(design, CaseDesign(Listed(campaign, table, alone)),
                       entry.path().filename().string() + (alone ? ", rows alone" : ""));
    ++campaigns;
  }
  EXPECT_GE(campaigns, 15);
}

// One draw moves thrust and mass flow of all stages.
TEST(RowsAgain, AListedInputLeavesTheOthersOfItsDraw) {
  const std::string smoke = "\n" + LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml").canonical_yaml;
  const Campaign listed =
      Listed(Without(smoke, {"sampling", "dispersions", "requirements", "verdicts"}) +
                 "dispersions: {propellant_temperature: {distribution: normal, three_sigma_k: 45, "
                 "sensitivity_percent_per_k: 0.2, per: vehicle}}\n",
             "thrust_factor_stage1\n1.01\n0.98\n1\n");
  const CaseDesign design(listed);
  const double rows[] = {1.01, 0.98, 1.0};
  for (std::uint64_t i = 0; i < kRows; ++i) {
    FlightInputs in = design.Draw(i);
    const auto input = [&](const char* name) { return InputValue(in, FindInput(name)); };
    EXPECT_EQ(input("thrust_factor_stage1"), rows[i]);
    EXPECT_NE(input("thrust_factor_stage2"), 1.0);
    EXPECT_EQ(input("thrust_factor_stage2"), input("mass_flow_factor_stage1"));
  }
}

// Winds by level, gusts, turbulence, noise, angles, factors, delays: all that `full` draws.
TEST(RowsAgain, HaveTheSameDigests) {
  const std::string file = DISPERSA_CAMPAIGNS "/full.yaml";
  const Campaign campaign = LoadCampaign(file);
  const CampaignFlights flights(campaign);
  std::vector<CaseResult> flown;
  for (std::uint64_t i = 0; i < kRows; ++i) flown.push_back(flights.FlyCase(i));
  const CampaignFlights listed(Listed(campaign, CasesCsvOf(campaign, flown), true));
  for (std::uint64_t i = 0; i < kRows; ++i) {
    const CaseResult result = listed.FlyCase(i);
    EXPECT_EQ(result.digest, flown[i].digest) << i;
    EXPECT_EQ(result.inputs_digest, flown[i].inputs_digest) << i;
  }
  // A column holds the wind that was flown, at the altitude beside it.
  const auto input = [&](const char* name) {
    return flights.rows().AllOf(flown[0].inputs)[static_cast<std::size_t>(FindInput(name))];
  };
  const WindStatistics& winds = *campaign.wind_statistics;
  EXPECT_EQ(input("wind_profile_altitude_5_m"), winds.altitude_m[4]);
  EXPECT_NEAR(input("wind_profile_east_5_m_s"), winds.mean_east_m_s[4], 6.0 * winds.sigma_east_m_s[4]);
  EXPECT_NE(input("wind_profile_east_5_m_s"), winds.mean_east_m_s[4]);
}

// The value in the column's unit, once converted, comes back to itself: any angle, of any size.
TEST(RowsAgain, AnglesComeBackToTheBit) {
  for (std::uint64_t i = 0; i < 20000; ++i) {
    Stream stream(1, i, "angles");
    FlightInputs in;
    in.air.wind_azimuth_rad = std::ldexp(stream.Normal(), static_cast<int>(i % 60) - 40);
    TakeColumns(in);
    const double flown_rad = in.air.wind_azimuth_rad;
    const double column_deg = InputValues(in)[static_cast<std::size_t>(FindInput("wind_azimuth_deg"))];
    EXPECT_EQ(column_deg * kRadPerDeg, flown_rad) << i;
  }
}

}  // namespace
}  // namespace dispersa::cases_rows_again_test
