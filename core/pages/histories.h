// The time histories of a report: the nominal flight, the worst cases, and bands over many flights.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/analysis/campaign_summary.h"
#include "core/analysis/flight_bands.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/history.h"
#include "core/impact/impact_points.h"
#include "core/pages/reports.h"

namespace dispersa {

/// Flights whose parts are followed to the ground. More dots than these are one spot.
inline constexpr std::size_t kMostFallen = 100;

struct FlightHistories {
  CaseResult nominal;
  History nominal_history;
  FlightBands bands;
  /// Where parts of the flights in all percentiles come down, by case.
  std::vector<ImpactPoint> impacts;
  std::vector<std::uint64_t> written_cases;  ///< cases with a file histories/case_<index>.csv.gz, ascending
  std::vector<SampledFlight>
      written_flights;  ///< the same cases at the steps of the bands: one column for each band
};

/// CSV with one line for each row. The header names the columns of flights under this autopilot. NaN is an
/// empty cell. `digits`: significant ones of a value; 0: all that are needed to read back the same bits.
std::string HistoryCsv(const History& history, const AutopilotConfig& autopilot, int digits = 0);

/// Of a history with every tick: its rows at the multiples of a step, those of events, and those at which a
/// column is least or largest.
History Thinned(const History& ticks, double tick_s, double step_s);

/// Rows of the cases with the smallest and the largest value of any metric, ascending.
std::vector<std::size_t> ExtremeRows(const CaseColumns& cases);

/// Removes histories/, which belongs to an earlier report.
void RemoveHistories(const ResultFolder& folder);

/// Flies the flights of the report again and writes histories/ anew. Of a folder that another engine flew it
/// reads what is stored, and nothing if that is of other flights or damaged. Throws the errors of
/// WriteReports().
FlightHistories WriteHistories(const ResultFolder& folder, const Campaign& campaign,
                               const CampaignSummary& summary, const CaseColumns& cases,
                               const ReportOptions& options);

}  // namespace dispersa
