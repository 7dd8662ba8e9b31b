#include "core/search/dispersion_space.h"

#include <algorithm>
#include <cmath>

#include "core/campaign/case_design.h"
#include "core/campaign/drawn_value.h"
#include "core/math/constants.h"
#include "core/statistics/normal.h"

namespace dispersa {
namespace {

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

/// The distribution's value at the standard normal deviate z. The formulas use z itself if the probability
/// would lose digits in the tails.
double ValueAt(const ScalarDistribution& d, const std::array<double, 2>& truncation, double z) {
  switch (d.kind) {
    case Distribution::kNormal:
      return d.nominal + d.sigma * z;
    case Distribution::kLogNormal:
      return d.nominal * std::exp(d.sigma * z);
    case Distribution::kRayleigh:  // as likely to be exceeded as |z|
      return DrawnValue(d, truncation, 2.0 * NormalProbability(-std::fabs(z)));
    case Distribution::kTruncatedNormal:
    case Distribution::kTriangular:
    case Distribution::kEmpirical:
    case Distribution::kUniform:
      return DrawnValue(d, truncation, NormalProbability(z));
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
  for (const Dispersion& dispersion : dispersions_) {
    coordinates_.push_back({dispersion.name, KindOf(dispersion.distribution)});
    truncation_.push_back(TruncationOf(dispersion.distribution));
  }
  list_.sampling.method = SamplingMethod::kList;
  list_.derived = campaign.derived;
}

double DispersionSpace::Value(std::size_t coordinate, const std::vector<double>& point) const {
  const Dispersion& dispersion = dispersions_[coordinate];
  double z = point[coordinate];
  if (!dispersion.mix.empty()) {
    z = 0.0;
    for (const auto& [other, weight] : dispersion.mix) z += weight * point[other];
  }
  const double value = ValueAt(dispersion.distribution, truncation_[coordinate], z);
  return dispersion.absolute ? std::fabs(value) : value;
}

std::vector<FlightInputs> DispersionSpace::Inputs(const std::vector<std::vector<double>>& points) const {
  // A campaign whose design is a list of these points: the campaign's own code then computes the inputs.
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
