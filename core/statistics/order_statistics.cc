#include "core/statistics/order_statistics.h"

#include <boost/math/special_functions/beta.hpp>

#include "core/math/assertion.h"
#include "core/statistics/bisection.h"

namespace dispersa {

double ConsumerRisk(double probability, std::int64_t n, std::int64_t failures) {
  DISPERSA_ASSERT(probability > 0.0 && probability < 1.0 && n >= 0 && failures >= 0, n, failures,
                  probability);
  if (failures >= n) return 1.0;
  // P(X <= f) = I_p(n - f, f + 1). In this form the failure probability 1 - p need not be rounded.
  return boost::math::ibeta(static_cast<double>(n - failures), static_cast<double>(failures + 1),
                            probability);
}

double ProducerRisk(double probability, std::int64_t n, std::int64_t failures) {
  DISPERSA_ASSERT(probability > 0.0 && probability < 1.0 && n >= 0 && failures >= 0, n, failures,
                  probability);
  if (failures == 0) return 1.0;
  if (failures > n) return 0.0;
  return boost::math::ibetac(static_cast<double>(n - failures + 1), static_cast<double>(failures),
                             probability);
}

std::int64_t CasesNeeded(double probability, double consumer_risk, std::int64_t failures) {
  DISPERSA_ASSERT(consumer_risk > 0.0 && consumer_risk < 1.0, consumer_risk);
  const auto shown = [&](std::int64_t n) { return ConsumerRisk(probability, n, failures) <= consumer_risk; };
  std::int64_t enough = failures + 1;
  while (!shown(enough)) enough *= 2;
  return FirstTrue(failures, enough, shown);
}

std::optional<std::int64_t> MaxFailures(double probability, double consumer_risk, std::int64_t n) {
  DISPERSA_ASSERT(consumer_risk > 0.0 && consumer_risk < 1.0, consumer_risk);
  const std::int64_t too_many = FirstTrue(
      -1, n, [&](std::int64_t failures) { return ConsumerRisk(probability, n, failures) > consumer_risk; });
  if (too_many == 0) return std::nullopt;
  return too_many - 1;
}

}  // namespace dispersa
