// Sobol design: a low-discrepancy sequence.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dispersa {

/// Sobol sequence in Gray-code order with the direction numbers of S. Joe and F. Y. Kuo (SIAM J. Sci. Comput.
/// 30 (2008) 2635-2654), as Boost.Random holds them, and with a digital shift. Each dimension's digits are
/// exclusive-or'ed with 52 random bits drawn from (seed, dimension name).
///
/// The shift makes each point uniform, so means are unbiased. It keeps the sequence's stratification: every
/// block of 2^k cases has one case in each of 2^k equal strata of a dimension. Nothing is skipped: case 0 is
/// the (shifted) origin (A. B. Owen, "On dropping the first Sobol' point", 2020). A coordinate depends on the
/// case's index, on its dimension's place in the sequence, and on its name. It depends neither on the number
/// of cases nor on other dimensions. The cases are not independent: limits that assume independent draws do
/// not hold for them.
class Sobol {
 public:
  static constexpr std::size_t kMaxDimensions = 3667;  ///< of the tables
  static constexpr std::uint64_t kMaxCases = std::uint64_t{1} << 32;

  /// 1 to kMaxDimensions dimensions, the first ones of the sequence.
  Sobol(std::uint64_t seed, const std::vector<std::string>& dimension_names);
  /// The same with these dimensions of the sequence, each below kMaxDimensions and once.
  Sobol(std::uint64_t seed, const std::vector<std::string>& dimension_names,
        const std::vector<std::size_t>& sequence_dimensions);

  std::size_t dimensions() const { return dimensions_.size(); }

  /// Coordinate in (0, 1) of case `index` < kMaxCases in `dimension` < dimensions().
  double Uniform(std::uint64_t index, std::size_t dimension) const;
  /// The same coordinate before the shift, in [0, 1).
  double Unshifted(std::uint64_t index, std::size_t dimension) const;

 private:
  struct Dimension {
    std::array<std::uint64_t, 32> directions;
    std::uint64_t shift;
  };

  std::uint64_t Digits(std::uint64_t index, std::size_t dimension) const;

  std::vector<Dimension> dimensions_;
};

}  // namespace dispersa
