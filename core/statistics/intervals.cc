#include "core/statistics/intervals.h"

#include <limits>

#include <boost/math/special_functions/beta.hpp>

#include "core/math/assertion.h"
#include "core/statistics/bisection.h"
#include "core/statistics/order_statistics.h"

namespace dispersa {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

double ClopperPearsonLower(std::int64_t events, std::int64_t n, double confidence) {
  DISPERSA_ASSERT(n > 0 && events >= 0 && events <= n && confidence > 0.0 && confidence < 1.0, n, events,
                  confidence);
  if (events == 0) return 0.0;
  return boost::math::ibetac_inv(static_cast<double>(events), static_cast<double>(n - events + 1),
                                 confidence);
}

double ClopperPearsonUpper(std::int64_t events, std::int64_t n, double confidence) {
  DISPERSA_ASSERT(n > 0 && events >= 0 && events <= n && confidence > 0.0 && confidence < 1.0, n, events,
                  confidence);
  if (events == n) return 1.0;
  return boost::math::ibeta_inv(static_cast<double>(events + 1), static_cast<double>(n - events), confidence);
}

Interval ClopperPearson(std::int64_t events, std::int64_t n, double confidence) {
  const double one_sided = 0.5 + 0.5 * confidence;
  return {ClopperPearsonLower(events, n, one_sided), ClopperPearsonUpper(events, n, one_sided)};
}

RankInterval QuantileRanks(std::int64_t n, double probability, double confidence) {
  DISPERSA_ASSERT(n >= 0 && probability > 0.0 && probability < 1.0 && confidence > 0.0 && confidence < 1.0, n,
                  probability, confidence);
  // The number B of values up to the quantile is binomial, and n - B counts as failures. If B < r, the value
  // of rank r is above the quantile and is no lower bound. If B >= r, it is below and is no upper bound. Each
  // may happen with half of 1 - confidence.
  const double tail = 0.5 * (1.0 - confidence);
  const std::int64_t too_high = FirstTrue(
      0, n + 1, [&](std::int64_t rank) { return ProducerRisk(probability, n, n - rank + 1) > tail; });
  const std::int64_t high_enough =
      FirstTrue(0, n + 1, [&](std::int64_t rank) { return ConsumerRisk(probability, n, n - rank) <= tail; });
  return {too_high - 1, high_enough};
}

Interval QuantileInterval(const std::vector<double>& sorted_values, double probability, double confidence) {
  const auto n = static_cast<std::int64_t>(sorted_values.size());
  const RankInterval ranks = QuantileRanks(n, probability, confidence);
  return {ranks.lower == 0 ? -kInfinity : sorted_values[ranks.lower - 1],
          ranks.upper == n + 1 ? kInfinity : sorted_values[ranks.upper - 1]};
}

}  // namespace dispersa
