#include "core/statistics/two_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <boost/math/special_functions/gamma.hpp>

#include "core/math/assertion.h"
#include "core/statistics/order_statistics.h"
#include "core/statistics/sensitivity.h"

namespace dispersa {
namespace {

double LogChoose(std::int64_t n, std::int64_t k) {
  const auto log_factorial = [](std::int64_t m) { return boost::math::lgamma(static_cast<double>(m) + 1.0); };
  return log_factorial(n) - log_factorial(k) - log_factorial(n - k);
}

/// The estimate of a quantile, if the sample reaches it and the values around it are finite; else undefined.
double Estimate(const std::vector<double>& sorted, double probability) {
  // The factor allows for rounding: with 100 values, 1 - 0.99 must still leave one value beyond the 99 %.
  const double beyond =
      static_cast<double>(sorted.size()) * std::min(probability, 1.0 - probability) * (1.0 + 1e-12);
  if (beyond < 1.0) return kUndefined;
  const double estimate = Quantile(sorted, probability);
  return std::isfinite(estimate) ? estimate : kUndefined;
}

std::vector<double> Sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

/// Correlation of "a is at most its quantile" and "b is at most its own".
double IndicatorCorrelation(const std::vector<double>& a, double of_a, const std::vector<double>& b,
                            double of_b) {
  double in_a = 0.0, in_b = 0.0, in_both = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    in_a += a[i] <= of_a;
    in_b += b[i] <= of_b;
    in_both += a[i] <= of_a && b[i] <= of_b;
  }
  const auto n = static_cast<double>(a.size());
  const double variance = in_a * (n - in_a) * in_b * (n - in_b);
  return variance > 0.0 ? (n * in_both - in_a * in_b) / std::sqrt(variance) : 0.0;
}

}  // namespace

double McNemarP(std::int64_t only_a, std::int64_t only_b) {
  return std::min(1.0, 2.0 * ConsumerRisk(0.5, only_a + only_b, std::min(only_a, only_b)));
}

double FisherP(std::int64_t events_a, std::int64_t n_a, std::int64_t events_b, std::int64_t n_b) {
  DISPERSA_ASSERT(events_a >= 0 && events_a <= n_a && events_b >= 0 && events_b <= n_b);
  if (n_a == 0 || n_b == 0) return 1.0;
  const std::int64_t events = events_a + events_b;
  const double all = LogChoose(n_a + n_b, events);
  const auto log_probability = [&](std::int64_t k) {
    return LogChoose(n_a, k) + LogChoose(n_b, events - k) - all;
  };
  // The margin counts tables that are as likely as this one in spite of the rounding of their logarithms.
  const double seen = log_probability(events_a) + 1e-7;
  double p = 0.0;
  for (std::int64_t k = std::max<std::int64_t>(0, events - n_b); k <= std::min(events, n_a); ++k) {
    const double log_p = log_probability(k);
    if (log_p <= seen) p += std::exp(log_p);
  }
  return std::min(1.0, p);
}

std::vector<double> HolmAdjusted(const std::vector<double>& p_values) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p_values.size(); ++i) {
    if (!std::isnan(p_values[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return p_values[i] < p_values[j]; });
  std::vector<double> adjusted(p_values.size(), kUndefined);
  double largest = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - i) * p_values[order[i]]));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

Interval DifferenceLimits(double a, const Interval& limits_a, double b, const Interval& limits_b,
                          double correlation) {
  const auto reach = [&](double of_b, double of_a) {
    if (!std::isfinite(of_b) || !std::isfinite(of_a)) return std::numeric_limits<double>::infinity();
    return std::sqrt(std::max(0.0, of_b * of_b + of_a * of_a - 2.0 * correlation * of_b * of_a));
  };
  return {b - a - reach(b - limits_b.lower, limits_a.upper - a),
          b - a + reach(limits_b.upper - b, a - limits_a.lower)};
}

QuantileDifference CompareQuantiles(const std::vector<double>& a, const std::vector<double>& b,
                                    double probability, double confidence, bool paired) {
  DISPERSA_ASSERT(!paired || a.size() == b.size(), a.size(), b.size());
  QuantileDifference result;
  if (a.empty() || b.empty()) return result;
  const std::vector<double> sorted_a = Sorted(a);
  const std::vector<double> sorted_b = Sorted(b);
  result.a = Estimate(sorted_a, probability);
  result.b = Estimate(sorted_b, probability);
  if (std::isfinite(result.a) && std::isfinite(result.b)) {
    result.difference = result.b - result.a;
    result.interval = DifferenceLimits(result.a, QuantileInterval(sorted_a, probability, confidence),
                                       result.b, QuantileInterval(sorted_b, probability, confidence),
                                       paired ? IndicatorCorrelation(a, result.a, b, result.b) : 0.0);
  }

  std::vector<double> pooled = a;
  pooled.insert(pooled.end(), b.begin(), b.end());
  const auto rank =
      static_cast<std::size_t>(std::clamp(std::ceil(probability * static_cast<double>(pooled.size())) - 1.0,
                                          0.0, static_cast<double>(pooled.size() - 1)));
  std::nth_element(pooled.begin(), pooled.begin() + static_cast<std::ptrdiff_t>(rank), pooled.end());
  const double common = pooled[rank];
  // Counts on the side of the tail, so that the counted event is rare.
  const auto beyond = [&](double value) { return probability < 0.5 ? value < common : value > common; };
  const auto count = [&](const std::vector<double>& values) {
    return static_cast<std::int64_t>(std::count_if(values.begin(), values.end(), beyond));
  };
  if (paired) {
    std::int64_t only_a = 0, only_b = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      only_a += beyond(a[i]) && !beyond(b[i]);
      only_b += beyond(b[i]) && !beyond(a[i]);
    }
    result.p = McNemarP(only_a, only_b);
  } else {
    result.p = FisherP(count(a), std::ssize(a), count(b), std::ssize(b));
  }
  return result;
}

double TendencyOf(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty() || b.empty()) return kUndefined;
  const std::vector<double> sorted = Sorted(a);
  double larger = 0.0;
  for (const double value : b) {
    const auto [equal, above] = std::equal_range(sorted.begin(), sorted.end(), value);
    larger += static_cast<double>((equal - sorted.begin()) - (sorted.end() - above));
  }
  return larger / (static_cast<double>(a.size()) * static_cast<double>(b.size()));
}

double LocationP(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty() || b.empty()) return kUndefined;
  std::vector<double> pooled = a;
  pooled.insert(pooled.end(), b.begin(), b.end());
  std::vector<bool> of_a(pooled.size(), false);
  std::fill_n(of_a.begin(), a.size(), true);
  return RankSumP(Ranked(pooled), of_a);
}

}  // namespace dispersa
