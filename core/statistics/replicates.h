// Confidence from independent replicates of a design whose own points are not independent.
#pragma once

#include <vector>

#include "core/statistics/intervals.h"

namespace dispersa {

/// Bounds of the mean of shares in [0, 1], one from each of two or more independent replicates; each is wrong
/// with about `risk`. Student's t over the replicates, limited to [0, 1]. Where all shares are 0 (or 1) and
/// show no spread, the exact bound of the probability that a replicate has any failure (success) at all takes
/// its place, which the mean cannot exceed. README.md states the coverage.
Interval ReplicateMeanBounds(const std::vector<double>& shares, double risk);

}  // namespace dispersa
