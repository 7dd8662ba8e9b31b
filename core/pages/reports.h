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
  /// Number of first cases that are flown again for the percentile bands. The extremes of every metric are
  /// flown again too.
  std::uint64_t history_cases = 500;
  int threads = 1;        ///< for these flights and the statistics; the files do not depend on it
  bool histories = true;  ///< false: nothing is flown again, and the report has no time histories
  /// Called from the calling thread from time to time ("time histories", 40, 104). It may throw to stop.
  std::function<void(const std::string& what, std::uint64_t done, std::uint64_t total)> progress;
};

/// Writes cases.csv, histories/, summary.json, report.html and SHA256SUMS from the stored results. Each is
/// replaced as a whole. The same stored results always give the same bytes. The nominal flight, the worst
/// cases and the cases of ReportOptions are flown again. With histories: ResultError (kConflict) if a case
/// does not reproduce its digest. Of a folder that another engine flew nothing is flown again, and its stored
/// histories are drawn.
CampaignSummary WriteReports(const ResultFolder& folder, const Campaign& campaign,
                             const ReportOptions& options = {});

}  // namespace dispersa
