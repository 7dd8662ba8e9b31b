// Sensitivity of functions with indices in closed form, and dependences that correlation misses.
#include "core/statistics/sensitivity.h"

#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::statistics_sensitivity_test {
namespace {

using std::numbers::pi;

/// Uniform columns on (low, high), n cases each.
std::vector<std::vector<double>> Uniform(std::size_t columns, std::size_t n, double low, double high) {
  std::vector<std::vector<double>> x(columns, std::vector<double>(n));
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t k = 0; k < n; ++k)
      x[i][k] = low + (high - low) * Stream(11, k, "x" + std::to_string(i)).Uniform();
  }
  return x;
}

// T. Ishigami and T. Homma (1990), a = 7, b = 0.1: y = sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1 on (-pi, pi).
TEST(FirstOrderIndex, OfTheIshigamiFunction) {
  constexpr std::size_t n = 8000;
  const auto x = Uniform(3, n, -pi, pi);
  std::vector<double> y(n);
  for (std::size_t k = 0; k < n; ++k) {
    y[k] = std::sin(x[0][k]) + 7.0 * std::pow(std::sin(x[1][k]), 2) +
           0.1 * std::pow(x[2][k], 4) * std::sin(x[0][k]);
  }
  const double a = 7.0, b = 0.1;
  const double variance = a * a / 8.0 + b * std::pow(pi, 4) / 5.0 + b * b * std::pow(pi, 8) / 18.0 + 0.5;
  const double exact[] = {0.5 * std::pow(1.0 + b * std::pow(pi, 4) / 5.0, 2) / variance,
                          a * a / 8.0 / variance, 0.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const SensitivityIndex index = FirstOrderIndex(x[i], y);
    // Noise of 8000 cases, and what the classes smooth away: together two per cent of the variance.
    EXPECT_NEAR(index.index, exact[i], 0.02) << i;
    EXPECT_LE(index.low, index.index);
    EXPECT_GE(index.high, index.index);
  }
  EXPECT_NEAR(exact[0], 0.3139, 1e-4);
  EXPECT_NEAR(exact[1], 0.4424, 1e-4);
  // x2 acts through its square: its rank correlation says nothing.
  EXPECT_NEAR(RankCorrelation(x[1], y), 0.0, 0.03);
}

// I. M. Sobol's g function with a = 0, 1, 4.5, 9: variances 1/3 / (1 + a)^2, product form.
TEST(FirstOrderIndex, OfTheGFunction) {
  constexpr std::size_t n = 8000;
  const double a[] = {0.0, 1.0, 4.5, 9.0};
  const auto x = Uniform(4, n, 0.0, 1.0);
  std::vector<double> y(n, 1.0);
  double total = 1.0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < n; ++k) y[k] *= (std::fabs(4.0 * x[i][k] - 2.0) + a[i]) / (1.0 + a[i]);
    total *= 1.0 + 1.0 / (3.0 * (1.0 + a[i]) * (1.0 + a[i]));
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const double exact = 1.0 / (3.0 * (1.0 + a[i]) * (1.0 + a[i])) / (total - 1.0);
    EXPECT_NEAR(FirstOrderIndex(x[i], y).index, exact, 0.02) << i;
  }
}

TEST(FirstOrderIndex, TheIntervalHoldsWhatItSays) {
  // y = x + noise of equal variance: index 0.5. 95 % within the interval; 200 repetitions leave 91 % to 99 %.
  int covered = 0;
  for (std::uint64_t repetition = 0; repetition < 200; ++repetition) {
    std::vector<double> x, y;
    for (std::uint64_t k = 0; k < 400; ++k) {
      x.push_back(Stream(repetition, k, "x").Normal());
      y.push_back(x.back() + Stream(repetition, k, "noise").Normal());
    }
    const SensitivityIndex index = FirstOrderIndex(x, y);
    covered += index.low <= 0.5 && 0.5 <= index.high;
  }
  EXPECT_GE(covered, 182);
  EXPECT_LE(covered, 199);
}

// The mean of y within k classes of n cases varies by chance alone: by (k - 1) / (n - 1) of the variance, 9 %
// of 100 cases in 10 classes. The degrees of freedom take it off.
TEST(FirstOrderIndex, OfAnIdleInputIsZeroOnAverage) {
  constexpr int kRepetitions = 400;
  double shares = 0.0, indices = 0.0;
  for (std::uint64_t repetition = 0; repetition < kRepetitions; ++repetition) {
    std::vector<double> x, y;
    for (std::uint64_t k = 0; k < 100; ++k) {
      x.push_back(Stream(repetition, k, "idle").Uniform());
      y.push_back(Stream(repetition, k, "y").Normal());
    }
    shares += FirstOrderShare(x, y) / kRepetitions;
    indices += FirstOrderIndex(x, y).index / kRepetitions;
  }
  // One share spreads by sqrt(2 (k - 1)) / n = 0.042; four standard errors of 400.
  EXPECT_NEAR(shares, 0.0, 0.0085);
  // The index is cut off at 0: its mean is that of half a normal of that spread, 0.4 of it.
  EXPECT_NEAR(indices, 0.4 * 0.042, 0.0085);
}

// Nine cases in three classes, by hand: of 48 about the mean 6 are within the classes.
TEST(FirstOrderIndex, IsKelleysEpsilonSquared) {
  const std::vector<double> x = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  const std::vector<double> y = {1, 2, 3, 2, 3, 4, 6, 7, 8};  // class means 2, 3, 7; each has 2 within
  const double total = 2.0 * 3.0 + 3.0 * (4.0 + 1.0 + 9.0);   // about the mean of 4
  EXPECT_NEAR(FirstOrderShare(x, y), 1.0 - 8.0 / 6.0 * 6.0 / total, 1e-12);
}

