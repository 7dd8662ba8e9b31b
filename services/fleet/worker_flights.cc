#include "services/fleet/worker_flights.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "services/coordinator/coordinator.h"
#include "services/fleet/local_workers.h"
#include "services/log/log.h"
#include "services/transport/private_domain.h"
#include "services/transport/run_pass.h"

namespace dispersa {
namespace {

constexpr char kLoopback[] = "127.0.0.1";
// Replaced workers in a row without a case flown or quarantined.
constexpr int kFruitlessEndsAllowed = 10;
constexpr double kJoinPatience_s = 60.0;
constexpr double kLeavePatience_s = 0.3;

class WorkerFlights {
 public:
  WorkerFlights(CampaignBook& book, ExecutionFile& execution, Observer& observer)
      : book_(book), execution_(execution), observer_(observer) {}

  std::optional<std::string> Fly(const std::filesystem::path& program, int count) {
    if (access(program.c_str(), X_OK) != 0) {
      return fmt::format("{}: no worker can be started: {}", program.string(), std::strerror(errno));
    }
    const PrivateDomain domain;
    execution_.domain = domain.domain();
    // Every user of this machine can join the domain: only who has the secret is listened to, on both sides.
    RunPass pass{DrawSecret(), {}};
    if (const auto& law = book_.campaign().autopilot.plugin; law && !law->in_python)
      pass.plugins.insert(law->sha256);
    NetworkOptions network{domain.domain(), kLoopback};
    network.secret = pass.secret;
    Coordinator coordinator(network, book_);
    LocalWorkers workers(program,
                         {"--domain", std::to_string(domain.domain()), "--address", kLoopback, "--peer",
                          fmt::format("{}:{}", kLoopback, CoordinatorPort(domain.domain()))},
                         count, ToText(pass));
    std::optional<std::string> reason;
    while (!book_.refusal() && !book_.Complete() && !reason) {
      if (observer_.ShouldStop()) {
        workers.End(0.0);
        Note(workers);
        throw Interrupted();
      }
      Supervise(coordinator, workers);
      coordinator.Step(std::chrono::milliseconds(50));
      for (const std::string& uuid : coordinator.TakeUnresponsive()) {
        LogWarning("worker {} does not answer: it is killed", uuid);
        workers.Kill(uuid);
      }
      ShowFlying(book_, observer_,
                 fmt::format("{} worker{}", workers.alive(), workers.alive() == 1 ? "" : "s"));
      workers.NoteJoined(coordinator.joined(), Now());
      reason = ReasonToEnd(coordinator, workers);
    }
    book_.Flush();
    coordinator.Dismiss();
    workers.End(reason ? 0.0 : kLeavePatience_s);
    Note(workers);
    return reason;
  }

 private:
  double Now() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  void Supervise(Coordinator& coordinator, LocalWorkers& workers) {
    const std::uint64_t settled = book_.flown_now() + book_.ledger().Progress().quarantined;
    const LocalWorkers::Changes changes = workers.Poll(Now(), settled);
    for (const WorkerProcess& ended : changes.ended) {
      LogWarning("worker {} (process {}) ended with {}; another takes its place", ended.uuid, ended.pid,
                 ended.how);
      coordinator.WorkerEnded(ended.uuid, ended.end, ended.how);
    }
    for (const WorkerProcess& started : changes.started) coordinator.Supervise(started.uuid);
    if (!changes.ended.empty() || !changes.started.empty()) Note(workers);
  }

  std::optional<std::string> ReasonToEnd(const Coordinator& coordinator, const LocalWorkers& workers) const {
    if (coordinator.joined() == 0 && coordinator.refusal()) {
      return "no worker may fly this campaign: " + *coordinator.refusal();
    }
    if (!book_.breakdown().empty()) return book_.breakdown();
    // Whoever takes their places would say the same.
    if (const auto refusal = coordinator.RefusalByAll(book_.campaign().result_id())) {
      return "no worker can fly this campaign: " + *refusal;
    }
    if (workers.fruitless_ends() > kFruitlessEndsAllowed) {
      return fmt::format("{} workers ended in a row without a result, the last one with {}",
                         workers.fruitless_ends(), LastEnd(workers));
    }
    if (const auto quarantined = book_.ledger().Progress().quarantined;
        quarantined >= kMaxQuarantinedWithoutResult && book_.flown_now() == 0) {
      return fmt::format("the first {} cases ended every worker that flew them, the last one with {}",
                         quarantined, LastEnd(workers));
    }
    if (workers.NobodyJoined_s(Now()) > kJoinPatience_s) {
      return fmt::format("no worker has joined for {:.0f} s", kJoinPatience_s);
    }
    return std::nullopt;
  }

  static std::string LastEnd(const LocalWorkers& workers) {
    std::string how;
    for (const WorkerProcess& worker : workers.history()) {
      if (worker.ended_utc) how = worker.how;
    }
    return how;
  }

  void Note(const LocalWorkers& workers) {
    execution_.workers = workers.history();
    execution_.Write();
  }

  CampaignBook& book_;
  ExecutionFile& execution_;
  Observer& observer_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

FlyWithWorkers WorkersOfProgram(const std::filesystem::path& program) {
  return [program](CampaignBook& book, ExecutionFile& execution, Observer& observer,
                   int workers) -> std::optional<std::string> {
    try {
      return WorkerFlights(book, execution, observer).Fly(program, workers);
    } catch (const NetworkError& error) {
      return error.what();
    }
  };
}

}  // namespace dispersa
