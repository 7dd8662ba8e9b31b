// Fingerprints and the columns of the inputs.
#include "core/flight/digest.h"

#include <gtest/gtest.h>

#include <set>

#include "core/flight/flight_inputs.h"
#include "core/math/constants.h"

namespace dispersa::flight_digest_test {
namespace {

Digest Of(const std::vector<double>& values) {
  Digester digester;
  digester.Add(values.data(), values.size());
  return digester.Finish();
}

TEST(Digest, SeesEveryBitAndTheOrder) {
  EXPECT_EQ(Of({1.0, 2.0}), Of({1.0, 2.0}));
  EXPECT_NE(Of({1.0, 2.0}), Of({2.0, 1.0}));
  EXPECT_NE(Of({1.0, 2.0}), Of({1.0, std::nextafter(2.0, 3.0)}));
  EXPECT_NE(Of({0.0}), Of({-0.0}));
  EXPECT_NE(Of({0.0}), Of({0.0, 0.0}));
}

TEST(Digest, DoesNotDependOnHowValuesArrive) {
  Digester digester;
  const double values[] = {1.0, 2.0, 3.0};
  digester.Add(values, 1);
  digester.Add(values + 1, 2);
  EXPECT_EQ(digester.Finish(), Of({1.0, 2.0, 3.0}));
}

TEST(Digest, OfNothingIsThePublishedValueOfXxh3) {
  // XXH3_128bits of zero bytes with seed 0 (xxHash 0.8 specification).
  EXPECT_EQ(Of({}).Hex(), "99aa06d3014798d86001c324468d497f");
}

TEST(Digest, HexIs32DigitsWithLeadingZeros) {
  EXPECT_EQ((Digest{0x1, 0xabcdef}).Hex(), "00000000000000010000000000abcdef");
}

// Each column must be the field that its name says, in the unit that its name says.
TEST(InputColumns, NameTheFieldsOfFlightInputs) {
  FlightInputs in;
  const auto expect = [&](const std::string& name, double& field, double unit) {
    const int column = FindInput(name);
    ASSERT_GE(column, 0) << name;
    EXPECT_EQ(&InputValue(in, column), &field) << name;
    EXPECT_EQ(InputColumns()[static_cast<std::size_t>(column)].unit, unit) << name;
  };
  for (std::size_t i = 0; i < kFurtherNozzles; ++i) {
    const std::string of = "_nozzle" + std::to_string(i + 5);
    expect("nozzle_misalignment" + of + "_deg", in.further[i].nozzle.line.misalignment_rad.magnitude,
           kRadPerDeg);
    expect("nozzle_misalignment_clock" + of + "_deg", in.further[i].nozzle.line.misalignment_rad.clock_rad,
           kRadPerDeg);
    expect("nozzle_misalignment_y" + of + "_deg", in.further[i].nozzle.line.misalignment_rad.y, kRadPerDeg);
    expect("nozzle_misalignment_z" + of + "_deg", in.further[i].nozzle.line.misalignment_rad.z, kRadPerDeg);
    expect("nozzle_offset" + of + "_m", in.further[i].nozzle.line.offset_m.magnitude, 1.0);
    expect("nozzle_offset_clock" + of + "_deg", in.further[i].nozzle.line.offset_m.clock_rad, kRadPerDeg);
    expect("nozzle_offset_y" + of + "_m", in.further[i].nozzle.line.offset_m.y, 1.0);
    expect("nozzle_offset_z" + of + "_m", in.further[i].nozzle.line.offset_m.z, 1.0);
    expect("nozzle_thrust_factor" + of, in.further[i].nozzle.thrust_factor, 1.0);
    expect("nozzle_flow_factor" + of, in.further[i].nozzle.flow_factor, 1.0);
  }
  for (std::size_t i = 0; i < kMaxStages; ++i) {
    const std::string stage = "_stage" + std::to_string(i + 1);
    expect("thrust_misalignment" + stage + "_deg", in.stages[i].thrust.misalignment_rad.magnitude,
           kRadPerDeg);
    expect("thrust_misalignment_clock" + stage + "_deg", in.stages[i].thrust.misalignment_rad.clock_rad,
           kRadPerDeg);
    expect("thrust_offset" + stage + "_m", in.stages[i].thrust.offset_m.magnitude, 1.0);
    expect("thrust_offset_clock" + stage + "_deg", in.stages[i].thrust.offset_m.clock_rad, kRadPerDeg);
    for (std::size_t nozzle = 0; nozzle < kNozzles; ++nozzle) {
      const std::string of = stage + "_" + kNozzleNames[nozzle];
      expect("nozzle_misalignment" + of + "_deg",
             in.stages[i].nozzles[nozzle].line.misalignment_rad.magnitude, kRadPerDeg);
      expect("nozzle_misalignment_clock" + of + "_deg",
             in.stages[i].nozzles[nozzle].line.misalignment_rad.clock_rad, kRadPerDeg);
      expect("nozzle_offset" + of + "_m", in.stages[i].nozzles[nozzle].line.offset_m.magnitude, 1.0);
      expect("nozzle_offset_clock" + of + "_deg", in.stages[i].nozzles[nozzle].line.offset_m.clock_rad,
             kRadPerDeg);
      expect("nozzle_thrust_factor" + of, in.stages[i].nozzles[nozzle].thrust_factor, 1.0);
      expect("nozzle_flow_factor" + of, in.stages[i].nozzles[nozzle].flow_factor, 1.0);
      expect("nozzle_misalignment_y" + of + "_deg", in.stages[i].nozzles[nozzle].line.misalignment_rad.y,
             kRadPerDeg);
      expect("nozzle_misalignment_z" + of + "_deg", in.stages[i].nozzles[nozzle].line.misalignment_rad.z,
             kRadPerDeg);
      expect("nozzle_offset_y" + of + "_m", in.stages[i].nozzles[nozzle].line.offset_m.y, 1.0);
      expect("nozzle_offset_z" + of + "_m", in.stages[i].nozzles[nozzle].line.offset_m.z, 1.0);
    }
    expect("cg_offset" + stage + "_m", in.stages[i].cg_offset_m.magnitude, 1.0);
    expect("cg_offset_clock" + stage + "_deg", in.stages[i].cg_offset_m.clock_rad, kRadPerDeg);
    expect("dry_mass_factor" + stage, in.stages[i].dry_mass_factor, 1.0);
    expect("propellant_factor" + stage, in.stages[i].propellant_factor, 1.0);
    expect("product_of_inertia_xy" + stage + "_kg_m2", in.stages[i].product_of_inertia_xy_kg_m2, 1.0);
    expect("product_of_inertia_xz" + stage + "_kg_m2", in.stages[i].product_of_inertia_xz_kg_m2, 1.0);
    expect("product_of_inertia_yz" + stage + "_kg_m2", in.stages[i].product_of_inertia_yz_kg_m2, 1.0);
    expect("ignition_delay" + stage + "_s", in.stages[i].ignition_delay_s, 1.0);
    expect("separation_delay" + stage + "_s", in.stages[i].separation_delay_s, 1.0);
    expect("drag_factor" + stage, in.stages[i].drag_factor, 1.0);
    expect("lift_factor" + stage, in.stages[i].lift_factor, 1.0);
    expect("cg_factor" + stage, in.stages[i].cg_factor, 1.0);
    expect("cp_factor" + stage, in.stages[i].cp_factor, 1.0);
    expect("inertia_factor" + stage, in.stages[i].inertia_factor, 1.0);
    expect("actuator_bandwidth_factor" + stage, in.stages[i].actuator_bandwidth_factor, 1.0);
    expect("thrust_misalignment_y" + stage + "_deg", in.stages[i].thrust.misalignment_rad.y, kRadPerDeg);
    expect("thrust_misalignment_z" + stage + "_deg", in.stages[i].thrust.misalignment_rad.z, kRadPerDeg);
    expect("thrust_offset_y" + stage + "_m", in.stages[i].thrust.offset_m.y, 1.0);
    expect("thrust_offset_z" + stage + "_m", in.stages[i].thrust.offset_m.z, 1.0);
    expect("cg_offset_y" + stage + "_m", in.stages[i].cg_offset_m.y, 1.0);
    expect("cg_offset_z" + stage + "_m", in.stages[i].cg_offset_m.z, 1.0);
    expect("thrust_factor" + stage, in.stages[i].thrust_factor, 1.0);
    expect("mass_flow_factor" + stage, in.stages[i].mass_flow_factor, 1.0);
    expect("specific_impulse_factor" + stage, in.stages[i].specific_impulse_factor, 1.0);
    expect("tip_off_pitch" + stage + "_deg_s", in.stages[i].tip_off_pitch_rad_s, kRadPerDeg);
    expect("tip_off_yaw" + stage + "_deg_s", in.stages[i].tip_off_yaw_rad_s, kRadPerDeg);
    expect("tip_off_roll" + stage + "_deg_s", in.stages[i].tip_off_roll_rad_s, kRadPerDeg);
  }
  expect("wind_max_speed_m_s", in.air.wind_max_speed_m_s, 1.0);
  expect("wind_azimuth_deg", in.air.wind_azimuth_rad, kRadPerDeg);
  expect("wind_altitude_m", in.air.wind_altitude_m, 1.0);
  expect("wind_width_m", in.air.wind_width_m, 1.0);
  expect("gust_speed_m_s", in.air.gust_speed_m_s, 1.0);
  expect("gust_altitude_m", in.air.gust_altitude_m, 1.0);
  expect("gust_length_m", in.air.gust_length_m, 1.0);
  expect("gust_azimuth_deg", in.air.gust_azimuth_rad, kRadPerDeg);
  expect("wind_profile_north_1_m_s", in.air.wind_profile_north_m_s[0], 1.0);
  expect("wind_profile_north_20_m_s", in.air.wind_profile_north_m_s[19], 1.0);
  expect("wind_profile_east_1_m_s", in.air.wind_profile_east_m_s[0], 1.0);
  expect("wind_profile_altitude_20_m", in.air.wind_profile_altitude_m[19], 1.0);
  expect("drag_factor", in.drag_factor, 1.0);
  expect("lift_factor", in.lift_factor, 1.0);
  expect("cg_factor", in.cg_factor, 1.0);
  expect("cp_factor", in.cp_factor, 1.0);
  expect("density_factor", in.air.density_factor, 1.0);
  expect("inertia_factor", in.inertia_factor, 1.0);
  expect("actuator_bandwidth_factor", in.actuator_bandwidth_factor, 1.0);
  expect("gyro_bias_roll_deg_s", in.sensors.gyro_bias_roll_rad_s, kRadPerDeg);
  expect("gyro_bias_pitch_deg_s", in.sensors.gyro_bias_pitch_rad_s, kRadPerDeg);
  expect("gyro_bias_yaw_deg_s", in.sensors.gyro_bias_yaw_rad_s, kRadPerDeg);
  expect("gyro_noise_deg_s", in.sensors.gyro_noise_rad_s, kRadPerDeg);
  expect("stuck_nozzle", in.stuck_nozzle, 1.0);
  expect("stuck_nozzle_stage", in.stuck_nozzle_stage, 1.0);
  expect("stuck_nozzle_deg", in.stuck_nozzle_rad, kRadPerDeg);
  expect("pn_error_factor", in.pn_error_factor, 1.0);
  expect("pn_rate_factor", in.pn_rate_factor, 1.0);
  expect("loop_gain_factor", in.loop_gain_factor, 1.0);
  expect("loop_delay_s", in.loop_delay_s, 1.0);
  expect("loop_stage", in.loop_stage, 1.0);
  const char* const axes[] = {"downrange", "right", "down"};
  for (std::size_t i = 0; i < 3; ++i) {
    expect(std::string("navigation_position_error_") + axes[i] + "_m",
           in.sensors.navigation_position_error_m[i], 1.0);
    expect(std::string("navigation_velocity_error_") + axes[i] + "_m_s",
           in.sensors.navigation_velocity_error_m_s[i], 1.0);
  }
  expect("accelerometer_scale_factor", in.sensors.accelerometer_scale_factor, 1.0);
  expect("payload_mass_kg", in.payload_mass_kg, 1.0);
  expect("payload_element", in.payload_element, 1.0);
  expect("launch_azimuth_error_deg", in.launch_azimuth_error_rad, kRadPerDeg);
  expect("initial_roll_error_deg", in.initial_roll_error_rad, kRadPerDeg);
  expect("initial_pitch_error_deg", in.initial_pitch_error_rad, kRadPerDeg);
  expect("initial_yaw_error_deg", in.initial_yaw_error_rad, kRadPerDeg);
}

TEST(InputColumns, CoverEveryDoubleOnceWithDistinctNames) {
  std::set<std::string> names;
  std::set<std::size_t> offsets;
  for (const InputColumn& column : InputColumns()) {
    names.insert(column.name);
    offsets.insert(column.offset);
  }
  EXPECT_EQ(names.size(), InputColumns().size());
  EXPECT_EQ(offsets.size(), sizeof(FlightInputs) / sizeof(double));
  EXPECT_EQ(*offsets.rbegin(), sizeof(FlightInputs) - sizeof(double));
}

TEST(InputValues, AreInTheUnitsOfTheirNamesWithoutMinusZero) {
  FlightInputs in;
  in.sensors.gyro_bias_yaw_rad_s = 0.5 * kRadPerDeg;
  in.air.wind_azimuth_rad = -0.0;
  const std::vector<double> values = InputValues(in);
  EXPECT_DOUBLE_EQ(values[static_cast<std::size_t>(FindInput("gyro_bias_yaw_deg_s"))], 0.5);
  EXPECT_FALSE(std::signbit(values[static_cast<std::size_t>(FindInput("wind_azimuth_deg"))]));
  EXPECT_EQ(FindInput("no_such_input"), -1);
}

}  // namespace
}  // namespace dispersa::flight_digest_test
