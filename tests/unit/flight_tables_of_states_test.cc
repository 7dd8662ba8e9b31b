// The tables that a stack flies with: of its planes, with the motor out, and after bodies have left; as the
// file has them and as a case draws them. Every number is another one.
#include "core/flight/flight_model.h"
#include "core/vehicle/aero_table.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_tables_of_states_test {
namespace {

// A table of one plane whose coefficients are these, with uncertainties of its own.
AeroTable With(double ca, double off, double cn, double xcp_m, double part) {
  AeroTable table = SampleTable();
  table.ca.assign(4, ca);
  table.ca_power_off.assign(4, off);
  table.cn = {0.0, cn, 0.0, cn};
  table.xcp_station_m.assign(4, xcp_m);
  table.cmq_per_rad = {-cn, -cn};
  table.clp_per_rad = {-ca, -ca};
  table.uncertainty = {std::vector<double>(4, part),
                       std::vector<double>(4, 2.0 * part),
                       std::vector<double>(4, 3.0 * part),
                       {4.0 * part, 4.0 * part}};
  return table;
}

// A stack of two planes that lets go of two bodies, one after the other.
AeroTable OfStates() {
  AeroTable table = With(0.30, 0.40, 3.0, 4.0, 0.010);
  table.yaw_plane = {With(0.33, 0.44, 3.3, 4.4, 0.011)};
  AeroTable first = With(0.20, 0.25, 2.0, 5.0, 0.020), second = With(0.10, 0.15, 1.0, 6.0, 0.030);
  first.yaw_plane = {With(0.22, 0.27, 2.2, 5.5, 0.022)};
  second.yaw_plane = {With(0.11, 0.16, 1.1, 6.6, 0.033)};
  table.lighter = {{{"one"}, first}, {{"one", "other"}, second}};
  return table;
}

void ExpectDrawn(const AeroTable& is, const AeroTable& of, const AeroSigmas& sigmas, const char* which) {
  const double part = of.uncertainty.ca[0];
  EXPECT_NEAR(is.ca[3], of.ca[3] * (1.0 + sigmas.ca * part), 1e-14) << which;
  EXPECT_NEAR(is.ca_power_off[3], of.ca_power_off[3] * (1.0 + sigmas.ca * part), 1e-14) << which;
  EXPECT_NEAR(is.cn[3], of.cn[3] * (1.0 + sigmas.cn * 2.0 * part), 1e-14) << which;
  EXPECT_NEAR(is.xcp_station_m[3], of.xcp_station_m[3] + sigmas.xcp * 3.0 * part, 1e-14) << which;
  EXPECT_NEAR(is.cmq_per_rad[1], of.cmq_per_rad[1] * (1.0 + sigmas.damping * 4.0 * part), 1e-14) << which;
}

TEST(TablesOfStates, AreAllDrawnByOneCase) {
  const AeroTable table = OfStates();
  for (const double sign : {1.0, -1.0}) {
    const AeroSigmas sigmas{sign * 1.0, sign * -2.0, sign * 3.0, sign * -0.5};
    const AeroTable drawn = Drawn(table, sigmas);
    ExpectDrawn(drawn, table, sigmas, "whole");
    ExpectDrawn(drawn.yaw_plane[0], table.yaw_plane[0], sigmas, "its yaw plane");
    ASSERT_EQ(drawn.lighter.size(), 2u);
    for (const std::size_t k : {0u, 1u}) {
      const AeroTable &is = drawn.lighter[k].table, &of = table.lighter[k].table;
      ExpectDrawn(is, of, sigmas, k == 0 ? "first lighter" : "second lighter");
      ExpectDrawn(is.yaw_plane[0], of.yaw_plane[0], sigmas, "a lighter one's yaw plane");
    }
  }
  AeroTable of_lighter = table;
  of_lighter.uncertainty = of_lighter.lighter[0].table.uncertainty = {};
  EXPECT_TRUE(IsUncertain(of_lighter));
  of_lighter.lighter[1].table.uncertainty = {};
  EXPECT_FALSE(IsUncertain(of_lighter));
}

// Axial force in the plane of pitch and in that of yaw, by state: with the motor out, and without bodies.
TEST(TablesOfStates, FlyInTheirPlaneAndState) {
  Vehicle vehicle = SampleVehicle();
  Jettison one, other;
  one.name = "one";
  other.name = "other";
  vehicle.stages[1].jettisoned = {one, other};
  vehicle.aerodynamics[0] = OfStates();
  const LauncherPlant plant = BuildNominalPlant(vehicle);
  const LauncherStack& stack = plant.stacks[0];
  EXPECT_EQ(stack.aerodynamics.ca.table.z[3], 0.30);
  EXPECT_EQ(stack.aerodynamics.ca_yaw.table.z[3], 0.33);
  struct Expected {
    unsigned without;
    bool power_off;
    double ca, ca_yaw, cn, cn_yaw;
  };
  constexpr Expected kExpected[] = {{0u, true, 0.40, 0.44, 3.0, 3.3},
                                    {1u, false, 0.20, 0.22, 2.0, 2.2},
                                    {1u, true, 0.25, 0.27, 2.0, 2.2},
                                    {3u, false, 0.10, 0.11, 1.0, 1.1},
                                    {3u, true, 0.15, 0.16, 1.0, 1.1}};
  ASSERT_TRUE(stack.aero_variants);
  ASSERT_EQ(stack.aero_variants->size(), std::size(kExpected));
  for (std::size_t i = 0; i < std::size(kExpected); ++i) {
    const AeroVariant& is = (*stack.aero_variants)[i];
    EXPECT_EQ(is.without, kExpected[i].without) << i;
    EXPECT_EQ(is.power_off, kExpected[i].power_off) << i;
    EXPECT_EQ(is.body.ca.table.z[3], kExpected[i].ca) << i;
    EXPECT_EQ(is.body.ca_yaw.table.z[3], kExpected[i].ca_yaw) << i;
    EXPECT_EQ(is.body.cn.table.z[3], kExpected[i].cn) << i;
    EXPECT_EQ(is.body.cn_yaw.table.z[3], kExpected[i].cn_yaw) << i;
  }
}

}  // namespace
}  // namespace dispersa::flight_tables_of_states_test
