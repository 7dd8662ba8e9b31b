// Which inputs a case has: the campaign's sampling method and dispersions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/random/latin_hypercube.h"
#include "core/random/sobol.h"

namespace dispersa {

/// Number of runs of a corner, one-at-a-time, grid or list design before it repeats; 1 for random designs.
/// With fewer cases the design is incomplete.
std::uint64_t DesignSize(const Campaign& campaign);

/// Draws cases. Every dispersion has its own random stream, keyed by (seed, case, name), so one more changes
/// no other. Latin hypercube and Sobol designs place all cases together and replace the streams' uniform
/// numbers. Their columns also belong to the dispersion's name. Replicates are designs one after the other,
/// each with its own permutations, shifts and draws. In the designs of DesignSize some factors move by plan
/// (two_point: corners and one at a time; values: grid and list). Every other dispersion stays random.
class CaseDesign {
 public:
  explicit CaseDesign(const Campaign& campaign);

  /// Pure: the inputs do not depend on earlier draws.
  FlightInputs Draw(std::uint64_t case_index) const;

 private:
  double Uniform(std::uint64_t case_index, std::size_t dispersion) const;
  /// `deviates`: the standard normals of a case as far as they are drawn, else NaN.
  double Normal(std::uint64_t case_index, std::size_t dispersion, std::vector<double>& deviates) const;
  double Value(std::uint64_t case_index, std::size_t dispersion, std::vector<double>& deviates) const;

  Sampling sampling_;
  std::vector<Dispersion> dispersions_;
  std::vector<DerivedInput> derived_;
  std::vector<std::size_t> factors_;  ///< dispersions that move by plan
  std::uint64_t size_ = 1;
  std::vector<std::array<double, 2>> truncation_;  ///< uniform numbers of a truncated normal's limits
  std::uint64_t replicate_size_ = 0;               ///< cases of one design
  std::vector<LatinHypercube> latin_hypercubes_;   ///< one a replicate
  std::vector<Sobol> sobols_;
};

}  // namespace dispersa
