#include "core/statistics/paired.h"

#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::statistics_paired_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(ComparePaired, TenPairs) {
  // Differences -1 and 1 to 9; ratios 1/2 and 2, 3, ... 10.
  const std::vector<double> a = {2, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  const std::vector<double> b = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const PairedDifference paired = ComparePaired(a, b, 0.95);
  EXPECT_EQ(paired.n, 10u);
  EXPECT_EQ(paired.worse, 9u);
  EXPECT_EQ(paired.better, 1u);
  EXPECT_EQ(paired.equal, 0u);
  EXPECT_EQ(paired.median_difference, 4.5);
  EXPECT_EQ(paired.difference_interval.lower, 1.0);  // ranks 2 and 9 of 10
  EXPECT_EQ(paired.difference_interval.upper, 8.0);
  EXPECT_DOUBLE_EQ(paired.median_ratio, std::sqrt(30.0));  // halfway between 5 and 6 in logarithms
  EXPECT_EQ(paired.ratio_interval.lower, 2.0);
  EXPECT_EQ(paired.ratio_interval.upper, 9.0);
  EXPECT_DOUBLE_EQ(paired.sign_test_p, 2.0 * 11.0 / 1024.0);
}

TEST(ComparePaired, SwappingTurnsSigns) {
  const std::vector<double> a = {2.0, 1.0, 4.0, kUndefined, 8.0, 3.0, 5.0};
  const std::vector<double> b = {1.0, 3.0, 4.0, 6.0, kUndefined, 2.0, kUndefined};
  const PairedDifference forth = ComparePaired(a, b, 0.9);
  const PairedDifference back = ComparePaired(b, a, 0.9);
  EXPECT_EQ(forth.worse, back.better);
  EXPECT_EQ(forth.better, back.worse);
  EXPECT_EQ(forth.median_difference, -back.median_difference);
  EXPECT_EQ(forth.difference_interval.lower, -back.difference_interval.upper);
  EXPECT_EQ(forth.difference_interval.upper, -back.difference_interval.lower);
  EXPECT_DOUBLE_EQ(forth.median_ratio * back.median_ratio, 1.0);
  EXPECT_EQ(forth.sign_test_p, back.sign_test_p);
}

TEST(ComparePaired, LostFlightsAreInfinitelyBad) {
  const std::vector<double> a = {1.0, kUndefined, kUndefined, 1.0, 1.0};
  const std::vector<double> b = {kUndefined, 1.0, kUndefined, kUndefined, kUndefined};
  const PairedDifference paired = ComparePaired(a, b, 0.9);
  EXPECT_EQ(paired.n, 5u);
  EXPECT_EQ(paired.lost_a, 2u);
  EXPECT_EQ(paired.lost_b, 4u);
  EXPECT_EQ(paired.worse, 3u);
  EXPECT_EQ(paired.better, 1u);
  EXPECT_EQ(paired.equal, 1u);
  EXPECT_EQ(paired.median_difference, kInfinity);
  EXPECT_EQ(paired.median_ratio, kInfinity);
  EXPECT_EQ(paired.difference_interval.lower, -kInfinity);
  EXPECT_EQ(paired.ratio_interval.lower, 0.0);
  EXPECT_EQ(paired.ratio_interval.upper, kInfinity);
}

TEST(ComparePaired, RatiosNeedPositiveValues) {
  for (const double not_positive : {0.0, -1.0}) {
    const PairedDifference paired = ComparePaired({1.0, not_positive, 2.0}, {1.0, 2.0, 2.0}, 0.9);
    EXPECT_TRUE(std::isnan(paired.median_ratio));
    EXPECT_TRUE(std::isnan(paired.ratio_interval.lower));
    EXPECT_TRUE(std::isnan(paired.ratio_interval.upper));
    EXPECT_EQ(paired.median_difference, 0.0);
  }
}

TEST(ComparePaired, RatiosOfLostFlightsAndOfOnePair) {
  // Both lost: neither is worse, in the difference and in the ratio.
  const PairedDifference both =
      ComparePaired({kUndefined, kUndefined, 1.0}, {kUndefined, kUndefined, 4.0}, 0.9);
  EXPECT_EQ(both.median_difference, 0.0);
  EXPECT_EQ(both.median_ratio, 1.0);
  // One pair bounds nothing: a ratio is above 0 all the same.
  const PairedDifference one = ComparePaired({2.0}, {6.0}, 0.9);
  EXPECT_EQ(one.median_ratio, 3.0);
  EXPECT_EQ(one.ratio_interval.lower, 0.0);
  EXPECT_EQ(one.ratio_interval.upper, kInfinity);
  EXPECT_EQ(one.difference_interval.lower, -kInfinity);
}

TEST(ComparePaired, WithoutDifferences) {
  const PairedDifference equal = ComparePaired({1.0, 2.0}, {1.0, 2.0}, 0.9);
  EXPECT_EQ(equal.equal, 2u);
  EXPECT_EQ(equal.sign_test_p, 1.0);
  EXPECT_EQ(equal.median_ratio, 1.0);
  const PairedDifference none = ComparePaired({}, {}, 0.9);
  EXPECT_EQ(none.n, 0u);
  EXPECT_TRUE(std::isnan(none.median_difference));
  EXPECT_TRUE(std::isnan(none.sign_test_p));
}

// Skewed pairs whose differences have the median 1: the interval covers it as often as it says.
TEST(ComparePaired, IntervalCoversTheMedianDifference) {
  constexpr int kReplicates = 4000;
  int covered = 0;
  for (int replicate = 0; replicate < kReplicates; ++replicate) {
    Stream stream(20260101, static_cast<std::uint64_t>(replicate), "pairs");
    std::vector<double> a, b;
    for (int i = 0; i < 101; ++i) {
      a.push_back(std::exp(stream.Normal()));
      b.push_back(a.back() + std::exp(stream.Normal()));
    }
    const Interval interval = ComparePaired(a, b, 0.90).difference_interval;
    covered += interval.lower <= 1.0 && 1.0 <= interval.upper;
  }
  // Discrete ranks: exact coverage 1 - 2 P(B(101, 1/2) <= 41) = 0.9265. Four standard errors of the
  // simulation (fixed seeds).
  EXPECT_NEAR(covered / double{kReplicates}, 0.9265, 0.017);
}

}  // namespace
}  // namespace dispersa::statistics_paired_test
