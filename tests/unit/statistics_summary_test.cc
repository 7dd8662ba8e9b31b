#include "core/statistics/summary.h"

#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::statistics_summary_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Summarize, SmallSample) {
  const Summary summary = Summarize({4.0, kUndefined, 1.0, 3.0, 2.0});
  EXPECT_EQ(summary.n, 4u);
  EXPECT_EQ(summary.undefined, 1u);
  EXPECT_EQ(summary.mean, 2.5);
  EXPECT_DOUBLE_EQ(summary.std, std::sqrt(5.0 / 3.0));
  EXPECT_EQ(summary.min, 1.0);
  EXPECT_EQ(summary.max, 4.0);
  EXPECT_EQ(summary.p50, 2.5);
  EXPECT_DOUBLE_EQ(summary.p05, 1.15);
  EXPECT_DOUBLE_EQ(summary.p99, 3.97);
}

TEST(Summarize, TooFewValues) {
  const Summary none = Summarize({kUndefined, kInfinity, -kInfinity});
  EXPECT_EQ(none.n, 0u);
  EXPECT_EQ(none.undefined, 3u);
  for (const double value : {none.mean, none.std, none.min, none.max, none.p50, none.p99_865}) {
    EXPECT_TRUE(std::isnan(value));
  }
  const Summary one = Summarize({7.0});
  EXPECT_EQ(one.mean, 7.0);
  EXPECT_TRUE(std::isnan(one.std));
  EXPECT_EQ(one.p99_73, 7.0);
}

TEST(Summarize, BitsDoNotDependOnOrder) {
  std::vector<double> values = {0.0, -0.0, -0.0, 0.0};
  Stream stream(20260101, 0, "values");
  for (int i = 0; i < 1000; ++i) values.push_back(std::exp(20.0 * stream.Normal()));
  const Summary sorted = Summarize(values);
  for (int shuffle = 0; shuffle < 20; ++shuffle) {
    for (std::size_t i = values.size() - 1; i > 0; --i) std::swap(values[i], values[stream.Bits() % (i + 1)]);
    const Summary shuffled = Summarize(values);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(shuffled.mean), std::bit_cast<std::uint64_t>(sorted.mean));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(shuffled.std), std::bit_cast<std::uint64_t>(sorted.std));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(shuffled.min), std::bit_cast<std::uint64_t>(sorted.min));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(shuffled.p50), std::bit_cast<std::uint64_t>(sorted.p50));
  }
}

TEST(Summarize, HoldsNoNegativeZero) {
  const Summary summary = Summarize({-0.0, -0.0});
  for (const double value : {summary.mean, summary.std, summary.min, summary.max, summary.p50, summary.p99}) {
    EXPECT_EQ(value, 0.0);
    EXPECT_FALSE(std::signbit(value));
  }
}

// Injection velocities spread by millimetres: a one-pass sum of squares would lose every digit.
TEST(Summarize, KeepsASmallSpreadAboutALargeMean) {
  std::vector<double> values;
  for (int i = 0; i < 1001; ++i) values.push_back(7612.5 + (i - 500) * 0x1p-20);
  const Summary summary = Summarize(values);
  EXPECT_EQ(summary.mean, 7612.5);
  // Variance of 1001 equally spaced values, with divisor n - 1: n (n + 1) / 12 steps².
  EXPECT_DOUBLE_EQ(summary.std, std::sqrt(1001.0 * 1002.0 / 12.0) * 0x1p-20);
}

TEST(Summarize, CompensatesTheSum) {
  std::vector<double> values(10, 0.1);
  values.push_back(1e16);
  values.push_back(-1e16);
  EXPECT_DOUBLE_EQ(Summarize(values).mean, 1.0 / 12.0);
}

// numpy.percentile([3, 1, 4, 1, 5, 9, 2, 6], q) by its definition (n - 1) q.
TEST(Quantile, IsTypeSeven) {
  const std::vector<double> sorted = SortedFinite({3, 1, 4, 1, 5, 9, 2, 6});
  EXPECT_EQ(Quantile(sorted, 0.0), 1.0);
  EXPECT_EQ(Quantile(sorted, 0.25), 1.75);
  EXPECT_EQ(Quantile(sorted, 0.5), 3.5);
  EXPECT_DOUBLE_EQ(Quantile(sorted, 0.9), 6.9);
  EXPECT_EQ(Quantile(sorted, 1.0), 9.0);
  EXPECT_TRUE(std::isnan(Quantile({}, 0.5)));
}

TEST(Summarize, QuantilesAreAtTheirProbabilities) {
  std::vector<double> values(100001);
  std::iota(values.begin(), values.end(), 0.0);
  const Summary summary = Summarize(values);
  // Rounding of probability × 100000.
  EXPECT_NEAR(summary.p00_135, 135.0, 1e-9);
  EXPECT_NEAR(summary.p01, 1000.0, 1e-9);
  EXPECT_NEAR(summary.p05, 5000.0, 1e-9);
  EXPECT_NEAR(summary.p50, 50000.0, 1e-9);
  EXPECT_NEAR(summary.p95, 95000.0, 1e-9);
  EXPECT_NEAR(summary.p99, 99000.0, 1e-9);
  EXPECT_NEAR(summary.p99_73, 99730.0, 1e-9);
  EXPECT_NEAR(summary.p99_865, 99865.0, 1e-9);
}

}  // namespace
}  // namespace dispersa::statistics_summary_test
