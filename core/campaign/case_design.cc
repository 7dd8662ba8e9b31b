#include "core/campaign/case_design.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/campaign/drawn_value.h"
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

// The dimension of Sobol's sequence that belongs to each dispersion: that of the first input which it feeds.
// Of several that feed one input, the later names go on behind all inputs.
std::vector<std::size_t> SobolDimensions(const std::vector<Dispersion>& dispersions) {
  const std::size_t inputs = InputColumns().size();
  std::vector<std::size_t> dimensions;
  for (const Dispersion& dispersion : dispersions) {
    std::size_t rank = 0;
    for (const Dispersion& other : dispersions)
      rank += other.inputs.front() == dispersion.inputs.front() && other.name < dispersion.name ? 1 : 0;
    dimensions.push_back(static_cast<std::size_t>(dispersion.inputs.front()) + rank * inputs);
  }
  return dimensions;
}

// The first design keeps the plain seed, so that a campaign of one is what it was.
std::uint64_t ReplicateSeed(std::uint64_t seed, std::uint64_t replicate) {
  return replicate == 0 ? seed : Stream(seed, replicate, "replicate").Bits();
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
      derived_(campaign.derived),
      factors_(Factors(campaign)),
      size_(DesignSize(campaign)) {
  for (const Dispersion& dispersion : dispersions_)
    truncation_.push_back(TruncationOf(dispersion.distribution));
  std::vector<std::string> names;
  for (const Dispersion& d : dispersions_) names.push_back(d.name);
  replicate_size_ = sampling_.cases / sampling_.replicates;
  if (names.empty()) return;
  for (std::uint64_t replicate = 0; replicate < sampling_.replicates; ++replicate) {
    const std::uint64_t seed = ReplicateSeed(sampling_.seed, replicate);
    if (sampling_.method == SamplingMethod::kLatinHypercube)
      latin_hypercubes_.emplace_back(seed, replicate_size_, names);
    if (sampling_.method == SamplingMethod::kSobol)
      sobols_.emplace_back(seed, names, SobolDimensions(dispersions_));
  }
}

double CaseDesign::Uniform(std::uint64_t case_index, std::size_t dispersion) const {
  // One Sobol design goes on beyond the number of cases; several have a size.
  if (!latin_hypercubes_.empty())
    return latin_hypercubes_[case_index / replicate_size_].Uniform(case_index % replicate_size_, dispersion);
  if (sobols_.size() == 1) return sobols_[0].Uniform(case_index, dispersion);
  if (!sobols_.empty())
    return sobols_[case_index / replicate_size_].Uniform(case_index % replicate_size_, dispersion);
  return Stream(sampling_.seed, case_index, dispersions_[dispersion].name).Uniform();
}

double CaseDesign::Normal(std::uint64_t case_index, std::size_t dispersion,
                          std::vector<double>& deviates) const {
  const auto deviate = [&](std::size_t of) {
    if (std::isnan(deviates[of])) deviates[of] = InverseNormal(Uniform(case_index, of));
    return deviates[of];
  };
  const auto& mix = dispersions_[dispersion].mix;
  if (mix.empty()) return deviate(dispersion);
  double sum = 0.0;
  for (const auto& [other, weight] : mix) sum += weight * deviate(other);
  return sum;
}

double CaseDesign::Value(std::uint64_t case_index, std::size_t dispersion,
                         std::vector<double>& deviates) const {
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
    case Distribution::kConstant:
      return d.values.front();
    case Distribution::kNormal:
      return d.nominal + d.sigma * Normal(case_index, dispersion, deviates);
    default:
      return DrawnValue(d, truncation_[dispersion], Uniform(case_index, dispersion));
  }
}

FlightInputs CaseDesign::Draw(std::uint64_t case_index) const {
  FlightInputs inputs;
  std::vector<double> deviates(dispersions_.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < dispersions_.size(); ++i) {
    double value = Value(case_index, i, deviates);
    if (dispersions_[i].absolute) value = std::fabs(value);
    for (const int column : dispersions_[i].inputs) {
      double& input = InputValue(inputs, column);
      input = IsFactor(column) && !dispersions_[i].replaces ? input * value : value;
    }
  }
  TakeColumns(inputs);
  Derive(derived_, inputs);
  return inputs;
}

}  // namespace dispersa
