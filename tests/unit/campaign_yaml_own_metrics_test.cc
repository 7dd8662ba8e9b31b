// A campaign's own metrics as its file gives them, and every refusal of one in full.
#include "core/campaign/case_result.h"
#include "core/campaign_yaml/load.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_own_metrics_test {
namespace {

TEST(CampaignYamlOwnMetrics, AreListedBehindTheVehicles) {
  const InputFiles files;
  files.Write("campaign.yaml", TextOfFile(files.Path("campaign.yaml")) +
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

}  // namespace
}  // namespace dispersa::campaign_yaml_own_metrics_test
