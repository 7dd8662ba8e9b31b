// Histograms of results that are still arriving: the order does not matter, and memory is bounded.
#include "services/ledger/running_histogram.h"

#include "tests/test.h"

namespace dispersa::running_histogram_test {

HistogramBins BinsOf(const std::vector<double>& values, std::size_t most = RunningHistogram::kMaxBins) {
  RunningHistogram histogram;
  for (const double value : values) histogram.Add(value);
  EXPECT_EQ(histogram.n(), std::ssize(values));
  return histogram.Bins(most);
}

TEST(RunningHistogram, CountsWhatLiesInEachBin) {
  const HistogramBins bins = BinsOf({0.0, 1.0, 1.5, 63.9, 63.0});
  EXPECT_EQ(bins.width, 1.0);
  EXPECT_EQ(bins.low, 0.0);
  ASSERT_EQ(bins.counts.size(), 64u);
  EXPECT_EQ(bins.counts[0], 1);
  EXPECT_EQ(bins.counts[1], 2);
  EXPECT_EQ(bins.counts[63], 2);
  const HistogramBins wider = BinsOf({0.0, 1.0, 1.5, 63.9, 64.0});
  EXPECT_EQ(wider.width, 2.0);
  EXPECT_EQ(wider.counts.size(), 33u);
  EXPECT_THAT(BinsOf({-3.0, -1.0, 2.0}, 3).counts, ElementsAre(2, 1)) << "both sides of 0 stay apart";
  EXPECT_THAT(BinsOf({}).counts, IsEmpty());
}

TEST(RunningHistogram, OneValueAgainAndAgainIsOneNarrowBin) {
  for (const double value : {0.0, 593.2649582940616, -1e-300, 1e308, 5e-324}) {
    const HistogramBins bins = BinsOf({value, value, value});
    EXPECT_THAT(bins.counts, ElementsAre(3)) << value;
    EXPECT_LE(bins.low, value);
    EXPECT_GT(bins.low + bins.width, value);
    EXPECT_LE(bins.width, std::max(std::fabs(value) * 1e-12, 1e-300)) << value;
  }
}

TEST(RunningHistogram, TheSameValuesGiveTheSameBinsInAnyOrder) {
  std::mt19937_64 draw(1);
  for (int world = 0; world < 200; ++world) {
    std::vector<double> values;
    const int n = std::uniform_int_distribution(1, 40)(draw);
    const int decades = std::uniform_int_distribution(0, 300)(draw);
    const double offset = world % 3 == 0 ? 6871.0 : 0.0;
    for (int i = 0; i < n; ++i) {
      const double exponent = std::uniform_real_distribution(-decades / 2.0, decades / 2.0 + 1e-9)(draw);
      values.push_back(offset + std::normal_distribution()(draw) * std::pow(10.0, exponent));
    }
    const HistogramBins expected = BinsOf(values);
    ASSERT_LE(expected.counts.size(), RunningHistogram::kMaxBins);
    EXPECT_EQ(std::accumulate(expected.counts.begin(), expected.counts.end(), std::int64_t{0}), n);
    for (std::size_t i = 0; i < expected.counts.size(); ++i) {
      const double low = expected.low + static_cast<double>(i) * expected.width, high = low + expected.width;
      EXPECT_EQ(expected.counts[i],
                std::count_if(values.begin(), values.end(), [&](double v) { return low <= v && v < high; }));
    }
    std::shuffle(values.begin(), values.end(), draw);
    const HistogramBins again = BinsOf(values);
    EXPECT_EQ(again.low, expected.low);
    EXPECT_EQ(again.width, expected.width);
    EXPECT_EQ(again.counts, expected.counts);
    for (const std::size_t most : {2u, 6u, 20u}) EXPECT_LE(BinsOf(values, most).counts.size(), most);
  }
}

}  // namespace dispersa::running_histogram_test
