// Boosters in a vehicle's file: what is read, and what is said about what is wrong.
#include <gtest/gtest.h>

#include <string>

#include "core/campaign_yaml/load.h"
#include "core/vehicle/mass.h"
#include "tests/unit/bad_input.h"

namespace dispersa {
namespace {

constexpr char kAfter[] = "\nreaction_control:";
constexpr char kBoosters[] =
    "\nboosters: {count: 2, dry_mass_kg: 20, propellant_mass_kg: 60, radius_m: 0.7, diameter_m: 0.3, top_station_m: 7, "
    "bottom_station_m: 9.8, nozzle_station_m: 9.7, separation_delay_s: 0.5, motor: {thrust_kn: 5, burning_time_s: 30}, "
    "grain: {top_station_m: 8, bottom_station_m: 8.9, outer_diameter_m: 0.28, inner_diameter_m: 0.1}}"
    "\nreaction_control:";

TEST(BoostersFile, AreRead) {
  const InputFiles files;
  files.Edit("vehicle.yaml", kAfter, kBoosters);
  const Vehicle vehicle = LoadVehicle(files.Path("vehicle.yaml"));
  EXPECT_EQ(vehicle.boosters.count, 2);
  EXPECT_EQ(vehicle.boosters.motor.thrust_n, 5e3);
  EXPECT_EQ(vehicle.boosters.nozzle_station_m, 9.7);
  EXPECT_EQ(vehicle.boosters.separation_delay_s, 0.5);
  // Part of the lift-off mass: 3000 kg less 1000 above, 1500 of propellant and the boosters.
  EXPECT_NEAR(DryMass(vehicle, 0), 500.0 - 160.0, 1e-9);
}

TEST(BoostersFile, ReadThrustCurvesAndStandInTheId) {
  const InputFiles files;
  files.Edit("vehicle.yaml", kAfter, kBoosters);
  files.Edit("vehicle.yaml", "motor: {thrust_kn: 5, burning_time_s: 30}",
             "motor: {thrust_curve: {reference: vacuum, table: booster.csv}}");
  files.Write("booster.csv", "time_s,thrust_n\n0,6000\n20,5000\n25,0\n");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  EXPECT_EQ(campaign.vehicle.boosters.motor.thrust_curve.time_s, (std::vector<double>{0.0, 20.0, 25.0}));
  files.Write("booster.csv", "time_s,thrust_n\n0,6001\n20,5000\n25,0\n");
  EXPECT_NE(LoadCampaign(files.Path("campaign.yaml")).flight_id, campaign.flight_id);
}

class BadBoostersTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadBoostersTest, AreReportedInFull) {
  const InputFiles files;
  files.Edit("vehicle.yaml", kAfter, kBoosters);
  files.Edit("vehicle.yaml", GetParam().from, GetParam().to);
  EXPECT_EQ(files.Texts(ValidateFile(files.Path("vehicle.yaml"))), GetParam().texts);
}

constexpr BadInput kBadBoosters[] = {
    {"One", "", "count: 2", "count: 1", "?"},
    {"Inside", "", "radius_m: 0.7", "radius_m: 0.4", "?"},
    {"Longer", "", "burning_time_s: 30", "burning_time_s: 61", "?"},
    {"Liquid", "", "motor: {thrust_kn: 5, burning_time_s: 30}", "motor: {liquid: {thrust_kn: 5}}", "?"},
    {"GrainTooThick", "", "outer_diameter_m: 0.28", "outer_diameter_m: 0.31", "?"},
    {"GrainOutside", "", "bottom_station_m: 8.9", "bottom_station_m: 9.9", "?"},
    {"TooHeavy", "", "propellant_mass_kg: 60", "propellant_mass_kg: 600", "?"},
};
INSTANTIATE_TEST_SUITE_P(BoostersFile, BadBoostersTest, testing::ValuesIn(kBadBoosters),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace dispersa
