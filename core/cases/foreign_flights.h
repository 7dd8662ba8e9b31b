// Flights with a plug-in as control law. They are flown by processes of dispersa-foreign, so that nothing in
// the plug-in ends this process or reads its memory.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/cases/flight_orders.h"
#include "core/containment/foreign_process.h"

namespace dispersa {

/// The processes that fly one campaign, and know no other. Thread-safe: there are as many as there were
/// threads that ordered at the same time.
class ForeignFlights {
 public:
  /// `canonical_yaml`: Campaign::canonical_yaml, of the flights `here`, which this object does not outlive.
  ForeignFlights(std::string canonical_yaml, const FlightsHere& here)
      : canonical_yaml_(std::move(canonical_yaml)), here_(here) {}

  /// Flies an order. Throws PluginError, ContainedEnd, NoChild, Interrupted, and the exceptions of `hear`.
  void Fly(const std::string& order, const std::function<void(FlownOnce flown)>& hear,
           const StopCheck& should_stop = nullptr) const;
  /// The queue's cases, some at a time. Cases that were not flown before a process ended are flown again,
  /// each alone. A case that ends this process too is quarantined.
  void FlyCases(CaseQueue& queue) const;

 private:
  struct BrokenOff;
  std::unique_ptr<ForeignProcess> Take() const;
  std::optional<BrokenOff> FlyTogether(std::vector<std::uint64_t>& cases, CaseQueue& queue) const;

  const std::string canonical_yaml_;
  const FlightsHere& here_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<ForeignProcess>> idle_;
};

}  // namespace dispersa
