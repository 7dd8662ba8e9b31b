#include "core/report/flight_bands.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/unit/report_test_support.h"

namespace dispersa {
namespace {

using report_test::kNaN;
using testing::ElementsAre;

constexpr double kStep_s = 0.2;

/// Rows of (time, value in column 1).
History MakeHistory(const std::vector<std::pair<double, double>>& rows) {
  History history;
  for (const auto& [time_s, value] : rows) {
    std::vector<double> row(HistoryColumns().size(), 0.0);
    row[0] = time_s;
    row[1] = value;
    history.values.insert(history.values.end(), row.begin(), row.end());
  }
  return history;
}

TEST(SampleFlight, TakesTheLastRowOfAnInstantAndNoEventBetween) {
  // An event at 0.2 s (two rows) and one at 0.33 s, between the samples.
  const History history = MakeHistory({{0.0, 1.0}, {0.2, 2.0}, {0.2, 3.0}, {0.33, 9.0}, {0.4, 4.0}});
  const SampledFlight samples = SampleFlight(history, {1}, kStep_s);
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_THAT(samples[0], ElementsAre(1.0, 3.0, 4.0));
}

TEST(ComputeBands, AreOrderStatisticsOfThoseStillFlying) {
  const std::vector<SampledFlight> flights = {{{1.0, 10.0}}, {{3.0}}, {{2.0, 30.0}}, {{kNaN, 20.0}}};
  const FlightBands bands = ComputeBands(flights, {1}, kStep_s);
  ASSERT_EQ(bands.bands.size(), 1u);
  EXPECT_EQ(bands.flights, 4u);
  EXPECT_THAT(bands.time_s, ElementsAre(0.0, 0.2));
  EXPECT_THAT(bands.flying, ElementsAre(4, 3));
  EXPECT_EQ(bands.bands[0].column, HistoryColumns()[1]);
  EXPECT_THAT(bands.bands[0].min, ElementsAre(1.0, 10.0));
  EXPECT_THAT(bands.bands[0].p50, ElementsAre(2.0, 20.0));
  EXPECT_THAT(bands.bands[0].max, ElementsAre(3.0, 30.0));
  EXPECT_DOUBLE_EQ(bands.bands[0].p95[0], 2.9);  // 95 % of the way through ranks 0, 1, 2: 2 + 0.9
}

TEST(ComputeBands, DoNotDependOnTheOrderOfFlights) {
  std::vector<SampledFlight> flights = {{{0.1, 0.2}}, {{0.7}}, {{-0.4, 0.9}}};
  const std::string csv = BandsCsv(ComputeBands(flights, {1}, kStep_s));
  std::swap(flights[0], flights[2]);
  EXPECT_EQ(BandsCsv(ComputeBands(flights, {1}, kStep_s)), csv);
}

TEST(BandsCsv, NamesItsColumns) {
  const std::string name = HistoryColumns()[1];
  const FlightBands bands = ComputeBands({{{1.0}}, {{1.0}}}, {1}, kStep_s);
  EXPECT_EQ(BandsCsv(bands), "time_s,flights," + name + "_min," + name + "_p01," + name + "_p05," + name +
                                 "_p50," + name + "_p95," + name + "_p99," + name +
                                 "_max\n0,2,1,1,1,1,1,1,1\n");
}

}  // namespace
}  // namespace dispersa
