#include "core/environment/wind.h"

#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::environment_wind_test {

// Rounding of a product of a speed below 100 m/s with a sine.
constexpr double kRounding = 1e-13;

double Speed(const WindNorthEast& wind) { return std::hypot(wind.north_m_s, wind.east_m_s); }

void ExpectWind(const WindNorthEast& actual, double north, double east) {
  EXPECT_NEAR(actual.north_m_s, north, kRounding);
  EXPECT_NEAR(actual.east_m_s, east, kRounding);
}

TEST(Wind, DirectionIsWhereItComesFrom) {
  ExpectWind(FromAzimuth(10.0, 0.0), -10.0, 0.0);      // a north wind blows south
  ExpectWind(FromAzimuth(10.0, kPi / 2), 0.0, -10.0);  // an east wind blows west
  ExpectWind(FromAzimuth(10.0, kPi), 10.0, 0.0);
  ExpectWind(FromAzimuth(10.0, 3 * kPi / 2), 0.0, 10.0);  // a westerly blows east
  ExpectWind(FromAzimuth(10.0, 240 * kRadPerDeg), 5.0, 10.0 * std::sqrt(0.75));
}

TEST(Wind, EmptyIsCalm) { EXPECT_EQ(Speed(Evaluate(Wind{}, 5000.0)), 0.0); }

TEST(JetStream, PeakWidthAndEdges) {
  const Wind wind{.jets = {{60.96, 12000.0, 10000.0, 3 * kPi / 2}}};
  ExpectWind(Evaluate(wind, 12000.0), 0.0, 60.96);
  EXPECT_NEAR(Speed(Evaluate(wind, 7000.0)), 30.48, kRounding);  // half maximum half a width away
  EXPECT_NEAR(Speed(Evaluate(wind, 17000.0)), 30.48, kRounding);
  EXPECT_EQ(Speed(Evaluate(wind, 2000.0)), 0.0);
  EXPECT_EQ(Speed(Evaluate(wind, 22000.0)), 0.0);
  EXPECT_EQ(Speed(Evaluate(wind, 0.0)), 0.0);
  EXPECT_EQ(Speed(Evaluate(wind, 1e6)), 0.0);
  for (double h = 0.0; h < 30000.0; h += 10.0) EXPECT_LE(Speed(Evaluate(wind, h)), 60.96 + kRounding) << h;
}

// Within 1 m of an edge the speed is V (pi/2 / width)² of a metre squared, 1.5e-6 m/s.
TEST(JetStream, LeavesWithoutAKink) {
  const Wind wind{.jets = {{60.96, 12000.0, 10000.0, 1.0}}};
  EXPECT_NEAR(Speed(Evaluate(wind, 2001.0)), 60.96 * std::pow(kPi / 2 / 10000.0, 2), 1e-11);
  EXPECT_NEAR(Speed(Evaluate(wind, 21999.0)), 60.96 * std::pow(kPi / 2 / 10000.0, 2), 1e-11);
}

TEST(WindTable, LinearHeldBelowAndFadingAbove) {
  const Wind wind{.tables = {{{1000.0, 2000.0, 4000.0}, {1.0, 3.0, -4.0}, {10.0, 0.0, 8.0}}}};
  ExpectWind(Evaluate(wind, 1500.0), 2.0, 5.0);
  ExpectWind(Evaluate(wind, 3000.0), -0.5, 4.0);
  ExpectWind(Evaluate(wind, 2000.0), 3.0, 0.0);
  ExpectWind(Evaluate(wind, -100.0), 1.0, 10.0);
  ExpectWind(Evaluate(wind, 4000.0), -4.0, 8.0);
  ExpectWind(Evaluate(wind, 4000.0 + 0.25 * kWindFade_m), -3.0, 6.0);
  ExpectWind(Evaluate(wind, 4000.0 + kWindFade_m), 0.0, 0.0);
  ExpectWind(Evaluate(wind, 4000.0 + 2.0 * kWindFade_m), 0.0, 0.0);
}

TEST(Gust, OneMinusCosine) {
  const Wind wind{.gusts = {{9.0, 5000.0, 240.0, kPi}}};
  ExpectWind(Evaluate(wind, 5000.0), 0.0, 0.0);
  ExpectWind(Evaluate(wind, 5060.0), 4.5, 0.0);
  ExpectWind(Evaluate(wind, 5120.0), 9.0, 0.0);
  ExpectWind(Evaluate(wind, 5180.0), 4.5, 0.0);
  ExpectWind(Evaluate(wind, 5240.0), 0.0, 0.0);
  ExpectWind(Evaluate(wind, 5300.0), 0.0, 0.0);
  ExpectWind(Evaluate(wind, 4900.0), 0.0, 0.0);
}

TEST(Wind, SumsItsParts) {
  const Wind wind{.jets = {{60.0, 12000.0, 12000.0, 3 * kPi / 2}, {10.0, 12000.0, 12000.0, kPi}},
                  .tables = {{{0.0, 20000.0}, {2.0, 2.0}, {-1.0, -1.0}}},
                  .gusts = {{8.0, 11000.0, 2000.0, kPi / 2}},
                  .steady = {0.5, 0.25}};
  ExpectWind(Evaluate(wind, 12000.0), 10.0 + 2.0 + 0.5, 60.0 - 1.0 - 8.0 + 0.25);
}

}  // namespace dispersa::environment_wind_test
