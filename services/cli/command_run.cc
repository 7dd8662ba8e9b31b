// dispersa run: a campaign from the file to the report.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/campaign/campaign_flights.h"
#include "core/flight/engine_version.h"
#include "core/report/shell_word.h"
#include "services/cli/campaign_output.h"
#include "services/cli/command.h"
#include "services/cli/execution_file.h"
#include "services/cli/local_workers.h"
#include "services/cli/progress.h"
#include "services/coordinator/coordinator.h"
#include "services/coordinator/open_campaign.h"
#include "services/coordinator/stop_signal.h"
#include "services/coordinator/threads.h"
#include "services/coordinator/utc.h"
#include "services/coordinator/whole_number.h"
#include "services/transport/private_domain.h"

namespace dispersa {
namespace {

constexpr char kLoopback[] = "127.0.0.1";
// Replacements of workers that end again and again while no case gets done or given up.
constexpr int kFruitlessEndsAllowed = 10;
// So many cases given up and not one flown: it is not the cases.
constexpr std::uint64_t kHopelessCases = 20;
constexpr double kJoinPatience_s = 60.0;
constexpr double kLeavePatience_s = 0.3;

struct RunOptions {
  CampaignRequest request;
  int workers = -1;  ///< -1: the usable cores
  int threads = 0;   ///< without workers; 0: the usable cores
  ReflownFlights reflown;
};

struct Interrupted {};

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string ResumeCommand(const RunOptions& options, const std::filesystem::path& directory) {
  std::string command = "dispersa run " + ShellWord(options.request.campaign);
  const CampaignOverrides& overrides = options.request.overrides;
  if (overrides.cases) command += fmt::format(" --cases {}", *overrides.cases);
  if (overrides.seed) command += fmt::format(" --seed {}", *overrides.seed);
  if (overrides.autopilot) command += " --autopilot " + ShellWord(*overrides.autopilot);
  if (options.workers >= 0) command += fmt::format(" --workers {}", options.workers);
  if (options.threads > 0) command += fmt::format(" --threads {}", options.threads);
  return command + " --out " + ShellWord(directory.string()) + " --resume";
}

/// Flies what is missing. Returns why it gave up, if it did. Throws Interrupted.
class CampaignRun {
 public:
  CampaignRun(CampaignBook& book, ExecutionFile& execution, bool quiet)
      : book_(book), execution_(execution), progress_(book.campaign().name, quiet) {}

  std::optional<std::string> FlyHere(int threads) {
    const CampaignFlights flights(book_.campaign());
    HereQueue queue(*this, threads);
    {
      std::vector<std::jthread> others;  // joined at the end of this block
      for (int i = 1; i < threads; ++i) others.emplace_back([&] { queue.FlyOn(flights); });
      queue.FlyOn(flights);
    }
    queue.RethrowProblem();
    if (StopRequested()) throw Interrupted();
    return std::nullopt;
  }

  std::optional<std::string> FlyWithWorkers(int count) {
    const std::filesystem::path program =
        std::filesystem::read_symlink("/proc/self/exe").parent_path() / "dispersa-worker";
    if (access(program.c_str(), X_OK) != 0) {
      return fmt::format("{}: no worker can be started: {}", program.string(), std::strerror(errno));
    }
    const PrivateDomain domain;
    execution_.domain = domain.domain();
    Coordinator coordinator({domain.domain(), kLoopback}, book_);
    LocalWorkers workers(program,
                         {"--domain", std::to_string(domain.domain()), "--address", kLoopback, "--peer",
                          fmt::format("{}:{}", kLoopback, CoordinatorPort(domain.domain()))},
                         count);
    std::optional<std::string> problem;
    double joined_s = Now();
    while (!book_.Complete() && !problem) {
      if (StopRequested()) {
        workers.End(0.0);
        Note(workers);
        throw Interrupted();
      }
      Supervise(coordinator, workers);
      coordinator.Step(std::chrono::milliseconds(50));
      for (const std::string& uuid : coordinator.TakeUnresponsive()) {
        spdlog::warn("worker {} does not answer: it is killed", uuid);
        workers.Kill(uuid);
      }
      ShowProgress(fmt::format("{} worker{}", workers.alive(), workers.alive() == 1 ? "" : "s"));
      if (coordinator.joined() > 0) joined_s = Now();
      problem = Problem(coordinator, workers, Now() - joined_s);
    }
    book_.Flush();
    coordinator.Dismiss();
    workers.End(problem ? 0.0 : kLeavePatience_s);
    Note(workers);
    return problem;
  }

