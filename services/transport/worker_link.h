// A worker's end of the network.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "services/transport/messages.h"
#include "services/transport/network.h"

namespace dispersa {

/// The coordinator has closed a campaign, or is gone: nothing more will come for it.
struct CampaignClosed {
  std::uint64_t coordinator_epoch = 0;  ///< of the definition; a newer one of the same campaign stays open
  std::string flight_id;
};

/// Not an order: something happened on this side, see WorkerLink::Wake.
struct Wakened {};

using WorkerEvent = std::variant<CampaignDefinition, CampaignClosed, FlyOrder, LeaveOrder, Refusal, Wakened>;

/// Sending is thread-safe. A thread of its own gives the heartbeat from construction to destruction.
/// Throws NetworkError.
class WorkerLink {
 public:
  /// `worker` is the UUID under which it appears; `peer` is the coordinator.
  WorkerLink(const NetworkOptions& network, const Peer& peer, const std::string& worker);
  ~WorkerLink();

  /// All events so far, in order; waits for the first one, at most `timeout`.
  std::vector<WorkerEvent> Wait(std::chrono::milliseconds timeout);
  /// Makes Wait return.
  void Wake();

  void Send(const WorkerStatus& status);
  void Send(const Report& report);
  void Send(const CampaignRefusal& refusal);
  /// Waits, at most so long, until the coordinator has what was sent.
  void Drain(std::chrono::milliseconds timeout);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dispersa
