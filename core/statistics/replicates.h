// Confidence limits from independent replicates of a design whose points depend on each other.
#pragma once

#include <cstdint>
#include <vector>

#include "core/statistics/intervals.h"

namespace dispersa {

/// Bounds of a probability from two or more independent replicates of a design of `points` points each.
/// `counts` has the number of events of each replicate. Each bound is wrong with about `risk`.
///
/// Each bound is the wider of two. The first is Student's t over the shares of the replicates. It accounts
/// for the dependence of points, but is too narrow for rare events, which few replicates show. The second is
/// that of Clopper and Pearson for as many independent cases. A Latin hypercube has at most points / (points
/// - 1) times their variance (A. B. Owen, Ann. Statist. 25 (1997) 1541-1562).
///
/// If all shares are 0 (or 1), Student's t has no spread to use. The exact bound of the probability that a
/// replicate has any event (any non-event) then replaces it. The share cannot exceed that probability.
/// README.md states the coverage.
Interval ReplicateBounds(const std::vector<std::int64_t>& counts, std::int64_t points, double risk);

}  // namespace dispersa
