#include "core/statistics/tolerance.h"

#include <cassert>
#include <cmath>

#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>

#include "core/statistics/order_statistics.h"

namespace dispersa {

std::int64_t WilksOneSided(double coverage, double confidence, std::int64_t order) {
  assert(order >= 1);
  // The order-th largest lies above the quantile when at least `order` values do: fewer is the risk.
  return CasesNeeded(coverage, 1.0 - confidence, order - 1);
}

std::int64_t WilksTwoSided(double coverage, double confidence) {
  // The share between the extremes is distributed as that below the second largest: Beta(n - 1, 2).
  return WilksOneSided(coverage, confidence, 2);
}

double NormalToleranceFactor(std::int64_t n, double coverage, double confidence) {
  assert(n >= 2 && coverage > 0.0 && coverage < 1.0 && confidence > 0.0 && confidence < 1.0);
  const double root_n = std::sqrt(static_cast<double>(n));
  const double noncentrality = quantile(boost::math::normal(), coverage) * root_n;
  const boost::math::non_central_t distribution(static_cast<double>(n - 1), noncentrality);
  return quantile(distribution, confidence) / root_n;
}

}  // namespace dispersa
