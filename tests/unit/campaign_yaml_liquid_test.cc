// Liquid stages in vehicle files, with the full text for each mistake.
#include <gtest/gtest.h>

#include "core/campaign/campaign.h"
#include "core/campaign/case_design.h"
#include "core/campaign_yaml/load.h"
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

struct BadLiquid {
  const char* name;
  std::string motor, tanks, said;
};
void PrintTo(const BadLiquid& bad, std::ostream* out) { *out << bad.name; }

class BadLiquidTest : public testing::TestWithParam<BadLiquid> {};

TEST_P(BadLiquidTest, IsReportedInFull) {
  const InputFiles files;
  MakeLiquid(files, GetParam().motor, GetParam().tanks);
  EXPECT_EQ(files.Texts(CheckFile(files.Path("vehicle.yaml")).errors), GetParam().said);
}

std::string With(const std::string& key) {
  return "motor: {liquid: {thrust_kn: 75, specific_impulse_s: 290, " + key + "}}";
}
std::string Tanks(const std::string& from, const std::string& to) {
  std::string text = kTanks;
  return text.replace(text.find(from), from.size(), to);
}

INSTANTIATE_TEST_SUITE_P(
    Liquids, BadLiquidTest,
    testing::Values(
        BadLiquid{"GrainBesideTheEngine", kLiquid, std::string(kTanks) + "\n    " + kGrain,
                  "vehicle.yaml:13:12: stages[0].grain: the motor is liquid, allowed: tanks in place of the "
                  "grain\n"},
        BadLiquid{"TanksOfASolidMotor", kMotor, std::string(kTanks) + "\n    " + kGrain,
                  "vehicle.yaml:12:12: stages[0].tanks: the motor is not liquid, allowed: a grain in place "
                  "of the tanks, "
                  "or motor: {liquid: {...}}\n"},
        BadLiquid{"NoTanks", kLiquid, "# no tanks",
                  "vehicle.yaml:6:5: stages[0]: missing key 'tanks', allowed: a list of 1 or more\n"},
        BadLiquid{
            "BesideThrust", "motor: {thrust_kn: 60, liquid: {thrust_kn: 75, specific_impulse_s: 290}}",
            kTanks,
            "vehicle.yaml:11:24: stages[0].motor.thrust_kn: 'thrust_kn' and 'liquid' are both given, and the "
            "engine has them inside, allowed: either liquid, or what a solid motor has\n"},
        BadLiquid{"NoImpulse", "motor: {liquid: {thrust_kn: 75}}", kTanks,
                  "vehicle.yaml:11:21: stages[0].motor.liquid: missing key 'specific_impulse_s' or "
                  "'specific_impulse_ms', allowed: a number above 0\n"},
        BadLiquid{"TooMuchThrottle", With("throttle: {time_s: [0, 9], level_percent: [100, 120]}"), kTanks,
                  "vehicle.yaml:11:110: stages[0].motor.liquid.throttle.level_percent[1]: 120 is out of "
                  "range, allowed: a "
                  "number from 0 to 100\n"},
        BadLiquid{"TimesThatTurnBack", With("throttle: {time_s: [0, 9, 8], level_percent: [100, 100, 90]}"),
                  kTanks,
                  "vehicle.yaml:11:88: stages[0].motor.liquid.throttle.time_s[2]: is not above the one "
                  "before, allowed: "
                  "values strictly increasing\n"},
        BadLiquid{"LessLevelsThanTimes", With("throttle: {time_s: [0, 9, 12], level_percent: [100, 100]}"),
                  kTanks,
                  "vehicle.yaml:11:72: stages[0].motor.liquid.throttle: there are 3 times and 2 levels, "
                  "allowed: one "
                  "level for each time\n"},
        BadLiquid{"StartsLate", With("throttle: {time_s: [1, 9], level_percent: [100, 100]}"), kTanks,
                  "vehicle.yaml:11:82: stages[0].motor.liquid.throttle.time_s[0]: '1' is not the time of "
                  "ignition, allowed: 0 as the first time\n"},
        BadLiquid{"NoThrust", With("throttle: {time_s: [0, 9], level_percent: [0, 0]}"), kTanks,
                  "vehicle.yaml:11:104: stages[0].motor.liquid.throttle.level_percent: the level is 0 at all "
                  "times, "
                  "allowed: a level above 0 somewhere\n"},
        BadLiquid{"CutOffByWish", With("cut_off: {at: will}"), kTanks,
                  "vehicle.yaml:11:76: stages[0].motor.liquid.cut_off.at: 'will' is not a choice, allowed: "
                  "one of depletion, "
                  "time, inertial_velocity, target\n"},
        BadLiquid{"CutOffWithoutTime", With("cut_off: {at: time}"), kTanks,
                  "vehicle.yaml:11:71: stages[0].motor.liquid.cut_off: missing key 'after_s' or 'after_ms', "
                  "allowed: a "
                  "number above 0\n"},
        BadLiquid{"AllResidual", With("residual_mass_kg: 1500"), kTanks,
                  "vehicle.yaml:11:80: stages[0].motor.liquid.residual_mass_kg: leaves nothing to burn, "
                  "allowed: 0 to "
                  "below propellant_mass_kg\n"},
        BadLiquid{"TanksOfAnotherSum", kLiquid, Tanks("450", "440"),
                  "vehicle.yaml:8:25: stages[0].propellant_mass_kg: is 1500.000000, the tanks hold "
                  "1490.000000, allowed: "
                  "the sum of the tanks' propellant_mass_kg\n"},
        BadLiquid{"TankTooSmall", kLiquid, Tanks("6.6", "6.3"),
                  "vehicle.yaml:12:48: stages[0].tanks[0].propellant_mass_kg: takes 0.920245 m3, the tank "
                  "has 0.827024, "
                  "allowed: at most what the tank holds, 943.634688 kg\n"},
        BadLiquid{
            "TankBehindTheStage", kLiquid,
            Tanks("top_station_m: 7, bottom_station_m: 7.95", "top_station_m: 9.2, bottom_station_m: 10.15"),
            "vehicle.yaml:12:234: stages[0].tanks[1].bottom_station_m: lies aft of the stage's "
            "bottom_station_m, "
            "allowed: at most bottom_station_m of the stage\n"}),
    [](const auto& bad) { return std::string(bad.param.name); });

