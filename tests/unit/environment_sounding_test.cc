#include "core/environment/sounding.h"

#include "core/environment/atmosphere.h"
#include "core/environment/earth.h"
#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::environment_sounding_test {

using Level = SoundingLevel;

// Of the Earth's own field: gravitation and centrifugal acceleration along the ellipsoid's normal, summed.
double GeopotentialByGravity(double height_m, double latitude_rad) {
  const Earth earth = Wgs84();
  const int steps = 2000;
  double potential = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double z = (i + 0.5) * height_m / steps;
    const Vector3 p = FromGeodetic(earth, {latitude_rad, 0.0, z});
    Vector3 g = Gravitation(earth, p);
    const double omega2 = earth.rotation_rate_rad_s * earth.rotation_rate_rad_s;
    g += Vector3(omega2 * p.x(), omega2 * p.y(), 0.0);
    const Matrix3 axes = NedAxes(latitude_rad, 0.0);
    potential += g.dot(axes.col(2)) * height_m / steps;
  }
  return potential / kStandardGravity;
}

TEST(GeometricHeight, IsThatOfTheEarthsField) {
  for (const double latitude_deg : {0.0, -28.5, 45.0, 69.0, 90.0})
    for (const double height_m : {0.0, 1000.0, 12000.0, 30000.0, 60000.0}) {
      const double latitude = latitude_deg * kRadPerDeg;
      const double geopotential = GeopotentialByGravity(height_m, latitude);
      EXPECT_NEAR(GeometricHeight(geopotential, latitude), height_m, 1.0) << latitude_deg << " " << height_m;
      EXPECT_NEAR(GeopotentialHeight(height_m, latitude), geopotential, 1.0)
          << latitude_deg << " " << height_m;
      EXPECT_NEAR(GeometricHeight(GeopotentialHeight(height_m, latitude), latitude), height_m, 1e-7);
    }
}

// Bolton's own table 1 has 6.112 hPa at 0 °C and 42.43 hPa at 30 °C.
TEST(SaturationPressure, IsBoltons) {
  EXPECT_NEAR(SaturationPressure(273.15), 611.2, 1e-9);
  EXPECT_NEAR(SaturationPressure(303.15), 4243.0, 4.0);
  EXPECT_NEAR(SaturationPressure(248.15), 80.7, 0.3);
}

Level OfStandard(double height_m) {
  const AirState air = StandardAtmosphere1976(height_m);
  return {.height_m = height_m,
          .pressure_pa = air.pressure_pa,
          .temperature_k = air.temperature_k,
          .north_m_s = height_m * 1e-3,
          .east_m_s = -height_m * 2e-3,
          .source = static_cast<int>(height_m)};
}

TEST(ProfileOf, LevelsAsMeasuredStay) {
  const SoundingProfile profile = ProfileOf({OfStandard(0.0), OfStandard(5000.0), OfStandard(20000.0)}, 0.5);
  EXPECT_EQ(profile.table.altitude_m, (std::vector<double>{0.0, 5000.0, 20000.0}));
  EXPECT_EQ(profile.table.north_m_s, (std::vector<double>{0.0, 5.0, 20.0}));
  EXPECT_EQ(profile.table.east_m_s, (std::vector<double>{0.0, -10.0, -40.0}));
  EXPECT_EQ(profile.sources, (std::vector<int>{0, 5000, 20000}));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(
        profile.table.density_kg_m3[i] / StandardAtmosphere1976(profile.table.altitude_m[i]).density_kg_m3,
        1.0, 1e-12);
  EXPECT_EQ(profile.with_heights_by_pressure + profile.dropped + profile.without_air + profile.without_wind,
            0u);
}

// Three levels between two heights and two above the last one; those below the first one have none. The
// temperature is linear in height and the equation takes its mean: 1 m between heights, and above the last
// one 12 m in 4 km.
TEST(ProfileOf, HeightsByPressure) {
  std::vector<Level> levels;
  for (const double height_m : {1000.0, 2000.0, 4000.0, 5000.0, 7000.0, 9000.0, 11000.0, 13000.0})
    levels.push_back(OfStandard(height_m));
  for (const std::size_t without : {0u, 2u, 3u, 4u, 6u, 7u}) levels[without].height_m = Level::kNone;
  const double latitude = std::asin(std::sqrt(0.5));
  const SoundingProfile profile = ProfileOf(levels, latitude);
  EXPECT_EQ(profile.with_heights_by_pressure, 5u);
  EXPECT_EQ(profile.dropped, 1u);
  const std::vector<double>& z = profile.table.altitude_m;
  ASSERT_EQ(z.size(), 7u);
  EXPECT_EQ(z[0], 2000.0);
  EXPECT_NEAR(z[1], 4000.0, 2.0);
  EXPECT_NEAR(z[2], 5000.0, 2.0);
  EXPECT_NEAR(z[3], 7000.0, 2.0);
  EXPECT_EQ(z[4], 9000.0);
  EXPECT_NEAR(z[5], 11000.0, 12.0);
  EXPECT_NEAR(z[6], 13000.0, 12.0);
}

