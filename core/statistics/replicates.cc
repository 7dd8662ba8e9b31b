#include "core/statistics/replicates.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

#include "core/math/assertion.h"

namespace dispersa {

namespace {

Interval StudentBounds(const std::vector<double>& shares, double risk) {
  const auto count = static_cast<double>(shares.size());
  if (std::all_of(shares.begin(), shares.end(), [](double share) { return share == 0.0; }))
    return {0.0, 1.0 - std::pow(risk, 1.0 / count)};
  if (std::all_of(shares.begin(), shares.end(), [](double share) { return share >= 1.0; }))
    return {std::pow(risk, 1.0 / count), 1.0};
  double mean = 0.0;
  for (const double share : shares) mean += share / count;
  double squares = 0.0;
  for (const double share : shares) squares += (share - mean) * (share - mean);
  const boost::math::students_t student(count - 1.0);
  const double reach = quantile(complement(student, risk)) * std::sqrt(squares / (count - 1.0) / count);
  return {std::max(mean - reach, 0.0), std::min(mean + reach, 1.0)};
}

}  // namespace

Interval ReplicateBounds(const std::vector<std::int64_t>& counts, std::int64_t points, double risk) {
  DISPERSA_ASSERT(counts.size() >= 2 && points > 0 && risk > 0.0 && risk < 0.5, points, risk, counts.size());
  std::vector<double> shares;
  std::int64_t events = 0;
  for (const std::int64_t count : counts) {
    shares.push_back(static_cast<double>(count) / static_cast<double>(points));
    events += count;
  }
  const Interval student = StudentBounds(shares, risk);
  const std::int64_t all = points * std::ssize(counts);
  return {std::min(student.lower, ClopperPearsonLower(events, all, 1.0 - risk)),
          std::max(student.upper, ClopperPearsonUpper(events, all, 1.0 - risk))};
}

}  // namespace dispersa
