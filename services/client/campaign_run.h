// Flies a campaign on this machine, from the prepared run to its reports: the work of `dispersa run`.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/analysis/campaign_summary.h"
#include "services/client/campaign_reports.h"
#include "services/client/execution_file.h"
#include "services/client/observer.h"
#include "services/ledger/campaign_book.h"
#include "services/ledger/prepare_run.h"
#include "services/program/exit_code.h"

namespace dispersa {

/// What a program says of anything that it would need the service for.
inline constexpr char kNoService[] = "this build has no service (DISPERSA_SERVICE=OFF)";

/// So many quarantined cases and none flown: the cases are not the cause.
inline constexpr std::uint64_t kMaxQuarantinedWithoutResult = 20;

/// Flies the missing cases of a book in a number of processes. Returns why it ended early, if it did. Throws
/// Interrupted. The service has it (services/fleet/worker_flights.h).
using FlyWithWorkers = std::function<std::optional<std::string>(CampaignBook& book, ExecutionFile& execution,
                                                                Observer& observer, int workers)>;

struct RunOptions {
  int workers = -1;  ///< processes (-1: the usable cores, 0: none, but threads of this process)
  int threads = 0;   ///< without workers (0: the usable cores)
  FlyWithWorkers fly_with_workers = nullptr;  ///< none: a build without the service
  ReflownFlights reflown;
  bool gate = false;  ///< nothing passes of which nothing is judged
};

struct RunResult {
  std::optional<CampaignSummary> summary;  ///< none of a share: its campaign is judged when it is merged
  ExitCode code = kExitDone;               ///< of the verdict, or of what prevents one
  std::uint64_t flown = 0, cases = 0;      ///< results of the folder, and cases that it is for
  std::optional<std::string> problem;      ///< why cases are missing, if workers failed
};

/// The number of processes; 0 by default in a build without the service. Throws InputError if it has none.
int WorkersOf(const RunOptions& options);

/// Tells the observer how far a book is flown, and by whom.
void ShowFlying(const CampaignBook& book, Observer& observer, const std::string& who);

/// Flies the missing cases and writes the reports and execution.json. Failures of single cases and workers
/// are logged. Throws InputError when the control law is not deterministic, Interrupted when the observer
/// stops it, and ResultError. The results flown so far are kept.
RunResult RunCampaign(PreparedRun prepared, const RunOptions& options, Observer& observer);

/// Writes the reports of cases that were flown elsewhere, and execution.json; flies none. Throws Interrupted
/// and ResultError.
RunResult ReportFlown(const PreparedRun& prepared, const RunOptions& options, Observer& observer);

}  // namespace dispersa
