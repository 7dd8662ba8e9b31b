#include "core/statistics/two_samples.h"

#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::statistics_two_samples_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(TwoSamples, McNemarIsTheBinomialOfTheDiscordantPairs) {
  EXPECT_DOUBLE_EQ(McNemarP(1, 9), 2.0 * 11.0 / 1024.0);  // 2 P(B(10, 1/2) <= 1)
  EXPECT_DOUBLE_EQ(McNemarP(9, 1), McNemarP(1, 9));
  EXPECT_EQ(McNemarP(0, 0), 1.0);
  EXPECT_EQ(McNemarP(4, 4), 1.0);
}

TEST(TwoSamples, FisherSumsTablesThatAreNoLikelier) {
  // Tea tasting: 3 of 4 and 1 of 4. The tables of k = 0 .. 4 have 1, 16, 36, 16, 1 of 70.
  EXPECT_NEAR(FisherP(3, 4, 1, 4), 34.0 / 70.0, 1e-12);
  EXPECT_NEAR(FisherP(4, 4, 0, 4), 2.0 / 70.0, 1e-12);
  // Unequal samples: 0 of 3 and 5 of 7; C(3, k) C(7, 5 - k) / C(10, 5) = 21, 105, 105, 21 of 252.
  EXPECT_NEAR(FisherP(0, 3, 5, 7), 42.0 / 252.0, 1e-12);
  EXPECT_EQ(FisherP(0, 10, 0, 20), 1.0);
  EXPECT_EQ(FisherP(0, 0, 1, 2), 1.0);
  EXPECT_GT(FisherP(900000, 1000000, 900100, 1000000), 0.5);  // many cases neither overflow nor vanish
}

TEST(TwoSamples, HolmStepsDownAndLeavesOutWhatIsNoTest) {
  const std::vector<double> adjusted = HolmAdjusted({0.01, kUndefined, 0.04, 0.03, 0.6});
  EXPECT_DOUBLE_EQ(adjusted[0], 0.04);
  EXPECT_TRUE(std::isnan(adjusted[1]));
  EXPECT_DOUBLE_EQ(adjusted[3], 0.09);
  EXPECT_DOUBLE_EQ(adjusted[2], 0.09);  // 2 x 0.04 would be less than the one before
  EXPECT_DOUBLE_EQ(adjusted[4], 0.6);
}

TEST(TwoSamples, LimitsJoinAsSidesOfATriangle) {
  // Independent: 3-4-5. Fully correlated: the difference of the reaches.
  const Interval independent = DifferenceLimits(10.0, {7.0, 14.0}, 20.0, {17.0, 23.0}, 0.0);
  EXPECT_DOUBLE_EQ(independent.lower, 10.0 - 5.0);              // of b below 3, of a above 4
  EXPECT_DOUBLE_EQ(independent.upper, 10.0 + std::sqrt(18.0));  // of b above 3, of a below 3
  EXPECT_DOUBLE_EQ(DifferenceLimits(10.0, {7.0, 14.0}, 20.0, {17.0, 23.0}, 1.0).lower, 9.0);
  EXPECT_EQ(DifferenceLimits(10.0, {7.0, kInfinity}, 20.0, {17.0, 23.0}, 0.0).lower, -kInfinity);
}

TEST(TwoSamples, ASampleThatDoesNotReachAPercentileGivesNone) {
  std::vector<double> a(100), b(100);
  for (int i = 0; i < 100; ++i) b[i] = (a[i] = i) + 0.5;
  const QuantileDifference median = CompareQuantiles(a, b, 0.5, 0.95, true);
  EXPECT_DOUBLE_EQ(median.difference, 0.5);
  // Each pair lies on the same side of its quantile: fully correlated, and nothing is left of either
  // interval.
  EXPECT_NEAR(median.interval.lower, 0.5, 1e-12);
  EXPECT_NEAR(median.interval.upper, 0.5, 1e-12);
  EXPECT_FALSE(std::isfinite(CompareQuantiles(a, b, 0.9973, 0.95, true).difference));
  EXPECT_EQ(CompareQuantiles(a, b, 0.99, 0.95, true).interval.upper, kInfinity);
  // Lost flights lie beyond: of 100 the 95 % is a lost one when ten are.
  std::fill(b.begin(), b.begin() + 10, kInfinity);
  EXPECT_TRUE(std::isnan(CompareQuantiles(a, b, 0.95, 0.95, true).difference));
  EXPECT_LT(CompareQuantiles(a, b, 0.9, 0.95, true).p, 1.0);
  EXPECT_TRUE(std::isnan(CompareQuantiles({}, {}, 0.5, 0.95, true).p));
}

