// How fast results of a campaign come, and how long it takes until all are there.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "services/ledger/ledger.h"

namespace dispersa {

/// Over the last ten measurements.
class Pace {
 public:
  void Measure(double now_s, std::uint64_t done);
  /// New results. Results that are removed (an expelled worker's) are no negative ones: only rises count.
  /// 0 before the second measurement.
  double PerSecond() const;

 private:
  struct Measurement {
    double now_s;
    std::uint64_t done;
  };
  std::deque<Measurement> past_;
};

/// Seconds until the cases that wait and those in flight have results. None while no result comes.
std::optional<double> TimeLeft(const LedgerProgress& progress, double rate_per_s);

}  // namespace dispersa
