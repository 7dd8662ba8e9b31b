// Two samples held against each other: counts, quantiles, and many tests at once. Pairs may depend on each
// other as they like within a pair; different pairs, and cases of samples that are not paired, are
// independent.
#pragma once

#include <cstdint>
#include <vector>

#include "core/statistics/intervals.h"
#include "core/statistics/summary.h"

namespace dispersa {

/// Exact two-sided p-value that of two yes-no answers to the same cases neither is likelier, from the cases
/// in which only one says yes (Q. McNemar, Psychometrika 12 (1947) 153-157, with the binomial distribution in
/// place of chi squared). 1 when they always agree.
double McNemarP(std::int64_t only_a, std::int64_t only_b);

/// Exact two-sided p-value that two independent samples of n_a and n_b cases have the same probability of an
/// event seen so often: the tables that are no likelier than this one, their margins given (R. A. Fisher, J.
/// R. Statist. Soc. 98 (1935) 39-82). 1 when either sample is empty.
double FisherP(std::int64_t events_a, std::int64_t n_a, std::int64_t events_b, std::int64_t n_b);

/// p-values adjusted so that rejecting all up to a risk errs at all with at most that risk, however the tests
/// depend on each other (S. Holm, Scand. J. Statist. 6 (1979) 65-70); in the order given. Undefined values
/// are no tests.
std::vector<double> HolmAdjusted(const std::vector<double>& p_values);

/// Limits of b - a from the limits of each, by the method of variance estimates recovery (G. Y. Zou and A.
/// Donner, Statist. Med. 27 (2008) 1693-1702, equation 5; with a correlation G. Y. Zou, Psychol. Methods 12
/// (2007) 399-413). Its coverage is that of the limits it is given as the samples grow; README.md states it
/// as simulated. Infinite where either limit that it needs is.
Interval DifferenceLimits(double a, const Interval& limits_a, double b, const Interval& limits_b,
                          double correlation);

/// The same quantile of two samples.
struct QuantileDifference {
  double a =
      kUndefined;  ///< estimates; undefined where fewer than one value lies beyond them, or lost flights do
  double b = kUndefined;
  double difference = kUndefined;  ///< b - a
  Interval interval{kUndefined, kUndefined};
  /// That as many lie beyond the pooled quantile in both: exact when pairs, or cases, are exchangeable
  /// between the samples (A. M. Mood's median test, at any quantile: McNemarP or FisherP).
  double p = kUndefined;
};

/// From one value a case; infinities are cases that are worse, or better, than any value. When `paired`, a[i]
/// and b[i] belong together. Limits of each sample are order statistics of any distribution;
/// DifferenceLimits() joins them, paired with the correlation of lying beyond the quantile.
QuantileDifference CompareQuantiles(const std::vector<double>& a, const std::vector<double>& b,
                                    double probability, double confidence, bool paired);

/// Two-sided p-value that neither sample's values tend to be larger: Wilcoxon's rank sum (RankSumP).
double LocationP(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace dispersa
