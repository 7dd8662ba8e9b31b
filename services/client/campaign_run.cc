#include "services/client/campaign_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <condition_variable>
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
#include "services/ledger/campaign_attempt.h"
#include "services/ledger/campaign_book.h"
#include "services/log/log.h"
#include "services/program/threads.h"
#include "services/program/utc.h"

namespace dispersa {
namespace {

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Flies the missing cases on threads of this process.
class FlyingHere {
 public:
  FlyingHere(CampaignBook& book, Observer& observer) : book_(book), observer_(observer) {}

  /// Why it ended early, if it did. Throws Interrupted.
  std::optional<std::string> Fly(int threads) {
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

 private:
  /// The ledger's cases for threads of this process.
  class HereQueue : public CaseQueue {
   public:
    HereQueue(FlyingHere& run, int threads) : run_(run) {
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
        ShowFlying(run_.book_, run_.observer_, kInProcess);
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

    FlyingHere& run_;
    std::mutex mutex_;  ///< of all that follows, and of the book
    std::condition_variable changed_;
    std::deque<std::pair<std::uint64_t, std::uint64_t>> waiting_;  ///< case and attempt
    std::map<std::uint64_t, std::uint64_t> attempts_;              ///< of the cases in flight
    std::optional<std::string> end_reason_;
    std::exception_ptr error_;
  };

  double Now() const { return SecondsSince(start_); }

  CampaignBook& book_;
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
  const int workers = WorkersOf(options);
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
      execution.problem = workers == 0 ? FlyingHere(book, observer).Fly(ThreadsOrAll(options.threads))
                                       : options.fly_with_workers(book, execution, observer, workers);
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

void ShowFlying(const CampaignBook& book, Observer& observer, const std::string& who) {
  const LedgerProgress progress = book.ledger().Progress();
  std::string note = who;
  if (progress.quarantined > 0) note += fmt::format(", {} quarantined", progress.quarantined);
  observer.Show(book.campaign().name, progress.done, progress.total, note);
}

int WorkersOf(const RunOptions& options) {
  if (!options.fly_with_workers && options.workers > 0)
    throw InputError(std::string("--workers: ") + kNoService, "--workers 0 and --threads N");
  if (options.workers >= 0) return options.workers;
  return options.fly_with_workers ? UsableCores() : 0;
}

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
