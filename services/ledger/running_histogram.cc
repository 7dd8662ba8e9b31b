#include "services/ledger/running_histogram.h"

#include <algorithm>
#include <cmath>

#include "core/math/assertion.h"

namespace dispersa {
namespace {

/// Values that differ by less than this share of their size may share a bin. It keeps the bins' numbers
/// small.
constexpr int kFinest = 40;  // binary digits

}  // namespace

void RunningHistogram::Add(double value) {
  DISPERSA_ASSERT(std::isfinite(value), value);
  ++n_;
  if (value != 0.0) {
    while (exponent_ < std::ilogb(value) - kFinest) Coarsen();
  }
  const auto bin = [&] { return static_cast<std::int64_t>(std::floor(std::ldexp(value, -exponent_))); };
  if (counts_.empty()) {
    first_ = bin();
    counts_.push_back(0);
  }
  const auto span = [&] {
    return std::max(bin(), first_ + std::ssize(counts_) - 1) - std::min(bin(), first_) + 1;
  };
  while (span() > static_cast<std::int64_t>(kMaxBins)) Coarsen();
  if (bin() < first_) {
    counts_.insert(counts_.begin(), static_cast<std::size_t>(first_ - bin()), 0);
    first_ = bin();
  }
  const auto at = static_cast<std::size_t>(bin() - first_);
  if (at >= counts_.size()) counts_.resize(at + 1);
  ++counts_[at];
  DISPERSA_ASSERT(counts_.size() <= kMaxBins, counts_.size(), value);
}

HistogramBins RunningHistogram::Bins(std::size_t most) const {
  RunningHistogram coarse = *this;
  DISPERSA_ASSERT(most >= 2, most);
  while (coarse.counts_.size() > most) coarse.Coarsen();
  const double width = std::ldexp(1.0, coarse.exponent_);
  return {static_cast<double>(coarse.first_) * width, width, coarse.counts_};
}

// Bins become one with their neighbours: 2 i and 2 i + 1 are i.
void RunningHistogram::Coarsen() {
  ++exponent_;
  if (counts_.empty()) return;
  const std::int64_t first = first_ >> 1;
  std::vector<std::int64_t> counts(
      static_cast<std::size_t>(((first_ + std::ssize(counts_) - 1) >> 1) - first + 1));
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    counts[static_cast<std::size_t>(((first_ + static_cast<std::int64_t>(i)) >> 1) - first)] += counts_[i];
  }
  first_ = first;
  counts_ = std::move(counts);
}

}  // namespace dispersa
