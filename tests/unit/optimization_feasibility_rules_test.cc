// Deb's rules, the tie-breaker, and values that are not finite.
#include "core/optimization/feasibility_rules.h"
#include "tests/test.h"

namespace dispersa::optimization_feasibility_rules_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Merit Of(double objective, std::vector<double> violations = {}, double tie_breaker = 0.0) {
  return MeritOf({objective, std::move(violations), tie_breaker});
}

TEST(FeasibilityRules, FeasibleBeatsInfeasibleWhateverTheObjectives) {
  EXPECT_TRUE(IsBetter(Of(1e9), Of(-1e9, {1e-12}), -kInfinity));
  EXPECT_FALSE(IsBetter(Of(-1e9, {1e-12}), Of(1e9), -kInfinity));
}

TEST(FeasibilityRules, OfTwoInfeasibleTheSmallerSumOfViolationsWins) {
  EXPECT_TRUE(IsBetter(Of(5.0, {0.2, 0.1}), Of(1.0, {0.0, 0.4}), -kInfinity));
  // Equal sums are equal: the objective and the tie-breaker of an infeasible point mean nothing.
  EXPECT_FALSE(IsBetter(Of(1.0, {0.25, 0.25}, 1.0), Of(5.0, {0.5}, 2.0), kInfinity));
  EXPECT_FALSE(IsBetter(Of(5.0, {0.5}, 2.0), Of(1.0, {0.25, 0.25}, 1.0), kInfinity));
}

TEST(FeasibilityRules, OfTwoFeasibleTheLowerObjectiveWins) {
  EXPECT_TRUE(IsBetter(Of(1.0, {0.0}, 9.0), Of(2.0, {-3.0}, 0.0), -kInfinity));
  EXPECT_FALSE(IsBetter(Of(2.0, {-3.0}, 0.0), Of(1.0, {0.0}, 9.0), -kInfinity));
}

TEST(FeasibilityRules, SatisfiedConstraintsDoNotMakeUpForViolatedOnes) {
  EXPECT_EQ(Of(0.0, {-1.0, 0.25}).violation, 0.25);
}

TEST(FeasibilityRules, TieBreakerDecidesUpToTheThresholdOnly) {
  const Merit a = Of(1.0, {}, 7.0);
  const Merit b = Of(1.5, {}, 3.0);
  EXPECT_TRUE(IsBetter(b, a, 1.5));
  EXPECT_FALSE(IsBetter(a, b, 1.5));
  EXPECT_TRUE(IsBetter(a, b, 1.4999));
  EXPECT_FALSE(IsBetter(b, a, 1.4999));
}

TEST(FeasibilityRules, EqualTieBreakersLeaveTheObjectiveToDecideAndEqualObjectivesTheTieBreaker) {
  EXPECT_TRUE(IsBetter(Of(1.0, {}, 3.0), Of(1.5, {}, 3.0), 2.0));
  EXPECT_TRUE(IsBetter(Of(1.0, {}, 3.0), Of(1.0, {}, 4.0), -kInfinity));
}

TEST(FeasibilityRules, ValuesThatAreNotFiniteAreTheWorst) {
  const Merit awful = Of(0.0, {1e300});
  for (const Merit& worst :
       {Of(kNan), Of(kInfinity), Of(-kInfinity), Of(0.0, {kNan}), Of(0.0, {1.0, kInfinity})}) {
    EXPECT_EQ(worst.violation, kInfinity);
    EXPECT_TRUE(IsBetter(awful, worst, kInfinity));
    EXPECT_FALSE(IsBetter(worst, awful, kInfinity));
  }
  EXPECT_TRUE(IsBetter(Of(1.0, {}, 1e300), Of(1.0, {}, kNan), kInfinity));
}

// std::stable_sort needs this: neither reflexive nor cyclic, and equivalence passes on.
TEST(FeasibilityRules, OrderIsAStrictWeakOne) {
  const std::vector<Merit> merits = {Of(0.0),          Of(1.0),           Of(0.5, {}, 1.0),
                                     Of(0.5, {}, 0.5), Of(2.0, {}, 0.1),  Of(2.0, {}, 0.2),
                                     Of(0.0, {0.1}),   Of(1.0, {0.1}),    Of(0.0, {0.2}),
                                     Of(kNan),         Of(0.9, {}, kNan), Of(3.0, {}, kNan)};
  const double threshold = 1.0;
  for (const Merit& a : merits) {
    EXPECT_FALSE(IsBetter(a, a, threshold));
    for (const Merit& b : merits) {
      EXPECT_FALSE(IsBetter(a, b, threshold) && IsBetter(b, a, threshold));
      for (const Merit& c : merits) {
        if (IsBetter(a, b, threshold)) {
          EXPECT_TRUE(IsBetter(a, c, threshold) || IsBetter(c, b, threshold));
        }
      }
    }
  }
}

}  // namespace
}  // namespace dispersa::optimization_feasibility_rules_test
