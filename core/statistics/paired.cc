#include "core/statistics/paired.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/assertion.h"
#include "core/statistics/order_statistics.h"

namespace dispersa {
namespace {

constexpr double kWorst = std::numeric_limits<double>::infinity();

/// The median of sorted values. Between two equal infinities it is that infinity, between opposite ones
/// undefined.
template <typename Middle>
double Median(const std::vector<double>& sorted, Middle middle) {
  const std::size_t half = sorted.size() / 2;
  const double upper = sorted[half];
  const double lower = sorted.size() % 2 == 0 ? sorted[half - 1] : upper;
  return lower == upper ? upper : middle(lower, upper);
}

/// Probability of a split at least this uneven, when both sides are equally likely.
double SignTest(std::size_t worse, std::size_t better) {
  const auto fewer = static_cast<std::int64_t>(std::min(worse, better));
  return std::min(1.0, 2.0 * ConsumerRisk(0.5, static_cast<std::int64_t>(worse + better), fewer));
}

}  // namespace

PairedDifference ComparePaired(const std::vector<double>& a, const std::vector<double>& b,
                               double confidence) {
  DISPERSA_ASSERT(a.size() == b.size(), a.size(), b.size());
  PairedDifference result;
  result.n = a.size();
  if (a.empty()) return result;

  std::vector<double> differences;
  std::vector<double> ratios;
  bool positive = true;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool has_a = std::isfinite(a[i]);
    const bool has_b = std::isfinite(b[i]);
    result.lost_a += has_a ? 0 : 1;
    result.lost_b += has_b ? 0 : 1;
    positive = positive && (!has_a || a[i] > 0.0) && (!has_b || b[i] > 0.0);
    // A lost flight is an infinite value; two lost flights are equal.
    const double difference = has_a && has_b ? b[i] - a[i] : (has_a ? kWorst : (has_b ? -kWorst : 0.0));
    const double ratio = has_a && has_b ? b[i] / a[i] : (has_a ? kWorst : (has_b ? 0.0 : 1.0));
    ++(difference > 0.0 ? result.worse : difference < 0.0 ? result.better : result.equal);
    differences.push_back(difference);
    ratios.push_back(ratio);
  }

  std::sort(differences.begin(), differences.end());
  result.median_difference = Median(differences, [](double x, double y) { return 0.5 * (x + y); });
  result.difference_interval = QuantileInterval(differences, 0.5, confidence);
  if (positive) {
    // The order statistics of the logarithms are the logarithms of the order statistics.
    std::sort(ratios.begin(), ratios.end());
    result.median_ratio = Median(ratios, [](double x, double y) { return std::sqrt(x) * std::sqrt(y); });
    result.ratio_interval = QuantileInterval(ratios, 0.5, confidence);
    result.ratio_interval.lower = std::max(result.ratio_interval.lower, 0.0);
  }
  result.sign_test_p = SignTest(result.worse, result.better);
  return result;
}

}  // namespace dispersa
