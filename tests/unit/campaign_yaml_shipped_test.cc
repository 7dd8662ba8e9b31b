// Every file that ships is valid, and the campaigns that refer to them load.
#include "core/campaign_yaml/load.h"
#include "tests/test.h"

namespace dispersa::campaign_yaml_shipped_test {
namespace {

std::string Texts(const std::vector<InputProblem>& problems) {
  std::string texts;
  for (const InputProblem& problem : problems) texts += problem.Text() + "\n";
  return texts;
}

TEST(CampaignYamlShipped, FilesAreValid) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(DISPERSA_CAMPAIGNS)) {
    if (entry.path().extension() != ".yaml") continue;
    if (entry.path().filename() == "published.yaml") continue;  // the gallery's: what others flew, no input
    EXPECT_EQ(Texts(CheckFile(entry.path().string()).errors), "");
    ++files;
  }
  EXPECT_GE(files, 10);
}

TEST(CampaignYamlShipped, ReferencesWereFoundForTheVehicleThatFliesThem) {
  for (const auto& entry : std::filesystem::directory_iterator(DISPERSA_CAMPAIGNS)) {
    if (entry.path().extension() != ".yaml") continue;
    std::vector<InputProblem> warnings;
    try {
      LoadCampaign(entry.path().string(), {}, &warnings);
    } catch (const InputError& error) {
      // One to optimise has no reference yet.
      ASSERT_EQ(error.problems().front().path, "optimize") << error.what();
    }
    EXPECT_EQ(Texts(warnings), "");
  }
}

}  // namespace
}  // namespace dispersa::campaign_yaml_shipped_test
