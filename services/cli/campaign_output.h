// What `run` and `report` have in common: the reports, and what is said about them.
#pragma once

#include <filesystem>
#include <functional>

#include "core/report/reports.h"
#include "services/cli/command.h"

namespace dispersa {

/// Writes all reports of a folder with progress on stderr, with or without flying time histories for them. `check`, if given, is called now and then and may
/// throw to stop.
CampaignSummary MakeReports(const ResultFolder& folder, const Campaign& campaign, int threads, bool quiet,
                            bool histories = true, const std::function<void()>& check = nullptr);

/// The verdicts, where the report is, and as the last line "result: DIR"; or summary.json plus `directory`.
void PrintSummary(const CampaignSummary& summary, const std::filesystem::path& directory, bool json);

}  // namespace dispersa
