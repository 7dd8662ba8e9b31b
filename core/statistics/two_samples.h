// Comparison of two samples: counts, quantiles, and many tests at once. The two values of a pair may depend
// on each other in any way. Different pairs are independent. Without pairs, all cases are independent.
#pragma once

#include <cstdint>
#include <vector>

#include "core/statistics/intervals.h"
#include "core/statistics/summary.h"

namespace dispersa {

/// Exact two-sided p-value for "an event is equally likely in both of two answers to the same cases".
/// `only_a` and `only_b` count the cases with the event in one answer alone (Q. McNemar, Psychometrika 12
/// (1947) 153-157, with the binomial distribution instead of chi squared). 1 if both are 0.
double McNemarP(std::int64_t only_a, std::int64_t only_b);

/// Exact two-sided p-value for "an event has the same probability in two independent samples" of n_a and n_b
/// cases. It sums the tables with the same margins that are no likelier than this one (R. A. Fisher, J. R.
/// Statist. Soc. 98 (1935) 39-82). 1 if either sample is empty.
double FisherP(std::int64_t events_a, std::int64_t n_a, std::int64_t events_b, std::int64_t n_b);

/// Adjusted p-values, in the given order. Rejecting all tests up to a risk makes any error with at most that
/// risk, however the tests depend on each other (S. Holm, Scand. J. Statist. 6 (1979) 65-70). Undefined
/// values are not counted as tests.
std::vector<double> HolmAdjusted(const std::vector<double>& p_values);

/// Limits of b - a from the limits of a and of b, by the method of variance estimates recovery: G. Y. Zou and
/// A. Donner, Statist. Med. 27 (2008) 1693-1702, equation 5; with a correlation G. Y. Zou, Psychol. Methods
/// 12 (2007) 399-413. As the samples grow, the coverage approaches that of the given limits. README.md states
/// the simulated coverage. A limit is infinite if a limit that it needs is infinite.
Interval DifferenceLimits(double a, const Interval& limits_a, double b, const Interval& limits_b,
                          double correlation);

/// The same quantile of two samples, compared.
struct QuantileDifference {
  double a = kUndefined;  ///< estimate; undefined if fewer than one value lies beyond it, or if it falls
                          ///< among lost flights
  double b = kUndefined;
  double difference = kUndefined;  ///< b - a
  Interval interval{kUndefined, kUndefined};
  /// For "the same share lies beyond the pooled quantile in both". Exact if pairs, or cases, are exchangeable
  /// between the samples (A. M. Mood's median test at any quantile, by McNemarP or FisherP).
  double p = kUndefined;
};

/// One value for each case. An infinite value is a case that is worse, or better, than any value. If
/// `paired`, a[i] and b[i] belong together. The limits of each sample are order statistics, valid for any
/// distribution. DifferenceLimits() joins them; if paired, with the correlation of "beyond the quantile" in a
/// and in b.
QuantileDifference CompareQuantiles(const std::vector<double>& a, const std::vector<double>& b,
                                    double probability, double confidence, bool paired);

/// How much likelier a value of b is the larger one than the smaller one, of all pairs of a value each: from
/// -1 to 1 (N. Cliff, Psychol. Bull. 114 (1993) 494). The direction that LocationP() tests. Undefined if
/// either sample is empty.
double TendencyOf(const std::vector<double>& a, const std::vector<double>& b);

/// Two-sided p-value for "the values of neither sample tend to be larger": Wilcoxon's rank sum test
/// (RankSumP).
double LocationP(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace dispersa