TEST(LiquidFile, UnusualLiquidsAreWarnedAbout) {
  const InputFiles files;
  MakeLiquid(files, "motor: {liquid: {thrust_kn: 75, specific_impulse_s: 520, residual_mass_kg: 150}}",
             Tanks("density_kg_m3: 810", "density_kg_m3: 2810"));
  std::vector<InputProblem> warnings;
  LoadVehicle(files.Path("vehicle.yaml"), &warnings);
  EXPECT_EQ(
      files.Texts(warnings),
      "vehicle.yaml:11:57: stages[0].motor.liquid.specific_impulse_s: is 520 s, usual: 200 to 470 s (in "
      "vacuum 220 "
      "to 240 s of hydrazine alone, 280 to 330 s of storable pairs, 300 to 360 s of oxygen with kerosene, to "
      "465 s "
      "with hydrogen; combustion never gave more than 550 s, reactors 900 s)\n"
      "vehicle.yaml:11:80: stages[0].motor.liquid.residual_mass_kg: is, as part of the propellant, 0.1, "
      "usual: up "
      "to 0.05 (0.5 to 3 % of a liquid stage's propellant stays in tanks and lines)\n"
      "vehicle.yaml:12:191: stages[0].tanks[1].density_kg_m3: is 2810 kg/m3, usual: 60 to 1700 kg/m3 (liquid "
      "hydrogen 71, kerosene 810, oxygen 1141, nitrogen tetroxide 1443 kg/m3)\n"
      "vehicle.yaml:12:171: stages[0].tanks[1].propellant_mass_kg: fills of the tank 0.265, usual: 0.5 to "
      "0.99 (a "
      "few per cent of a tank are left to the gas that presses the liquid out)\n"
      "vehicle.yaml:25:12: stages[1].grain: implies a propellant density of 589.5 kg/m3, usual: 1500 to 1950 "
      "kg/m3 "
      "(solid propellants: Sutton and Biblarz, table 12-1)\n");
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

// Above the last stage's tanks stand payload and fairing, which are no part of what the tanks are measured
// against.
TEST(LiquidFile, TanksOfTheLastStageAreMeasuredFromTheirTopOn) {
  const InputFiles files;
  MakeLiquid(files);
  files.Edit("vehicle.yaml", "propellant_mass_kg: 500", "propellant_mass_kg: 60");
  files.Edit("vehicle.yaml",
             "motor: {thrust_kn: 20, burning_time_s: 60, ignition_rise_s: 0.2, tail_off_s: 0.4}",
             "motor: {liquid: {thrust_kn: 1, specific_impulse_s: 300}}");
  const std::string tank =
      "tanks: [{name: pair, propellant_mass_kg: 60, density_kg_m3: 1400, top_station_m: 2, "
      "bottom_station_m: 3, diameter_m: 0.";
  files.Edit("vehicle.yaml",
             "grain: {top_station_m: 2, bottom_station_m: 3.5, outer_diameter_m: 0.9, inner_diameter_m: 0.3}",
             tank + "246}]");
  std::vector<InputProblem> warnings;
  LoadVehicle(files.Path("vehicle.yaml"), &warnings);
  // 0.0475 m3 of the two metres below 2 m, 1.571 m3.
  EXPECT_EQ(files.Texts(warnings),
            "vehicle.yaml:25:12: stages[1].tanks: take together, as part of the stage's diameter_m from its "
            "bottom to the "
            "next stage's (of the last: to their top), 0.03026, usual: 0.05 to 0.95 (the tanks are inside "
            "the stage; of "
            "Vega's upper stage they take 0.09)\n");
  files.Edit("vehicle.yaml", tank + "246}]", tank + "32}]");  // 0.0512, a fill of 0.53
  warnings.clear();
  LoadVehicle(files.Path("vehicle.yaml"), &warnings);
  EXPECT_EQ(files.Texts(warnings), "");
}

}  // namespace
}  // namespace dispersa::campaign_yaml_liquid_test
