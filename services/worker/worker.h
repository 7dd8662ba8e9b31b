// Flies what the coordinator assigns, until it is told to leave.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/campaign/campaign_flights.h"
#include "services/transport/worker_link.h"

namespace dispersa {

struct WorkerOptions {
  NetworkOptions network;
  Peer peer;
  std::string uuid;
  std::uint32_t slots = 1;  ///< cases at the same time, each on a thread
};

enum class WorkerExit { kTold, kRefused, kStopped };

/// One incarnation of a worker. Cases are flown on threads of their own; the thread of Run only talks. A
/// flight cannot be interrupted, so a worker that is stopped leaves flying threads behind: the process has to
/// end without destroying anything (std::_Exit).
class Worker {
 public:
  explicit Worker(const WorkerOptions& options);

  /// Until it is told to leave, refused or stopped. The connection is closed when it returns.
  WorkerExit Run();
  /// From any thread; not from a signal handler.
  void Stop();

 private:
  /// Flight id and coordinator's epoch: a coordinator that was started again opens the same flight anew, and
  /// its orders may arrive before that opening does.
  using CampaignKey = std::pair<std::string, std::uint64_t>;
  struct LoadedCampaign {
    LoadedCampaign(std::uint64_t epoch, const Campaign& campaign)
        : coordinator_epoch(epoch), flight_id(campaign.flight_id), flights(campaign) {}

    std::uint64_t coordinator_epoch;
    std::string flight_id;
    CampaignFlights flights;
  };
  struct Job {
    std::shared_ptr<const LoadedCampaign> campaign;
    std::uint64_t case_index;
    std::uint64_t attempt;
  };

  void Load(const CampaignDefinition& definition);
  void Close(const CampaignClosed& closed);
  void Enqueue(const FlyOrder& order);
  void FlyForEver();
  void SendStatus(std::optional<WorkerState> state = {});
  WorkerExit Leave(WorkerExit exit);

  WorkerOptions options_;
  std::unique_ptr<WorkerLink> link_;
  std::map<CampaignKey, std::shared_ptr<const LoadedCampaign>> campaigns_;
  std::deque<CampaignKey> closed_;  ///< of campaigns_, oldest first; the last few are kept, see Close
  std::vector<FlyOrder> early_orders_;  ///< whose campaign has not arrived yet

  std::mutex mutex_;  ///< of all below; also taken for sending from a flying thread
  std::condition_variable work_;
  std::deque<Job> jobs_;
  std::multiset<std::uint64_t> flying_;
  std::uint64_t flown_ = 0;
  bool stopping_ = false;
};

}  // namespace dispersa
