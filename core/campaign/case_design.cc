#include "core/campaign/case_design.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/random/draws.h"
#include "core/random/normal.h"

namespace dispersa {

namespace {

bool MovesByPlan(SamplingMethod method, Distribution kind) {
  switch (method) {
    case SamplingMethod::kCorners:
    case SamplingMethod::kOneAtATime:
      return kind == Distribution::kTwoPoint;
    case SamplingMethod::kGrid:
    case SamplingMethod::kList:
      return kind == Distribution::kValues;
    default:
      return false;
  }
}

std::vector<std::size_t> Factors(const Campaign& campaign) {
  std::vector<std::size_t> factors;
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i)
    if (MovesByPlan(campaign.sampling.method, campaign.dispersions[i].distribution.kind))
      factors.push_back(i);
  return factors;
}

bool IsFactor(int column) {
  constexpr std::string_view kMark = "_factor";
  return InputColumns()[static_cast<std::size_t>(column)].name.find(kMark) != std::string::npos;
}

// The element of a list that a uniform number in (0, 1) selects.
double Select(const std::vector<double>& values, double uniform) {
  const auto index = static_cast<std::size_t>(uniform * static_cast<double>(values.size()));
  return values[std::min(index, values.size() - 1)];
}

}  // namespace

std::uint64_t DesignSize(const Campaign& campaign) {
  const std::vector<std::size_t> factors = Factors(campaign);
  std::uint64_t size = 1;
  switch (campaign.sampling.method) {
    case SamplingMethod::kCorners:
      return std::uint64_t{1} << factors.size();
    case SamplingMethod::kOneAtATime:
      return std::max<std::uint64_t>(1, 2 * factors.size());
    case SamplingMethod::kGrid:
      for (const std::size_t f : factors) size *= campaign.dispersions[f].distribution.values.size();
      return size;
    case SamplingMethod::kList:
      return factors.empty() ? 1 : campaign.dispersions[factors[0]].distribution.values.size();
    default:
      return 1;
  }
}

CaseDesign::CaseDesign(const Campaign& campaign)
    : sampling_(campaign.sampling),
      dispersions_(campaign.dispersions),
      factors_(Factors(campaign)),
      size_(DesignSize(campaign)) {
  std::vector<std::string> names;
  for (const Dispersion& d : dispersions_) names.push_back(d.name);
  if (names.empty()) return;
  if (sampling_.method == SamplingMethod::kLatinHypercube)
    latin_hypercube_ = std::make_unique<LatinHypercube>(sampling_.seed, sampling_.cases, names);
  if (sampling_.method == SamplingMethod::kSobol)
    sobol_ = std::make_unique<Sobol>(sampling_.seed, names);
}

double CaseDesign::Uniform(std::uint64_t case_index, std::size_t dispersion) const {
  if (latin_hypercube_) return latin_hypercube_->Uniform(case_index, dispersion);
  if (sobol_) return sobol_->Uniform(case_index, dispersion);
  return Stream(sampling_.seed, case_index, dispersions_[dispersion].name).Uniform();
}

double CaseDesign::Value(std::uint64_t case_index, std::size_t dispersion) const {
  const ScalarDistribution& d = dispersions_[dispersion].distribution;
  const auto factor = std::find(factors_.begin(), factors_.end(), dispersion);
  if (factor != factors_.end()) {
    const std::uint64_t run = case_index % size_;
    const auto position = static_cast<std::uint64_t>(factor - factors_.begin());
    switch (sampling_.method) {
      case SamplingMethod::kCorners:
        return (run >> position) & 1 ? d.high : d.low;
      case SamplingMethod::kOneAtATime:
        if (run / 2 != position) return d.nominal;
        return run % 2 ? d.high : d.low;
      case SamplingMethod::kGrid: {
        // The first axis varies slowest.
        std::uint64_t faster = 1;
        for (std::size_t later = position + 1; later < factors_.size(); ++later)
          faster *= dispersions_[factors_[later]].distribution.values.size();
        return d.values[run / faster % d.values.size()];
      }
      default:
        return d.values[run];
    }
  }
  switch (d.kind) {
    case Distribution::kNormal:
      return d.nominal + d.sigma * InverseNormal(Uniform(case_index, dispersion));
    case Distribution::kUniform:
      return d.low + (d.high - d.low) * Uniform(case_index, dispersion);
    case Distribution::kTwoPoint:
      return Uniform(case_index, dispersion) < 0.5 ? d.low : d.high;
    case Distribution::kValues:
      return Select(d.values, Uniform(case_index, dispersion));
    case Distribution::kConstant:
      break;
  }
  return d.values.front();
}

FlightInputs CaseDesign::Draw(std::uint64_t case_index) const {
  FlightInputs inputs;
  for (std::size_t i = 0; i < dispersions_.size(); ++i) {
    double value = Value(case_index, i);
    if (dispersions_[i].absolute) value = std::fabs(value);
    for (const int column : dispersions_[i].inputs) {
      double& input = InputValue(inputs, column);
      input = IsFactor(column) ? input * value : value;
    }
  }
  return inputs;
}

}  // namespace dispersa
