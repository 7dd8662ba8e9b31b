// The rule base of equations (20) to (22) and the Lyapunov equation behind (32).
#include "core/control/fuzzy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/control/lyapunov.h"
#include "core/random/draws.h"

namespace dispersa {
namespace {

constexpr FuzzyRules kRules = {0.08, 0.03};
constexpr AxisGains kGains = {16.0, 7.0};

double Surface(const std::array<double, kFuzzyRules>& consequents, double error, double rate) {
  const auto zeta = Regressor(kRules, error, rate);
  double u = 0.0;
  for (std::size_t i = 0; i < kFuzzyRules; ++i) u += consequents[i] * zeta[i];
  return u;
}

TEST(Memberships, AreOneAtTheirCentreAndHalfAtTheCrossings) {
  using Grades = std::array<double, kFuzzySets>;
  EXPECT_EQ(Memberships(-2.0, 2.0), (Grades{1, 0, 0, 0, 0}));
  EXPECT_EQ(Memberships(-1.0, 2.0), (Grades{0, 1, 0, 0, 0}));
  EXPECT_EQ(Memberships(0.0, 2.0), (Grades{0, 0, 1, 0, 0}));
  EXPECT_EQ(Memberships(1.5, 2.0), (Grades{0, 0, 0, 0.5, 0.5}));
  EXPECT_EQ(Memberships(2.0, 2.0), (Grades{0, 0, 0, 0, 1}));
}

TEST(Memberships, OuterSetsAreShoulders) {
  EXPECT_EQ(Memberships(50.0, 2.0), Memberships(2.0, 2.0));
  EXPECT_EQ(Memberships(-50.0, 2.0), Memberships(-2.0, 2.0));
}

TEST(Regressor, IsAPartitionOfUnityWithAtMostFourRules) {
  Stream draws(1, 0, "regressor");
  for (int k = 0; k < 2000; ++k) {
    const auto zeta =
        Regressor(kRules, 0.4 * (draws.Uniform() - 0.5), 0.12 * (draws.Uniform() - 0.5));
    int fired = 0;
    for (const double z : zeta) {
      ASSERT_GE(z, 0.0);
      if (z > 0.0) ++fired;
    }
    ASSERT_LE(fired, 4);
    // 25 sums and one division: a few units in the last place.
    ASSERT_NEAR(std::accumulate(zeta.begin(), zeta.end(), 0.0), 1.0, 1e-15);
  }
}

TEST(Regressor, NumbersRulesByErrorSetThenRateSet) {
  const auto zeta = Regressor(kRules, kRules.error_range_rad, -0.5 * kRules.rate_range_rad_s);
  for (std::size_t i = 0; i < kFuzzyRules; ++i) EXPECT_EQ(zeta[i], i == 4 * kFuzzySets + 1 ? 1.0 : 0.0) << i;
}

TEST(PlaneConsequents, ReproduceTheLinearLawInsideTheOuterCentres) {
  const auto consequents = PlaneConsequents(kRules, kGains);
  Stream draws(2, 0, "plane");
  for (int k = 0; k < 1000; ++k) {
    const double error = 2.0 * kRules.error_range_rad * (draws.Uniform() - 0.5);
    const double rate = 2.0 * kRules.rate_range_rad_s * (draws.Uniform() - 0.5);
    // Rounding of products of order 1.
    ASSERT_NEAR(Surface(consequents, error, rate), kGains.kp_1_s2 * error + kGains.kd_1_s * rate, 1e-14);
  }
}

TEST(PlaneConsequents, AreFlatBeyondTheOuterCentres) {
  const auto consequents = PlaneConsequents(kRules, kGains);
  const double corner = kGains.kp_1_s2 * kRules.error_range_rad + kGains.kd_1_s * kRules.rate_range_rad_s;
  EXPECT_NEAR(Surface(consequents, 1.0, 1.0), corner, 1e-14);
  EXPECT_NEAR(Surface(consequents, -1.0, -1.0), -corner, 1e-14);
}

TEST(SolveLyapunov, LeavesNoResidual) {
  for (const double kp : {0.3, 16.0, 400.0})
    for (const double kd : {0.1, 7.0, 30.0})
      for (const double q12 : {0.0, 0.3, -0.4}) {
        Matrix2 a, q;
        a << 0.0, 1.0, -kp, -kd;
        q << 1.0, q12, q12, 0.5;
        const Matrix2 p = SolveLyapunov({kp, kd}, q);
        const Matrix2 residual = a.transpose() * p + p * a + q;
        // Terms reach kp * p11; four of them.
        const double scale = (1.0 + kp + kd) * p.cwiseAbs().maxCoeff();
        EXPECT_LT(residual.cwiseAbs().maxCoeff(), 4e-16 * scale) << kp << " " << kd << " " << q12;
        EXPECT_EQ(p(0, 1), p(1, 0));
        EXPECT_TRUE(IsPositiveDefinite(p));
      }
}

TEST(IsPositiveDefinite, RefusesSemiDefiniteAndIndefinite) {
  Matrix2 m;
  m << 1.0, 0.5, 0.5, 1.0;
  EXPECT_TRUE(IsPositiveDefinite(m));
  m << 1.0, 1.0, 1.0, 1.0;
  EXPECT_FALSE(IsPositiveDefinite(m));
  m << -1.0, 0.0, 0.0, -1.0;
  EXPECT_FALSE(IsPositiveDefinite(m));
  m << 1.0, 2.0, 2.0, 1.0;
  EXPECT_FALSE(IsPositiveDefinite(m));
}

}  // namespace
}  // namespace dispersa
