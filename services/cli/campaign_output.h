// What `run` and `report` have in common: their options, and what is said of the reports.
#pragma once

#include <filesystem>

#include "services/cli/command.h"
#include "services/client/campaign_reports.h"

namespace dispersa {

/// --no-histories and --envelope.
void AddReflownOptions(CLI::App& command, ReflownFlights& flights);

/// The verdicts, where the report is, and as the last line "result: DIR"; or summary.json plus `directory`.
void PrintSummary(const CampaignSummary& summary, const std::filesystem::path& directory, bool json);

}  // namespace dispersa
