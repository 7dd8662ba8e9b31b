#include "core/search/dispersion_space.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/normal.hpp>

#include "core/campaign/case_design.h"
#include "core/math/constants.h"

namespace dispersa {
namespace {

double Probability(double z) { return boost::math::cdf(boost::math::normal(), z); }
double Quantile(double p) { return boost::math::quantile(boost::math::normal(), p); }

CoordinateKind KindOf(const ScalarDistribution& d) {
  switch (d.kind) {
    case Distribution::kConstant:
    case Distribution::kTwoPoint:
    case Distribution::kValues:
      return CoordinateKind::kHeld;
    case Distribution::kUniform:
      return std::fabs(d.high - d.low - kTwoPi) < 1e-9 ? CoordinateKind::kDirection : CoordinateKind::kNormal;
    default:
      return CoordinateKind::kNormal;
  }
}

/// A sample's value at a probability, linear between its order statistics.
double SampleValue(const std::vector<double>& sorted, double p) {
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), sorted.size() - 1);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double TriangularValue(const ScalarDistribution& d, double p) {
  const double width = d.high - d.low;
  const double left = (d.nominal - d.low) / width;
  return p < left ? d.low + std::sqrt(p * width * (d.nominal - d.low))
                  : d.high - std::sqrt((1.0 - p) * width * (d.high - d.nominal));
}

/// The law's value where a standard normal is z.
double ValueAt(const ScalarDistribution& d, double z) {
  switch (d.kind) {
    case Distribution::kNormal:
      return d.nominal + d.sigma * z;
    case Distribution::kTruncatedNormal: {
      const double from = Probability((d.low - d.nominal) / d.sigma);
      const double to = Probability((d.high - d.nominal) / d.sigma);
      return std::clamp(d.nominal + d.sigma * Quantile(from + (to - from) * Probability(z)), d.low, d.high);
    }
    case Distribution::kLogNormal:
      return d.nominal * std::exp(d.sigma * z);
    case Distribution::kRayleigh:  // as likely to be exceeded as |z|
      return d.sigma * std::sqrt(-2.0 * std::log(2.0 * Probability(-std::fabs(z))));
    case Distribution::kTriangular:
      return TriangularValue(d, Probability(z));
    case Distribution::kEmpirical:
      return SampleValue(d.values, Probability(z));
    case Distribution::kUniform:
      return d.low + (d.high - d.low) * Probability(z);
    case Distribution::kTwoPoint:
      return d.nominal;
    case Distribution::kValues:
      return d.values[d.values.size() / 2];
    case Distribution::kConstant:
      break;
  }
  return d.values.front();
}

}  // namespace

DispersionSpace::DispersionSpace(const Campaign& campaign) : dispersions_(campaign.dispersions) {
  for (const Dispersion& dispersion : dispersions_)
    coordinates_.push_back({dispersion.name, KindOf(dispersion.distribution)});
  list_.sampling.method = SamplingMethod::kList;
}

double DispersionSpace::Value(std::size_t coordinate, const std::vector<double>& point) const {
  const Dispersion& dispersion = dispersions_[coordinate];
  double z = point[coordinate];
  if (!dispersion.mix.empty()) {
    z = 0.0;
    for (const auto& [other, weight] : dispersion.mix) z += weight * point[other];
  }
  const double value = ValueAt(dispersion.distribution, z);
  return dispersion.absolute ? std::fabs(value) : value;
}

std::vector<FlightInputs> DispersionSpace::Inputs(const std::vector<std::vector<double>>& points) const {
  // A list of these points is a design that the campaign's own code draws.
  Campaign list = list_;
  list.sampling.cases = points.size();
  for (std::size_t i = 0; i < dispersions_.size(); ++i) {
    Dispersion listed = dispersions_[i];
    listed.distribution = {};
    listed.distribution.kind = Distribution::kValues;
    listed.mix.clear();
    for (const std::vector<double>& point : points) listed.distribution.values.push_back(Value(i, point));
    list.dispersions.push_back(std::move(listed));
  }
  const CaseDesign design(list);
  std::vector<FlightInputs> inputs;
  for (std::size_t i = 0; i < points.size(); ++i) inputs.push_back(design.Draw(i));
  return inputs;
}

}  // namespace dispersa
