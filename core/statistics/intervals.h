// Confidence intervals for probabilities and quantiles of independent cases.
#pragma once

#include <cstdint>
#include <vector>

namespace dispersa {

/// Lower and upper bound; infinite if the data give no bound.
struct Interval {
  double lower;
  double upper;
};

/// Exact confidence limits of the probability of an event seen `events` times in n > 0 cases (C. J. Clopper
/// and E. S. Pearson, Biometrika 26 (1934) 404-413), one-sided ...
double ClopperPearsonLower(std::int64_t events, std::int64_t n, double confidence);
double ClopperPearsonUpper(std::int64_t events, std::int64_t n, double confidence);
/// ... and two-sided with equal tails.
Interval ClopperPearson(std::int64_t events, std::int64_t n, double confidence);

/// Ranks (from 1) of the order statistics that enclose a quantile with at least the given confidence. Equal
/// tails, for any distribution. 0 and n + 1 if the sample is too small for a bound. (H. A. David and H. N.
/// Nagaraja, Order Statistics, 3rd ed., Wiley 2003, section 7.1.)
struct RankInterval {
  std::int64_t lower;
  std::int64_t upper;
};
RankInterval QuantileRanks(std::int64_t n, double probability, double confidence);

/// The quantile's interval itself, from values in increasing order.
Interval QuantileInterval(const std::vector<double>& sorted_values, double probability, double confidence);

}  // namespace dispersa
