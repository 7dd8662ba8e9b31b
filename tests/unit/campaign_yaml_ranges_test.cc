// Each number of a vehicle file has one range, and the error for a value outside states it.
#include <gtest/gtest.h>

#include <string>

#include "core/campaign_yaml/load.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_ranges_test {
namespace {

struct OutOfRange {
  const char* from;
  const char* to;
  const char* said;  ///< behind the place
};

void PrintTo(const OutOfRange& row, std::ostream* out) { *out << row.to; }

class VehicleRanges : public testing::TestWithParam<OutOfRange> {};

TEST_P(VehicleRanges, AreSaidBeyondThem) {
  const InputFiles files;
  files.Edit("vehicle.yaml", GetParam().from, GetParam().to);
  const std::string texts = files.Texts(CheckFile(files.Path("vehicle.yaml")).errors);
  EXPECT_EQ(texts.substr(texts.find(": ") + 2), GetParam().said + std::string("\n"));
}

constexpr OutOfRange kRows[] = {
    {"liftoff_mass_ton: 3", "liftoff_mass_ton: 0",
     "stages[0].liftoff_mass_ton: 0 is out of range, allowed: a number above 0"},
    {"propellant_mass_kg: 1500", "propellant_mass_kg: 0",
     "stages[0].propellant_mass_kg: 0 is out of range, allowed: a number above 0"},
    {"diameter_m: 1\n", "diameter_m: -1\n",
     "stages[0].diameter_m: -1 is out of range, allowed: a number above 0"},
    {"thrust_kn: 60", "thrust_kn: 0",
     "stages[0].motor.thrust_kn: 0 is out of range, allowed: a number above 0"},
    {"burning_time_s: 60", "burning_time_s: -1",
     "stages[0].motor.burning_time_s: -1 is out of range, allowed: a number above 0"},
    {"ignition_rise_s: 0.2", "ignition_rise_s: -0.2",
     "stages[0].motor.ignition_rise_s: -0.2 is out of range, allowed: a number not below 0"},
    {"tail_off_s: 0.4", "tail_off_s: -0.4",
     "stages[0].motor.tail_off_s: -0.4 is out of range, allowed: a number not below 0"},
    {"thrust_kn: 60", "nozzle_exit_area_m2: -0.1, thrust_kn: 60",
     "stages[0].motor.nozzle_exit_area_m2: -0.1 is out of range, allowed: a number not below 0"},
    {"fraction: 0.75", "fraction: 0",
     "stages[0].structure[0].fraction: 0 is out of range, allowed: a number above 0 and not above 1"},
    {"outer_diameter_m: 1,", "outer_diameter_m: 0,",
     "stages[0].structure[0].outer_diameter_m: 0 is out of range, allowed: a number above 0"},
    {"inner_diameter_m: 0.98", "inner_diameter_m: -1",
     "stages[0].structure[0].inner_diameter_m: -1 is out of range, allowed: a number not below 0"},
    {"top_station_m: 4,", "top_station_m: -4,",
     "stages[0].structure[0].top_station_m: -4 is out of range, allowed: a number not below 0"},
    {"radius_m: 0.3", "radius_m: 0",
     "stages[0].gimbal.radius_m: 0 is out of range, allowed: a number above 0"},
    {"limit_deg: 6", "limit_deg: 0",
     "stages[0].gimbal.limit_deg: 0 is out of range, allowed: a number above 0 and below 90"},
    {"rate_limit_deg_s: 30", "rate_limit_deg_s: 0",
     "stages[0].gimbal.rate_limit_deg_s: 0 is out of range, allowed: a number above 0"},
    {"bandwidth_rad_s: 25", "bandwidth_rad_s: 0",
     "stages[0].gimbal.bandwidth_rad_s: 0 is out of range, allowed: a number above 0"},
    {"damping_ratio: 0.7", "damping_ratio: 0",
     "stages[0].gimbal.damping_ratio: 0 is out of range, allowed: a number above 0"},
    {"delay_ticks: 1", "delay_ticks: 51",
     "stages[0].gimbal.delay_ticks: 51 is out of range, allowed: a whole number from 0 to 50"},
    {"separation_delay_s: 0.5", "separation_delay_s: -0.5",
     "stages[0].separation_delay_s: -0.5 is out of range, allowed: a number not below 0"},
    {"{trigger: timer}", "{trigger: timer, delay_s: -1}",
     "stages[1].ignition.delay_s: -1 is out of range, allowed: a number not below 0"},
    {"thrust_n: 20", "thrust_n: 0",
     "reaction_control.thrust_n: 0 is out of range, allowed: a number above 0"},
    {"pitch_yaw_arm_m: 1", "pitch_yaw_arm_m: 0",
     "reaction_control.pitch_yaw_arm_m: 0 is out of range, allowed: a number above 0"},
    {"roll_arm_m: 0.5", "roll_arm_m: 0",
     "reaction_control.roll_arm_m: 0 is out of range, allowed: a number above 0"},
    {"specific_impulse_s: 65", "specific_impulse_s: 0",
     "reaction_control.specific_impulse_s: 0 is out of range, allowed: a number above 0"},
    {"minimum_on_time_ms: 20", "minimum_on_time_ms: 0",
     "reaction_control.minimum_on_time_ms: 0 is out of range, allowed: a number above 0"},
};

INSTANTIATE_TEST_SUITE_P(OneByOne, VehicleRanges, testing::ValuesIn(kRows));

TEST(VehicleRanges, EndsBelongToThem) {
  const InputFiles files;
  files.Edit("vehicle.yaml", "delay_ticks: 1", "delay_ticks: 50");
  files.Edit("vehicle.yaml", "hold_down_s: 0.5", "hold_down_s: 0");
  files.Edit("vehicle.yaml", "separation_delay_s: 0.5", "separation_delay_s: 0");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("vehicle.yaml")).errors), "");
}

}  // namespace
}  // namespace dispersa::campaign_yaml_ranges_test