 private:
  /// The ledger's cases for threads of this process.
  class HereQueue : public CaseQueue {
   public:
    HereQueue(CampaignRun& run, int threads) : run_(run) {
      const auto slots = static_cast<std::uint32_t>(threads);
      run_.book_.ledger().Join(kSelf, {EngineVersion(), slots, kAssignmentsAhead * slots}, run_.Now());
    }

    /// Until the campaign is complete or the run is stopped.
    void FlyOn(const CampaignFlights& flights) {
      for (;;) {
        flights.FlyCases(*this);
        std::unique_lock lock(mutex_);
        if (StopRequested() || problem_) return;
        try {
          if (run_.book_.Complete()) return;  // else the plan may have asked for more
        } catch (...) {
          problem_ = std::current_exception();
          return;
        }
        changed_.wait_for(lock, std::chrono::milliseconds(50));
      }
    }
    std::optional<std::uint64_t> Next(bool) override {
      const std::lock_guard lock(mutex_);
      if (StopRequested() || problem_) return std::nullopt;
      try {
        if (waiting_.empty()) {
          for (const Assignment& assignment : run_.book_.ledger().Assign(run_.Now()))
            for (const std::uint64_t case_index : assignment.cases) waiting_.emplace_back(case_index, assignment.attempt);
        }
        if (waiting_.empty()) return std::nullopt;
        const auto [case_index, attempt] = waiting_.front();
        waiting_.pop_front();
        attempts_[case_index] = attempt;
        run_.book_.Start(kSelf, case_index, attempt, run_.Now());
        return case_index;
      } catch (...) {
        problem_ = std::current_exception();
        return std::nullopt;
      }
    }
    void Done(CaseResult result) override {
      const std::lock_guard lock(mutex_);
      if (problem_) return;
      try {
        run_.book_.Accept(kSelf, "", attempts_.extract(result.case_index).mapped(), result, run_.Now());
        run_.book_.FlushIfDue(run_.Now());
        run_.ShowProgress("in process");
      } catch (...) {
        problem_ = std::current_exception();
      }
      changed_.notify_all();
    }
    void GivenUp(std::uint64_t case_index, const std::string& reason) override {
      const std::lock_guard lock(mutex_);
      run_.book_.ledger().GiveUp(kSelf, case_index, attempts_.extract(case_index).mapped(), reason,
                                 run_.Now());
      changed_.notify_all();
    }
    void RethrowProblem() const {
      if (problem_) std::rethrow_exception(problem_);
    }

   private:
    static constexpr char kSelf[] = "in process";
    static constexpr std::uint32_t kAssignmentsAhead = 4;

    CampaignRun& run_;
    std::mutex mutex_;  ///< of all that follows, and of the book
    std::condition_variable changed_;
    std::deque<std::pair<std::uint64_t, std::uint64_t>> waiting_;  ///< case and attempt
    std::map<std::uint64_t, std::uint64_t> attempts_;              ///< of the cases in flight
    std::exception_ptr problem_;
  };

  double Now() const { return SecondsSince(start_); }

  void Supervise(Coordinator& coordinator, LocalWorkers& workers) {
    const std::uint64_t settled = book_.flown_now() + book_.ledger().Progress().quarantined;
    const LocalWorkers::Changes changes = workers.Poll(Now(), settled);
    for (const WorkerProcess& ended : changes.ended) {
      spdlog::warn("worker {} (process {}) ended with {}; another takes its place", ended.uuid, ended.pid,
                   ended.how);
      coordinator.WorkerEnded(ended.uuid, ended.end, ended.how);
    }
    for (const WorkerProcess& started : changes.started) coordinator.Supervise(started.uuid);
    if (!changes.ended.empty() || !changes.started.empty()) Note(workers);
  }

