#include "core/analysis/flight_bands.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/analysis/band_counter.h"
#include "core/random/draws.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_bands_test {
namespace {

using report_test::kNaN;

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

// Dynamic pressure times incidence of each flight by itself: no product of two percentiles.
TEST(SampleFlight, MakesQAlphaAndLetsLongitudesRunOn) {
  for (const double sign : {1.0, -1.0}) {
    History history = MakeHistory({{0.0, 0.0}, {0.2, 0.0}, {0.4, 0.0}});
    const auto set = [&](std::size_t row, const char* name, double value) {
      history.values[row * HistoryColumns().size() + static_cast<std::size_t>(FindHistoryColumn(name))] =
          value;
    };
    const double crossing_deg[] = {179.0, 180.0, -179.0};
    for (std::size_t row = 0; row < 3; ++row) {
      set(row, "longitude_deg", sign * crossing_deg[row]);
      set(row, "qbar_pa", 1000.0);
      set(row, "incidence_deg", 18.0 * static_cast<double>(row));
    }
    const SampledFlight samples = SampleFlight(
        history, {FindHistoryColumn("longitude_deg"), FindBandColumn("q_alpha_pa_rad")}, kStep_s);
    EXPECT_THAT(samples[0], ElementsAre(sign * 179.0, sign * 180.0, sign * 181.0));
    EXPECT_DOUBLE_EQ(samples[1][2], 1000.0 * std::numbers::pi / 5.0);
  }
}

// Each axis by its own error, and by the thrust of its own flight: another coasts at another time.
TEST(SampleFlight, LeavesAttitudeErrorsWithoutThrustOut) {
  History history = MakeHistory({{0.0, 0.0}, {0.2, 0.0}, {0.4, 0.0}});
  const char* const axes[] = {"pitch", "yaw", "roll"};
  std::vector<int> columns;
  for (std::size_t row = 0; row < 3; ++row) {
    const auto set = [&](const std::string& name, double value) {
      history.values[row * HistoryColumns().size() + static_cast<std::size_t>(FindHistoryColumn(name))] =
          value;
    };
    set("thrust_n", row == 1 ? 0.0 : 10.0);
    for (int axis = 0; axis < 3; ++axis) set(fmt::format("{}_error_deg", axes[axis]), axis + 1.0);
  }
  for (const char* axis : axes) columns.push_back(FindBandColumn(fmt::format("{}_error_powered_deg", axis)));
  const SampledFlight samples = SampleFlight(history, columns, kStep_s);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(samples[axis][0], static_cast<double>(axis) + 1.0);
    EXPECT_TRUE(std::isnan(samples[axis][1]));
    EXPECT_EQ(samples[axis][2], static_cast<double>(axis) + 1.0);
  }
  EXPECT_EQ(FindBandColumn("pitch_error_deg"), FindHistoryColumn("pitch_error_deg"));
  EXPECT_EQ(FindBandColumn("none"), -1);
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
  // 0.27, 99 and 99.73 % of the way through ranks 0, 1, 2.
  EXPECT_DOUBLE_EQ(bands.bands[0].p00_27[0], 1.0054);
  EXPECT_DOUBLE_EQ(bands.bands[0].p99[0], 2.98);
  EXPECT_DOUBLE_EQ(bands.bands[0].p99_73[0], 2.9946);
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
  EXPECT_EQ(BandsCsv(bands), "time_s,flights," + name + "_min," + name + "_p00_27," + name + "_p01," + name +
                                 "_p50," + name + "_p99," + name + "_p99_73," + name +
                                 "_max\n0,2,1,1,1,1,1,1,1\n");
}

/// A quantity at two steps; every tenth flight ends after the first.
SampledFlight MakeFlight(std::uint64_t k) {
  const double value = Stream(3, k, "value").Normal();
  if (k % 10 == 0) return {{value}};
  return {{value, 100.0 + 0.01 * value}};
}

TEST(BandCounter, IsExactWhileItKeepsAll) {
  std::vector<SampledFlight> flights;
  BandCounter counter({1}, kStep_s);
  for (std::uint64_t k = 0; k < BandCounter::kKept; ++k) {
    flights.push_back(MakeFlight(k));
    counter.Add(flights.back());
  }
  EXPECT_EQ(BandsCsv(counter.Bands()), BandsCsv(ComputeBands(flights, {1}, kStep_s)));
}

