#include "core/random/sobol.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include <boost/random/sobol.hpp>

#include "core/math/assertion.h"
#include "core/random/draws.h"

namespace dispersa {

static_assert(Sobol::kMaxDimensions == boost::random::default_sobol_table::max_dimension);

namespace {

std::vector<std::size_t> FirstDimensions(std::size_t count) {
  std::vector<std::size_t> dimensions(count);
  std::iota(dimensions.begin(), dimensions.end(), std::size_t{0});
  return dimensions;
}

}  // namespace

Sobol::Sobol(std::uint64_t seed, const std::vector<std::string>& dimension_names)
    : Sobol(seed, dimension_names, FirstDimensions(dimension_names.size())) {}

Sobol::Sobol(std::uint64_t seed, const std::vector<std::string>& dimension_names,
             const std::vector<std::size_t>& sequence_dimensions) {
  DISPERSA_ASSERT(!dimension_names.empty() && sequence_dimensions.size() == dimension_names.size(),
                  sequence_dimensions.size(), dimension_names.size());
  const std::size_t last = *std::max_element(sequence_dimensions.begin(), sequence_dimensions.end());
  DISPERSA_ASSERT(last < kMaxDimensions, last);
  dimensions_.resize(dimension_names.size());
  for (std::size_t i = 0; i < dimensions_.size(); ++i) {
    dimensions_[i].shift = Stream(seed, 0, dimension_names[i] + "/shift").Bits();
  }
  // The point whose Gray code is the single bit k is the direction of that bit: point 2^(k+1) - 1. Boost's
  // sequence leaves out point 0, so its position is one less.
  boost::random::sobol sequence(last + 1);
  std::vector<std::uint64_t> directions(last + 1);
  for (std::size_t bit = 0; bit < 32; ++bit) {
    sequence.seed((std::uint64_t{2} << bit) - 2);
    for (std::uint64_t& direction : directions) direction = sequence();
    for (std::size_t i = 0; i < dimensions_.size(); ++i)
      dimensions_[i].directions[bit] = directions[sequence_dimensions[i]];
  }
}

std::uint64_t Sobol::Digits(std::uint64_t index, std::size_t dimension) const {
  DISPERSA_ASSERT(index < kMaxCases, index);
  const auto& directions = dimensions_.at(dimension).directions;
  std::uint64_t digits = 0;
  for (std::uint64_t gray = index ^ (index >> 1); gray != 0; gray &= gray - 1) {
    digits ^= directions[static_cast<std::size_t>(std::countr_zero(gray))];
  }
  return digits;
}

double Sobol::Uniform(std::uint64_t index, std::size_t dimension) const {
  return OpenUnitInterval(Digits(index, dimension) ^ dimensions_.at(dimension).shift);
}

double Sobol::Unshifted(std::uint64_t index, std::size_t dimension) const {
  // The first 2^32 points have at most 32 digits: exact.
  return static_cast<double>(Digits(index, dimension)) * 0x1p-64;
}

}  // namespace dispersa
