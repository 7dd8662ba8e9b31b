// The canonical text of a campaign, and what its two ids depend on.
#include "core/campaign_yaml/canonical.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/parse_yaml.h"
#include "core/campaign_yaml/sha256.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_canonical_test {
namespace {

std::string Canonical(const std::string& yaml) {
  std::vector<InputProblem> problems;
  const InputNode root = ParseYaml(yaml, "text", problems);
  EXPECT_TRUE(problems.empty());
  return CanonicalText(root);
}

// The campaign of the test data with one edit.
Campaign Edited(const std::string& file, const std::string& from, const std::string& to,
                const CampaignOverrides& overrides = {}) {
  const InputFiles files;
  files.Edit(file, from, to);
  return LoadCampaign(files.Path("campaign.yaml"), overrides);
}

Campaign Original() { return LoadCampaign(DISPERSA_TEST_DATA "/yaml/campaign.yaml"); }

TEST(CampaignYamlCanonical, SortsKeysAndShortensNumbers) {
  EXPECT_EQ(Canonical("b: 1.50   # comment\n"
                      "a: [1e3, 0x10, -0.0, 1.0e-7, 18446744073709551615, 'true', true, ~]\n"
                      "c: {z: [], y: {}, x: \"two words\"}\n"
                      "d:\n"
                      "- {q: +2., p: [3]}\n"
                      "- [[1, 2], [3]]\n"),
            "a: [1000, \"0x10\", 0, 1e-07, 18446744073709551615, \"true\", true, null]\n"
            "b: 1.5\n"
            "c:\n"
            "  x: \"two words\"\n"
            "  y: {}\n"
            "  z: []\n"
            "d:\n"
            "  - p: [3]\n"
            "    q: 2\n"
            "  -\n"
            "    - [1, 2]\n"
            "    - [3]\n");
}

TEST(CampaignYamlCanonical, TextSurvivesWhateverItHolds) {
  const std::string text = Canonical(
      "a: \"quote \\\" backslash \\\\ tab \\t line \\n bell \\x07 ä # : {[,\"\nb: '1e3'\nc: 'null'\n");
  EXPECT_EQ(text,
            "a: \"quote \\\" backslash \\\\ tab \\x09 line \\x0a bell \\x07 ä # : {[,\"\nb: \"1e3\"\nc: "
            "\"null\"\n");
  EXPECT_EQ(Canonical(text), text);
}

TEST(CampaignYamlCanonical, LoadsAgainToTheSame) {
  const Campaign campaign = Original();
  const Campaign again = ParseCampaign(campaign.canonical_yaml, "campaign.yaml");
  EXPECT_EQ(again.canonical_yaml, campaign.canonical_yaml);
  EXPECT_EQ(again.id, campaign.id);
  EXPECT_EQ(again.flight_id, campaign.flight_id);
  EXPECT_EQ(again.vehicle.stages[0].motor.thrust_n, campaign.vehicle.stages[0].motor.thrust_n);
  EXPECT_EQ(again.reference.attitude.knots[1].pitch, campaign.reference.attitude.knots[1].pitch);
  EXPECT_EQ(again.dispersions.size(), campaign.dispersions.size());
}

TEST(CampaignYamlCanonical, TablesAreInlined) {
  const InputFiles files;
  files.Edit(
      "campaign.yaml", "requirements:",
      "  wind_profile: {statistics: wind_statistics.csv, correlation_ne: 0.1, correlation_length_km: 3}\n"
      "requirements:");
  files.Edit("vehicle.yaml", "surface_roughness_um: 6",
             "aerodynamics:\n"
             "  tables:\n"
             "    - {reference_area_m2: 0.785, reference_length_m: 1, table: aero.csv}\n"
             "    - {reference_area_m2: 0.785, reference_length_m: 1, table: aero.csv}\n"
             "surface_roughness_um: 6");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  EXPECT_THAT(campaign.canonical_yaml, Not(HasSubstr(".csv")));
  EXPECT_THAT(campaign.canonical_yaml, HasSubstr("      mean_east_m_s: [2, 25]\n"));
  const Campaign again = ParseCampaign(campaign.canonical_yaml, "campaign.yaml");
  EXPECT_EQ(again.canonical_yaml, campaign.canonical_yaml);
  ASSERT_TRUE(again.wind_statistics.has_value());
  EXPECT_EQ(again.wind_statistics->sigma_east_m_s, (std::vector<double>{4, 12}));
  EXPECT_EQ(again.wind_statistics->correlation_length_m, 3000.0);

  ASSERT_EQ(again.vehicle.aerodynamics.size(), 2u);
  const AeroTable& table = again.vehicle.aerodynamics[1];
  EXPECT_EQ(table.mach, (std::vector<double>{0.5, 2.0}));
  EXPECT_EQ(table.incidence_rad, (std::vector<double>{0.0, 10.0 * kRadPerDeg}));
  EXPECT_EQ(table.cn, (std::vector<double>{0.0, 0.5, 0.0, 0.6}));
  EXPECT_EQ(table.cmq_per_rad, (std::vector<double>{-40, -30}));
}

TEST(CampaignYamlCanonical, IdsAreThoseOfTheTexts) {
  // NIST FIPS 180-4's example.
  EXPECT_EQ(Sha256Hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_TRUE(IsSha256Hex(Sha256Hex("abc")));
  EXPECT_FALSE(IsSha256Hex(Sha256Hex("abc") + "0"));
  EXPECT_FALSE(IsSha256Hex(std::string(64, 'A')));
  const Campaign campaign = Original();
  EXPECT_EQ(campaign.id, Sha256Hex(campaign.canonical_yaml));
  EXPECT_NE(campaign.id, campaign.flight_id);
}

TEST(CampaignYamlCanonical, CommentsAndSpellingOfNumbersDoNotMatter) {
  const Campaign campaign = Original();
  EXPECT_EQ(Edited("vehicle.yaml", "hold_down_s: 0.5", "hold_down_s: 5.0e-1  # half a second").id,
            campaign.id);
}

// Neither the name, nor the number of cases, nor the requirements decide a case.
TEST(CampaignYamlCanonical, ACampaignCanBeExtended) {
  const Campaign campaign = Original();
  for (const auto& [from, to] : {std::pair("name: trial", "name: trial2"),
                                 std::pair("cases: 100", "cases: 200"), std::pair("below: 0.5", "below: 0.6"),
                                 std::pair("name: trial", "name: trial\ndescription: 'a word more'")}) {
    const Campaign other = Edited("campaign.yaml", from, to);
    EXPECT_NE(other.id, campaign.id) << to;
    EXPECT_EQ(other.flight_id, campaign.flight_id) << to;
  }
}

TEST(CampaignYamlCanonical, WhatDecidesACaseChangesBothIds) {
  const Campaign campaign = Original();
  const struct {
    const char* file;
    const char* from;
    const char* to;
  } edits[] = {{"campaign.yaml", "seed: 20260101", "seed: 20260102"},
               {"campaign.yaml", "monte_carlo", "sobol"},
               {"campaign.yaml", "three_sigma_percent: 6.7", "three_sigma_percent: 6.8"},
               {"vehicle.yaml", "thrust_kn: 60", "thrust_kn: 60.0001"},
               {"autopilot.yaml", "gamma: [10, 20]", "gamma: [10, 21]"},
               {"reference.yaml", "[10, 85.5", "[10, 85.6"}};
  for (const auto& edit : edits) {
    const Campaign other = Edited(edit.file, edit.from, edit.to);
    EXPECT_NE(other.id, campaign.id) << edit.to;
    EXPECT_NE(other.flight_id, campaign.flight_id) << edit.to;
  }
}

TEST(CampaignYamlCanonical, EachKeyDecidesWhatItsDeclarationSays) {
  const auto ids = [](const InputFiles& files) {
    const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
    return std::array{LoadOptimization(files.Path("campaign.yaml")).vehicle_sha256, campaign.design_id,
                      campaign.flight_id, campaign.requirements_id};
  };
  const std::array original = ids(InputFiles());
  const struct {
    const char *file, *from, *to;
    std::array<bool, 4> changes;  ///< trajectory of the vehicle, design, flight, requirements
  } edits[] = {
      {"vehicle.yaml", "thrust_kn: 60", "thrust_kn: 60.0001", {true, true, true, false}},
      {"vehicle.yaml", "axial_load_g: 12", "axial_load_g: 11", {false, true, true, false}},
      {"vehicle.yaml", "limit_deg: ", "dead_zone_deg: 0.01, limit_deg: ", {false, true, true, false}},
      {"campaign.yaml", "seed: 20260101", "seed: 20260102", {false, false, true, false}},
      {"campaign.yaml", "cases: 100", "cases: 200", {false, false, false, false}},
      {"campaign.yaml", "name: trial", "name: trial\nassumptions: [calm]", {false, false, false, false}},
      {"campaign.yaml", "below: 0.5", "below: 0.5, id: R1, source: plan", {false, false, false, false}},
      {"campaign.yaml", "below: 0.5", "below: 0.6", {false, false, false, true}},
      {"campaign.yaml", "name: trial", "name: trial\nverdicts: {looks: 2}", {false, false, false, true}},
  };
  for (const auto& edit : edits) {
    const InputFiles files;
    files.Edit(edit.file, edit.from, edit.to);
    const std::array now = ids(files);
    for (std::size_t i = 0; i < now.size(); ++i)
      EXPECT_EQ(now[i] != original[i], edit.changes[i]) << edit.to << ", " << i;
  }
}

TEST(CampaignYamlCanonical, TheNumberOfCasesDecidesALatinHypercube) {
  const Campaign hundred = Edited("campaign.yaml", "monte_carlo", "latin_hypercube");
  const Campaign fifty = Edited("campaign.yaml", "monte_carlo", "latin_hypercube", {.cases = 50, .seed = {}});
  EXPECT_NE(hundred.flight_id, fifty.flight_id);
}

TEST(CampaignYamlCanonical, OverridesComeBeforeHashing) {
  const Campaign edited = Edited("campaign.yaml", "cases: 100, seed: 20260101", "cases: 8, seed: 3");
  const Campaign overridden = LoadCampaign(DISPERSA_TEST_DATA "/yaml/campaign.yaml", {.cases = 8, .seed = 3});
  EXPECT_EQ(overridden.sampling.cases, 8u);
  EXPECT_EQ(overridden.sampling.seed, 3u);
  EXPECT_EQ(overridden.canonical_yaml, edited.canonical_yaml);
  EXPECT_EQ(overridden.flight_id, edited.flight_id);
}

TEST(CampaignYamlCanonical, AnInlinedFileIsTheSameCampaign) {
  const InputFiles files;
  std::string autopilot = TextOfFile(files.Path("autopilot.yaml"));
  for (std::size_t at = 0; (at = autopilot.find('\n', at)) != std::string::npos; at += 3)
    autopilot.insert(at + 1, "  ");
  files.Edit("campaign.yaml", "autopilot: autopilot.yaml", "autopilot:\n  " + autopilot);
  EXPECT_EQ(LoadCampaign(files.Path("campaign.yaml")).id, Original().id);
}

TEST(CampaignYamlCanonical, ReferenceOfAnotherVehicleIsAWarning) {
  const InputFiles files;
  // Of the reference; the files' vehicle has some of its own.
  const auto warning = [&] {
    std::vector<InputProblem> warnings;
    LoadCampaign(files.Path("campaign.yaml"), {}, &warnings);
    std::erase_if(warnings, [](const InputProblem& one) { return one.unusual; });
    return files.Texts(warnings);
  };
  EXPECT_EQ(warning(),
            "reference.yaml:1:1: the reference was found for another vehicle; flights will miss its orbit, "
            "allowed: a "
            "reference that `dispersa optimize` wrote for this vehicle\n");
  const std::string sha = LoadOptimization(files.Path("campaign.yaml")).vehicle_sha256;
  files.Edit("reference.yaml", "vehicle_sha256: none", "vehicle_sha256: '" + sha + "'");
  EXPECT_EQ(warning(), "");
}

}  // namespace
}  // namespace dispersa::campaign_yaml_canonical_test
