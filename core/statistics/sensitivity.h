// What drives an output, from the cases that were flown anyway: nothing is flown for it, and no model is
// fitted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/statistics/intervals.h"

namespace dispersa {

/// Values sorted once, to be held against many others.
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

/// First-order Sobol index of y with respect to x, from given data: the share of y's variance that the mean
/// of y within equally filled classes of x explains, corrected for what chance explains (E. Plischke, "How to
/// compute variance-based sensitivity indicators with your spreadsheet software", Environ. Model. Softw. 35
/// (2012) 188; the correction is that of the analysis of variance, Kelley's epsilon squared). It sees any
/// dependence on x alone, signed, symmetric or circular. Equal x stay in one class. 0 without variance of x
/// or of y. Values are finite, as many of each. The samples' bits depend on `seed` alone.
SensitivityIndex FirstOrderIndex(const Ranked& x, const std::vector<double>& y, std::uint64_t seed = 1);

/// The index alone, unlimited below: what chance explains may come out negative.
double FirstOrderShare(const Ranked& x, const std::vector<double>& y);

/// y less its mean within the same classes of x: what x alone does not explain.
std::vector<double> RestOf(const Ranked& x, const std::vector<double>& y);

/// Pearson's correlation of the ranks; 0 where either has no variance.
double RankCorrelation(const Ranked& x, const Ranked& y);

/// Partial rank correlation of each x with y, the other ones held: one value an x, 0 where it is not defined
/// (S. Marino et al., J. Theor. Biol. 254 (2008) 178-196).
std::vector<double> PartialRankCorrelations(const std::vector<const Ranked*>& x, const Ranked& y);

/// Two-sided p-value that x is as large among the marked cases as among the others: Wilcoxon, Mann and
/// Whitney's rank sum in its normal approximation with ties. 1 when either side is empty.
double RankSumP(const Ranked& x, const std::vector<bool>& marked);

/// p-values adjusted so that those up to q are false discoveries in a share of at most q (Y. Benjamini and
/// Y. Hochberg, J. R. Statist. Soc. B 57 (1995) 289-300); in the order given.
std::vector<double> FalseDiscoveryRates(const std::vector<double>& p_values);

}  // namespace dispersa
