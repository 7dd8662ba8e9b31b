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

using WorkerEvent = std::variant<Orders, TextPart>;

/// Sending is thread-safe. Nothing that is sent is sure to arrive. Throws NetworkError.
class WorkerLink {
 public:
  /// `worker` is the UUID under which it appears. `peers`: where a coordinator may be. Their names are
  /// resolved now.
  WorkerLink(const NetworkOptions& network, const std::vector<Peer>& peers, const std::string& worker);
  ~WorkerLink();

  /// All events so far, in order. Waits at most `timeout` for the first one.
  std::vector<WorkerEvent> Wait(std::chrono::milliseconds timeout);

  void Send(const WorkerStatus& status);
  void Send(const Report& report);
  void Send(const TextRequest& request);
  void Send(const CampaignRefusal& refusal);
  /// Whether a coordinator has let this worker in since the last call. It may be heard soon.
  bool HasMet();
  /// Waits until the coordinator has the reports, refusals and statuses that were sent, at most so long for
  /// each kind.
  void Drain(std::chrono::milliseconds timeout);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dispersa
