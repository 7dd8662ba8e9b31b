// Flights with a plug-in as control law. They are flown by processes of dispersa-foreign, so that nothing in
// the plug-in ends this process or reads its memory.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/cases/flight_orders.h"
#include "core/containment/foreign_process.h"

namespace dispersa {

/// The processes that fly one campaign, and know no other. Thread-safe: there are as many as there were
/// threads that ordered at the same time. They stay for the next object of the same campaign, until one of
/// another is made: to read a campaign takes as long as dozens of its flights.
class ForeignFlights {
 public:
  /// `canonical_yaml`: Campaign::canonical_yaml, of the flights `here`, which this object does not outlive.
  ForeignFlights(const std::string& canonical_yaml, const FlightsHere& here);

  /// Flies an order. Throws PluginError, ContainedEnd, NoChild, Interrupted, and the exceptions of `hear`.
  void Fly(const std::string& order, const std::function<void(FlownOnce flown)>& hear,
           const StopCheck& should_stop = nullptr) const;
  /// The queue's cases, some at a time. Cases that were not flown before a process ended are flown again,
  /// each alone. A case that ends this process too is quarantined.
  void FlyCases(CaseQueue& queue) const;

 private:
  struct BrokenOff;
  struct Pool;
  std::optional<BrokenOff> FlyTogether(std::vector<std::uint64_t>& cases, CaseQueue& queue) const;

  const std::shared_ptr<Pool> pool_;
  const FlightsHere& here_;
};

}  // namespace dispersa
