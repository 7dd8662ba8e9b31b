// The rule base of equations (20) to (22) and the Lyapunov equation behind (32).
#include "core/control/axis_step.h"

#include "core/control/lyapunov.h"
#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::control_fuzzy_test {
namespace {

constexpr FuzzyRules kRules = {0.08, 0.03};
constexpr AxisGains kGains = {16.0, 7.0};

// The grades of a value by sets of a range.
std::array<double, kFuzzySets> Memberships(double x, double range) {
  std::array<double, kFuzzySets> grade;
  lanes::Grades(lanes::Clamp(2.0 * x / range + 2.0, 0.0, 4.0), grade.data());
  return grade;
}

// The frozen rules' surface.
double Surface(double error, double rate) {
  AxisConfig config;
  config.law = ControlLaw::kFrozenFuzzy;
  config.gains = {kGains};
  config.rules = kRules;
  AxisState state;
  AxisTelemetry telemetry;
  return StepAxis(BuildAxisLaw(config, 0.01), 0, error, rate, 1.0, 1.0, 0.01, state, telemetry);
}

TEST(Grades, AreOneAtTheirCentreAndHalfAtTheCrossings) {
  using Grades = std::array<double, kFuzzySets>;
  EXPECT_EQ(Memberships(-2.0, 2.0), (Grades{1, 0, 0, 0, 0}));
  EXPECT_EQ(Memberships(-1.0, 2.0), (Grades{0, 1, 0, 0, 0}));
  EXPECT_EQ(Memberships(0.0, 2.0), (Grades{0, 0, 1, 0, 0}));
  EXPECT_EQ(Memberships(1.5, 2.0), (Grades{0, 0, 0, 0.5, 0.5}));
  EXPECT_EQ(Memberships(2.0, 2.0), (Grades{0, 0, 0, 0, 1}));
}

TEST(Grades, OuterSetsAreShoulders) {
  EXPECT_EQ(Memberships(50.0, 2.0), Memberships(2.0, 2.0));
  EXPECT_EQ(Memberships(-50.0, 2.0), Memberships(-2.0, 2.0));
}

TEST(Grades, AreAPartitionOfUnityOverAtMostTwoSets) {
  Stream draws(1, 0, "grades");
  for (int k = 0; k < 2000; ++k) {
    const auto grades = Memberships(0.4 * (draws.Uniform() - 0.5), kRules.error_range_rad);
    int sets = 0;
    for (const double grade : grades) {
      ASSERT_GE(grade, 0.0);
      if (grade > 0.0) ++sets;
    }
    ASSERT_LE(sets, 2);
    ASSERT_EQ(std::accumulate(grades.begin(), grades.end(), 0.0), 1.0);
  }
}

TEST(Rules, AreNumberedByErrorSetThenRateSet) {
  AxisConfig config;
  config.law = ControlLaw::kFrozenFuzzy;
  config.gains = {kGains};
  config.rules = kRules;
  AxisState state;
  AxisTelemetry telemetry;
  StepAxis(BuildAxisLaw(config, 0.01), 0, kRules.error_range_rad, -0.5 * kRules.rate_range_rad_s, 1.0, 1.0,
           0.01, state, telemetry);
  EXPECT_EQ(state.rules_fired, 1u << (4 * kFuzzySets + 1));
}

TEST(Rules, StartAsTheLinearLawInsideTheOuterCentres) {
  Stream draws(2, 0, "plane");
  for (int k = 0; k < 1000; ++k) {
    const double error = 2.0 * kRules.error_range_rad * (draws.Uniform() - 0.5);
    const double rate = 2.0 * kRules.rate_range_rad_s * (draws.Uniform() - 0.5);
    // Rounding of products of order 1.
    ASSERT_NEAR(Surface(error, rate), kGains.kp_1_s2 * error + kGains.kd_1_s * rate, 1e-14);
  }
}

TEST(Rules, AreFlatBeyondTheOuterCentres) {
  const double corner = kGains.kp_1_s2 * kRules.error_range_rad + kGains.kd_1_s * kRules.rate_range_rad_s;
  EXPECT_NEAR(Surface(1.0, 1.0), corner, 1e-14);
  EXPECT_NEAR(Surface(-1.0, -1.0), -corner, 1e-14);
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
}  // namespace dispersa::control_fuzzy_test
