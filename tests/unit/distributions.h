// Distributions by their parameters.
#pragma once

#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/flight/flight_inputs.h"

namespace dispersa::made_up {

inline ScalarDistribution Normal(double mean, double sigma) {
  return {.kind = Distribution::kNormal, .nominal = mean, .sigma = sigma, .values = {}};
}
inline ScalarDistribution TruncatedNormal(double mean, double sigma, double low, double high) {
  return {.kind = Distribution::kTruncatedNormal,
          .nominal = mean,
          .sigma = sigma,
          .low = low,
          .high = high,
          .values = {}};
}
inline ScalarDistribution LogNormal(double median, double sigma) {
  return {.kind = Distribution::kLogNormal, .nominal = median, .sigma = sigma, .values = {}};
}
inline ScalarDistribution Rayleigh(double sigma) {
  return {.kind = Distribution::kRayleigh, .sigma = sigma, .values = {}};
}
inline ScalarDistribution Triangular(double low, double mode, double high) {
  return {.kind = Distribution::kTriangular, .nominal = mode, .low = low, .high = high, .values = {}};
}
inline ScalarDistribution Uniform(double low, double high) {
  return {.kind = Distribution::kUniform, .low = low, .high = high, .values = {}};
}
inline ScalarDistribution TwoPoint(double nominal, double low, double high) {
  return {.kind = Distribution::kTwoPoint, .nominal = nominal, .low = low, .high = high, .values = {}};
}
inline ScalarDistribution Values(std::vector<double> values, std::vector<double> weights = {}) {
  return {.kind = Distribution::kValues, .values = std::move(values), .weights = std::move(weights)};
}
inline ScalarDistribution Empirical(std::vector<double> values) {
  return {.kind = Distribution::kEmpirical, .values = std::move(values)};
}

inline Dispersion Of(const std::string& name, ScalarDistribution distribution, const std::string& input,
                     bool absolute = false) {
  return {name, std::move(distribution), {FindInput(input)}, absolute};
}

}  // namespace dispersa::made_up
