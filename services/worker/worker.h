// Flies the cases that the coordinator assigns: a flight desk with a clock, a network and threads that fly.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/program/mutex.h"
#include "services/transport/worker_link.h"
#include "services/worker/flight_desk.h"

namespace dispersa {

struct WorkerOptions {
  NetworkOptions network;
  std::vector<Peer> peers;  ///< where a coordinator may be; the youngest is followed
  std::string uuid;
  std::uint32_t slots = 1;                 ///< threads that fly
  std::optional<double> idle_exit_s = {};  ///< without a case for so long: leave
  std::optional<double> patience_s = {};   ///< without a coordinator for so long: give up
};

enum class WorkerExit { kTold, kRefused, kDrained, kIdle, kNoCoordinator, kFault };

/// One incarnation of a worker. Cases fly on their own threads; the thread of Run only communicates. A flight
/// cannot be interrupted. So a worker that ends early leaves flying threads behind, and the process must end
/// without destroying anything (std::_Exit).
class Worker {
 public:
  explicit Worker(const WorkerOptions& options);

  /// Until it is told to leave, refused, drained, idle or alone for too long. The connection is closed when
  /// it returns.
  WorkerExit Run();
  /// Why it ended early or was refused; else empty.
  const std::string& problem() const { return problem_; }
  /// Finish the flights under way, begin no more, then leave. From any thread, but not from a signal handler.
  void Drain();

 private:
  // For a flying thread: takes the next case (waits for one, or returns none if there is none now), and
  // returns its result. The coordinator knows of a case before Next returns it.
  std::optional<Job> Next(bool wait);
  void Done(const Job& job, CaseResult result);
  void Quarantined(const Job& job, const std::string& reason);
  class SlotQueue;
  void FlyForEver();
  /// The campaign is refused with the fault, its case is nobody's fault, and the worker leaves.
  void Break(const std::string& flight_id, const std::string& fault);

  void Connect();
  void Load(const CampaignText& text);
  void Send(const FlightDesk::Due& due);
  std::optional<WorkerExit> Exit(double now_s);
  WorkerExit Leave(WorkerExit exit);
  double Now() const;
  /// Where a coordinator may be, in words.
  std::string Where() const;

  WorkerOptions options_;
  std::string problem_;
  std::chrono::steady_clock::time_point origin_ = std::chrono::steady_clock::now();
  double heard_s_ = 0.0, busy_s_ = 0.0, told_s_ = 0.0, draining_s_ = 0.0,
         busy_since_drain_s_ = 0.0;  ///< the last time it was busy, used by the thread of Run

  Mutex mutex_;
  std::condition_variable work_;
  FlightDesk desk_ DISPERSA_GUARDED_BY(mutex_);
  bool closed_ DISPERSA_GUARDED_BY(mutex_) = false;
  std::string fault_ DISPERSA_GUARDED_BY(mutex_);
  /// None while the network cannot be used. Changed by the thread of Run under the lock.
  std::shared_ptr<WorkerLink> link_;
};

}  // namespace dispersa
