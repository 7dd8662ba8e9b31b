// All reports of a result folder.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/analysis/campaign_summary.h"
#include "core/campaign/campaign.h"
#include "core/results/result_folder.h"

namespace dispersa {

struct ReportOptions {
  /// The first so many cases are flown again for the percentile bands, and besides them the extremes of every
  /// metric.
  std::uint64_t history_cases = 500;
  int threads = 1;        ///< for flying them; the files do not depend on it
  bool histories = true;  ///< false: nothing is flown again, the report has no flight over time
  /// Called now and then from the calling thread ("time histories", 40, 104); may throw to stop.
  std::function<void(const std::string& what, std::uint64_t done, std::uint64_t total)> progress;
};

/// Writes cases.csv, histories/, summary.json and report.html from what is stored, each replaced as a whole.
/// The same stored results give the same bytes, whoever flew them. Flies the nominal, the worst cases and
/// others again, as ReportOptions say. With histories, InputError when another engine flew the folder;
/// ResultError (kConflict) when a case does not reproduce its digest.
CampaignSummary WriteReports(const ResultFolder& folder, const Campaign& campaign,
                             const ReportOptions& options = {});

}  // namespace dispersa
