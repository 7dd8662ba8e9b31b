// Verifies the atmosphere against the US Standard Atmosphere, 1976, as computed or printed by others.
#include "core/environment/atmosphere.h"
#include "tests/test.h"
#include "tests/unit/read_csv.h"

namespace dispersa::us76_test {
namespace {

void ExpectRelative(double actual, double expected, double tolerance, double at) {
  EXPECT_NEAR(actual, expected, tolerance * std::fabs(expected)) << "at " << at;
}

// python3-fluids, 9 digits: half a unit of the last is at most 5e-9. Temperature is the molecular-scale one,
// which up to 80 km is the kinetic one.
TEST(Us76, EveryKilometreTo80) {
  const auto rows = ReadCsv(DISPERSA_TEST_DATA "/us76/grid_0_80km.csv");
  ASSERT_EQ(rows.size(), 81u);
  for (const auto& row : rows) {
    const AirState air = StandardAtmosphere1976(row[0]);
    ExpectRelative(air.temperature_k, row[1], 5e-9, row[0]);
    ExpectRelative(air.pressure_pa, row[2], 5e-9, row[0]);
    ExpectRelative(air.density_kg_m3, row[3], 5e-9, row[0]);
    ExpectRelative(air.speed_of_sound_m_s, row[4], 5e-9, row[0]);
  }
}

// The standard's tables have five digits (half a unit of the last is at most 5e-5; density is derived from
// two of them), and their altitudes below 86 km are rounded to a metre, worth 8e-5 in pressure.
TEST(Us76, TabulatedNodesTo1000Km) {
  const auto rows = ReadCsv(DISPERSA_TEST_DATA "/us76/us76_nodes_0_1000km.csv");
  ASSERT_EQ(rows.size(), 49u);
  for (const auto& row : rows) {
    const double z = 1e3 * row[0];
    const AirState air = StandardAtmosphere1976(z);
    // The file's temperature at 86 km is molecular-scale, and its density follows from it.
    const double kinetic = z == 86e3 ? row[2] / 28.9644 : 1.0;
    ExpectRelative(air.temperature_k, row[1] * kinetic, 5e-5, z);
    ExpectRelative(air.pressure_pa, row[3], 1e-4, z);
    ExpectRelative(air.density_kg_m3, row[4] / kinetic, 1.5e-4, z);
  }
}

// Midway between the nodes, where the interpolation is worst, against an integration of the standard's
// equations. The header promises 0.1 %.
TEST(Us76, BetweenTheNodesAbove86Km) {
  const auto rows = ReadCsv(DISPERSA_TEST_DATA "/us76/upper_integrated.csv");
  ASSERT_EQ(rows.size(), 41u);
  for (const auto& row : rows) {
    const double z = 1e3 * row[0];
    const AirState air = StandardAtmosphere1976(z);
    EXPECT_NEAR(air.temperature_k, row[1], 1e-3) << z;  // three decimals
    ExpectRelative(air.pressure_pa, row[3], 1.0e-3, z);
    ExpectRelative(air.density_kg_m3, row[4], 1.0e-3, z);
  }
}

}  // namespace
}  // namespace dispersa::us76_test
