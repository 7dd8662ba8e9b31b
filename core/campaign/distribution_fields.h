// One scalar's distribution in a campaign's `dispersions`.
#pragma once

#include <span>

#include "core/campaign/campaign.h"
#include "core/input/fields.h"

namespace dispersa {

/// A dispersed quantity around 0 in one of its units, or a factor around 1. A factor's deviations are in
/// percent. Its values are in percent (a deviation) or a factor.
struct DispersedScalar {
  Dimension dimension;  ///< empty: a factor
  Range range;          ///< of every value that can be drawn (a normal draw: out to 6 sigma)
  std::span<const Distribution> kinds = {};  ///< that it may have (empty: all, but a factor is no magnitude)
  bool IsFactor() const { return dimension.empty(); }
  double Nominal() const { return IsFactor() ? 1.0 : 0.0; }
};

/// Factors that multiply a physical quantity, which must stay positive.
inline constexpr DispersedScalar kPositiveFactor{{}, kPositive};

/// `distribution` and its parameters. The map may hold further keys. A bare "percent: 20" is refused: the
/// meaning of "±" is always stated.
void DescribeDistribution(Fields& fields, const DispersedScalar& scalar, ScalarDistribution& distribution);

/// A direction in the full circle: "uniform", {fixed_deg: x} or a distribution.
void DescribeDirection(Fields& fields, const char* key, ScalarDistribution& direction, const char* meaning);

/// "stem_unit: x" or "stem: {distribution: ...}". Returns false if neither is there; if it is `needed`, that
/// is an error.
bool DescribeFixedOrDrawn(Fields& fields, const char* stem, const DispersedScalar& scalar, bool needed,
                          ScalarDistribution& distribution, const char* meaning);

/// The same value in every case.
ScalarDistribution Constant(double value);
ScalarDistribution Uniform(double low, double high);

}  // namespace dispersa
