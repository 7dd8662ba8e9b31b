// The worker processes of `dispersa run`: its children, replaced when they end, gone when it is gone.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/client/execution_file.h"

namespace dispersa {

/// How a process that ended with this status (waitpid) counts in the rules of blame.
WorkerEnd ClassifyExit(int status, std::string* how);

/// Every worker dies with the thread that started it, even if that is killed. Not thread-safe.
class LocalWorkers {
 public:
  /// Each worker is `program arguments... --uuid <its own>`. A pass that is not empty goes to it through a
  /// pipe that no other process can read (`--run-pass DESCRIPTOR`). Starts nothing yet.
  LocalWorkers(std::filesystem::path program, std::vector<std::string> arguments, int count,
               std::string pass = "");
  /// Kills the remaining workers.
  ~LocalWorkers();
  LocalWorkers(const LocalWorkers&) = delete;
  LocalWorkers& operator=(const LocalWorkers&) = delete;

  struct Changes {
    std::vector<WorkerProcess> started;
    std::vector<WorkerProcess> ended;
  };
  /// Notes ended workers, and starts missing ones: at once, or later and later if they keep ending without
  /// `progress` (a number that grows). Times in seconds.
  Changes Poll(double now_s, std::uint64_t progress);
  /// Ends in a row without progress.
  int fruitless_ends() const { return fruitless_ends_; }

  /// `joined`: how many the coordinator has now.
  void NoteJoined(std::size_t joined, double now_s);
  /// Since the last time that one had joined, or since the first Poll().
  double NobodyJoined_s(double now_s) const { return now_s - joined_s_; }

  void Kill(const std::string& uuid);
  /// Waits at most `patience_s` for them to end by themselves, then sends SIGKILL.
  void End(double patience_s);

  int alive() const;
  /// All incarnations so far.
  const std::vector<WorkerProcess>& history() const { return history_; }

 private:
  void Start(std::size_t slot);
  std::vector<WorkerProcess> Reap();
  bool WaitAll(double seconds);
  void SignalAll(int signal);

  std::filesystem::path program_;
  std::vector<std::string> arguments_;
  std::string pass_;
  std::vector<std::optional<std::size_t>> slots_;  ///< position in history_ of the one that lives
  std::vector<WorkerProcess> history_;
  std::uint64_t progress_ = 0;
  int fruitless_ends_ = 0;
  double start_due_s_ = 0.0;
  double joined_s_ = 0.0;
};

}  // namespace dispersa
