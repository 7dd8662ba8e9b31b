// Inputs that follow from drawn ones: what they are, and every refusal in full.
#include "core/campaign/derived_input.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/campaign/case_design.h"
#include "core/campaign_yaml/load.h"
#include "core/cases/campaign_flights.h"
#include "core/search/dispersion_space.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_derived_input_test {
namespace {

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
    "azimuth: "
    "uniform}\n";

Campaign With(const std::string& items, const std::string& method = "monte_carlo") {
  std::string text = kDrawn;
  text.replace(text.find("METHOD"), 6, method);
  const InputFiles files;
  files.Write("derived.yaml", text + (items.empty() ? "" : "derived:\n" + items));
  return LoadCampaign(files.Path("derived.yaml"));
}

std::string TextsOf(const std::string& items) {
  std::string text = kDrawn;
  text.replace(text.find("METHOD"), 6, "monte_carlo");
  const auto line = std::count(text.begin(), text.end(), '\n') + 2;
  const InputFiles files;
  files.Write("derived.yaml", text + "derived:\n" + items);
  std::string texts = files.Texts(CheckFile(files.Path("derived.yaml")).errors);
  for (int item = 0; item < 2; ++item) {
    const std::string at = "derived.yaml:" + std::to_string(line + item) + ":";
    for (std::size_t i = 0; (i = texts.find(at)) != std::string::npos;)
      texts.replace(i, at.size(), std::to_string(item + 1) + ":");
  }
  return texts;
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

TEST(DerivedInput, IsRefusedWithItsPlace) {
  constexpr char kNames[] =
      ", allowed: a column of cases.csv without 'input_', such as thrust_factor_stage1\n";
  EXPECT_EQ(
      TextsOf("  - {input: densty_factor, expression: drag_factor}\n"),
      std::string("1:13: derived[0].input: 'densty_factor' is not an input of this vehicle's flights (did "
                  "you mean 'density_factor'?)") +
          kNames);
  EXPECT_EQ(TextsOf("  - {input: density_factor, expression: thrust_factor_stage5}\n"),
            std::string(
                "1:41: derived[0].expression: at character 1: 'thrust_factor_stage5' is not an input of this "
                "vehicle's flights (did you mean 'thrust_factor_stage1'?)") +
                kNames);
  EXPECT_EQ(
      TextsOf("  - {input: thrust_factor_stage2, expression: thrust_factor_stage1}\n"),
      "1:13: derived[0].input: 'thrust_factor_stage2' is drawn by the dispersion 'thrust/stage2', allowed: "
      "an input that no dispersion draws\n");
  EXPECT_EQ(TextsOf("  - {input: density_factor, expression: thrust_factor_stage1}\n"
                    "  - {input: drag_factor, expression: density_factor}\n"),
            "2:38: derived[1].expression: at character 1: 'density_factor' is derived itself, allowed: drawn "
            "inputs\n");
  EXPECT_EQ(TextsOf("  - {input: density_factor, expression: thrust_factor_stage1}\n"
                    "  - {input: density_factor, expression: thrust_factor_stage2}\n"),
            "2:13: derived[1].input: 'density_factor' is derived twice, allowed: each input once\n");
  EXPECT_EQ(
      TextsOf("  - {input: density_factor, expression: log(gust_speed_m_s)}\n"),
      "1:41: derived[0].expression: it has no value for the nominal flight's inputs, allowed: an expression "
      "that is finite there\n");
  EXPECT_EQ(
      TextsOf("  - {input: drag_factor, expression: density_factor}\n"
              "  - {input: density_factor, expression: thrust_factor_stage1}\n"),
      "2:13: derived[1].input: the expression of 'drag_factor' takes 'density_factor', allowed: an input "
      "that no expression takes\n");
  EXPECT_NE(TextsOf("  - {input: density_factor, expression: max(thrust_factor_stage1)}\n"), "");
}

}  // namespace
}  // namespace dispersa::campaign_derived_input_test
