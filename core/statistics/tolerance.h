// Tolerance limits: bounds that cover a share of the population with a confidence.
#pragma once

#include <cstdint>

namespace dispersa {

/// Smallest number of independent cases whose `order`-th largest value exceeds the `coverage` quantile with
/// the given confidence, for any distribution (S. S. Wilks, Ann. Math. Statist. 12 (1941) 91-96).
std::int64_t WilksOneSided(double coverage, double confidence, std::int64_t order = 1);
/// The same for the range from the smallest to the largest value.
std::int64_t WilksTwoSided(double coverage, double confidence);

/// The k for which mean + k std of n >= 2 independent normal values exceeds the `coverage` quantile with the
/// given confidence, by the noncentral t distribution (G. J. Hahn and W. Q. Meeker, Statistical Intervals,
/// Wiley 1991, section 4.6.3). Only for values that are normal; requirements use order statistics.
double NormalToleranceFactor(std::int64_t n, double coverage, double confidence);

}  // namespace dispersa
