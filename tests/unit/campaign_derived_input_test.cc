// Inputs that follow from drawn ones: what they are, and every refusal in full.
#include "core/campaign/derived_input.h"

#include "core/campaign/case_design.h"
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/search/dispersion_space.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_derived_input_test {

constexpr char kDrawn[] =
    "schema: dispersa/campaign/1\nname: derived\n"
    "vehicle: " DISPERSA_CAMPAIGNS
    "/vehicles/slv4.yaml\n"
    "reference: " DISPERSA_CAMPAIGNS
    "/references/slv4_500km.yaml\n"
    "autopilot: " DISPERSA_CAMPAIGNS
    "/autopilots/adaptive_fuzzy.yaml\n"
    "sampling: {method: METHOD, cases: 8, seed: 3}\n"
    "dispersions:\n"
    "  thrust: {distribution: normal, three_sigma_percent: 2, conserve: total_impulse, per: stage}\n"
    "  gust: {speed_m_s: 9, altitude: {distribution: uniform, low_km: 4, high_km: 14}, length_m: 600, "
    "azimuth: uniform}\n";

Campaign With(const std::string& items, const std::string& method = "monte_carlo") {
  std::string text = kDrawn;
  text.replace(text.find("METHOD"), 6, method);
  const InputFiles files;
  files.Write("derived.yaml", text + (items.empty() ? "" : "derived:\n" + items));
  return LoadCampaign(files.Path("derived.yaml"));
}

constexpr char kFlow[] =
    "  - {input: lift_factor, expression: 1 + 0.5 * (thrust_factor_stage1 - 1)}\n"
    "  - {input: wind_azimuth_deg, expression: gust_azimuth_deg + 10}\n";

TEST(DerivedInput, FollowsFromTheDrawsInTheUnitsOfItsColumns) {
  for (const std::string method : {"monte_carlo", "latin_hypercube", "sobol"}) {
    const CaseDesign plain(With("", method)), derived(With(kFlow, method));
    for (std::uint64_t k = 0; k < 8; ++k) {
      const FlightInputs before = plain.Draw(k);
      FlightInputs expected = before;
      expected.lift_factor = 1.0 + 0.5 * (before.stages[0].thrust_factor - 1.0);
      const FlightInputs drawn = derived.Draw(k);
      EXPECT_EQ(drawn.lift_factor, expected.lift_factor) << method;
      EXPECT_NEAR(drawn.air.wind_azimuth_rad, before.air.gust_azimuth_rad + 10.0 * kRadPerDeg, 1e-15);
      expected.air.wind_azimuth_rad = drawn.air.wind_azimuth_rad;
      EXPECT_EQ(InputValues(drawn), InputValues(expected)) << "and nothing else changes";
    }
  }
}

TEST(DerivedInput, IsPartOfTheFlightId) {
  const Campaign plain = With(""), derived = With(kFlow);
  EXPECT_NE(plain.flight_id, derived.flight_id);
  EXPECT_NE(plain.design_id, derived.design_id);
  const InputFiles files;
  files.Write("again.yaml", derived.canonical_yaml);
  const Campaign again = LoadCampaign(files.Path("again.yaml"));
  EXPECT_EQ(again.id, derived.id);
  EXPECT_EQ(InputValues(CaseDesign(again).Draw(5)), InputValues(CaseDesign(derived).Draw(5)));
}

// The search draws its own cases.
TEST(DerivedInput, FollowsInASearch) {
  const DispersionSpace space(With(kFlow));
  std::vector<double> point(space.coordinates().size(), 0.0);
  for (std::size_t i = 0; i < point.size(); ++i)
    if (space.coordinates()[i].name == "thrust/stage1") point[i] = 3.0;
  const FlightInputs inputs = space.Inputs({point})[0];
  EXPECT_NEAR(inputs.stages[0].thrust_factor, 1.02, 1e-12);
  EXPECT_NEAR(inputs.lift_factor, 1.01, 1e-12);
}

TEST(DerivedInput, WithoutAValueIsAFlightThatFails) {
  const Campaign campaign =
      With("  - {input: density_factor, expression: 1 + sqrt(thrust_factor_stage1 - 1)}\n");
  int failed = 0, flown = 0;
  for (std::uint64_t k = 0; k < 8; ++k) {
    const CaseResult result = CampaignFlights(campaign).FlyCase(k);
    if (CaseDesign(campaign).Draw(k).stages[0].thrust_factor < 1.0) {
      ++failed;
      EXPECT_EQ(result.outcome, Outcome::kNumericalFailure);
      EXPECT_EQ(result.reason, "the input density_factor has no value");
    } else {
      ++flown;
      EXPECT_NE(result.outcome, Outcome::kNumericalFailure);
    }
  }
  EXPECT_GT(failed, 0);
  EXPECT_GT(flown, 0);
}

}  // namespace dispersa::campaign_derived_input_test
