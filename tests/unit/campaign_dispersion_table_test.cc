// The table of dispersions against the columns of a flight's inputs.
#include "core/campaign/dispersion_table.h"
#include "tests/test.h"

namespace dispersa::campaign_dispersion_table_test {

std::string KeyOfColumn(const std::string& name) {
  const int column = FindInput(name);
  EXPECT_GE(column, 0) << name;
  return column < 0 ? "" : InputKey(column);
}

TEST(DispersionTable, EveryColumnButOneHasTheKeyThatDrawsIt) {
  std::set<std::string> without;
  for (const InputColumn& column : InputColumns())
    if (KeyOfColumn(column.name).empty()) without.insert(column.name);
  // Only a search for margins sets it.
  EXPECT_EQ(without, (std::set<std::string>{"loop_stage"}));
}

TEST(DispersionTable, AColumnHasTheNameThatTheFileGivesIt) {
  EXPECT_EQ(KeyOfColumn("drag_factor"), "drag_coefficient");
  EXPECT_EQ(KeyOfColumn("drag_factor_stage2"), "drag_coefficient");
  EXPECT_EQ(KeyOfColumn("thrust_factor_stage1"), "thrust");
  EXPECT_EQ(KeyOfColumn("nozzle_misalignment_clock_stage3_top_deg"), "thrust_misalignment");
  EXPECT_EQ(KeyOfColumn("cg_offset_y_stage6_m"), "center_of_gravity_offset");
  EXPECT_EQ(KeyOfColumn("wind_azimuth_deg"), "wind.azimuth");
  EXPECT_EQ(KeyOfColumn("turbulence_scale"), "turbulence.scale");
  EXPECT_EQ(KeyOfColumn("tip_off_yaw_stage1_deg_s"), "tip_off_rate.yaw");
  EXPECT_EQ(KeyOfColumn("wind_profile_east_30_m_s"), "wind_profile");
  EXPECT_EQ(KeyOfColumn("bending_frequency_factor_mode5"), "bending_frequency");
}

TEST(DispersionTable, OfSeveralKeysACampaignHasItsOwn) {
  Campaign campaign;
  const int thrust = FindInput("thrust_factor_stage1"), azimuth = FindInput("wind_azimuth_deg");
  EXPECT_EQ(InputKey(campaign, thrust), "thrust") << "none draws it";
  campaign.dispersions = {{.name = "burn_rate/stage1", .distribution = {}, .inputs = {thrust}},
                          {.name = "wind/azimuth", .distribution = {}, .inputs = {azimuth}}};
  EXPECT_EQ(InputKey(campaign, thrust), "burn_rate");
  EXPECT_EQ(InputKey(campaign, azimuth), "wind.azimuth");
  EXPECT_EQ(InputKey(campaign, FindInput("thrust_factor_stage2")), "thrust");
}

TEST(DispersionTable, APatternStandsForEveryName) {
  EXPECT_EQ(ExpandColumn("nozzle_thrust_factor_{stage}_{nozzle}").size(),
            static_cast<std::size_t>(kMaxStages) * kNozzles + kFurtherNozzles);
  EXPECT_EQ(ExpandColumn("nozzle_thrust_factor_{stage}_{nozzle}").back(), "nozzle_thrust_factor_nozzle68");
  EXPECT_EQ(
      ExpandColumn("navigation_position_error_{axis}_m"),
      (std::vector<std::string>{"navigation_position_error_downrange_m", "navigation_position_error_right_m",
                                "navigation_position_error_down_m"}));
}

}  // namespace dispersa::campaign_dispersion_table_test
