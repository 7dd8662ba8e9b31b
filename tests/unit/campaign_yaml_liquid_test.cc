// Liquid stages in vehicle files.
#include "core/campaign/campaign.h"
#include "core/campaign/case_design.h"
#include "core/campaign_yaml/load.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_liquid_test {
namespace {

constexpr char kMotor[] =
    "motor: {thrust_kn: 60, burning_time_s: 60, ignition_rise_s: 0.2, tail_off_s: 0.4, "
    "published_mass_flow_kg_s: "
    "25}";
constexpr char kGrain[] =
    "grain: {top_station_m: 5, bottom_station_m: 9, outer_diameter_m: 0.9, inner_diameter_m: 0.3}";
// 26.4 kg/s.
constexpr char kLiquid[] = "motor: {liquid: {thrust_kn: 75, specific_impulse_s: 290, residual_mass_kg: 15}}";
constexpr char kTanks[] =
    "tanks: [{name: oxygen, propellant_mass_kg: 1050, density_kg_m3: 1141, top_station_m: 5, "
    "bottom_station_m: 6.6, "
    "diameter_m: 0.9}, {name: kerosene, propellant_mass_kg: 450, density_kg_m3: 810, top_station_m: 7, "
    "bottom_station_m: 7.95, diameter_m: 0.9}]";

void MakeLiquid(const InputFiles& files, const std::string& motor = kLiquid,
                const std::string& tanks = kTanks) {
  files.Edit("vehicle.yaml", kMotor, motor);
  files.Edit("vehicle.yaml", kGrain, tanks);
}

Stage StageOf(const InputFiles& files) { return LoadVehicle(files.Path("vehicle.yaml")).stages[0]; }

TEST(LiquidFile, IsReadAndIsUsual) {
  const InputFiles files;
  MakeLiquid(files);
  const Stage stage = StageOf(files);
  EXPECT_EQ(stage.motor.thrust_n, 75e3);
  EXPECT_DOUBLE_EQ(1500.0 / stage.motor.burning_time_s, 75e3 / (290.0 * 9.80665));
  EXPECT_EQ(stage.motor.residual_mass_kg, 15.0);
  EXPECT_EQ(stage.motor.cut_off, CutOff::kAtDepletion);
  EXPECT_TRUE(stage.motor.throttle.empty());
  ASSERT_EQ(stage.tanks.size(), 2u);
  EXPECT_EQ(stage.tanks[1].name, "kerosene");
  EXPECT_EQ(stage.tanks[1].propellant_mass_kg, 450.0);
  EXPECT_EQ(stage.tanks[1].density_kg_m3, 810.0);
  EXPECT_EQ(stage.tanks[1].top_station_m, 7.0);
  EXPECT_EQ(stage.tanks[1].bottom_station_m, 7.95);
  EXPECT_EQ(stage.tanks[1].diameter_m, 0.9);
  EXPECT_EQ(files.Texts(CheckFile(files.Path("vehicle.yaml")).errors), "");
}

TEST(LiquidFile, ThrottlesAndIsCutOff) {
  const InputFiles files;
  MakeLiquid(files,
             "motor: {liquid: {thrust_kn: 75, specific_impulse_s: 290, throttle: {time_s: [0, 40, 41], "
             "level_percent: "
             "[100, 100, 65]}, cut_off: {at: time, after_s: 50}}}");
  const Motor motor = StageOf(files).motor;
  EXPECT_EQ(motor.throttle.time_s, (std::vector<double>{0.0, 40.0, 41.0}));
  EXPECT_EQ(motor.throttle.level, (std::vector<double>{1.0, 1.0, 0.65}));
  EXPECT_EQ(motor.cut_off, CutOff::kAtTime);
  EXPECT_EQ(motor.cut_off_s, 50.0);
}

// The engine draws another mixture than the tanks hold, which a solid stage cannot.
TEST(LiquidFile, ReadsDrawsOfTheMixture) {
  const InputFiles files;
  files.Edit("campaign.yaml", "  thrust: ",
             "  mixture_ratio: {distribution: normal, sigma_percent: 1, per: stage, stage: 1}\n  thrust: ");
  EXPECT_EQ(
      files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
      "campaign.yaml:11:18: dispersions.mixture_ratio: stage 1 has no two tanks, whose flows could differ, "
      "allowed: stage: those with liquid engines of two propellants\n");
  MakeLiquid(files);
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  const FlightInputs in = CaseDesign(campaign).Draw(3);
  EXPECT_NE(in.stages[0].mixture_ratio_factor, 1.0);
  EXPECT_EQ(in.stages[1].mixture_ratio_factor, 1.0);
  files.Edit("campaign.yaml", "per: stage, stage: 1", "per: stage");
  EXPECT_EQ(
      files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
      "campaign.yaml:11:18: dispersions.mixture_ratio: stage 2 has no two tanks, whose flows could differ, "
      "allowed: stage: those with liquid engines of two propellants\n");
}

TEST(LiquidFile, TakesTheThrottleFromACsv) {
  const InputFiles files;
  files.Write("throttle.csv", "# as flown\nlevel_percent,time_s\n50,0\n100,2\n");
  MakeLiquid(files, "motor: {liquid: {thrust_kn: 75, specific_impulse_s: 290, throttle: throttle.csv}}");
  const Throttle throttle = StageOf(files).motor.throttle;
  EXPECT_EQ(throttle.time_s, (std::vector<double>{0.0, 2.0}));
  EXPECT_EQ(throttle.level, (std::vector<double>{0.5, 1.0}));
}

TEST(LiquidFile, HasATailOffThatItsCommandPrecedes) {
  const InputFiles files;
  MakeLiquid(files,
             "motor: {liquid: {thrust_kn: 75, specific_impulse_s: 290, tail_off_s: 0.5, cut_off: {at: time, "
             "after_s: 50}}}");
  EXPECT_EQ(StageOf(files).motor.tail_off_s, 0.5);
  files.Edit("vehicle.yaml", "after_s: 50", "after_s: 0.2");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("vehicle.yaml")).errors),
            "vehicle.yaml:11:74: stages[0].motor.liquid.tail_off_s: is more than twice cut_off.after_*: its "
            "command would be before the ignition, allowed: at most twice cut_off.after_*\n");
  files.Edit("vehicle.yaml", "tail_off_s: 0.5", "tail_off_s: 2.5");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("vehicle.yaml")).errors),
            "vehicle.yaml:11:74: stages[0].motor.liquid.tail_off_s: 2.5 is out of range, allowed: a number "
            "from 0 to 2\n");
}

}  // namespace
}  // namespace dispersa::campaign_yaml_liquid_test
