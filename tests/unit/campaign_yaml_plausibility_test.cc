// Implausible vehicles, texts in other encodings and slips of the pen, as a user reads them.
#include "core/campaign_yaml/load.h"
#include "core/input/read_value.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_plausibility_test {
namespace {

// The files' vehicle is of round numbers, and light.
const std::string kLightGrains =
    "vehicle.yaml:12:12: stages[0].grain: implies a propellant density of 663.1 kg/m3, usual: 1500 to 1950 "
    "kg/m3 "
    "(solid propellants: Sutton and Biblarz, table 12-1)\n"
    "vehicle.yaml:25:12: stages[1].grain: implies a propellant density of 589.5 kg/m3, usual: 1500 to 1950 "
    "kg/m3 "
    "(solid propellants: Sutton and Biblarz, table 12-1)\n";

TEST(CampaignYamlPlausibility, WhatIsUnusualIsAWarningAndNoError) {
  const InputFiles files;
  const FileCheck vehicle = CheckFile(files.Path("vehicle.yaml"));
  EXPECT_TRUE(vehicle.errors.empty());
  EXPECT_TRUE(vehicle.is_vehicle);
  ASSERT_TRUE(vehicle.vehicle);
  EXPECT_EQ(files.Texts(vehicle.warnings), kLightGrains);
  const FileCheck campaign = CheckFile(files.Path("campaign.yaml"));
  EXPECT_TRUE(campaign.errors.empty());
  EXPECT_FALSE(campaign.is_vehicle);
  EXPECT_THAT(files.Texts(campaign.warnings), HasSubstr(kLightGrains));
  std::vector<InputProblem> warnings;
  LoadVehicle(files.Path("vehicle.yaml"), &warnings);
  EXPECT_EQ(files.Texts(warnings), kLightGrains);
}

TEST(CampaignYamlPlausibility, WhatCannotBeIsAnErrorOfEveryReader) {
  const InputFiles files;
  files.Edit("vehicle.yaml", "burning_time_s: 60, ignition_rise_s: 0.2, tail_off_s: 0.4, p",
             "burning_time_s: 6000, ignition_rise_s: 0.2, tail_off_s: 0.4, p");
  const std::string text =
      "vehicle.yaml:8:25: stages[0].propellant_mass_kg: implies with thrust and burning time a specific "
      "impulse of "
      "24473 s, which cannot be, allowed: up to 1000 s (200 to 410 s of solid and liquid rockets: Sutton and "
      "Biblarz, "
      "Rocket Propulsion Elements, 7th ed., table 2-1; 465 s of hydrogen stages in vacuum; combustion never "
      "gave more "
      "than 550 s, reactors 900 s)\n";
  EXPECT_EQ(files.Texts(CheckFile(files.Path("vehicle.yaml")).errors), text);
  EXPECT_TRUE(CheckFile(files.Path("vehicle.yaml")).warnings.empty()) << "errors come first";
  EXPECT_FALSE(CheckFile(files.Path("vehicle.yaml")).vehicle);
  const auto thrown = [&](const auto& load) {
    try {
      load();
    } catch (const InputError& error) {
      return files.Texts(error.problems());
    }
    return std::string();
  };
  EXPECT_EQ(thrown([&] { LoadVehicle(files.Path("vehicle.yaml")); }), text);
  EXPECT_EQ(thrown([&] { LoadCampaign(files.Path("campaign.yaml")); }), text);
  EXPECT_EQ(thrown([&] { LoadOptimization(files.Path("campaign.yaml")); }), text);
}

// A file that says that its vehicle is made up is flown, and what cannot be stays a warning.
TEST(CampaignYamlPlausibility, WhatCannotBeIsAWarningOfAMadeUpVehicle) {
  const InputFiles files;
  files.Edit("vehicle.yaml", "burning_time_s: 60, ignition_rise_s: 0.2, tail_off_s: 0.4, p",
             "burning_time_s: 6000, ignition_rise_s: 0.2, tail_off_s: 0.4, p");
  files.Edit("vehicle.yaml", "name: two-stage\n", "name: two-stage\nmade_up: true\n");
  const FileCheck check = CheckFile(files.Path("vehicle.yaml"));
  EXPECT_TRUE(check.errors.empty());
  ASSERT_TRUE(check.vehicle);
  EXPECT_TRUE(check.vehicle->made_up);
  EXPECT_THAT(
      files.Texts(check.warnings),
      HasSubstr(
          "vehicle.yaml:9:25: stages[0].propellant_mass_kg: implies with thrust and burning time a specific "
          "impulse of 24473 s, usual: 180 to 470 s (200 to 410 s of solid and liquid rockets"));
}

TEST(CampaignYamlPlausibility, LimitsOfTheVehicleAreNoRequirement) {
  const InputFiles files;
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  ASSERT_EQ(campaign.requirements.size(), 1u);
  files.Edit("campaign.yaml", "requirements:\n",
             "requirements:\n  - {metric: structural_limit_exceeded, below: 1, probability: 0.9, "
             "consumer_risk: 0.2}\n");
  const Campaign own = LoadCampaign(files.Path("campaign.yaml"));
  ASSERT_EQ(own.requirements.size(), 2u);
  EXPECT_EQ(own.requirements[0].probability, 0.9);
  EXPECT_EQ(own.flight_id, campaign.flight_id) << "requirements decide no case";
  EXPECT_EQ(own.design_id, campaign.design_id);
  files.Edit("vehicle.yaml", "limits: {q_alpha_kpa_rad: 10, axial_load_g: 12, terminate: false}\n", "");
  EXPECT_THAT(files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
              HasSubstr("'structural_limit_exceeded' is of flights with limits of the vehicle's structure"));
  files.Edit("campaign.yaml",
             "  - {metric: structural_limit_exceeded, below: 1, probability: 0.9, consumer_risk: 0.2}\n", "");
  const Campaign unlimited = LoadCampaign(files.Path("campaign.yaml"));
  EXPECT_NE(unlimited.flight_id, campaign.flight_id) << "limits decide a metric";
  EXPECT_EQ(LoadOptimization(files.Path("campaign.yaml")).vehicle_sha256,
            LoadOptimization(DISPERSA_TEST_DATA "/yaml/campaign.yaml").vehicle_sha256)
      << "and no trajectory";
}

// Its words and its place are no part of what is required; its limits are.
TEST(CampaignYamlPlausibility, TheIdOfRequirementsIsOfWhatIsRequired) {
  const InputFiles files;
  const std::string one =
      "  - {metric: yaw_error_peak_deg, below: 2, probability: 0.9, consumer_risk: 0.1}\n";
  files.Edit("campaign.yaml", "requirements:\n", "requirements:\n" + one);
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  files.Edit(
      "campaign.yaml", one,
      "  - {metric: yaw_error_peak_deg, below: 2, probability: 0.90, consumer_risk: 0.1, id: R1, rationale: "
      "the fairing, source: spec 3}\n");
  const Campaign worded = LoadCampaign(files.Path("campaign.yaml"));
  EXPECT_EQ(worded.requirements_id, campaign.requirements_id);
  EXPECT_NE(worded.id, campaign.id);
  EXPECT_EQ(worded.requirements[0].id, "R1");
  EXPECT_EQ(worded.requirements[0].rationale, "the fairing");
  EXPECT_EQ(worded.requirements[0].source, "spec 3");
  EXPECT_EQ(LoadCampaign(files.Path("campaign.yaml"), {.cases = 3, .seed = 9}).design_id, campaign.design_id);
  files.Edit("campaign.yaml", "metric: yaw_error_peak_deg, below: 2", "metric: yaw_error_peak_deg, below: 3");
  EXPECT_NE(LoadCampaign(files.Path("campaign.yaml")).requirements_id, campaign.requirements_id);
}

TEST(CampaignYamlPlausibility, AReferenceThatMissesItsTargetSaysSo) {
  const InputFiles files;
  files.Edit("reference.yaml", "problem:", "target_missed: 12 km short\nproblem:");
  std::vector<InputProblem> warnings;
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"), {}, &warnings);
  EXPECT_EQ(campaign.reference.target_missed, "12 km short");
  EXPECT_THAT(
      files.Texts(warnings),
      HasSubstr(
          "reference.yaml:3:16: target_missed: the reference misses its own target: 12 km short, allowed: "
          "a reference that reaches it\n"));
  EXPECT_EQ(LoadReference({"again", WriteReference(campaign.reference)}).target_missed, "12 km short");
}

TEST(CampaignYamlPlausibility, AColumnMayHaveAnyUnit) {
  const InputFiles files;
  files.Edit("campaign.yaml", "  wind:", "  wind_profile: {table: wind.csv}\n  wind:");
  files.Write("wind.csv", "altitude_km;east_km_h;north_m_s\n0;36;-1,5\n20;72;2\n");
  const WeatherTable table = *LoadCampaign(files.Path("campaign.yaml")).wind_table;
  EXPECT_EQ(table.altitude_m, (std::vector<double>{0.0, 20e3}));
  EXPECT_EQ(table.north_m_s, (std::vector<double>{-1.5, 2.0}));
  EXPECT_DOUBLE_EQ(table.east_m_s[0], 10.0);
  EXPECT_DOUBLE_EQ(table.east_m_s[1], 20.0);
}

// The numbers under another unit's name would be others.
TEST(CampaignYamlPlausibility, NoOtherUnitIsProposed) {
  EXPECT_EQ(DidYouMean("altitude_km", {"altitude_m"}), "");
  EXPECT_EQ(DidYouMean("altitud_m", {"altitude_m"}), " (did you mean 'altitude_m'?)");
  const std::vector<std::string> methods = {"monte_carlo", "latin_hypercube", "sobol", "grid"};
  EXPECT_EQ(DidYouMean("lhs", methods), " (did you mean 'latin_hypercube'?)");
  EXPECT_EQ(DidYouMean("mc", methods), " (did you mean 'monte_carlo'?)");
  EXPECT_EQ(DidYouMean("sx", methods), "") << "one word has no initials";
  EXPECT_EQ(DidYouMean("metric_q_max_pa", {"q_alpha_max_pa", "q_max_pa"}), " (did you mean 'q_max_pa'?)");
  EXPECT_EQ(DidYouMean("input_drag_factor", {"drag_factor"}), " (did you mean 'drag_factor'?)");
}

}  // namespace
}  // namespace dispersa::campaign_yaml_plausibility_test
