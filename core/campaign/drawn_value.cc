#include "core/campaign/drawn_value.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/math/functions.h"
#include "core/random/normal.h"

namespace dispersa {
namespace {

// The element of a list that a uniform number in (0, 1) selects.
double Select(const ScalarDistribution& d, double uniform) {
  std::size_t index = 0;
  if (d.weights.empty()) {
    index = static_cast<std::size_t>(uniform * static_cast<double>(d.values.size()));
  } else {
    double total = 0.0;
    for (const double weight : d.weights) total += weight;
    double sum = d.weights[0];
    while (index + 1 < d.values.size() && uniform * total >= sum) sum += d.weights[++index];
  }
  return d.values[std::min(index, d.values.size() - 1)];
}

// The quantile of a sample, linear between its order statistics.
double SampleQuantile(const std::vector<double>& ascending, double uniform) {
  const double position = uniform * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  if (below + 1 >= ascending.size()) return ascending.back();
  const double share = position - static_cast<double>(below);
  return ascending[below] + share * (ascending[below + 1] - ascending[below]);
}

double Triangular(const ScalarDistribution& d, double uniform) {
  const double range = d.high - d.low;
  const double rising = (d.nominal - d.low) / range;  // probability below the mode
  return uniform < rising ? d.low + Sqrt(uniform * range * (d.nominal - d.low))
                          : d.high - Sqrt((1.0 - uniform) * range * (d.high - d.nominal));
}

// The probability below x, by bisection: the inverse is at hand, and has the same bits on every machine.
double NormalProbability(double x) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (InverseNormal(middle) < x ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::array<double, 2> TruncationOf(const ScalarDistribution& d) {
  if (d.kind != Distribution::kTruncatedNormal) return {0.0, 1.0};
  return {NormalProbability((d.low - d.nominal) / d.sigma),
          NormalProbability((d.high - d.nominal) / d.sigma)};
}

double DrawnValue(const ScalarDistribution& d, const std::array<double, 2>& truncation, double uniform) {
  switch (d.kind) {
    case Distribution::kNormal:
      return d.nominal + d.sigma * InverseNormal(uniform);
    case Distribution::kTruncatedNormal: {
      const auto& [from, to] = truncation;
      const double draw = InverseNormal(from + (to - from) * uniform);
      return Clamp(d.nominal + d.sigma * draw, d.low, d.high);  // of rounding alone
    }
    case Distribution::kLogNormal:
      return d.nominal * Exp(d.sigma * InverseNormal(uniform));
    case Distribution::kRayleigh:
      return d.sigma * Sqrt(-2.0 * Log(uniform));
    case Distribution::kTriangular:
      return Triangular(d, uniform);
    case Distribution::kEmpirical:
      return SampleQuantile(d.values, uniform);
    case Distribution::kUniform:
      return d.low + (d.high - d.low) * uniform;
    case Distribution::kTwoPoint:
      return uniform < 0.5 ? d.low : d.high;
    case Distribution::kValues:
      return Select(d, uniform);
    case Distribution::kConstant:
      break;
  }
  return d.values.front();
}

}  // namespace dispersa
