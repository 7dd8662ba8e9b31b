// Bounds from replicates of a design, in cases with a closed form.
#include "core/statistics/replicates.h"
#include "tests/test.h"

namespace dispersa::statistics_replicates_test {
namespace {

constexpr double kRisk = 0.1;

// Two replicates leave one degree of freedom: Student's is then Cauchy's, whose quantile is a tangent.
TEST(ReplicateBounds, OfTwoReplicatesAreCauchys) {
  const double t = std::tan(std::numbers::pi * (0.5 - kRisk));
  const Interval bounds = ReplicateBounds({80, 120}, 400, kRisk);
  const double mean = 0.25, standard_error = 0.05;  // of shares of 0.2 and 0.3
  EXPECT_NEAR(bounds.lower, mean - t * standard_error, 1e-12);
  EXPECT_NEAR(bounds.upper, mean + t * standard_error, 1e-12);
}

// Three leave two: its quantile is (1 - 2 risk) sqrt(2 / (4 risk (1 - risk))).
TEST(ReplicateBounds, OfThreeReplicatesHaveTwoDegreesOfFreedom) {
  const double t = (1.0 - 2.0 * kRisk) * std::sqrt(2.0 / (4.0 * kRisk * (1.0 - kRisk)));
  const Interval bounds = ReplicateBounds({100, 200, 300}, 1000, kRisk);
  const double standard_error = 0.1 / std::sqrt(3.0);
  EXPECT_NEAR(bounds.lower, 0.2 - t * standard_error, 1e-12);
  EXPECT_NEAR(bounds.upper, 0.2 + t * standard_error, 1e-12);
}

// Replicates that agree say nothing of their spread: the bounds are those of as many independent cases.
TEST(ReplicateBounds, AreNeverNarrowerThanThoseOfIndependentCases) {
  const Interval bounds = ReplicateBounds({3, 3, 3, 3}, 10, kRisk);
  EXPECT_EQ(bounds.lower, ClopperPearsonLower(12, 40, 1.0 - kRisk));
  EXPECT_EQ(bounds.upper, ClopperPearsonUpper(12, 40, 1.0 - kRisk));
  EXPECT_LT(bounds.lower, 0.3);
  EXPECT_GT(bounds.upper, 0.3);
}

// No event in any of three: a replicate is without one with a probability of at least risk^(1/3).
TEST(ReplicateBounds, WithoutAnyEventCountReplicates) {
  const Interval none = ReplicateBounds({0, 0, 0}, 50, kRisk);
  EXPECT_EQ(none.lower, 0.0);
  EXPECT_NEAR(none.upper, 1.0 - std::cbrt(kRisk), 1e-12);
  const Interval all = ReplicateBounds({50, 50, 50}, 50, kRisk);
  EXPECT_NEAR(all.lower, std::cbrt(kRisk), 1e-12);
  EXPECT_EQ(all.upper, 1.0);
}

}  // namespace
}  // namespace dispersa::statistics_replicates_test
