#include "core/random/sobol.h"

#include <bit>
#include <cassert>

#include <boost/random/sobol.hpp>

#include "core/random/draws.h"

namespace dispersa {

static_assert(Sobol::kMaxDimensions == boost::random::default_sobol_table::max_dimension);

Sobol::Sobol(std::uint64_t seed, const std::vector<std::string>& dimension_names) {
  assert(!dimension_names.empty() && dimension_names.size() <= kMaxDimensions);
  dimensions_.resize(dimension_names.size());
  for (std::size_t i = 0; i < dimensions_.size(); ++i) {
    dimensions_[i].shift = Stream(seed, 0, dimension_names[i] + "/shift").Bits();
  }
  // The point whose Gray code is the single bit k is the direction of that bit: point 2^(k+1) - 1. Boost's
  // sequence leaves out point 0, so its position is one less.
  boost::random::sobol sequence(dimensions_.size());
  for (std::size_t bit = 0; bit < 32; ++bit) {
    sequence.seed((std::uint64_t{2} << bit) - 2);
    for (Dimension& dimension : dimensions_) dimension.directions[bit] = sequence();
  }
}

std::uint64_t Sobol::Digits(std::uint64_t index, std::size_t dimension) const {
  assert(index < kMaxCases);
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
