#include "core/statistics/replicates.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

namespace dispersa {

Interval ReplicateMeanBounds(const std::vector<double>& shares, double risk) {
  assert(shares.size() >= 2 && risk > 0.0 && risk < 0.5);
  const auto count = static_cast<double>(shares.size());
  double mean = 0.0;
  for (const double share : shares) mean += share / count;
  double squares = 0.0;
  for (const double share : shares) squares += (share - mean) * (share - mean);
  if (std::all_of(shares.begin(), shares.end(), [](double share) { return share == 0.0; }))
    return {0.0, 1.0 - std::pow(risk, 1.0 / count)};
  if (std::all_of(shares.begin(), shares.end(), [](double share) { return share >= 1.0; }))
    return {std::pow(risk, 1.0 / count), 1.0};
  const boost::math::students_t student(count - 1.0);
  const double reach = quantile(complement(student, risk)) * std::sqrt(squares / (count - 1.0) / count);
  return {std::max(mean - reach, 0.0), std::min(mean + reach, 1.0)};
}

}  // namespace dispersa
