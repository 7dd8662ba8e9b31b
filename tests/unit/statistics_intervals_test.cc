#include "core/statistics/intervals.h"

#include "core/random/draws.h"
#include "core/statistics/order_statistics.h"
#include "tests/test.h"
#include "tests/unit/read_csv.h"

namespace dispersa::statistics_intervals_test {

// SciPy's figures are printed with 12 digits.
constexpr double kPrinted = 1e-11;

TEST(ClopperPearson, MatchesSciPy) {
  const auto rows = ReadCsv(DISPERSA_TEST_DATA "/stats/clopper_pearson.csv");
  ASSERT_EQ(rows.size(), 18u);
  for (const auto& row : rows) {
    const auto events = static_cast<std::int64_t>(row[0]);
    const auto n = static_cast<std::int64_t>(row[1]);
    const double confidence = row[2];
    const Interval two_sided = ClopperPearson(events, n, confidence);
    SCOPED_TRACE(std::to_string(events) + " of " + std::to_string(n));
    EXPECT_NEAR(two_sided.lower, row[3], kPrinted * row[3]);
    EXPECT_NEAR(two_sided.upper, row[4], kPrinted * row[4]);
    EXPECT_NEAR(ClopperPearsonLower(events, n, confidence), row[5], kPrinted * row[5]);
    EXPECT_NEAR(ClopperPearsonUpper(events, n, confidence), row[6], kPrinted * row[6]);
  }
}

TEST(ClopperPearson, LimitsSolveTheRisks) {
  // At its lower limit a success probability shows with exactly the risk that the limit leaves.
  const double lower = ClopperPearsonLower(1998, 2000, 0.90);
  EXPECT_NEAR(ConsumerRisk(lower, 2000, 2), 0.10, 1e-12);
  const double upper = ClopperPearsonUpper(1988, 2000, 0.90);
  EXPECT_NEAR(ProducerRisk(upper, 2000, 12), 0.10, 1e-12);
  EXPECT_EQ(ClopperPearsonLower(0, 10, 0.9), 0.0);
  EXPECT_EQ(ClopperPearsonUpper(10, 10, 0.9), 1.0);
}

// The exact coverage, summed over all outcomes, is at least the confidence for any probability.
TEST(ClopperPearson, CoversAtLeastTheConfidence) {
  constexpr std::int64_t kCases = 30;
  for (int i = 1; i < 40; ++i) {
    const double probability = i / 40.0;
    double covered = 0.0;
    for (std::int64_t events = 0; events <= kCases; ++events) {
      const Interval interval = ClopperPearson(events, kCases, 0.9);
      if (interval.lower > probability || interval.upper < probability) continue;
      covered += ConsumerRisk(1.0 - probability, kCases, events) -
                 (events == 0 ? 0.0 : ConsumerRisk(1.0 - probability, kCases, events - 1));
    }
    EXPECT_GE(covered, 0.9) << probability;
    EXPECT_LT(covered, 0.995) << probability;  // and not by being far too wide
  }
}

// Tables of the confidence interval of the median: W. J. Conover, Practical Nonparametric Statistics; the
// levels are sums of binomial terms, for example n = 10: 1 - 2 (1 + 10) / 1024 = 0.9785 for ranks 2 and 9.
TEST(QuantileRanks, OfTheMedian) {
  const RankInterval ten = QuantileRanks(10, 0.5, 0.95);
  EXPECT_EQ(ten.lower, 2);
  EXPECT_EQ(ten.upper, 9);
  const RankInterval six = QuantileRanks(6, 0.5, 0.95);  // 1 - 2 / 64 = 0.969
  EXPECT_EQ(six.lower, 1);
  EXPECT_EQ(six.upper, 6);
  const RankInterval five = QuantileRanks(5, 0.5, 0.95);  // 1 - 2 / 32 = 0.9375 is too little
  EXPECT_EQ(five.lower, 0);
  EXPECT_EQ(five.upper, 6);
  const RankInterval exact = QuantileRanks(6, 0.5, 1.0 - 2.0 / 64.0);  // equality is enough
  EXPECT_EQ(exact.lower, 1);
  EXPECT_EQ(exact.upper, 6);
  const RankInterval none = QuantileRanks(0, 0.5, 0.95);
  EXPECT_EQ(none.lower, 0);
  EXPECT_EQ(none.upper, 1);
}

TEST(QuantileRanks, AreTheTightestWithHalfTheRiskOnEachSide) {
  for (const double probability : {0.01, 0.3, 0.5, 0.95, 0.9973}) {
    for (const std::int64_t n : {1, 20, 2000}) {
      const RankInterval ranks = QuantileRanks(n, probability, 0.90);
      const auto below = [&](std::int64_t count) {  // P(at most count values below the quantile)
        return count < 0 ? 0.0 : ConsumerRisk(1.0 - probability, n, count);
      };
      // 1 - probability rounds, and changes the risks by less than this.
      constexpr double kRounding = 1e-12;
      EXPECT_LE(below(ranks.lower - 1), 0.05 + kRounding);
      EXPECT_GT(below(ranks.lower), 0.05 - kRounding);
      EXPECT_GE(below(ranks.upper - 1), 0.95 - kRounding);
      if (ranks.upper > 1) {
        EXPECT_LT(below(ranks.upper - 2), 0.95 + kRounding);
      }
    }
  }
}

TEST(QuantileInterval, PicksTheOrderStatistics) {
  const std::vector<double> values = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const Interval median = QuantileInterval(values, 0.5, 0.95);
  EXPECT_EQ(median.lower, 2.0);
  EXPECT_EQ(median.upper, 9.0);
  const Interval tail = QuantileInterval(values, 0.95, 0.90);
  EXPECT_EQ(tail.lower, 8.0);  // P(B <= 7) = 0.0115 and P(B <= 8) = 0.0861 for B of 10 with 0.95
  EXPECT_TRUE(std::isinf(tail.upper));
}

TEST(QuantileInterval, CoversTheQuantile) {
  constexpr int kReplicates = 4000;
  constexpr std::size_t kCases = 200;
  int covered = 0;
  for (int replicate = 0; replicate < kReplicates; ++replicate) {
    Stream stream(20260101, static_cast<std::uint64_t>(replicate), "values");
    std::vector<double> values;
    for (std::size_t i = 0; i < kCases; ++i) values.push_back(stream.Uniform());
    std::sort(values.begin(), values.end());
    const Interval interval = QuantileInterval(values, 0.9, 0.9);
    covered += interval.lower <= 0.9 && 0.9 <= interval.upper;
  }
  // The ranks give this coverage exactly; four standard errors of the simulation (fixed seeds).
  const RankInterval ranks = QuantileRanks(kCases, 0.9, 0.9);
  const double exact =
      ConsumerRisk(0.1, kCases, ranks.upper - 1) - ConsumerRisk(0.1, kCases, ranks.lower - 1);
  EXPECT_GE(exact, 0.9);
  EXPECT_NEAR(covered / double{kReplicates}, exact, 4.0 * std::sqrt(0.9 * 0.1 / kReplicates));
}

}  // namespace dispersa::statistics_intervals_test
