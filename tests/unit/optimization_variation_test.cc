// Crossover and mutation: bounds, symmetry, and the distributions of their sources.
#include "core/optimization/variation.h"
#include "tests/test.h"

namespace dispersa::optimization_variation_test {
namespace {

constexpr int kDraws = 20000;

TEST(CrossOver, KeepsTheMeanFarFromTheBoundsAndEqualParents) {
  for (std::uint64_t i = 0; i < 100; ++i) {
    Stream stream(1, i, "test");
    double a = 1.0;
    double b = 3.0;
    CrossOver(&a, &b, -1e9, 1e9, 2.0, &stream);
    EXPECT_NEAR(a + b, 4.0, 1e-14 * (std::fabs(a) + std::fabs(b)));  // rounding of a sum
    double same = 0.1;
    double other = 0.1;
    CrossOver(&same, &other, -1.0, 1.0, 2.0, &stream);
    EXPECT_EQ(same, 0.1);
    EXPECT_EQ(other, 0.1);
  }
}

// Deb and Agrawal (1995): the spread factor beta is at most 1 with probability one half, and at most
// x >= 1 with probability 1 - x^-(eta+1) / 2.
TEST(CrossOver, SpreadHasItsDistribution) {
  int contracting = 0;
  int within_twice = 0;
  int exchanged = 0;
  Stream stream(2, 0, "test");
  for (int i = 0; i < kDraws; ++i) {
    double a = -1.0;
    double b = 1.0;
    CrossOver(&a, &b, -1e9, 1e9, 2.0, &stream);
    contracting += std::fabs(a - b) <= 2.0;
    within_twice += std::fabs(a - b) <= 4.0;
    exchanged += a > b;
  }
  // Four standard deviations of a fraction near one half: 4 * 0.5 / sqrt(20000) = 0.014; the seed is fixed.
  EXPECT_NEAR(contracting / double{kDraws}, 0.5, 0.014);
  EXPECT_NEAR(within_twice / double{kDraws}, 1.0 - 0.5 / 8.0, 0.014);
  EXPECT_NEAR(exchanged / double{kDraws}, 0.5, 0.014);
}

TEST(CrossOver, NeverLeavesTheBoundsNorPilesUpOnThem) {
  Stream stream(3, 0, "test");
  int on_bound = 0;
  for (int i = 0; i < kDraws; ++i) {
    double a = 0.01;
    double b = 0.9;
    CrossOver(&a, &b, 0.0, 1.0, 0.5, &stream);
    for (const double child : {a, b}) {
      EXPECT_GE(child, 0.0);
      EXPECT_LE(child, 1.0);
      on_bound += child == 0.0 || child == 1.0;
    }
  }
  EXPECT_EQ(on_bound, 0);
}

TEST(CrossOverOnLine, ChildrenLieOnTheLineWithinTheBox) {
  Stream stream(4, 0, "test");
  const std::vector<double> lower = {0.0, -10.0, 5.0};
  const std::vector<double> upper = {1.0, 10.0, 5.0};
  int beyond_a = 0;
  int beyond_b = 0;
  for (int i = 0; i < kDraws; ++i) {
    std::vector<double> a = {0.2, -2.0, 5.0};
    std::vector<double> b = {0.6, 4.0, 5.0};
    CrossOverOnLine(&a, &b, lower, upper, 1.0, &stream);
    for (const std::vector<double>& child : {a, b}) {
      EXPECT_NEAR(child[1] + 2.0, 15.0 * (child[0] - 0.2), 1e-13);  // rounding of values near 10
      EXPECT_GE(child[0], 0.0);
      EXPECT_LE(child[1], 10.0);
      EXPECT_EQ(child[2], 5.0);
    }
    beyond_a += a[0] < 0.2;
    beyond_b += b[0] > 0.6;
  }
  // Beyond a the bounds leave a spread factor of L = 2, beyond b of L = 3; so the distribution of index 1,
  // cut there, has (1 - L^-2) / (2 - L^-2) outside the parents. Four standard deviations are 0.014.
  EXPECT_NEAR(beyond_a / double{kDraws}, 3.0 / 7.0, 0.014);
  EXPECT_NEAR(beyond_b / double{kDraws}, 8.0 / 17.0, 0.014);
}

TEST(Mutated, StaysWithinTheBoundsAndLeavesFixedVariables) {
  Stream stream(5, 0, "test");
  for (int i = 0; i < kDraws; ++i) {
    for (const double x : {0.0, 0.3, 1.0}) {
      const double y = Mutated(x, 0.0, 1.0, 0.0, &stream);
      EXPECT_GE(y, 0.0);
      EXPECT_LE(y, 1.0);
    }
    EXPECT_EQ(Mutated(7.0, 7.0, 7.0, 20.0, &stream), 7.0);
  }
}

// Away from the bounds the change d, as a fraction of the range, has P(|d| <= x) = 1 - (1 - x)^(eta+1).
TEST(Mutated, ChangeHasItsDistribution) {
  Stream stream(6, 0, "test");
  int small = 0;
  int upward = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double change = Mutated(0.0, -1.0, 1.0, 20.0, &stream) / 2.0;
    small += std::fabs(change) <= 0.05;
    upward += change > 0.0;
  }
  // The cut at the bounds changes the distribution by 0.5^21, which is nothing beside the 0.014 of above.
  EXPECT_NEAR(small / double{kDraws}, 1.0 - std::pow(0.95, 21.0), 0.014);
  EXPECT_NEAR(upward / double{kDraws}, 0.5, 0.014);
}

// Seen from the other end of the range the same distribution: bounds cut it on either side by as much.
TEST(Mutated, NearABoundIsTheMirrorImageOfNearTheOther) {
  constexpr int kTries = 4000;
  const double lower = -2.0, upper = 3.0, beside = 0.3;
  double low_mean = 0.0, high_mean = 0.0, farthest = 0.0;
  int on_bound = 0;
  for (std::uint64_t draw = 0; draw < kTries; ++draw) {
    Stream one(8, draw, "mutation"), other(9, draw, "mutation");
    const double low = Mutated(lower + beside, lower, upper, 3.0, &one) - lower;
    const double high = upper - Mutated(upper - beside, lower, upper, 3.0, &other);
    low_mean += low / kTries;
    high_mean += high / kTries;
    farthest = std::fmax(farthest, high);
    on_bound += low == 0.0 || high == 0.0;
  }
  // The change has a deviation below 0.9, its mean over the draws below 0.015: 4 of the difference of two are
  // asked.
  EXPECT_NEAR(high_mean, low_mean, 0.085);
  EXPECT_GT(farthest, 2.0) << "most of the range can be crossed";
  EXPECT_EQ(on_bound, 0) << "nothing piles up on a bound";
}

}  // namespace
}  // namespace dispersa::optimization_variation_test
