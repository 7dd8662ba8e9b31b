// Boosters in a vehicle file: values read.
#include "core/campaign/campaign.h"
#include "core/campaign/case_design.h"
#include "core/campaign_yaml/load.h"
#include "core/flight/flight_inputs.h"
#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_boosters_test {
namespace {

constexpr char kAfter[] = "\nreaction_control:";
constexpr char kBoosters[] =
    "\nboosters: {count: 2, dry_mass_kg: 20, propellant_mass_kg: 60, radius_m: 0.7, diameter_m: 0.3, "
    "top_station_m: 7, "
    "bottom_station_m: 9.8, nozzle_station_m: 9.7, separation_delay_s: 0.5, motor: {thrust_kn: 5, "
    "burning_time_s: 30}, "
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

// Electron with two boosters, and a first stage that is cut off and burns again without them.
TEST(BoostersFile, AreGoneWhenTheFirstStageBurnsAgain) {
  const InputFiles files;
  files.Write("electron.yaml", TextOfFile(DISPERSA_CAMPAIGNS "/gallery/electron/vehicle.yaml"));
  constexpr double kBoosters_kg = 2.0 * (100.0 + 800.0), kElectron_kg = 12744.0, kBurn_s = 100.0;
  files.Edit("electron.yaml", "liftoff_mass_kg: 12744 ", "liftoff_mass_kg: 14544 ");
  files.Edit(
      "electron.yaml",
      "        throttle: {time_s: [0, 28, 36, 85, 95, 156], level_percent: [100, 100, 70, 70, 86, 70]}\n",
      "        cut_off: {at: time, after_s: 100}\n");
  files.Edit("electron.yaml", "  - name: stage2\n",
             "  - {restarts: true, name: again, ignition: {trigger: burnout_detection, delay_s: 5}}\n  - "
             "name: stage2\n");
  files.Edit(
      "electron.yaml", "\nreaction_control:",
      "\nboosters: {count: 2, dry_mass_kg: 100, propellant_mass_kg: 800, radius_m: 0.9, diameter_m: 0.6, "
      "top_station_m: 11, bottom_station_m: 16, nozzle_station_m: 15.9, attachment_station_m: 15, "
      "motor: {thrust_kn: 60, burning_time_s: 35}, grain: {top_station_m: 12, bottom_station_m: 14.5, "
      "outer_diameter_m: 0.58, "
      "inner_diameter_m: 0.1}}\nreaction_control:");
  const std::string nozzle = "  - {mass_kg: 79, cg_aft_of_pivot_m: 0.25, inertia_about_hinge_kg_m2: 8.2}\n";
  files.Edit("electron.yaml", nozzle, nozzle + nozzle);
  const Vehicle vehicle = LoadVehicle(files.Path("electron.yaml"));
  ASSERT_EQ(vehicle.stages.size(), 3u);
  const double full_kg = 9250.0, burnt_kg = 224e3 / (311.0 * kStandardGravity) * kBurn_s;
  EXPECT_NEAR(vehicle.stages[1].liftoff_mass_kg, kElectron_kg - burnt_kg, 1e-6);
  EXPECT_NEAR(DryMass(vehicle, 0), kElectron_kg - 2544.0 - full_kg, 1e-9);
  EXPECT_NEAR(DryMass(vehicle, 1), DryMass(vehicle, 0), 1e-6);
  const std::vector<StackMass> stacks = BuildStackMasses(vehicle);  // boosters empty
  EXPECT_NEAR(stacks[0].At(full_kg).mass_kg, kElectron_kg + kBoosters_kg - 2.0 * 800.0, 1e-6);
  EXPECT_NEAR(stacks[1].At(full_kg - burnt_kg).mass_kg, kElectron_kg - burnt_kg, 1e-6);
  // Structure of the bare launcher: tubes at their own places, no boosters' share among them.
  EXPECT_NEAR(stacks[1].fixed_mass_kg, kElectron_kg - full_kg, 1e-6);
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

constexpr char kGrain[] =
    "grain: {top_station_m: 8, bottom_station_m: 8.9, outer_diameter_m: 0.28, inner_diameter_m: 0.1}";
void MakeLiquid(const InputFiles& files) {
  files.Edit("vehicle.yaml", kAfter, kBoosters);
  files.Edit("vehicle.yaml", "motor: {thrust_kn: 5, burning_time_s: 30}",
             "motor: {nozzle_exit_area_m2: 0.01, liquid: {thrust_kn: 5, specific_impulse_s: 300, "
             "residual_mass_kg: 1, throttle: {time_s: [0, 10, 20], level_percent: [100, 100, 80]}, "
             "cut_off: {at: time, after_s: 25}}}");
  files.Edit("vehicle.yaml", kGrain,
             "tanks: [{name: oxygen, propellant_mass_kg: 42, density_kg_m3: 1141, top_station_m: 7.1, "
             "bottom_station_m: 8.2, diameter_m: 0.28}, {name: kerosene, propellant_mass_kg: 18, "
             "density_kg_m3: 810, top_station_m: 8.3, bottom_station_m: 8.9, diameter_m: 0.28}]");
}

// The same keys as of a stage. What a campaign's folder keeps of them is read again as it was.
TEST(BoostersFile, ReadLiquidEnginesAndTanks) {
  const InputFiles files;
  MakeLiquid(files);
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  const auto expect = [](const Boosters& b) {
    ASSERT_EQ(b.tanks.size(), 2u);
    EXPECT_EQ(b.tanks[1].propellant_mass_kg, 18.0);
    EXPECT_EQ(b.motor.thrust_n, 5e3);
    EXPECT_EQ(b.motor.nozzle_exit_area_m2, 0.01);
    EXPECT_EQ(b.motor.residual_mass_kg, 1.0);
    EXPECT_EQ(b.motor.cut_off, CutOff::kAtTime);
    EXPECT_EQ(b.motor.cut_off_s, 25.0);
    EXPECT_EQ(b.motor.throttle.level, (std::vector<double>{1.0, 1.0, 0.8}));
    EXPECT_NEAR(b.motor.burning_time_s, 60.0 * 300.0 * kStandardGravity / 5e3, 1e-12);
  };
  expect(campaign.vehicle.boosters);
  files.Write("kept.yaml", campaign.canonical_yaml);
  const Campaign kept = LoadCampaign(files.Path("kept.yaml"));
  expect(kept.vehicle.boosters);
  EXPECT_EQ(kept.flight_id, campaign.flight_id);
}

// Each its own, as the file says, and one for all.
TEST(BoostersFile, ReadDispersionsOfTheirMasses) {
  const InputFiles files;
  MakeLiquid(files);
  files.Edit("vehicle.yaml", "count: 2,", "angles_deg: [0, 120, 240],");
  files.Edit("campaign.yaml", "  thrust: ",
             "  booster_dry_mass: {distribution: normal, sigma_percent: 1}\n"
             "  booster_propellant_load: {distribution: uniform, low_factor: 0.99, high_factor: 1.01}\n"
             "  booster_mixture_ratio: {distribution: normal, sigma_percent: 1, per: vehicle}\n  thrust: ");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("campaign.yaml")).errors), "");
  const FlightInputs in = CaseDesign(LoadCampaign(files.Path("campaign.yaml"))).Draw(3);
  for (double BoosterInputs::*const factor :
       {&BoosterInputs::dry_mass_factor, &BoosterInputs::propellant_factor}) {
    const auto drawn = [&](std::size_t k) { return in.further[k].booster.*factor; };
    EXPECT_NE(drawn(0), 1.0);
    EXPECT_NE(drawn(0), drawn(1));
    EXPECT_NE(drawn(1), drawn(2));
    EXPECT_EQ(drawn(3), 1.0);
  }
  EXPECT_NE(in.further[0].booster.mixture_ratio_factor, 1.0);
  EXPECT_EQ(in.further[0].booster.mixture_ratio_factor, in.further[2].booster.mixture_ratio_factor);
  files.Edit("campaign.yaml", "high_factor: 1.01", "high_factor: 9");
  EXPECT_NE(files.Texts(CheckFile(files.Path("campaign.yaml")).errors).find("a draw can be 9 (factor)"),
            std::string::npos);
}

