#include "core/statistics/percentiles.h"

#include <cmath>

#include "core/statistics/summary.h"

namespace dispersa {

std::vector<Percentile> Percentiles(const std::vector<double>& sorted_values) {
  static const struct {
    const char* name;
    double probability;
  } kShown[] = {{"p00_135", 0.00135}, {"p01", 0.01}, {"p05", 0.05},      {"p50", 0.5},
                {"p95", 0.95},        {"p99", 0.99}, {"p99_73", 0.9973}, {"p99_865", 0.99865}};
  const auto n = static_cast<double>(sorted_values.size());
  std::vector<Percentile> percentiles;
  for (const auto& [name, probability] : kShown) {
    // The rounding of 1 - 0.99 shall not take the 99 % of 100 values away.
    const double beyond = n * std::min(probability, 1.0 - probability) * (1.0 + 1e-12);
    percentiles.push_back({name, probability,
                           beyond >= 1.0 ? Quantile(sorted_values, probability) : kUndefined,
                           QuantileInterval(sorted_values, probability, kPercentileConfidence)});
  }
  return percentiles;
}

double Skewness(const std::vector<double>& sorted_values) {
  if (sorted_values.empty()) return kUndefined;
  const auto n = static_cast<double>(sorted_values.size());
  double mean = 0.0;
  for (const double value : sorted_values) mean += value / n;
  double second = 0.0;
  double third = 0.0;
  for (const double value : sorted_values) {
    const double deviation = value - mean;
    second += deviation * deviation / n;
    third += deviation * deviation * deviation / n;
  }
  return second > 0.0 ? third / std::pow(second, 1.5) : kUndefined;
}

}  // namespace dispersa