  std::optional<std::string> Problem(const Coordinator& coordinator, const LocalWorkers& workers,
                                     double nobody_joined_s) const {
    if (coordinator.joined() == 0 && coordinator.refusal()) {
      return "no worker may fly this campaign: " + *coordinator.refusal();
    }
    if (workers.fruitless_ends() > kFruitlessEndsAllowed) {
      return fmt::format("{} workers ended in a row without a result, the last one with {}",
                         workers.fruitless_ends(), LastEnd(workers));
    }
    if (const auto given_up = book_.ledger().Progress().quarantined;
        given_up >= kHopelessCases && book_.flown_now() == 0) {
      return fmt::format("the first {} cases ended every worker that flew them, the last one with {}",
                         given_up, LastEnd(workers));
    }
    if (nobody_joined_s > kJoinPatience_s) {
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
    progress_.Show(progress.done, progress.total, note);
  }

  CampaignBook& book_;
  ExecutionFile& execution_;
  Progress progress_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

ExitCode FlyAndReport(const RunOptions& options, const GlobalOptions& global, OpenedCampaign opened,
                      ExecutionFile& execution) {
  const std::filesystem::path directory = opened.folder.directory();
  const int workers = options.workers >= 0 ? options.workers : UsableCores();
  CampaignBook book(opened.campaign, std::move(opened.folder));
  execution.workers_wanted = workers;
  execution.cases_before = book.ledger().Progress().done;
  execution.Write();

  const auto start = std::chrono::steady_clock::now();
  const auto note_end = [&] {
    book.Flush();
    execution.cases_flown = book.flown_now();
    execution.flying_s = SecondsSince(start);
  };
  ExitCode code = kExitDone;
  if (!book.Complete()) {
    try {
      CampaignRun run(book, execution, global.quiet);
      execution.problem = workers == 0 ? run.FlyHere(ThreadsOrAll(options.threads))
                                       : run.FlyWithWorkers(workers);
    } catch (const NetworkError& error) {
      execution.problem = error.what();
    } catch (const Interrupted&) {
      note_end();
      throw;
    }
  }
  note_end();
  if (execution.problem) {
    spdlog::error("{}", *execution.problem);
    code = WorseOf(code, kExitIncomplete);
  }
  for (const BlamedCase& blamed : book.ledger().Quarantined()) {
    spdlog::warn("case {} is quarantined: {}", blamed.case_index, fmt::join(blamed.reasons, "; "));
  }
  const CampaignSummary summary =
      MakeReports(book.folder(), book.campaign(), workers, global.quiet, options.reflown, [] {
        if (StopRequested()) throw Interrupted();
      });
  execution.ended_utc = UtcNow();
  execution.Write();
  PrintSummary(summary, directory, global.json);
  return WorseOf(code, CampaignExitCode(summary.verdict, book.ledger().Progress().conflicts));
}

ExitCode Run(const RunOptions& options, const GlobalOptions& global) {
  CatchStopSignals();
  OpenedCampaign opened = OpenCampaign(options.request);
  const std::filesystem::path directory = opened.folder.directory();
  ExecutionFile execution;
  execution.directory = directory;
  execution.started_utc = UtcNow();
  try {
    return FlyAndReport(options, global, std::move(opened), execution);
  } catch (const Interrupted&) {
    execution.ended_utc = UtcNow();
    execution.problem = "interrupted";
    try {
      execution.Write();
    } catch (const ResultError& error) {
      spdlog::error("{}", error.what());
    }
    fmt::print(stderr, "interrupted; to go on: {}\n", ResumeCommand(options, directory));
    return kExitInterrupted;
  } catch (const ResultError& error) {
    if (error.kind() != ResultError::Kind::kDiskFull) throw;
    spdlog::error("{}", error.what());
    fmt::print(stderr, "to go on when there is space: {}\n", ResumeCommand(options, directory));
    return kExitIncomplete;
  }
}

}  // namespace

void AddRunCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command =
      app.add_subcommand("run", "fly a campaign on local workers and write its result folder");
  CampaignRequest& request = options->request;
  command->add_option("campaign", request.campaign, "campaign file")->required()->type_name(kFileType);
  command
      ->add_option("--workers", options->workers,
                   "worker processes; default: the usable cores; 0 flies in this process without DDS")
      ->check(CLI::Range(0, 1024));
  command
      ->add_option("--threads", options->threads,
                   "threads that fly in this process with --workers 0; default: the usable cores")
      ->check(CLI::Range(1, 1024));
  command->add_option("--out", request.out, "result folder; default: results/<name>-<first 8 of id>")
      ->type_name(kFolderType)
      ->check([](const std::string& text) { return text.empty() ? "must not be empty" : ""; });
  command->add_option("--cases", request.overrides.cases, "number of cases, instead of the file's")
      ->check(CaseCountProblem);
  command->add_option("--seed", request.overrides.seed, "seed, instead of the file's");
  command->add_option("--autopilot", request.overrides.autopilot, "autopilot file, instead of the campaign's")
      ->type_name(kFileType);
  AddReflownOptions(*command, options->reflown);
  command->add_flag("--resume", request.resume, "go on in a folder of the same flight id");
  command->footer(
      "Example: dispersa run campaigns/table3.yaml --cases 200 --out results/trial\n"
      "         dispersa run campaigns/table3.yaml --cases 500 --out results/trial --resume");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return Run(*options, global); };
  });
}

}  // namespace dispersa