TEST(BandCounter, IsRightToAClassBeyondThat) {
  std::vector<SampledFlight> flights;
  BandCounter counter({1}, kStep_s);
  for (std::uint64_t k = 0; k < 5000; ++k) {
    flights.push_back(MakeFlight(k));
    counter.Add(flights.back());
  }
  const FlightBands exact = ComputeBands(flights, {1}, kStep_s);
  const FlightBands counted = counter.Bands();
  EXPECT_EQ(counted.flights, 5000u);
  EXPECT_EQ(counted.flying, exact.flying);
  const FlightBands first =
      ComputeBands({flights.begin(), flights.begin() + BandCounter::kKept}, {1}, kStep_s);
  for (std::size_t step = 0; step < 2; ++step) {
    const Band& a = counted.bands[0];
    const Band& b = exact.bands[0];
    const double one_class = (first.bands[0].max[step] - first.bands[0].min[step]) / 128.0;
    EXPECT_EQ(a.min[step], b.min[step]);
    EXPECT_EQ(a.max[step], b.max[step]);
    for (const auto& [counted_value, exact_value] :
         {std::pair{a.p00_27[step], b.p00_27[step]}, std::pair{a.p01[step], b.p01[step]},
          std::pair{a.p50[step], b.p50[step]}, std::pair{a.p99[step], b.p99[step]},
          std::pair{a.p99_73[step], b.p99_73[step]}}) {
      EXPECT_NEAR(counted_value, exact_value, one_class) << step;
      EXPECT_NE(counted_value, exact_value) << "were they kept after all?";
    }
  }
}

// Within a class values are evenly spread, here as in truth: a percentile is then right to a small part of a
// class.
TEST(BandCounter, FindsAPercentileWithinItsClass) {
  constexpr int kFlights = 20000;
  BandCounter counter({1}, kStep_s);
  std::vector<SampledFlight> flights;
  for (int k = 0; k < kFlights; ++k) {
    flights.push_back(
        {{100.0 + (k * 7919 % kFlights) / double{kFlights}}});  // each of them once, in no order
    counter.Add(flights.back());
  }
  const Band exact = ComputeBands(flights, {1}, kStep_s).bands[0], counted = counter.Bands().bands[0];
  // A class is 1/128 and holds 156 values: 2 of them.
  const double tolerance = 2.0 / kFlights;
  EXPECT_NEAR(counted.p01[0], exact.p01[0], tolerance);
  EXPECT_NEAR(counted.p00_27[0], exact.p00_27[0], tolerance);
  EXPECT_NEAR(counted.p50[0], exact.p50[0], tolerance);
  EXPECT_NEAR(counted.p99_73[0], exact.p99_73[0], tolerance);
  EXPECT_NEAR(counted.p99[0], exact.p99[0], tolerance);
}

TEST(BandCounter, DoesNotDependOnTheOrderBeyondTheFirst) {
  std::vector<std::uint64_t> order(1000);
  std::iota(order.begin(), order.end(), std::uint64_t{0});
  const auto csv = [&] {
    BandCounter counter({1}, kStep_s);
    for (const std::uint64_t k : order) counter.Add(MakeFlight(k));
    counter.AddExtreme({{-9.0, 99.0, 7.0}});
    return BandsCsv(counter.Bands());
  };
  const std::string forward = csv();
  std::reverse(order.begin() + BandCounter::kKept, order.end());
  std::reverse(order.begin(), order.begin() + BandCounter::kKept);
  EXPECT_TRUE(csv() == forward);
}

TEST(BandCounter, WidensByExtremesWithoutCountingThem) {
  BandCounter counter({1}, kStep_s);
  counter.Add({{1.0}});
  counter.Add({{2.0}});
  counter.AddExtreme({{-5.0, 8.0}});
  const FlightBands bands = counter.Bands();
  EXPECT_EQ(bands.flights, 2u);
  EXPECT_EQ(bands.extreme_flights, 1u);
  EXPECT_THAT(bands.flying, ElementsAre(2, 0));
  EXPECT_THAT(bands.bands[0].min, ElementsAre(-5.0, 8.0));
  EXPECT_THAT(bands.bands[0].max, ElementsAre(2.0, 8.0));
  EXPECT_EQ(bands.bands[0].p50[0], 1.5);
  EXPECT_TRUE(std::isnan(bands.bands[0].p50[1]));
}

}  // namespace
}  // namespace dispersa::analysis_bands_test
