// execution.json: who ran a campaign, when, in which processes. It has only facts that differ between runs.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "services/ledger/ledger.h"

namespace dispersa {

/// One incarnation of a worker of this run.
struct WorkerProcess {
  std::string uuid;
  pid_t pid = 0;
  std::string started_utc;
  std::optional<std::string> ended_utc;
  WorkerEnd end = WorkerEnd::kLeft;  ///< once ended
  std::string how;                   ///< "exit code 1", "signal 9 (Killed)"
};

/// Writes execution.json of the newest run in a result folder. Each Write replaces the file as a whole; it
/// throws ResultError.
struct ExecutionFile {
  std::filesystem::path directory;
  std::string started_utc;
  std::string vehicle_file;   ///< empty: inlined
  std::optional<int> domain;  ///< none: flown in process
  int workers_wanted = 0;
  std::uint64_t cases_before = 0;  ///< stored by earlier runs
  std::uint64_t cases_flown = 0;
  double flying_s = 0.0;  ///< wall clock
  std::vector<WorkerProcess> workers;
  std::optional<std::string> ended_utc;
  std::optional<std::string> problem;  ///< why it is incomplete

  void Write() const;
};

}  // namespace dispersa
