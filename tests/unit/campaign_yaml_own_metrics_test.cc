// A campaign's own metrics as its file gives them, and every refusal of one in full.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/campaign/case_result.h"
#include "core/campaign_yaml/load.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_own_metrics_test {
namespace {

std::string TextsOf(const std::string& items) {
  const InputFiles files;
  files.Write("campaign.yaml", ReadWholeFile(files.Path("campaign.yaml")) + "metrics:\n" + items);
  const int first = static_cast<int>(std::count(items.begin(), items.end(), '\n'));
  const std::string whole = ReadWholeFile(files.Path("campaign.yaml"));
  const auto lines = std::count(whole.begin(), whole.end(), '\n');
  std::string texts = files.Texts(CheckFile(files.Path("campaign.yaml")).errors);
  // Lines from that of the first item on.
  const std::string at = "campaign.yaml:" + std::to_string(lines - first + 1) + ":";
  for (std::size_t i = 0; (i = texts.find(at)) != std::string::npos;) texts.replace(i, at.size(), "1:");
  const std::string next = "campaign.yaml:" + std::to_string(lines - first + 2) + ":";
  for (std::size_t i = 0; (i = texts.find(next)) != std::string::npos;) texts.replace(i, next.size(), "2:");
  return texts;
}

TEST(CampaignYamlOwnMetrics, AreListedBehindTheVehicles) {
  const InputFiles files;
  files.Write("campaign.yaml", ReadWholeFile(files.Path("campaign.yaml")) +
                                   "metrics:\n  - {name: q_kpa, expression: ' max( qbar_pa )  / 1000 ', "
                                   "description: as a check}\n");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  ASSERT_EQ(campaign.own_metrics.size(), 1u);
  EXPECT_EQ(campaign.own_metrics[0].name, "q_kpa");
  EXPECT_EQ(campaign.own_metrics[0].expression, "max( qbar_pa ) / 1000");
  EXPECT_EQ(campaign.own_metrics[0].meaning, "as a check");
  const MetricList list = MetricsOf(campaign);
  EXPECT_EQ(list.NameAt(list.size() - 1), "q_kpa");
  EXPECT_EQ(MeasuredMetrics(campaign).back(), list.size() - 1);
  const Campaign without = [&] {
    const InputFiles plain;
    return LoadCampaign(plain.Path("campaign.yaml"));
  }();
  EXPECT_EQ(campaign.flight_id, without.flight_id);
  EXPECT_NE(campaign.id, without.id);
  EXPECT_EQ(campaign.requirements_id, without.requirements_id) << "nothing is required of it";
  EXPECT_EQ(without.result_id(), without.flight_id);
  EXPECT_NE(campaign.result_id(), campaign.flight_id);
}

TEST(CampaignYamlOwnMetrics, RefusesWhatCannotBeMeasured) {
  EXPECT_EQ(
      TextsOf("  - {name: q_kpa, expression: max(qbar)}\n"),
      "1:31: metrics[0].expression: at character 5: 'qbar' is not a column of histories, allowed: a column "
      "of `dispersa fly --history`, burn, burn1 to burn2, or coast\n");
  EXPECT_EQ(
      TextsOf("  - {name: q_kpa, expression: max(qbar_p)}\n"),
      "1:31: metrics[0].expression: at character 5: 'qbar_p' is not a column of histories (did you mean "
      "'qbar_pa'?), allowed: a column of `dispersa fly --history`, burn, burn1 to burn2, or coast\n");
  EXPECT_EQ(
      TextsOf("  - {name: q_kpa, expression: max(qbar_pa while burn3)}\n"),
      "1:31: metrics[0].expression: at character 19: the vehicle has no stage 3, allowed: burn1 to burn2\n");
  EXPECT_EQ(TextsOf("  - {name: q_kpa, expression: max(total_gain)}\n"),
            "1:31: metrics[0].expression: at character 5: 'total_gain' is a column of other control laws, "
            "allowed: a column of this law's histories\n");
  EXPECT_EQ(
      TextsOf("  - {name: Q, expression: max(qbar_pa)}\n"),
      "1:12: metrics[0].name: 'Q' cannot name a metric, allowed: a small letter, then small letters, digits "
      "and '_', 60 at most\n");
  EXPECT_EQ(TextsOf("  - {name: q_max_pa, expression: max(qbar_pa)}\n"),
            "1:12: metrics[0].name: 'q_max_pa' is a metric already, allowed: another name\n");
  EXPECT_EQ(
      TextsOf("  - {name: a_pa, expression: max(qbar_pa)}\n  - {name: a_pa, expression: min(qbar_pa)}\n"),
      "2:12: metrics[1].name: 'a_pa' is a metric already, allowed: another name\n");
  EXPECT_EQ(TextsOf("  - {name: a_pa}\n"), "1:5: metrics[0]: missing key 'expression', allowed: text\n");
}

}  // namespace
}  // namespace dispersa::campaign_yaml_own_metrics_test
