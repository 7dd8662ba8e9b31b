// Options of `run` and `report`, and their output about the reports.
#pragma once

#include <filesystem>
#include <string>

#include "services/cli/command.h"
#include "services/client/campaign_reports.h"

namespace dispersa {

/// --no-histories and --envelope.
void AddReflownOptions(CLI::App& command, ReflownFlights& flights);

/// --gate.
void AddGateOption(CLI::App& command, bool& gate);

/// --fresh.
void AddFreshOption(CLI::App& command, std::string& reason);

/// --open.
void AddOpenOption(CLI::App& command, bool& open);
/// Starts the browser with a file or an address and does not wait for it: $BROWSER, or xdg-open. A failure is
/// a warning.
void OpenInBrowser(std::string page);

/// Prints the verdicts, the report's place, and as the last line "result: DIR". With `json`: summary.json
/// plus `directory`. `if_incomplete`: what to do next then; empty: what is to be done after a run.
void PrintSummary(const CampaignSummary& summary, const std::filesystem::path& directory, bool json,
                  const std::string& if_incomplete = "");

}  // namespace dispersa