// A percentile has an estimate from the number of values on that leaves one of them beyond it.
TEST(TwoSamples, APercentileIsReachedByOneValueBeyondIt) {
  for (const auto& [probability, needed] :
       {std::pair{0.99, 100}, {0.95, 20}, {0.01, 100}, {0.05, 20}, {0.5, 2}}) {
    std::vector<double> values;
    for (int i = 0; i < needed; ++i) values.push_back(i);
    EXPECT_TRUE(std::isfinite(CompareQuantiles(values, values, probability, 0.95, false).a)) << probability;
    values.pop_back();
    EXPECT_TRUE(std::isnan(CompareQuantiles(values, values, probability, 0.95, false).a)) << probability;
  }
}

TEST(TwoSamples, SwappingTurnsSigns) {
  std::vector<double> a, b;
  Stream stream(7, 0, "two_samples");
  for (int i = 0; i < 400; ++i) {
    a.push_back(std::exp(stream.Normal()));
    b.push_back(a.back() * (1.0 + 0.2 * stream.Normal()));
  }
  for (const bool paired : {true, false}) {
    const QuantileDifference forth = CompareQuantiles(a, b, 0.95, 0.95, paired);
    const QuantileDifference back = CompareQuantiles(b, a, 0.95, 0.95, paired);
    EXPECT_DOUBLE_EQ(forth.difference, -back.difference);
    EXPECT_NEAR(forth.interval.lower, -back.interval.upper, 1e-12);
    EXPECT_NEAR(forth.p, back.p, 1e-9);
  }
  EXPECT_DOUBLE_EQ(LocationP(a, b), LocationP(b, a));
  // The gain by pairing.
  const Interval paired = CompareQuantiles(a, b, 0.95, 0.95, true).interval;
  const Interval unpaired = CompareQuantiles(a, b, 0.95, 0.95, false).interval;
  EXPECT_LT(paired.upper - paired.lower, 0.8 * (unpaired.upper - unpaired.lower));
}

// 95 % of skewed samples, paired and not: the limits miss the truth no more often than stated, and the test
// of two equal tails errs no more often. `tests/run --long -R Coverage` does it 20,000 times.
TEST(TwoSamples, TailLimitsCoverTheTruth) {
  constexpr int kReplicates = 1000;
  for (const bool paired : {true, false}) {
    int missed = 0, rejected = 0;
    for (int replicate = 0; replicate < kReplicates; ++replicate) {
      Stream stream(11, static_cast<std::uint64_t>(replicate), paired ? "tails/paired" : "tails/unpaired");
      std::vector<double> a, b;
      for (int i = 0; i < 200; ++i) {
        const double shared = paired ? stream.Normal() : 0.0;
        const double share = paired ? 0.9 : 0.0;
        const double own = std::sqrt(1.0 - share * share);
        a.push_back(std::exp(share * shared + own * stream.Normal()));
        b.push_back(std::exp(share * shared + own * stream.Normal()));
      }
      const QuantileDifference tail = CompareQuantiles(a, b, 0.95, 0.95, paired);
      missed += tail.interval.lower > 0.0 || tail.interval.upper < 0.0;
      rejected += tail.p <= 0.05;
    }
    // Four standard errors of 1000 repetitions at 5 %: 0.028.
    EXPECT_LE(missed / double{kReplicates}, 0.078) << paired;
    EXPECT_LE(rejected / double{kReplicates}, 0.078) << paired;
    EXPECT_GT(missed, 0) << paired;
  }
}

TEST(Tendency, CountsPairsOfBothSamples) {
  const double lost = std::numeric_limits<double>::infinity();
  EXPECT_DOUBLE_EQ(TendencyOf({1.0, 2.0}, {3.0, 4.0, 5.0}), 1.0);
  EXPECT_DOUBLE_EQ(TendencyOf({3.0, 4.0, 5.0}, {1.0, 2.0}), -1.0);
  EXPECT_DOUBLE_EQ(TendencyOf({1.0, 2.0, 3.0}, {2.0, 2.0}), 0.0);
  EXPECT_DOUBLE_EQ(TendencyOf({1.0, lost}, {2.0, lost}), 0.25);  // two larger, one smaller, one equal
  EXPECT_DOUBLE_EQ(TendencyOf({1.0, 5.0}, {2.0, lost}), 0.5);
  EXPECT_TRUE(std::isnan(TendencyOf({}, {1.0})));
}

}  // namespace
}  // namespace dispersa::statistics_two_samples_test
