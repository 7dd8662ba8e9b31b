// The coordinator's end of the network.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "services/transport/messages.h"
#include "services/transport/network.h"

namespace dispersa {

/// The heartbeat of a worker stopped, without an explanation.
struct WorkerSilent {
  std::string worker;
};

/// A worker closed its connection, or its participant was not heard of for 5 s.
struct WorkerGone {
  std::string worker;
};

using CoordinatorEvent = std::variant<WorkerStatus, Report, CampaignRefusal, WorkerSilent, WorkerGone>;

/// Events are read by one thread, which also sends. Throws NetworkError.
class CoordinatorLink {
 public:
  /// Listens at CoordinatorPort(network.domain).
  explicit CoordinatorLink(const NetworkOptions& network);
  ~CoordinatorLink();

  /// All events so far, in order; waits for the first one, at most `timeout`.
  std::vector<CoordinatorEvent> Wait(std::chrono::milliseconds timeout);

  /// Tells all workers, those that come later too, until it is closed.
  void OpenCampaign(const CampaignDefinition& campaign);
  void CloseCampaign(const std::string& flight_id);

  /// To one worker, which need not be matched yet.
  void Send(const std::string& worker, const FlyOrder& order);
  void Send(const std::string& worker, const LeaveOrder& order);
  void Refuse(const Refusal& refusal);
  /// Waits, at most so long, until the worker has what was sent to it.
  void Drain(const std::string& worker, std::chrono::milliseconds timeout);
  /// Drops what was kept to talk to it.
  void Forget(const std::string& worker);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dispersa
