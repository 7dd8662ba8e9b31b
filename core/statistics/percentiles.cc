#include "core/statistics/percentiles.h"

#include <algorithm>
#include <cmath>

#include "core/statistics/compensated_sum.h"
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
    // The factor allows for rounding: with 100 values, 1 - 0.99 must still leave one value beyond the 99 %.
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
  const double mean = Mean(sorted_values);
  // In units of the largest deviation, so that the cube neither overflows nor vanishes.
  const double scale = std::max(mean - sorted_values.front(), sorted_values.back() - mean);
  if (!(scale > 0.0)) return kUndefined;
  const auto moment = [&](int power) {
    return CompensatedSum(sorted_values,
                          [&](double value) {
                            const double deviation = (value - mean) / scale;
                            return power == 2 ? deviation * deviation : deviation * deviation * deviation;
                          }) /
           n;
  };
  return moment(3) / std::pow(moment(2), 1.5);
}

}  // namespace dispersa
