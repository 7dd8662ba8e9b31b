// Latin hypercube design: a whole-design draw of N cases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dispersa {

/// N cases over D dimensions. Each dimension has exactly one case in each of N equal strata of (0, 1) (McKay,
/// Beckman and Conover, Technometrics 21 (1979) 239-245).
///
/// The permutation of a dimension depends on (seed, dimension name, N) alone. A new dimension changes no
/// other one, but every case changes with N. The cases are not independent: limits that assume independent
/// draws do not hold for them.
class LatinHypercube {
 public:
  /// `cases` is in [1, 2^32). Holds 4 N D bytes.
  LatinHypercube(std::uint64_t seed, std::uint64_t cases, const std::vector<std::string>& dimension_names);

  std::uint64_t cases() const { return cases_; }
  std::size_t dimensions() const { return dimensions_.size(); }

  /// Coordinate in (0, 1) of case `index` < cases() in `dimension` < dimensions(): uniform in its stratum.
  double Uniform(std::uint64_t index, std::size_t dimension) const;

 private:
  struct Dimension {
    std::string name;
    std::vector<std::uint32_t> stratum_of_case;
  };

  std::uint64_t seed_;
  std::uint64_t cases_;
  std::vector<Dimension> dimensions_;
};

}  // namespace dispersa
