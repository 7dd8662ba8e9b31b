#include "core/environment/weather_ensemble.h"

#include "core/environment/atmosphere.h"
#include "core/math/functions.h"
#include "tests/test.h"

namespace dispersa::environment_weather_ensemble_test {

DatedWeather Member(const std::string& time, double north_m_s, double east_m_s, double top_m) {
  DatedWeather one{time + ".csv", time};
  one.table.altitude_m = {50.0, top_m};
  one.table.north_m_s = {north_m_s, north_m_s};
  one.table.east_m_s = {east_m_s, 3.0 * east_m_s};
  return one;
}

TEST(MonthOf, OfDaysAndHours) {
  EXPECT_EQ(MonthOf("2020-01-15"), 1);
  EXPECT_EQ(MonthOf("1999-12-31T24"), 12);
  for (const char* text : {"", "2020-13-01", "2020-00-01", "2020-01-00", "2020-01-32", "2020-1-15",
                           "2020-01-15T25", "2020-01-15T1", "2020/01/15", "2020-01-15 12", "2o20-01-15"})
    EXPECT_EQ(MonthOf(text), 0) << text;
}

// Three soundings of January, of two years, and one of July.
TEST(WeighByMonth, MonthsAreEquallyLikely) {
  std::vector<DatedWeather> all;
  for (const char* time : {"2019-01-03", "2020-01-15T12", "2020-07-15T00", "2020-01-16"})
    all.push_back(Member(time, 0.0, 0.0, 20e3));
  WeighByMonth(all);
  EXPECT_EQ(all[2].weight, 1.0);
  for (const std::size_t i : {0u, 1u, 3u}) EXPECT_EQ(all[i].weight, 1.0 / 3.0) << i;
}

TEST(MeanWeather, IsOfWindsByWeight) {
  std::vector<DatedWeather> all = {Member("2020-01-15", 8.0, -2.0, 20e3),
                                   Member("2020-07-15", -4.0, 10.0, 20e3),
                                   Member("2020-07-16", -4.0, 10.0, 10050.0)};
  const WeatherTable mean = MeanWeather(all);
  EXPECT_FALSE(mean.has_air());
  EXPECT_EQ(mean.altitude_m.front(), 50.0);
  EXPECT_EQ(mean.altitude_m[1], 150.0);
  EXPECT_GE(mean.altitude_m.back(), 20e3);
  EXPECT_LT(mean.altitude_m.back(), 20.1e3);
  EXPECT_NEAR(mean.north_m_s.front(), 0.0, 1e-14);
  EXPECT_NEAR(mean.east_m_s.front(), 6.0, 1e-14);
  // Halfway through its fading the third counts half: (8 - 4 - 2) / 3.
  EXPECT_NEAR(mean.north_m_s[150], 2.0 / 3.0, 1e-12);
  all[0].weight = 2.0;
  EXPECT_NEAR(MeanWeather(all).north_m_s.front(), 2.0, 1e-14);
  EXPECT_NEAR(MeanWeather(all).east_m_s.front(), 4.0, 1e-14);
}

TEST(MeanWeather, IsOfTheLogarithmsOfTheAir) {
  std::vector<DatedWeather> all = {Member("2020-01-15", 0.0, 0.0, 20e3),
                                   Member("2020-07-15", 0.0, 0.0, 20e3)};
  all[0].table.pressure_pa = {100e3, 5e3};
  all[0].table.density_kg_m3 = {1.3, 0.08};
  WeatherTable mean = MeanWeather(all);  // the second flies the standard
  ASSERT_TRUE(mean.has_air());
  const AirState standard = StandardAtmosphere1976(50.0);
  EXPECT_NEAR(mean.pressure_pa[0] / Sqrt(100e3 * standard.pressure_pa), 1.0, 1e-10);
  EXPECT_NEAR(mean.density_kg_m3[0] / Sqrt(1.3 * standard.density_kg_m3), 1.0, 1e-10);
  all[1].table.pressure_pa = {101e3, 6e3};
  all[1].table.density_kg_m3 = {1.1, 0.09};
  mean = MeanWeather(all);
  EXPECT_NEAR(mean.density_kg_m3[0] / Sqrt(1.3 * 1.1), 1.0, 1e-10);
}

TEST(WindTop, IsWhereTheWindOnlyFades) {
  WeatherTable table;
  table.altitude_m = {0.0, 2000.0, 5000.0, 7000.0, 18000.0};
  table.north_m_s = {1.0, -4.0, -10.0, -8.0, 0.0};
  table.east_m_s = {0.0, 0.0, 5.0, 4.0, 0.0};
  EXPECT_EQ(WindTop(table), 5000.0);
  table.east_m_s[3] = 4.1;
  EXPECT_EQ(WindTop(table), 7000.0);
  table.east_m_s[4] = 1.0;
  EXPECT_EQ(WindTop(table), 18000.0);
  table.north_m_s = table.east_m_s = {0.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(WindTop(table), 18000.0);
}

}  // namespace dispersa::environment_weather_ensemble_test
