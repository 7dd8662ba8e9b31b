// What a scalar's distribution makes of a uniform number: the same function for draws, designs and searches.
#pragma once

#include <array>

#include "core/campaign/campaign.h"

namespace dispersa {

/// The probabilities below the limits of a truncated normal; 0 and 1 of any other law. Worth keeping.
std::array<double, 2> TruncationOf(const ScalarDistribution& distribution);

/// The value that a uniform number in (0, 1) draws. All but a Rayleigh's and a coin's grow with it;
/// `truncation` is TruncationOf the same distribution. The same bits on every machine.
double DrawnValue(const ScalarDistribution& distribution, const std::array<double, 2>& truncation,
                  double uniform);

}  // namespace dispersa