TEST(ProfileOf, TheWindIsLinearWhereItLacksHoldsBelowAndFadesAbove) {
  std::vector<Level> levels;
  for (const double height_m : {0.0, 2000.0, 3000.0, 6000.0, 11000.0, 17000.0})
    levels.push_back(OfStandard(height_m));
  for (const std::size_t without : {0u, 2u, 4u, 5u}) levels[without].north_m_s = Level::kNone;
  const SoundingProfile profile = ProfileOf(levels, {});
  EXPECT_EQ(profile.without_wind, 4u);
  const std::vector<double> north = {2.0, 2.0, 3.0, 6.0, 3.0, 0.0},
                            east = {-4.0, -4.0, -6.0, -12.0, -6.0, 0.0};
  for (std::size_t i = 0; i < north.size(); ++i) {
    EXPECT_NEAR(profile.table.north_m_s[i], north[i], 1e-12) << i;
    EXPECT_NEAR(profile.table.east_m_s[i], east[i], 1e-12) << i;
  }
}

TEST(ProfileOf, TheAirIsThatOfAWeatherTable) {
  std::vector<Level> levels;
  for (const double height_m : {0.0, 1000.0, 2000.0, 4000.0, 9000.0, 15000.0})
    levels.push_back(OfStandard(height_m));
  for (const std::size_t without : {0u, 2u, 4u, 5u}) levels[without].temperature_k = Level::kNone;
  levels[1].pressure_pa *= 1.02, levels[3].pressure_pa *= 0.98;
  const SoundingProfile profile = ProfileOf(levels, {});
  EXPECT_EQ(profile.without_air, 4u);
  const std::vector<double>& p = profile.table.pressure_pa;
  const auto standard = [&](std::size_t i) { return StandardAtmosphere1976(levels[i].height_m).pressure_pa; };
  EXPECT_NEAR(p[0] / standard(0), 1.02, 1e-12);                            // below: the ratio holds
  EXPECT_NEAR(p[2], p[1] * std::pow(p[3] / p[1], 1000.0 / 3000.0), 1e-6);  // exponential
  EXPECT_NEAR(p[4] / standard(4), 0.99, 1e-12);                            // half-way of 10 km above
  EXPECT_NEAR(p[5] / standard(5), 1.0, 1e-12);
}

TEST(ProfileOf, VapourMakesAirLighter) {
  Level dry = OfStandard(0.0), moist = dry;
  moist.vapour_pa = 2000.0;
  const auto density = [](const Level& level) {
    return ProfileOf({level, OfStandard(5000.0)}, {}).table.density_kg_m3[0];
  };
  EXPECT_NEAR(density(moist) / density(dry), 1.0 - 0.378 * 2000.0 / 101325.0, 1e-5);
  // A density that was measured holds.
  moist.density_kg_m3 = 1.3;
  EXPECT_EQ(density(moist), 1.3);
  // And gives the pressure that lacks.
  dry.density_kg_m3 = 1.2, dry.pressure_pa = Level::kNone;
  EXPECT_NEAR(ProfileOf({dry, OfStandard(5000.0)}, {}).table.pressure_pa[0],
              1.2 * kAirGasConstant_j_kg_k * 288.15, 1e-6);
}

TEST(ProfileOf, LevelsInAnyOrderAndAtOnePlaceAreOne) {
  Level wind = OfStandard(3004.0), air = OfStandard(3000.0);
  wind.pressure_pa = wind.temperature_k = Level::kNone;
  air.north_m_s = air.east_m_s = Level::kNone;
  const SoundingProfile profile = ProfileOf({OfStandard(9000.0), wind, OfStandard(0.0), air}, {});
  EXPECT_EQ(profile.table.altitude_m, (std::vector<double>{0.0, 3000.0, 9000.0}));
  EXPECT_EQ(profile.table.north_m_s[1], 3.004);
  EXPECT_EQ(profile.table.pressure_pa[1], air.pressure_pa);
  EXPECT_EQ(profile.dropped, 1u);
  EXPECT_EQ(profile.sources, (std::vector<int>{0, 3000, 9000}));
}

TEST(ProfileOf, OneLevelWithAirIsNone) {
  Level second = OfStandard(1000.0);
  second.temperature_k = Level::kNone;
  EXPECT_FALSE(ProfileOf({OfStandard(0.0), second}, {}).table.has_air());
}

TEST(ProfileOf, NothingIsAnEmptyTable) { EXPECT_TRUE(ProfileOf({}, {}).table.altitude_m.empty()); }

}  // namespace dispersa::environment_sounding_test
