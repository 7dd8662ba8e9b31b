// The value that a scalar's distribution gives for a uniform number: the same function for draws, designs and
// searches.
#pragma once

#include <array>

#include "core/campaign/campaign.h"

namespace dispersa {

/// The probabilities below the limits of a truncated normal; 0 and 1 for any other distribution. Compute them
/// once.
std::array<double, 2> TruncationOf(const ScalarDistribution& distribution);

/// The value that a uniform number in (0, 1) draws: the same bits on every machine. It grows with the number,
/// except for a Rayleigh distribution and a coin. `truncation` is TruncationOf the same distribution.
double DrawnValue(const ScalarDistribution& distribution, const std::array<double, 2>& truncation,
                  double uniform);

}  // namespace dispersa
