// A campaign flown on this machine, from its opened folder to its reports: what `dispersa run` does.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/analysis/campaign_summary.h"
#include "services/client/campaign_reports.h"
#include "services/client/observer.h"
#include "services/ledger/open_campaign.h"
#include "services/program/exit_code.h"

namespace dispersa {

struct RunOptions {
  int workers = -1;  ///< processes; -1: the usable cores; 0: none, threads of this process
  int threads = 0;   ///< without workers; 0: the usable cores
  std::filesystem::path worker_program;  ///< dispersa-worker
  ReflownFlights reflown;
};

struct RunResult {
  CampaignSummary summary;
  ExitCode code = kExitDone;           ///< of the verdict, or of what stands in its way
  std::optional<std::string> problem;  ///< why cases are missing, if they are for want of workers
};

/// Flies what is missing, writes the reports and execution.json. What goes wrong with single cases and
/// workers is logged. Throws InputError when the campaign's control law turns out not to be deterministic,
/// Interrupted when the observer wants it to stop, and ResultError; what was flown is kept.
RunResult RunCampaign(OpenedCampaign opened, const RunOptions& options, Observer& observer);

}  // namespace dispersa
