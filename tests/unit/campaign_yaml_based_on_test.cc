// Files that say what differs from another one.
#include "core/campaign_yaml/load.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_based_on_test {

constexpr char kHead[] = "schema: dispersa/campaign/1\nbased_on: campaign.yaml\n";

// The same file, with one line less that it could take from another.
TEST(BasedOn, TheIdsAreThoseOfTheWrittenOutFile) {
  const InputFiles files;
  const Campaign whole = LoadCampaign(files.Path("campaign.yaml"));
  files.Write("derived.yaml", kHead);
  EXPECT_EQ(LoadCampaign(files.Path("derived.yaml")).canonical_yaml, whole.canonical_yaml);
  files.Write("derived.yaml", std::string(kHead) + "name: other\n");
  const Campaign derived = LoadCampaign(files.Path("derived.yaml"));
  EXPECT_NE(derived.id, whole.id);
  EXPECT_EQ(derived.flight_id, whole.flight_id);
  EXPECT_EQ(derived.vehicle_file, whole.vehicle_file);
  EXPECT_THAT(derived.canonical_yaml, Not(HasSubstr("based_on")));
  // What the command line replaces may stand in the base.
  const CampaignOverrides overrides{.cases = 3, .seed = 4};
  EXPECT_EQ(LoadCampaign(files.Path("derived.yaml"), overrides).sampling.cases, 3u);
  EXPECT_EQ(LoadCampaign(files.Path("derived.yaml"), overrides).flight_id,
            LoadCampaign(files.Path("campaign.yaml"), overrides).flight_id);
}

// Dispersions are taken one by one, everything else as a whole; what is left out is not there.
TEST(BasedOn, TakesDispersionsOneByOne) {
  const InputFiles files;
  const Campaign whole = LoadCampaign(files.Path("campaign.yaml"));
  ASSERT_FALSE(whole.requirements.empty());
  files.Write("middle.yaml", std::string(kHead) +
                                 "without: [requirements, dispersions.thrust]\n"
                                 "dispersions: {inertia: {distribution: normal, three_sigma_percent: 5}}\n");
  const std::string middle = LoadCampaign(files.Path("middle.yaml")).canonical_yaml;
  EXPECT_THAT(middle, HasSubstr("\n  inertia:\n"));
  EXPECT_THAT(middle, HasSubstr("\n  drag_coefficient:\n"));
  EXPECT_THAT(middle, Not(HasSubstr("\n  thrust:\n")));
  EXPECT_THAT(middle, Not(HasSubstr("requirements")));
  files.Write("last.yaml",
              "schema: dispersa/campaign/1\nbased_on: middle.yaml\nwithout: [dispersions]\n"
              "dispersions: {inertia: {distribution: normal, three_sigma_percent: 1}}\n");
  const std::string last = LoadCampaign(files.Path("last.yaml")).canonical_yaml;
  EXPECT_THAT(
      last, HasSubstr("\ndispersions:\n  inertia:\n    distribution: normal\n    three_sigma_percent: 1\n"));
  EXPECT_THAT(last, Not(HasSubstr("drag_coefficient")));
}

// A name is relative to the file in which it stands: a list's table, a vehicle.
TEST(BasedOn, NamesAreRelativeToTheFileInWhichTheyStand) {
  const InputFiles files;
  std::filesystem::create_directories(files.Path("far/near"));
  files.Write("far/rows.csv", "thrust_factor_stage1\n1.01\n0.99\n");
  files.Write("far/list.yaml",
              "schema: dispersa/campaign/1\nbased_on: ../campaign.yaml\nwithout: [requirements]\n"
              "sampling: {method: list, cases: 2, seed: 1, table: rows.csv}\n");
  files.Write("far/near/derived.yaml", "schema: dispersa/campaign/1\nbased_on: ../list.yaml\nname: x\n");
  const Campaign list = LoadCampaign(files.Path("far/list.yaml"));
  EXPECT_EQ(LoadCampaign(files.Path("far/near/derived.yaml")).flight_id, list.flight_id);
  // A text in place of a file, and the written-out one.
  const InputSource text(files.Path("far/near/<dict>"),
                         "schema: dispersa/campaign/1\nbased_on: ../list.yaml\n");
  EXPECT_EQ(LoadCampaign(text).id, list.id);
  EXPECT_EQ(ParseCampaign(list.canonical_yaml, "again").id, list.id);
}

// Nor is what has mistakes loaded.
TEST(BasedOn, NeedsAFile) {
  const InputFiles files;
  EXPECT_THROW(ParseCampaign(kHead, "text"), InputError);
  files.Write("derived.yaml", "schema: dispersa/campaign/1\nbased_on: none.yaml\n");
  EXPECT_THROW(LoadCampaign(files.Path("derived.yaml")), InputError);
}

}  // namespace dispersa::campaign_yaml_based_on_test
