// Serves one campaign to the workers of a network.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/coordinator/campaign_book.h"
#include "services/transport/coordinator_link.h"

namespace dispersa {

/// Turns messages into events of the ledger and its assignments into messages. One thread.
class Coordinator {
 public:
  /// Throws NetworkError. The book must outlive it.
  Coordinator(const NetworkOptions& network, CampaignBook& book);

  /// One round: waits for messages, at most `timeout`, and does what follows from them and from the time.
  /// Throws ResultError.
  void Step(std::chrono::milliseconds timeout);

  /// Announces that the end of this worker will be told by WorkerEnded: a local process has an exit status,
  /// which says more than a silent heartbeat.
  void Supervise(const std::string& worker);
  /// A supervised worker ended. Takes effect a moment later, when its last messages have arrived.
  void WorkerEnded(const std::string& worker, WorkerEnd end, const std::string& reason);
  /// Supervised workers that hang or do not beat: to be killed.
  std::vector<std::string> TakeUnresponsive();

  /// Every worker is told to leave, and waited for until the message is there.
  void Dismiss();

  std::size_t joined() const { return joined_.size(); }
  /// Why a worker was refused or refused the campaign, most recently.
  const std::optional<std::string>& refusal() const { return refusal_; }

 private:
  void On(const WorkerStatus& status);
  void On(const Report& report);
  void On(const CampaignRefusal& refusal);
  void On(const WorkerSilent& silent);
  void On(const WorkerGone& gone);
  void Lose(const std::string& worker, WorkerEnd end, const std::string& reason);
  double Now() const;

  struct Ending {
    double due_s;
    std::string worker;
    WorkerEnd end;
    std::string reason;
  };

  std::uint64_t epoch_;
  std::chrono::steady_clock::time_point origin_ = std::chrono::steady_clock::now();
  CampaignBook& book_;
  CoordinatorLink link_;
  std::map<std::string, std::string> joined_;  ///< host, by worker
  std::set<std::string> supervised_;
  std::set<std::string> banned_;  ///< ended, or refused: whatever still arrives of them changes nothing
  std::set<std::string> unresponsive_;
  std::vector<Ending> endings_;
  std::optional<std::string> refusal_;
  double expired_s_ = 0.0;
};

}  // namespace dispersa
