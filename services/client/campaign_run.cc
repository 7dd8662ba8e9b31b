#include "services/client/campaign_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "core/cases/campaign_flights.h"
#include "core/flight/engine_version.h"
#include "services/client/execution_file.h"
#include "services/client/local_workers.h"
#include "services/coordinator/coordinator.h"
#include "services/ledger/campaign_attempt.h"
#include "services/ledger/campaign_book.h"
#include "services/log/log.h"
#include "services/program/threads.h"
#include "services/program/utc.h"
#include "services/transport/private_domain.h"
#include "services/transport/run_pass.h"

namespace dispersa {
namespace {

constexpr char kLoopback[] = "127.0.0.1";
// Replaced workers in a row without a case flown or quarantined.
constexpr int kFruitlessEndsAllowed = 10;
// So many quarantined cases and none flown: the cases are not the cause.
constexpr std::uint64_t kMaxQuarantinedWithoutResult = 20;
constexpr double kJoinPatience_s = 60.0;
constexpr double kLeavePatience_s = 0.3;

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Flies the missing cases. The Fly functions return why they ended early, if they did; they throw
/// Interrupted.
class CampaignRun {
 public:
  CampaignRun(CampaignBook& book, ExecutionFile& execution, Observer& observer)
      : book_(book), execution_(execution), observer_(observer) {}

  std::optional<std::string> FlyHere(int threads) {
    const CampaignFlights flights(book_.campaign());
    HereQueue queue(*this, threads);
    {
      std::vector<std::jthread> others;  // joined at the end of this block
      for (int i = 1; i < threads; ++i) others.emplace_back([&] { queue.FlyOn(flights); });
      queue.FlyOn(flights);
    }
    queue.RethrowError();
    if (observer_.ShouldStop()) throw Interrupted();
    return queue.end_reason();
  }

