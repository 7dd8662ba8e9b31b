#include "core/environment/atmosphere.h"

#include "core/environment/density_factor.h"
#include "tests/test.h"

namespace dispersa::environment_atmosphere_test {

void ExpectRelative(double actual, double expected, double tolerance, double at) {
  EXPECT_NEAR(actual, expected, tolerance * std::fabs(expected)) << "at " << at;
}

// Geopotential layer boundaries as geometric altitudes, the nodes of M/M0 from 80 km to 86 km, the limits
// of the temperature laws, and nodes of the upper part: 2 mm apart nothing changes by more than 1e-6
// relative (the steepest value, density, changes by 2e-4 per metre).
TEST(StandardAtmosphere, IsContinuous) {
  std::vector<double> boundaries;
  for (const double h : {0.0, 11000.0, 20000.0, 32000.0, 47000.0, 51000.0, 71000.0})
    boundaries.push_back(6356766.0 * h / (6356766.0 - h));
  for (double z = 80000.0; z <= 86000.0; z += 500.0) boundaries.push_back(z);
  for (const double z : {91e3, 94e3, 97e3, 100e3, 110e3, 112e3, 120e3, 150e3, 300e3, 600e3, 950e3, -5e3})
    boundaries.push_back(z);
  for (const double z : boundaries) {
    const AirState below = StandardAtmosphere1976(z - 1e-3);
    const AirState above = StandardAtmosphere1976(z + 1e-3);
    ExpectRelative(above.temperature_k, below.temperature_k, 1e-6, z);
    ExpectRelative(above.pressure_pa, below.pressure_pa, 1e-6, z);
    ExpectRelative(above.density_kg_m3, below.density_kg_m3, 1e-6, z);
    ExpectRelative(above.speed_of_sound_m_s, below.speed_of_sound_m_s, 1e-6, z);
  }
}

// Central differences over 2 m: their error is (2 m / scale height)² / 6, about 2e-8, above the rounding.
TEST(StandardAtmosphere, IsInHydrostaticBalanceBelow86Km) {
  for (double z = -4900.0; z < 86000.0; z += 37.0) {
    const double slope =
        (StandardAtmosphere1976(z + 1.0).pressure_pa - StandardAtmosphere1976(z - 1.0).pressure_pa) / 2.0;
    const double gravity = 9.80665 * std::pow(6356766.0 / (6356766.0 + z), 2);
    ExpectRelative(slope, -gravity * StandardAtmosphere1976(z).density_kg_m3, 1e-6, z);
  }
}

TEST(StandardAtmosphere, OutsideItsRange) {
  const AirState bottom = StandardAtmosphere1976(-5000.0);
  const AirState deep = StandardAtmosphere1976(-50000.0);
  EXPECT_EQ(deep.temperature_k, bottom.temperature_k);
  EXPECT_EQ(deep.pressure_pa, bottom.pressure_pa);
  EXPECT_EQ(deep.density_kg_m3, bottom.density_kg_m3);
  EXPECT_EQ(deep.speed_of_sound_m_s, bottom.speed_of_sound_m_s);

  EXPECT_GT(StandardAtmosphere1976(1e6).density_kg_m3, 0.0);
  const AirState space = StandardAtmosphere1976(1e6 + 1.0);
  EXPECT_EQ(space.temperature_k, 1000.0);
  EXPECT_EQ(space.pressure_pa, 0.0);
  EXPECT_EQ(space.density_kg_m3, 0.0);
  EXPECT_EQ(space.speed_of_sound_m_s, StandardAtmosphere1976(1e6).speed_of_sound_m_s);
}

TEST(DensityFactor, ScalesDensityAndPressureAtHeldTemperature) {
  const AirState air = StandardAtmosphere1976(12000.0);
  const AirState dense = Scaled(air, 1.25);
  EXPECT_EQ(dense.density_kg_m3, 1.25 * air.density_kg_m3);
  EXPECT_EQ(dense.pressure_pa, 1.25 * air.pressure_pa);
  EXPECT_EQ(dense.temperature_k, air.temperature_k);
  EXPECT_EQ(dense.speed_of_sound_m_s, air.speed_of_sound_m_s);
}

TEST(DensityFactor, IsScaleTimesProfile) {
  EXPECT_EQ(DensityFactor{}(5000.0), 1.0);
  EXPECT_EQ(DensityFactor{0.9}(5000.0), 0.9);
  const DensityFactor factor{2.0, {{0.0, 10000.0}, {1.0, 1.5}}};
  EXPECT_DOUBLE_EQ(factor(5000.0), 2.5);
  EXPECT_DOUBLE_EQ(factor(-1.0), 2.0);
  EXPECT_DOUBLE_EQ(factor(50000.0), 3.0);
}

}  // namespace dispersa::environment_atmosphere_test
