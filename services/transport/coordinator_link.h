// The coordinator's end of the network.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "services/transport/messages.h"
#include "services/transport/network.h"
#include "services/transport/pulse.h"

namespace dispersa {

/// A participant closed its connection, or was not heard of for 5 s.
struct SenderGone {};

/// A received message and its sender's participant, an identifier that the sender cannot choose.
struct CoordinatorEvent {
  std::string sender;
  std::variant<WorkerStatus, Report, TextRequest, CampaignRefusal, Request, SenderGone> what;
};

/// Opens a further participant when the last ones have few places left (doors.h).
///
/// Events are read by one thread, which also sends. Nothing that is sent is sure to arrive. Throws
/// NetworkError.
class CoordinatorLink {
 public:
  /// Listens at CoordinatorPort(network.domain), and for workers' statuses at StatusPort(network.domain).
  explicit CoordinatorLink(const NetworkOptions& network);
  ~CoordinatorLink();

  /// All events so far, in order. Waits at most `timeout` for the first one.
  std::vector<CoordinatorEvent> Wait(std::chrono::milliseconds timeout);

  /// Begins to ask itself. Its questions are answered in Wait.
  std::shared_ptr<const Pulse> StartPulse();

  /// To one worker, which need not be matched yet.
  void Send(const Orders& orders);
  void Send(const TextPart& part);
  /// To one client.
  void Send(const Reply& reply);
  /// Waits, at most so long, until the worker has the orders that were sent to it.
  void Drain(const std::string& worker, std::chrono::milliseconds timeout);
  /// Drops the state of the conversation with a worker or client.
  void Forget(const std::string& who);

  /// To all observers.
  void Publish(const CampaignProgress& progress);
  void Publish(const std::string& flight_id, const std::string& worker, const FlownCase& flown);
  /// Whether anybody listens to results.
  bool HasResultObservers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dispersa
