// What `run` and `report` have in common: the reports, and what is said about them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "core/report/reports.h"
#include "services/cli/command.h"

namespace dispersa {

/// Which flights are flown again for the report.
struct ReflownFlights {
  bool none = false;
  std::uint64_t envelope = ReportOptions().history_cases;
};
/// --no-histories and --envelope.
void AddReflownOptions(CLI::App& command, ReflownFlights& flights);

/// Writes all reports of a folder with progress on stderr. `check`, if given, is called now and then and may
/// throw to stop.
CampaignSummary MakeReports(const ResultFolder& folder, const Campaign& campaign, int threads, bool quiet,
                            const ReflownFlights& reflown, const std::function<void()>& check = nullptr);

/// The verdicts, where the report is, and as the last line "result: DIR"; or summary.json plus `directory`.
void PrintSummary(const CampaignSummary& summary, const std::filesystem::path& directory, bool json);

}  // namespace dispersa
