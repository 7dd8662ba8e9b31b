#include "core/statistics/anytime.h"

#include <cmath>
#include <limits>

#include <boost/math/special_functions/beta.hpp>

#include "core/math/assertion.h"
#include "core/statistics/bisection.h"

namespace dispersa {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

double LogBeta(double a, double b) { return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b); }

/// The log likelihood of a failure probability `failure`: ln(p^f (1 - p)^(n - f)).
double LogLikelihood(double failure, std::int64_t n, std::int64_t failures) {
  return static_cast<double>(failures) * std::log(failure) +
         static_cast<double>(n - failures) * std::log1p(-failure);
}

/// The condition holds for small probabilities and not for large ones. Returns the boundary between them, in
/// (0, 1).
template <typename Condition>
double LastTrue(Condition condition) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (condition(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

double PassEvidence(double probability, std::int64_t n, std::int64_t failures) {
  DISPERSA_ASSERT(probability > 0.0 && probability < 1.0 && n >= failures && failures >= 0, n, failures,
                  probability);
  const double limit = 1.0 - probability;
  const double a = static_cast<double>(failures) + 0.5;
  const double b = static_cast<double>(n - failures) + 1.0;
  const double share = boost::math::ibeta(a, b, limit);
  if (share <= 0.0) return kNone;
  return std::log(share) + LogBeta(a, b) - std::log(2.0 * std::sqrt(limit)) -
         LogLikelihood(limit, n, failures);
}

double FailEvidence(double probability, std::int64_t n, std::int64_t failures) {
  DISPERSA_ASSERT(probability > 0.0 && probability < 1.0 && n >= failures && failures >= 0, n, failures,
                  probability);
  if (failures == 0) return kNone;
  const double limit = 1.0 - probability;
  const auto a = static_cast<double>(failures);
  const double b = static_cast<double>(n - failures) + 1.0;
  const double share = boost::math::ibetac(a, b, limit);
  if (share <= 0.0) return kNone;
  return std::log(share) + LogBeta(a, b) - std::log(-std::log(limit)) - LogLikelihood(limit, n, failures);
}

LookBoundary AnytimeBoundary(double probability, double pass_risk, double fail_risk, std::int64_t n) {
  DISPERSA_ASSERT(pass_risk > 0.0 && pass_risk < 1.0 && fail_risk > 0.0 && fail_risk < 1.0, pass_risk,
                  fail_risk);
  const std::int64_t first_open = FirstTrue(-1, n + 1, [&](std::int64_t failures) {
    return PassEvidence(probability, n, failures) < -std::log(pass_risk);
  });
  const std::int64_t reject = FirstTrue(-1, n + 1, [&](std::int64_t failures) {
    return FailEvidence(probability, n, failures) >= -std::log(fail_risk);
  });
  return {n, first_open - 1, reject};
}

std::int64_t AnytimeCasesNeeded(double probability, double risk, std::int64_t failures) {
  const auto enough = [&](std::int64_t n) {
    return PassEvidence(probability, n, failures) >= -std::log(risk);
  };
  std::int64_t high = failures + 1;
  while (!enough(high)) high *= 2;
  return FirstTrue(failures, high, enough);
}

Interval AnytimeSuccess(std::int64_t n, std::int64_t failures, std::int64_t most_failures, double risk) {
  DISPERSA_ASSERT(n > 0, n);
  const double threshold = -std::log(risk);
  return {LastTrue([&](double p) { return p > 0.0 && PassEvidence(p, n, most_failures) >= threshold; }),
          failures == 0 ? 1.0 : LastTrue([&](double p) {
            return p <= 0.0 || FailEvidence(p, n, failures) < threshold;
          })};
}

}  // namespace dispersa
