// Fingerprints and the columns of the inputs.
#include "core/flight/digest.h"

#include "core/flight/flight_inputs.h"
#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::flight_digest_test {

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

// Each column must be the field that its name says, in the unit that its name says: degrees, or that of the
// field.
TEST(InputColumns, NameTheFieldsOfFlightInputs) {
  FlightInputs in;
  const auto expect = [&](const std::string& name, double& field) {
    const int column = FindInput(name);
    ASSERT_GE(column, 0) << name;
    EXPECT_EQ(&InputValue(in, column), &field) << name;
    const bool is_angle = name.ends_with("_deg") || name.ends_with("_deg_s");
    EXPECT_EQ(InputColumns()[static_cast<std::size_t>(column)].unit, is_angle ? kRadPerDeg : 1.0) << name;
  };
  const auto expect_offset = [&](const std::string& name, const std::string& of, Lateral& offset,
                                 const std::string& unit) {
    expect(name + of + unit, offset.magnitude);
    expect(name + "_clock" + of + "_deg", offset.clock_rad);
    expect(name + "_y" + of + unit, offset.y);
    expect(name + "_z" + of + unit, offset.z);
  };
  const auto expect_line = [&](const std::string& name, const std::string& of, ThrustLine& line) {
    expect_offset(name + "_misalignment", of, line.misalignment_rad, "_deg");
    expect_offset(name + "_offset", of, line.offset_m, "_m");
  };
  const auto expect_nozzle = [&](const std::string& of, NozzleInputs& nozzle) {
    expect_line("nozzle", of, nozzle.line);
    expect("nozzle_thrust_factor" + of, nozzle.thrust_factor);
    expect("nozzle_flow_factor" + of, nozzle.flow_factor);
  };
  for (std::size_t i = 0; i < kFurtherNozzles; ++i)
    expect_nozzle("_nozzle" + std::to_string(i + 5), in.further[i].nozzle);
  for (std::size_t i = 0; i < kMaxStages; ++i) {
    const std::string of = "_stage" + std::to_string(i + 1);
    StageInputs& stage = in.stages[i];
    expect_line("thrust", of, stage.thrust);
    for (std::size_t nozzle = 0; nozzle < kNozzles; ++nozzle)
      expect_nozzle(of + "_" + kNozzleNames[nozzle], stage.nozzles[nozzle]);
    expect_offset("cg_offset", of, stage.cg_offset_m, "_m");
    expect("dry_mass_factor" + of, stage.dry_mass_factor);
    expect("propellant_factor" + of, stage.propellant_factor);
    expect("product_of_inertia_xy" + of + "_kg_m2", stage.product_of_inertia_xy_kg_m2);
    expect("product_of_inertia_xz" + of + "_kg_m2", stage.product_of_inertia_xz_kg_m2);
    expect("product_of_inertia_yz" + of + "_kg_m2", stage.product_of_inertia_yz_kg_m2);
    expect("ignition_delay" + of + "_s", stage.ignition_delay_s);
    expect("separation_delay" + of + "_s", stage.separation_delay_s);
    expect("drag_factor" + of, stage.drag_factor);
    expect("lift_factor" + of, stage.lift_factor);
    expect("cg_factor" + of, stage.cg_factor);
    expect("cp_factor" + of, stage.cp_factor);
    expect("inertia_factor" + of, stage.inertia_factor);
    expect("actuator_bandwidth_factor" + of, stage.actuator_bandwidth_factor);
    expect("thrust_factor" + of, stage.thrust_factor);
    expect("mass_flow_factor" + of, stage.mass_flow_factor);
    expect("specific_impulse_factor" + of, stage.specific_impulse_factor);
    expect("tip_off_pitch" + of + "_deg_s", stage.tip_off_pitch_rad_s);
    expect("tip_off_yaw" + of + "_deg_s", stage.tip_off_yaw_rad_s);
    expect("tip_off_roll" + of + "_deg_s", stage.tip_off_roll_rad_s);
  }
  expect("wind_max_speed_m_s", in.air.wind_max_speed_m_s);
  expect("wind_azimuth_deg", in.air.wind_azimuth_rad);
  expect("wind_altitude_m", in.air.wind_altitude_m);
  expect("wind_width_m", in.air.wind_width_m);
  expect("gust_speed_m_s", in.air.gust_speed_m_s);
  expect("gust_altitude_m", in.air.gust_altitude_m);
  expect("gust_length_m", in.air.gust_length_m);
  expect("gust_azimuth_deg", in.air.gust_azimuth_rad);
  expect("wind_profile_north_1_m_s", in.air.wind_profile_north_m_s[0]);
  expect("wind_profile_north_20_m_s", in.air.wind_profile_north_m_s[19]);
  expect("wind_profile_east_1_m_s", in.air.wind_profile_east_m_s[0]);
  expect("wind_profile_altitude_20_m", in.air.wind_profile_altitude_m[19]);
  expect("drag_factor", in.drag_factor);
  expect("lift_factor", in.lift_factor);
  expect("cg_factor", in.cg_factor);
  expect("cp_factor", in.cp_factor);
  expect("density_factor", in.air.density_factor);
  expect("inertia_factor", in.inertia_factor);
  expect("actuator_bandwidth_factor", in.actuator_bandwidth_factor);
  expect("gyro_bias_roll_deg_s", in.sensors.gyro_bias_roll_rad_s);
  expect("gyro_bias_pitch_deg_s", in.sensors.gyro_bias_pitch_rad_s);
  expect("gyro_bias_yaw_deg_s", in.sensors.gyro_bias_yaw_rad_s);
  expect("gyro_noise_deg_s", in.sensors.gyro_noise_rad_s);
  expect("stuck_nozzle", in.stuck_nozzle);
  expect("stuck_nozzle_stage", in.stuck_nozzle_stage);
  expect("stuck_nozzle_deg", in.stuck_nozzle_rad);
  expect("pn_error_factor", in.pn_error_factor);
  expect("pn_rate_factor", in.pn_rate_factor);
  expect("loop_gain_factor", in.loop_gain_factor);
  expect("loop_delay_s", in.loop_delay_s);
  expect("loop_stage", in.loop_stage);
  const char* const axes[] = {"downrange", "right", "down"};
  for (std::size_t i = 0; i < 3; ++i) {
    expect(std::string("navigation_position_error_") + axes[i] + "_m",
           in.sensors.navigation_position_error_m[i]);
    expect(std::string("navigation_velocity_error_") + axes[i] + "_m_s",
           in.sensors.navigation_velocity_error_m_s[i]);
  }
  expect("accelerometer_scale_factor", in.sensors.accelerometer_scale_factor);
  expect("payload_mass_kg", in.payload_mass_kg);
  expect("payload_element", in.payload_element);
  expect("launch_azimuth_error_deg", in.launch_azimuth_error_rad);
  expect("initial_roll_error_deg", in.initial_roll_error_rad);
  expect("initial_pitch_error_deg", in.initial_pitch_error_rad);
  expect("initial_yaw_error_deg", in.initial_yaw_error_rad);
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

}  // namespace dispersa::flight_digest_test
