// Flies the results again that the audit selected.
#pragma once

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/cases/campaign_flights.h"
#include "services/ledger/audit.h"
#include "services/program/mutex.h"

namespace dispersa {

/// Flies on one thread of its own, so that the coordinator's message thread does not wait.
class Auditor {
 public:
  /// A claim and the fingerprint of the case as it was flown here.
  struct Verdict {
    std::string flight_id;
    Claim claim;
    Digest truth;
  };

  /// A rule of the program was broken in flights of this campaign: they end, without verdicts.
  struct Fault {
    std::string flight_id;
    std::string what;
  };

  Auditor();
  ~Auditor();

  void Fly(const Campaign& campaign, std::vector<Claim> claims);
  /// Verdicts since the last call.
  std::vector<Verdict> Take();
  std::vector<Fault> TakeFaults();

 private:
  class Queue;
  struct Work {
    std::shared_ptr<const Campaign> campaign;
    std::shared_ptr<const CampaignFlights> flights;  ///< made when the first claim is flown
    std::deque<Claim> claims;
    bool is_flown = false;  ///< now
  };

  void FlyForEver();
  /// Waits for claims; returns the flight id of their campaign, or nothing at the end.
  std::string Await();
  std::shared_ptr<const CampaignFlights> FlightsOf(const std::string& flight_id);

  Mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Work> work_ DISPERSA_GUARDED_BY(mutex_);  ///< by flight id
  std::vector<Verdict> verdicts_ DISPERSA_GUARDED_BY(mutex_);
  std::vector<Fault> faults_ DISPERSA_GUARDED_BY(mutex_);
  bool closed_ DISPERSA_GUARDED_BY(mutex_) = false;
  std::jthread thread_;
};

}  // namespace dispersa
