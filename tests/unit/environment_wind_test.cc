#include "core/environment/wind.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/math/constants.h"

namespace dispersa::environment_wind_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
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
  EXPECT_THAT(Problems(wind), IsEmpty());
}

TEST(JetStream, Problems) {
  EXPECT_THAT(Problems(JetStream{60.96, 12000.0, 12000.0, 0.0}), IsEmpty());
  EXPECT_THAT(Problems(JetStream{-1.0, NAN, 0.0, kInfinity}),
              ElementsAre("the maximum speed of a jet stream must be finite and not negative",
                          "the altitude of a jet stream must be finite",
                          "the width of a jet stream must be finite and positive",
                          "the azimuth of a jet stream must be finite"));
}

TEST(WindTable, Problems) {
  EXPECT_THAT(Problems(WindTable{{0.0, 1.0}, {0.0, 1.0}, {0.0, 1.0}}), IsEmpty());
  EXPECT_THAT(Problems(WindTable{{0.0}, {0.0}, {0.0}}),
              ElementsAre("a wind table needs at least two altitudes"));
  EXPECT_THAT(Problems(WindTable{{0.0, 2.0, 1.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}),
              ElementsAre("the altitudes of a wind table must be finite and strictly increasing"));
  EXPECT_THAT(Problems(WindTable{{0.0, 1.0}, {0.0}, {0.0, 1.0}}),
              ElementsAre("a wind table needs one north and one east value for each altitude"));
  EXPECT_THAT(Problems(WindTable{{0.0, 1.0}, {0.0, NAN}, {0.0, 1.0}}),
              ElementsAre("the values of a wind table must be finite"));
}

TEST(Gust, Problems) {
  EXPECT_THAT(Problems(Gust{9.0, 5000.0, 240.0, 0.0}), IsEmpty());
  EXPECT_THAT(Problems(Gust{-9.0, kInfinity, -240.0, NAN}),
              ElementsAre("the speed of a gust must be finite and not negative",
                          "the start altitude of a gust must be finite",
                          "the length of a gust must be finite and positive",
                          "the azimuth of a gust must be finite"));
}

TEST(Wind, ProblemsSayWhichPart) {
  const Wind wind{.jets = {{1.0, 0.0, 1.0, 0.0}, {1.0, 0.0, -1.0, 0.0}},
                  .tables = {{{0.0}, {0.0}, {0.0}}},
                  .gusts = {{1.0, 0.0, 0.0, 0.0}},
                  .steady = {NAN, 0.0}};
  EXPECT_THAT(Problems(wind), ElementsAre("jets[1]: the width of a jet stream must be finite and positive",
                                          "tables[0]: a wind table needs at least two altitudes",
                                          "gusts[0]: the length of a gust must be finite and positive",
                                          "steady: the components of a steady wind must be finite"));
}

}  // namespace
}  // namespace dispersa::environment_wind_test
