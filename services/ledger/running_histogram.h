// A histogram that grows while values arrive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace dispersa {

/// Counts of values between low + i * width and low + (i + 1) * width.
struct HistogramBins {
  double low = 0.0;
  double width = 0.0;
  std::vector<std::int64_t> counts;  ///< the first and the last are not 0
};

/// Takes bounded memory. The bin width is a power of two, and bins begin at its multiples. The width doubles
/// when the values no longer fit. So the same values give the same bins in any order.
class RunningHistogram {
 public:
  static constexpr std::size_t kMaxBins = 64;

  /// Finite.
  void Add(double value);
  std::int64_t n() const { return n_; }
  /// At most `most` bins, which is at least 2: values on either side of 0 stay apart. None if there is no
  /// value.
  HistogramBins Bins(std::size_t most = kMaxBins) const;

 private:
  void Coarsen();

  int exponent_ = -1000;  ///< of the width
  std::int64_t first_ = 0;
  std::vector<std::int64_t> counts_;
  std::int64_t n_ = 0;
};

}  // namespace dispersa
