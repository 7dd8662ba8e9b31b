// Percentiles that a number of values supports, and those that it does not.
#include "core/statistics/percentiles.h"

#include "core/statistics/summary.h"
#include "tests/test.h"

namespace dispersa::statistics_percentiles_test {
namespace {

std::vector<double> Rising(int n) {
  std::vector<double> values;
  for (int i = 1; i <= n; ++i) values.push_back(i);
  return values;
}

// A name says its percentile: "p99_865" is 99.865 %. Of 0, 1, ... 10,000 that is the value 9986.5.
TEST(Percentiles, AreThoseOfTheirNames) {
  std::vector<double> values;
  for (int i = 0; i <= 10'000; ++i) values.push_back(i);
  for (const Percentile& one : Percentiles(values)) {
    std::string percent = one.name.substr(1);
    std::replace(percent.begin(), percent.end(), '_', '.');
    EXPECT_DOUBLE_EQ(one.probability, std::stod(percent) / 100.0) << one.name;
    EXPECT_NEAR(one.estimate, 100.0 * std::stod(percent), 1e-8) << one.name;
  }
}

TEST(Percentiles, BeyondTheSampleThereIsOnlyABound) {
  const auto of300 = Percentiles(Rising(300));
  ASSERT_EQ(of300.size(), 8u);
  EXPECT_EQ(of300[6].name, "p99_73");
  EXPECT_TRUE(std::isnan(of300[6].estimate));  // 0.81 of 300 values lie beyond
  EXPECT_TRUE(std::isinf(of300[6].limits.upper));
  // P(at least k of 300 above the 99.73 %) <= 2.5 % from k = 4 on: 297 is below it with 97.5 %.
  EXPECT_EQ(of300[6].limits.lower, 297.0);
  EXPECT_EQ(of300[5].estimate, Quantile(Rising(300), 0.99));
  EXPECT_FALSE(std::isnan(Percentiles(Rising(371))[6].estimate));
  EXPECT_FALSE(std::isnan(Percentiles(Rising(100))[5].estimate));
  EXPECT_TRUE(std::isnan(Percentiles(Rising(99))[5].estimate));
  EXPECT_TRUE(std::isnan(Percentiles(Rising(99))[1].estimate));
}

// Of the median of 10 values the ranks 2 and 9 hold 97.9 %; 3 and 8 would hold 89 %.
TEST(Percentiles, LimitsOfAMedianAreThoseOfTheTable) {
  const Percentile median = Percentiles(Rising(10))[3];
  EXPECT_EQ(median.limits.lower, 2.0);
  EXPECT_EQ(median.limits.upper, 9.0);
  EXPECT_EQ(median.estimate, 5.5);
  const Percentile of_one = Percentiles(Rising(1))[3];
  EXPECT_TRUE(std::isinf(of_one.limits.lower) && std::isinf(of_one.limits.upper));
  EXPECT_TRUE(std::isnan(Percentiles({})[3].estimate));
}

// Their mean, summed term by term, is off by rounding: every deviation is that error, and its skewness 1.
TEST(Skewness, OfEqualValuesIsUndefined) {
  for (const double value : {0.1, 0.7, 3.3, 1e-3 / 3.0, -7.7, 6.02e23, 1e-200})
    for (const std::size_t count : {3, 24, 5000}) {
      const std::vector<double> equal(count, value);
      EXPECT_TRUE(std::isnan(Skewness(equal))) << value;
      EXPECT_EQ(Summarize(equal).std, 0.0) << value;
      EXPECT_EQ(Summarize(equal).mean, value);
    }
}

// Far from 0 and of any size, where sums of powers would cancel, overflow or vanish.
TEST(Skewness, DoesNotDependOnPlaceAndScale) {
  const double by_hand = 2.0 / std::pow(2.0, 1.5);
  EXPECT_NEAR(Skewness({1e9, 1e9, 1e9 + 3.0}), by_hand, 1e-12);
  EXPECT_NEAR(Skewness({0.0, 0.0, 3e-160}), by_hand, 1e-12);
  EXPECT_NEAR(Skewness({0.0, 0.0, 3e160}), by_hand, 1e-12);
  EXPECT_NEAR(Skewness({-3e160, 0.0, 0.0}), -by_hand, 1e-12);
}

TEST(Skewness, OfSmallSamplesByHand) {
  EXPECT_TRUE(std::isnan(Skewness({})));
  EXPECT_TRUE(std::isnan(Skewness({2.0, 2.0})));
  EXPECT_EQ(Skewness({-1.0, 0.0, 1.0}), 0.0);
  // 0 0 3: mean 1, deviations -1 -1 2, second moment 2, third 2.
  EXPECT_NEAR(Skewness({0.0, 0.0, 3.0}), 2.0 / std::pow(2.0, 1.5), 1e-15);
}

}  // namespace
}  // namespace dispersa::statistics_percentiles_test
