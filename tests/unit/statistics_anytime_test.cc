// Evidence that holds at any time: against quadrature, and as a martingale.
#include "core/statistics/anytime.h"
#include "tests/test.h"

#include <boost/math/quadrature/tanh_sinh.hpp>

namespace dispersa::statistics_anytime_test {

double Ratio(double p, double limit, int n, int failures) {
  return std::pow(p / limit, failures) * std::pow((1.0 - p) / (1.0 - limit), n - failures);
}

TEST(Anytime, EvidenceIsTheMixtureOfLikelihoodRatios) {
  boost::math::quadrature::tanh_sinh<double> integrator;
  for (const double probability : {0.5, 0.9, 0.9973}) {
    const double limit = 1.0 - probability;
    for (const auto& [n, failures] : {std::pair{10, 0}, {200, 3}, {900, 1}}) {
      const double passing = integrator.integrate(
          [&](double p) { return Ratio(p, limit, n, failures) / (2.0 * std::sqrt(limit) * std::sqrt(p)); },
          0.0, limit);
      EXPECT_NEAR(PassEvidence(probability, n, failures), std::log(passing), 1e-8);
      if (failures == 0) continue;
      const double failing = integrator.integrate(
          [&](double p) { return Ratio(p, limit, n, failures) / (p * -std::log(limit)); }, limit, 1.0);
      EXPECT_NEAR(FailEvidence(probability, n, failures), std::log(failing), 1e-8);
    }
  }
}

// At the limit the evidence after the next case has the mean of the evidence now: a martingale, begun at 1.
TEST(Anytime, EvidenceIsAMartingaleAtTheLimit) {
  const double probability = 0.97;
  EXPECT_NEAR(PassEvidence(probability, 0, 0), 0.0, 1e-12);
  for (const auto& [n, failures] : {std::pair{5, 1}, {100, 3}, {700, 30}}) {
    const double next_pass = probability * std::exp(PassEvidence(probability, n + 1, failures)) +
                             (1.0 - probability) * std::exp(PassEvidence(probability, n + 1, failures + 1));
    EXPECT_NEAR(next_pass / std::exp(PassEvidence(probability, n, failures)), 1.0, 1e-9);
    const double next_fail = probability * std::exp(FailEvidence(probability, n + 1, failures)) +
                             (1.0 - probability) * std::exp(FailEvidence(probability, n + 1, failures + 1));
    EXPECT_NEAR(next_fail / std::exp(FailEvidence(probability, n, failures)), 1.0, 1e-9);
  }
}

TEST(Anytime, BoundariesAreWhereTheEvidenceIsEnough) {
  const LookBoundary look = AnytimeBoundary(0.9973, 0.10, 0.10, 5000);
  EXPECT_EQ(look.n, 5000);
  const double enough = std::log(10.0);
  EXPECT_GE(PassEvidence(0.9973, 5000, look.accept), enough);
  EXPECT_LT(PassEvidence(0.9973, 5000, look.accept + 1), enough);
  EXPECT_GE(FailEvidence(0.9973, 5000, look.reject), enough);
  EXPECT_LT(FailEvidence(0.9973, 5000, look.reject - 1), enough);
  EXPECT_EQ(AnytimeBoundary(0.9973, 0.10, 0.10, 100).accept, -1);
  for (const std::int64_t failures : {0, 1, 7}) {
    const std::int64_t n = AnytimeCasesNeeded(0.9973, 0.10, failures);
    EXPECT_EQ(AnytimeBoundary(0.9973, 0.10, 0.10, n).accept, failures);
    EXPECT_LT(AnytimeBoundary(0.9973, 0.10, 0.10, n - 1).accept, failures);
  }
}

TEST(Anytime, TheConfidenceSequenceEndsWhereTheTestsTurn) {
  const Interval success = AnytimeSuccess(2000, 4, 6, 0.10);
  EXPECT_LT(success.lower, 1994.0 / 2000.0);
  EXPECT_GT(success.upper, 1996.0 / 2000.0);
  EXPECT_NEAR(PassEvidence(success.lower, 2000, 6), std::log(10.0), 1e-6);
  EXPECT_NEAR(FailEvidence(success.upper, 2000, 4), std::log(10.0), 1e-6);
  EXPECT_EQ(AnytimeSuccess(2000, 0, 0, 0.10).upper, 1.0);
}

}  // namespace dispersa::statistics_anytime_test
