// Confidence from independent replicates of a design whose own points are not independent.
#pragma once

#include <cstdint>
#include <vector>

#include "core/statistics/intervals.h"

namespace dispersa {

/// Bounds of a probability from two or more independent replicates of a design of `points` points each:
/// `counts` of its events, one a replicate; each bound is wrong with about `risk`. The wider of two:
/// Student's t over the shares of the replicates, which knows how their points depend, but too little of rare
/// events, that few replicates show; and Clopper and Pearson's of as many independent cases, than which a
/// Latin hypercube has at most points / (points - 1) times the variance (A. B. Owen, Ann. Statist. 25 (1997)
/// 1541-1562). Where all shares are 0 (or 1) and show no spread, the exact bound of the probability that a
/// replicate has any event (any other) takes the place of the first, which the share cannot exceed. README.md
/// states the coverage.
Interval ReplicateBounds(const std::vector<std::int64_t>& counts, std::int64_t points, double risk);

}  // namespace dispersa
