// Clusters of engines in a vehicle file: rings, shares, names, ids; and the columns that their dispersions
// feed.
#include "core/campaign/campaign.h"
#include "core/campaign_yaml/load.h"
#include "core/flight/flight_inputs.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_clusters_test {
namespace {

constexpr char kCross[] = "radius_m: 0.3, limit_deg: 6, rate_limit_deg_s: 30, bandwidth_rad_s: 25";
constexpr char kDrives[] = "limit_deg: 6, rate_limit_deg_s: 30, bandwidth_rad_s: 25";
constexpr char kOctaweb[] =
    "nozzles: [{name: centre, turns_towards_deg: [90, 180]}, {name: outer, ring: {count: 8, radius_m: 0.3}, "
    "turns_towards_deg: [90, 180]}], ";

struct Edited {
  InputFiles files;
  explicit Edited(const std::string& nozzles) { files.Edit("vehicle.yaml", kCross, nozzles + kDrives); }
};

TEST(ClustersFile, ARingIsItsNozzles) {
  const Edited edited(kOctaweb);
  const Vehicle vehicle = LoadVehicle(edited.files.Path("vehicle.yaml"));
  const std::vector<Nozzle> nozzles = NozzlesOf(vehicle.stages[0].gimbal);
  ASSERT_EQ(nozzles.size(), 9u);
  EXPECT_EQ(nozzles[0].name, "centre");
  EXPECT_EQ(nozzles[8].name, "outer8");
  EXPECT_NEAR(nozzles[3].z_m, 0.3, 1e-15);  // the third of eight, a quarter turn on
  EXPECT_NEAR(nozzles[3].thrust_share, 1.0 / 9.0, 1e-15);
}

TEST(ClustersFile, TheirPlacesStandInTheId) {
  const Edited plain(kOctaweb), turned(
                                    "nozzles: [{name: centre, turns_towards_deg: [90, 180]}, {name: outer, "
                                    "ring: {count: 8, radius_m: 0.3, "
                                    "first_deg: 1}, turns_towards_deg: [90, 180]}], ");
  EXPECT_NE(LoadCampaign(plain.files.Path("campaign.yaml")).flight_id,
            LoadCampaign(turned.files.Path("campaign.yaml")).flight_id);
}

TEST(ClustersFile, DispersionsNameEveryEngine) {
  const Edited edited(kOctaweb);
  edited.files.Edit("campaign.yaml", "  thrust: ",
                    "  stuck_nozzle: {stage: 1, nozzle: outer7, angle_deg: 1}\n  thrust_offset: "
                    "{distribution: normal, sigma_mm: 3, draw: per_axis, per: nozzle, stage: 1}\n  thrust: ");
  const Campaign campaign = LoadCampaign(edited.files.Path("campaign.yaml"));
  std::vector<std::string> names, columns;
  for (const Dispersion& d : campaign.dispersions) {
    if (d.name.starts_with("thrust_offset/y")) {
      names.push_back(d.name);
      columns.push_back(InputColumns()[static_cast<std::size_t>(d.inputs.at(0))].name);
    }
    if (d.name == "stuck_nozzle/nozzle") {
      EXPECT_EQ(d.distribution.nominal, 8.0);
    }
  }
  ASSERT_EQ(names.size(), 9u);
  EXPECT_EQ(names[8], "thrust_offset/y/stage1_outer8");
  EXPECT_EQ(columns[3], "nozzle_offset_y_stage1_top_m");
  EXPECT_EQ(columns[4], "nozzle_offset_y_nozzle5_m");
  EXPECT_EQ(columns[8], "nozzle_offset_y_nozzle9_m");
  // Results have columns for the five, and for no more of them.
  const std::size_t count = InputCount(ColumnClass(campaign.vehicle));
  EXPECT_LT(static_cast<std::size_t>(FindInput("nozzle_flow_factor_nozzle9")), count);
  EXPECT_GE(static_cast<std::size_t>(FindInput("nozzle_misalignment_nozzle10_deg")), count);
}

}  // namespace
}  // namespace dispersa::campaign_yaml_clusters_test
