#include "core/optimization/variation.h"

#include <algorithm>
#include <utility>

#include "core/math/functions.h"

namespace dispersa {

namespace {

// The spread factor for a uniform draw u, given the share of the distribution that a bound at a distance of
// `gap` beyond the nearer parent leaves, for parents that are `distance` apart.
double SpreadFactor(double u, double gap, double distance, double eta) {
  const double alpha = 2.0 - Pow(1.0 + 2.0 * gap / distance, -(eta + 1.0));
  const double argument = u * alpha <= 1.0 ? u * alpha : 1.0 / (2.0 - u * alpha);
  return Pow(argument, 1.0 / (eta + 1.0));
}

}  // namespace

void CrossOver(double* a, double* b, double lower, double upper, double eta, Stream* stream) {
  const double u = stream->Uniform();
  const bool exchange = stream->Uniform() < 0.5;  // neither child belongs to one of the parents
  const auto [low, high] = std::minmax({*a, *b});
  if (low == high) return;
  const double middle = 0.5 * (low + high);
  const double half = 0.5 * (high - low);
  const double below = middle - half * SpreadFactor(u, low - lower, high - low, eta);
  const double above = middle + half * SpreadFactor(u, upper - high, high - low, eta);
  *a = Clamp(below, lower, upper);
  *b = Clamp(above, lower, upper);
  if (exchange) std::swap(*a, *b);
}

double Mutated(double x, double lower, double upper, double eta, Stream* stream) {
  const double u = stream->Uniform();
  const double range = upper - lower;
  if (range == 0.0) return x;
  double change = 0.0;
  if (u < 0.5) {
    const double cut = Pow(1.0 - (x - lower) / range, eta + 1.0);
    change = Pow(2.0 * u + (1.0 - 2.0 * u) * cut, 1.0 / (eta + 1.0)) - 1.0;
  } else {
    const double cut = Pow(1.0 - (upper - x) / range, eta + 1.0);
    change = 1.0 - Pow(2.0 * (1.0 - u) + (2.0 * u - 1.0) * cut, 1.0 / (eta + 1.0));
  }
  return Clamp(x + change * range, lower, upper);
}

}  // namespace dispersa
