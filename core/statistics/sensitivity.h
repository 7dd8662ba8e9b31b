// The influence of inputs on an output, from the flown cases. No further flight and no fitted model is
// needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/statistics/intervals.h"

namespace dispersa {

/// Values that are sorted once and compared with many others.
class Ranked {
 public:
  Ranked(const std::vector<double>& values);

  std::size_t size() const { return ranks_.size(); }
  /// Positions by rising value, equal values in the order given.
  const std::vector<std::uint32_t>& order() const { return order_; }
  /// From 1; equal values share their mean rank.
  const std::vector<double>& ranks() const { return ranks_; }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<double> ranks_;
};

/// An index with its interval of 95 %, from the standard error over bootstrap samples.
struct SensitivityIndex {
  double index = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// First-order Sobol index of y with respect to x, from given data. It is the share of y's variance that the
/// mean of y within equally filled classes of x explains. The share that chance explains is subtracted (E.
/// Plischke, "How to compute variance-based sensitivity indicators with your spreadsheet software", Environ.
/// Model. Softw. 35 (2012) 188; the correction is that of the analysis of variance, Kelley's epsilon
/// squared). It sees any dependence on x alone, signed, symmetric or circular. Equal x stay in one class. 0
/// without variance of x or of y. Values are finite; x and y have the same length. The samples' bits depend
/// on `seed` alone.
SensitivityIndex FirstOrderIndex(const Ranked& x, const std::vector<double>& y, std::uint64_t seed = 1);

/// The index alone, without a lower limit: it may be negative after the correction for chance.
double FirstOrderShare(const Ranked& x, const std::vector<double>& y);

/// The part of y that x alone does not explain: y minus its mean within the same classes of x.
std::vector<double> RestOf(const Ranked& x, const std::vector<double>& y);

/// Pearson's correlation of the ranks; 0 where either has no variance.
double RankCorrelation(const Ranked& x, const Ranked& y);

/// Partial rank correlation of each x with y, the other ones held: one value an x, 0 where it is not defined
/// (S. Marino et al., J. Theor. Biol. 254 (2008) 178-196).
std::vector<double> PartialRankCorrelations(const std::vector<const Ranked*>& x, const Ranked& y);

/// Two-sided p-value of the hypothesis that x is equally large among the marked cases and the others. It is
/// the rank sum of Wilcoxon, Mann and Whitney in its normal approximation with ties. 1 if either side is
/// empty.
double RankSumP(const Ranked& x, const std::vector<bool>& marked);

/// Adjusted p-values: among those up to q, the share of false discoveries is at most q (Y. Benjamini and Y.
/// Hochberg, J. R. Statist. Soc. B 57 (1995) 289-300); in the order given.
std::vector<double> FalseDiscoveryRates(const std::vector<double>& p_values);

}  // namespace dispersa