// Each with its place, its nozzle's drives, and dispersions of its own.
TEST(BoostersFile, ReadBodiesOfTheirOwn) {
  const InputFiles files;
  files.Edit("vehicle.yaml", kAfter, kBoosters);
  files.Edit("vehicle.yaml", "count: 2,",
             "angles_deg: [0, 120, 240], cant_deg: 5, gimbal: {turns_towards_deg: [90, 180], limit_deg: 6, "
             "rate_limit_deg_s: 10, bandwidth_rad_s: 20, damping_ratio: 0.7},");
  files.Edit("campaign.yaml", "  thrust: ",
             "  booster_burn_rate: {distribution: normal, sigma_percent: 1}\n"
             "  booster_misalignment: {distribution: normal, sigma_deg: 0.1}\n  thrust: ");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  const Boosters& b = campaign.vehicle.boosters;
  EXPECT_EQ(b.count, 3);
  ASSERT_EQ(b.angles_rad.size(), 3u);
  EXPECT_NEAR(b.angles_rad[2], 240.0 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(b.cant_rad, 5.0 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(b.gimbal.limit_rad, 6.0 * kRadPerDeg, 1e-15);
  std::string fed;
  for (const Dispersion& d : campaign.dispersions) {
    if (!d.name.starts_with("booster_")) continue;
    fed += d.name + ":";
    for (const int input : d.inputs) fed += " " + InputColumns()[static_cast<std::size_t>(input)].name;
    fed += "\n";
  }
  EXPECT_EQ(fed,
            "booster_burn_rate/booster1: nozzle_thrust_factor_nozzle5 nozzle_flow_factor_nozzle5\n"
            "booster_burn_rate/booster2: nozzle_thrust_factor_nozzle6 nozzle_flow_factor_nozzle6\n"
            "booster_burn_rate/booster3: nozzle_thrust_factor_nozzle7 nozzle_flow_factor_nozzle7\n"
            "booster_misalignment/y/booster1: nozzle_misalignment_y_nozzle5_deg\n"
            "booster_misalignment/z/booster1: nozzle_misalignment_z_nozzle5_deg\n"
            "booster_misalignment/y/booster2: nozzle_misalignment_y_nozzle6_deg\n"
            "booster_misalignment/z/booster2: nozzle_misalignment_z_nozzle6_deg\n"
            "booster_misalignment/y/booster3: nozzle_misalignment_y_nozzle7_deg\n"
            "booster_misalignment/z/booster3: nozzle_misalignment_z_nozzle7_deg\n");
}

// Boosters by their number stand at equal angles. The file stays.
TEST(BoostersFile, OfSomeAlikeDrawEachItsOwn) {
  const InputFiles files;
  files.Edit("vehicle.yaml", kAfter, kBoosters);
  files.Edit("campaign.yaml", "  thrust: ",
             "  booster_dry_mass: {distribution: normal, sigma_percent: 1}\n"
             "  booster_propellant_load: {distribution: normal, sigma_percent: 1}\n  thrust: ");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  const Boosters& b = campaign.vehicle.boosters;
  EXPECT_EQ(b.count, 2);
  ASSERT_EQ(b.angles_rad.size(), 2u);
  EXPECT_EQ(b.angles_rad[0], 0.0);
  EXPECT_NEAR(b.angles_rad[1], kPi, 1e-15);
  const FlightInputs in = CaseDesign(campaign).Draw(3);
  for (double BoosterInputs::*const factor :
       {&BoosterInputs::dry_mass_factor, &BoosterInputs::propellant_factor}) {
    const auto drawn = [&](std::size_t k) { return in.further[k].booster.*factor; };
    EXPECT_NE(drawn(0), 1.0);
    EXPECT_NE(drawn(1), 1.0);
    EXPECT_NE(drawn(0), drawn(1));
    EXPECT_EQ(drawn(2), 1.0);
  }
  EXPECT_NE(campaign.canonical_yaml.find("count: 2"), std::string::npos);
  EXPECT_EQ(campaign.canonical_yaml.find("angles_deg"), std::string::npos);
  files.Write("kept.yaml", campaign.canonical_yaml);
  const Campaign kept = LoadCampaign(files.Path("kept.yaml"));
  EXPECT_EQ(kept.flight_id, campaign.flight_id);
  EXPECT_EQ(kept.vehicle.boosters.angles_rad, b.angles_rad);
}

TEST(BoostersFile, OfSomeAlikeStandInAListOfCases) {
  const InputFiles files;
  files.Edit("vehicle.yaml", kAfter, kBoosters);
  files.Write("runs.csv",
              "booster_dry_mass_factor_nozzle5,booster_dry_mass_factor_nozzle6\n1,1.1\n1.2,0.9\n");
  files.Edit("campaign.yaml", "method: monte_carlo, cases: 100, seed: 20260101",
             "method: list, cases: 2, seed: 1, table: runs.csv");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  const FlightInputs in = CaseDesign(campaign).Draw(1);
  EXPECT_EQ(in.further[0].booster.dry_mass_factor, 1.2);
  EXPECT_EQ(in.further[1].booster.dry_mass_factor, 0.9);
  files.Write("runs.csv",
              "booster_dry_mass_factor_nozzle5,booster_dry_mass_factor_nozzle7\n1,1.1\n1.2,0.9\n");
  EXPECT_NE(files.Texts(CheckFile(files.Path("campaign.yaml")).errors)
                .find("'booster_dry_mass_factor_nozzle7' is not an input"),
            std::string::npos)
      << "there are two";
}

}  // namespace
}  // namespace dispersa::campaign_yaml_boosters_test
