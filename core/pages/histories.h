// The flights whose time histories go with a report: the nominal, the worst cases, and bands over many.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/analysis/campaign_summary.h"
#include "core/analysis/flight_bands.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/history.h"
#include "core/pages/reports.h"

namespace dispersa {

struct FlightHistories {
  CaseResult nominal;
  History nominal_history;
  FlightBands bands;
  std::vector<std::uint64_t> written_cases;    ///< with a file histories/case_<index>.csv, ascending
  std::vector<SampledFlight> written_flights;  ///< the same at the steps of the bands: one column a band
};

/// One line a row; the header names the columns that flights under the autopilot have. NaN is an empty cell.
std::string HistoryCsv(const History& history, const AutopilotConfig& autopilot);

/// Rows of the cases with the least and with the largest value of any metric, ascending.
std::vector<std::size_t> ExtremeRows(const CaseColumns& cases);

/// Removes histories/, which would belong to an earlier report.
void RemoveHistories(const ResultFolder& folder);

/// Flies again what the report shows and writes histories/ anew. Errors as WriteReports.
FlightHistories WriteHistories(const ResultFolder& folder, const Campaign& campaign,
                               const CampaignSummary& summary, const CaseColumns& cases,
                               const ReportOptions& options);

}  // namespace dispersa
