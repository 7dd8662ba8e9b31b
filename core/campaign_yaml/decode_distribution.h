// One scalar's distribution in a campaign's `dispersions`.
#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/input/map_reader.h"

namespace dispersa {

/// What is dispersed: a quantity around 0 in one of its units, or a factor around 1, whose deviations are
/// percent and whose values are percent (a deviation) or factor.
struct DispersedScalar {
  Dimension dimension;  ///< empty: a factor
  Range range;          ///< of every value that can be drawn; of a normal draw out to 6 sigma
  bool IsFactor() const { return dimension.empty(); }
  double Nominal() const { return IsFactor() ? 1.0 : 0.0; }
};

/// Factors that multiply a physical quantity, which must stay positive.
inline constexpr DispersedScalar kPositiveFactor{{}, kPositive};

/// Reads `distribution` and its parameters; the caller's map may hold further keys. A bare "percent: 20" is a
/// problem: what "±" means is always explicit.
ScalarDistribution ReadDistribution(MapReader& map, const DispersedScalar& scalar);

/// A direction in the full circle: "uniform", {fixed_deg: x} or a distribution.
ScalarDistribution ReadDirection(const InputNode& node, const std::string& path,
                                 std::vector<InputProblem>& problems);

/// The same value in every case.
ScalarDistribution Constant(double value);
ScalarDistribution Uniform(double low, double high);

}  // namespace dispersa