TEST(FirstOrderIndex, DegenerateDataGiveZero) {
  EXPECT_EQ(FirstOrderIndex(std::vector<double>{1, 2, 3}, {1, 2, 3}).index, 0.0);  // too few
  const std::vector<double> same(100, 2.0);
  std::vector<double> rising(100);
  for (std::size_t i = 0; i < 100; ++i) rising[i] = static_cast<double>(i);
  EXPECT_EQ(FirstOrderIndex(same, rising).index, 0.0);
  EXPECT_EQ(FirstOrderIndex(rising, same).index, 0.0);
  EXPECT_GT(FirstOrderIndex(rising, rising).index, 0.95);
}

TEST(FirstOrderIndex, GroupsOfManyCasesGiveTheSameInterval) {
  std::vector<double> x, y;
  for (std::uint64_t k = 0; k < 20000; ++k) {
    x.push_back(Stream(3, k, "x").Normal());
    y.push_back(std::fabs(x.back()) + Stream(3, k, "noise").Normal());
  }
  const double exact = (1.0 - 2.0 / pi) / (2.0 - 2.0 / pi);
  const SensitivityIndex index = FirstOrderIndex(x, y);
  EXPECT_NEAR(index.index, exact, 0.015);
  EXPECT_LT(index.high - index.low, 0.03);
}

TEST(Ranks, ShareTheMeanOfTies) {
  EXPECT_THAT(Ranked(std::vector{3.0, 1.0, 3.0, 2.0}).ranks(), ElementsAre(3.5, 1.0, 3.5, 2.0));
  EXPECT_DOUBLE_EQ(
      RankCorrelation(std::vector<double>{1, 2, 3, 4}, std::vector<double>{10, 100, 1000, 10000}), 1.0);
  EXPECT_DOUBLE_EQ(RankCorrelation(std::vector<double>{1, 2, 3, 4}, std::vector<double>{1, 1, 1, 1}), 0.0);
}

TEST(PartialRankCorrelations, TellAConfounderFromACause) {
  // z follows x; only x acts on y. z's plain correlation is large, its partial one is not.
  std::vector<double> x, z, y;
  for (std::uint64_t k = 0; k < 2000; ++k) {
    x.push_back(Stream(5, k, "x").Normal());
    z.push_back(x.back() + 0.5 * Stream(5, k, "z").Normal());
    y.push_back(x.back() + 0.5 * Stream(5, k, "y").Normal());
  }
  EXPECT_GT(RankCorrelation(z, y), 0.7);
  const Ranked ranked_x(x), ranked_z(z);
  const auto partial = PartialRankCorrelations({&ranked_x, &ranked_z}, y);
  EXPECT_GT(partial[0], 0.6);
  EXPECT_NEAR(partial[1], 0.0, 0.06);
}

// A regression of three cases an input, and three more: fewer say nothing.
TEST(PartialRankCorrelations, NeedCasesForTheirInputs) {
  const std::vector<double> x = {1, 2, 3, 4, 5, 6, 7, 8, 9}, z = {2, 1, 4, 9, 3, 7, 5, 8, 6};
  std::vector<double> y;
  for (std::size_t k = 0; k < x.size(); ++k) y.push_back(x[k] + 0.1 * z[k]);
  const Ranked enough_x(x), enough_z(z);
  EXPECT_GT(PartialRankCorrelations({&enough_x, &enough_z}, Ranked(y))[0], 0.9);
  const auto but_one = [](std::vector<double> values) {
    values.pop_back();
    return values;
  };
  const Ranked few_x(but_one(x)), few_z(but_one(z));
  EXPECT_THAT(PartialRankCorrelations({&few_x, &few_z}, Ranked(but_one(y))), ElementsAre(0.0, 0.0));
}

TEST(RankSum, AgreesWithItsTable) {
  // The marked ones are the three largest of eight. Rank sum 21, mean 13.5, variance 11.25; z = 7 / 3.3541.
  const std::vector<double> x = {1, 2, 3, 4, 5, 6, 7, 8};
  const std::vector<bool> largest = {false, false, false, false, false, true, true, true};
  EXPECT_NEAR(RankSumP(x, largest), std::erfc(7.0 / std::sqrt(11.25) / std::sqrt(2.0)), 1e-12);
  EXPECT_EQ(RankSumP(x, std::vector<bool>(8, false)), 1.0);
  EXPECT_EQ(RankSumP(std::vector<double>(8, 1.0), largest), 1.0);
}

// The example of Benjamini and Hochberg's paper, section 3.3: fifteen p-values, four discoveries at 5 %.
TEST(FalseDiscoveryRates, AreThoseOfThePaper) {
  const std::vector<double> p = {0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                                 0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.000};
  const std::vector<double> rates = FalseDiscoveryRates(p);
  int discoveries = 0;
  for (const double rate : rates) discoveries += rate <= 0.05;
  EXPECT_EQ(discoveries, 4);
  EXPECT_NEAR(rates[3], 0.0095 * 15 / 4, 1e-15);
  EXPECT_EQ(rates.back(), 1.0);
  EXPECT_THAT(FalseDiscoveryRates({0.04, 0.01}), ElementsAre(DoubleEq(0.04), DoubleEq(0.02)));
}

}  // namespace
}  // namespace dispersa::statistics_sensitivity_test
