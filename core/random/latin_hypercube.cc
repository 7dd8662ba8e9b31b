#include "core/random/latin_hypercube.h"

#include <bit>
#include <numeric>
#include <utility>

#include "core/math/assertion.h"
#include "core/random/draws.h"

namespace dispersa {
namespace {

/// Uniform integer below `bound`, without bias: multiply and reject (D. Lemire, "Fast random integer
/// generation in an interval", ACM Trans. Model. Comput. Simul. 29 (2019)), on 32 bits.
std::uint32_t Below(Stream& stream, std::uint32_t bound) {
  const std::uint32_t rejected = -bound % bound;  // 2^32 mod bound
  std::uint64_t product;
  do {
    product = (stream.Bits() >> 32) * bound;
  } while (static_cast<std::uint32_t>(product) < rejected);
  return static_cast<std::uint32_t>(product >> 32);
}

/// A uniformly random permutation (Fisher and Yates; Knuth, TAOCP 2, algorithm 3.4.2P).
std::vector<std::uint32_t> Permutation(Stream stream, std::uint32_t size) {
  std::vector<std::uint32_t> permutation(size);
  std::iota(permutation.begin(), permutation.end(), 0u);
  for (std::uint32_t left = size; left > 1; --left) {
    std::swap(permutation[left - 1], permutation[Below(stream, left)]);
  }
  return permutation;
}

}  // namespace

LatinHypercube::LatinHypercube(std::uint64_t seed, std::uint64_t cases,
                               const std::vector<std::string>& dimension_names)
    : seed_(seed), cases_(cases) {
  DISPERSA_ASSERT(cases >= 1 && cases < std::uint64_t{1} << 32, cases);
  dimensions_.reserve(dimension_names.size());
  for (const std::string& name : dimension_names) {
    dimensions_.push_back(
        {name, Permutation(Stream(seed, 0, name + "/permutation"), static_cast<std::uint32_t>(cases))});
  }
}

double LatinHypercube::Uniform(std::uint64_t index, std::size_t dimension) const {
  // In whole cells, N 2^k < 2^52 of them, so that rounding leaves neither the stratum nor (0, 1).
  const Dimension& of = dimensions_.at(dimension);
  const auto cell_bits = 52 - std::bit_width(cases_);
  const std::uint64_t cell = Stream(seed_, index, of.name).Bits() >> (64 - cell_bits);
  const std::uint64_t position = std::uint64_t{of.stratum_of_case.at(index)} << cell_bits | cell;
  return (static_cast<double>(position) + 0.5) / static_cast<double>(cases_ << cell_bits);
}

}  // namespace dispersa