  std::optional<std::string> FlyWithWorkers(const std::filesystem::path& program, int count) {
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
      ShowProgress(fmt::format("{} worker{}", workers.alive(), workers.alive() == 1 ? "" : "s"));
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
  /// The ledger's cases for threads of this process.
  class HereQueue : public CaseQueue {
   public:
    HereQueue(CampaignRun& run, int threads) : run_(run) {
      const auto slots = static_cast<std::uint32_t>(threads);
      run_.book_.ledger().Join(kInProcess, {EngineVersion(), slots, kAssignmentsAhead * slots}, run_.Now());
    }

    /// Until the campaign is complete or the run is stopped.
    void FlyOn(const CampaignFlights& flights) {
      for (;;) {
        try {
          flights.FlyCases(*this);
        } catch (...) {
          const std::lock_guard lock(mutex_);
          if (!error_) error_ = std::current_exception();
        }
        std::unique_lock lock(mutex_);
        if (run_.observer_.ShouldStop() || error_ || end_reason_) return;
        try {
          if (run_.book_.refusal() || run_.book_.Complete()) return;  // else the plan may have asked for more
        } catch (...) {
          error_ = std::current_exception();
          return;
        }
        changed_.wait_for(lock, std::chrono::milliseconds(50));
      }
    }
    std::optional<std::uint64_t> Next(bool) override {
      const std::lock_guard lock(mutex_);
      if (run_.observer_.ShouldStop() || error_ || end_reason_ || run_.book_.refusal()) return std::nullopt;
      try {
        if (waiting_.empty()) {
          for (const Assignment& assignment : run_.book_.ledger().Assign(run_.Now()))
            for (const std::uint64_t case_index : assignment.cases)
              waiting_.emplace_back(case_index, assignment.attempt);
        }
        if (waiting_.empty()) return std::nullopt;
        const auto [case_index, attempt] = waiting_.front();
        waiting_.pop_front();
        attempts_[case_index] = attempt;
        run_.book_.Start(kInProcess, case_index, attempt, run_.Now());
        return case_index;
      } catch (...) {
        error_ = std::current_exception();
        return std::nullopt;
      }
    }
    void Done(CaseResult result) override {
      const std::lock_guard lock(mutex_);
      if (error_) return;
      try {
        run_.book_.Accept(kInProcess, "", attempts_.extract(result.case_index).mapped(), result, run_.Now());
        run_.book_.FlushIfDue(run_.Now());
        run_.ShowProgress(kInProcess);
      } catch (...) {
        error_ = std::current_exception();
      }
      changed_.notify_all();
    }
    void Quarantined(std::uint64_t case_index, const std::string& reason) override {
      const std::lock_guard lock(mutex_);
      if (error_) return;
      run_.book_.Quarantine(kInProcess, case_index, attempts_.extract(case_index).mapped(), reason,
                            run_.Now());
      if (const auto quarantined = run_.book_.ledger().Progress().quarantined;
          quarantined >= kMaxQuarantinedWithoutResult && run_.book_.flown_now() == 0)
        end_reason_ = fmt::format("the first {} cases ended every process that flew them, the last one: {}",
                                  quarantined, reason);
      changed_.notify_all();
    }
    const std::optional<std::string>& end_reason() const { return end_reason_; }
    void RethrowError() const {
      if (error_) std::rethrow_exception(error_);
    }

   private:
    static constexpr std::uint32_t kAssignmentsAhead = 4;

    CampaignRun& run_;
    std::mutex mutex_;  ///< of all that follows, and of the book
    std::condition_variable changed_;
    std::deque<std::pair<std::uint64_t, std::uint64_t>> waiting_;  ///< case and attempt
    std::map<std::uint64_t, std::uint64_t> attempts_;              ///< of the cases in flight
    std::optional<std::string> end_reason_;
    std::exception_ptr error_;
  };

  double Now() const { return SecondsSince(start_); }

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

  void ShowProgress(const std::string& who) {
    const LedgerProgress progress = book_.ledger().Progress();
    std::string note = who;
    if (progress.quarantined > 0) note += fmt::format(", {} quarantined", progress.quarantined);
    observer_.Show(book_.campaign().name, progress.done, progress.total, note);
  }

  CampaignBook& book_;
  ExecutionFile& execution_;
  Observer& observer_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The reports of what was flown, and the exit code.
RunResult Conclude(const ResultFolder& folder, const Campaign& campaign, const LedgerProgress& progress,
                   int threads, const RunOptions& options, ExecutionFile& execution, Observer& observer) {
  ExitCode code = execution.problem ? kExitIncomplete : kExitDone;
  execution.Write();  // the report shows when and how long
  RunResult result;
  result.problem = execution.problem;
  result.flown = progress.done;
  result.cases = progress.total;
  if (folder.ItsShare()) {
    if (progress.done < progress.total) code = kExitIncomplete;
  } else {
    result.summary = MakeReports(folder, campaign, threads, options.reflown, observer);
    code =
        WorseOf(code, CampaignExitCode(result.summary->standing.verdict, progress.conflicts, options.gate));
  }
  result.code = code;
  execution.ended_utc = UtcNow();
  execution.Write();
  if (!result.summary) return result;
  WriteStanding(folder, *result.summary);
  NoteEndedIn(ResultRoot(folder.directory()), folder, campaign, *result.summary);
  return result;
}

ExecutionFile BeginIn(const PreparedRun& prepared) {
  ExecutionFile execution;
  execution.directory = prepared.folder.directory();
  execution.started_utc = UtcNow();
  execution.vehicle_file = prepared.campaign.vehicle_file;
  return execution;
}

RunResult FlyAndReport(const RunOptions& options, PreparedRun prepared, ExecutionFile& execution,
                       Observer& observer) {
  const int workers = options.workers >= 0 ? options.workers : UsableCores();
  CampaignBook book(prepared.campaign, std::move(prepared.folder));
  book.Expect(std::move(prepared.flown));
  execution.workers_wanted = workers;
  execution.cases_before = book.ledger().Progress().done;
  execution.Write();

  const auto start = std::chrono::steady_clock::now();
  const auto note_end = [&] {
    book.Flush();
    execution.cases_flown = book.flown_now();
    execution.flying_s = SecondsSince(start);
  };
  if (!book.refusal() && !book.Complete()) {
    try {
      CampaignRun run(book, execution, observer);
      execution.problem = workers == 0 ? run.FlyHere(ThreadsOrAll(options.threads))
                                       : run.FlyWithWorkers(options.worker_program, workers);
    } catch (const NetworkError& error) {
      execution.problem = error.what();
    } catch (const Interrupted&) {
      note_end();
      if (book.folder().ItsShare()) throw;
      book.KeepTally();
      NoteCancelledIn(ResultRoot(book.folder().directory()), book.folder().directory(), book);
      throw;
    }
  }
  observer.EndPhase();
  note_end();
  if (book.refusal()) {
    execution.problem = book.refusal();
    execution.ended_utc = UtcNow();
    execution.Write();
    throw InputError(*book.refusal());
  }
  if (execution.problem) LogError("{}", *execution.problem);
  for (const CaseBlames& blamed : book.ledger().Quarantined()) {
    LogWarning("case {} is quarantined: {}", blamed.case_index, fmt::join(blamed.reasons, "; "));
  }
  const int threads = workers == 0 ? ThreadsOrAll(options.threads) : workers;
  return Conclude(book.folder(), book.campaign(), book.ledger().Progress(), threads, options, execution,
                  observer);
}

}  // namespace

RunResult ReportFlown(const PreparedRun& prepared, const RunOptions& options, Observer& observer) {
  ExecutionFile execution = BeginIn(prepared);
  LedgerProgress progress;
  progress.total = progress.done = execution.cases_before = prepared.folder.CaseCount();
  return Conclude(prepared.folder, prepared.campaign, progress, ThreadsOrAll(options.threads), options,
                  execution, observer);
}

RunResult RunCampaign(PreparedRun prepared, const RunOptions& options, Observer& observer) {
  ExecutionFile execution = BeginIn(prepared);
  try {
    return FlyAndReport(options, std::move(prepared), execution, observer);
  } catch (const Interrupted&) {
    execution.ended_utc = UtcNow();
    execution.problem = "interrupted";
    try {
      execution.Write();
    } catch (const ResultError& error) {
      LogError("{}", error.what());
    }
    throw;
  }
}

}  // namespace dispersa
