#include "core/optimization/variation.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/math/functions.h"

namespace dispersa {

namespace {

// Distance of a child from the middle, in half distances of the parents (1: on its parent), for a uniform
// draw u. A bound cuts the distribution at `limit` (at least 1).
double SpreadFactor(double u, double limit, double eta) {
  const double alpha = 2.0 - Pow(limit, -(eta + 1.0));
  const double argument = u * alpha <= 1.0 ? u * alpha : 1.0 / (2.0 - u * alpha);
  return Pow(argument, 1.0 / (eta + 1.0));
}

// Distance of the bound beyond `parent` from the middle, in half distances of the parents. +infinity: no
// bound.
double Limit(double parent, double middle, double lower, double upper) {
  if (parent == middle) return std::numeric_limits<double>::infinity();
  const double bound = parent > middle ? upper : lower;
  return std::max(1.0, (bound - middle) / (parent - middle));
}

}  // namespace

void CrossOver(double* a, double* b, double lower, double upper, double eta, Stream* stream) {
  const double u = stream->Uniform();
  const bool exchange = stream->Uniform() < 0.5;  // neither child belongs to one of the parents
  const double middle = 0.5 * (*a + *b);
  for (double* parent : {a, b}) {
    const double spread = SpreadFactor(u, Limit(*parent, middle, lower, upper), eta);
    *parent = Clamp(middle + spread * (*parent - middle), lower, upper);
  }
  if (exchange) std::swap(*a, *b);
}

void CrossOverOnLine(std::vector<double>* a, std::vector<double>* b, const std::vector<double>& lower,
                     const std::vector<double>& upper, double eta, Stream* stream) {
  const double u = stream->Uniform();
  std::vector<double> middle(a->size());
  for (std::size_t k = 0; k < middle.size(); ++k) middle[k] = 0.5 * ((*a)[k] + (*b)[k]);
  for (std::vector<double>* parent : {a, b}) {
    double limit = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < middle.size(); ++k) {
      limit = std::min(limit, Limit((*parent)[k], middle[k], lower[k], upper[k]));
    }
    const double spread = SpreadFactor(u, limit, eta);
    for (std::size_t k = 0; k < middle.size(); ++k) {
      (*parent)[k] = Clamp(middle[k] + spread * ((*parent)[k] - middle[k]), lower[k], upper[k]);
    }
  }
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
