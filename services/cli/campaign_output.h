// Options of `run` and `report`, and their output about the reports.
#pragma once

#include <filesystem>

#include "services/cli/command.h"
#include "services/client/campaign_reports.h"

namespace dispersa {

/// --no-histories and --envelope.
void AddReflownOptions(CLI::App& command, ReflownFlights& flights);

/// Prints the verdicts, the report's place, and as the last line "result: DIR". With `json`: summary.json
/// plus `directory`.
void PrintSummary(const CampaignSummary& summary, const std::filesystem::path& directory, bool json);

}  // namespace dispersa
