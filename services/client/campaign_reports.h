// The reports of a result folder, under the eyes of an observer.
#pragma once

#include <cstdint>

#include "core/pages/reports.h"
#include "services/client/observer.h"

namespace dispersa {

/// Which flights are flown again for the report.
struct ReflownFlights {
  bool none = false;
  std::uint64_t envelope = ReportOptions().history_cases;
};

/// Writes all reports of a folder. Throws as WriteReports, and Interrupted.
CampaignSummary MakeReports(const ResultFolder& folder, const Campaign& campaign, int threads,
                            const ReflownFlights& reflown, Observer& observer);

}  // namespace dispersa
