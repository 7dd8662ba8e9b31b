// The stored results by column, for statistics and charts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/flight/metrics.h"
#include "core/results/case_column.h"
#include "core/results/lost_flight.h"
#include "core/results/result_folder.h"

namespace dispersa {

/// All values in ascending order of case index. NaN is undefined.
struct CaseColumns {
  std::vector<std::uint64_t> index;
  std::vector<Outcome> outcome;
  std::vector<CaseColumn> inputs;  ///< one for each input of the vehicle (empty if not asked for)
  std::vector<CaseColumn>
      metrics;  ///< one for each metric of the vehicle (empty if its control law does not measure it)
  std::vector<std::string> own_metrics;  ///< names of the campaign's own metrics, the last ones of `metrics`
  bool are_alike = false;                ///< two flights or more, and all have one digest
  /// An event: SeenEvent::kValues of each flight in which it happened.
  struct Event {
    std::string name;
    std::shared_ptr<ColumnFile> values;
  };
  std::vector<Event> events;             ///< in the order in which they were first seen
  std::vector<LostFlight> lost_flights;  ///< the first kListedLostFlights lost flights

  std::size_t rows() const { return index.size(); }
};

/// A page with a longer list would not be read. cases.csv lists all lost flights.
inline constexpr std::size_t kListedLostFlights = 10000;

/// Reads all metrics, and the inputs at the positions `wanted_inputs` in InputColumns(), in one pass. An
/// input that the rows do not hold is a column of its constant. `observe`, if given, gets each result in
/// order; with more than one of `threads` on another one than the caller's, while the next rows are read. A
/// million cases take 50 MB beside the columns in use.
CaseColumns ReadColumns(const ResultFolder& folder, const std::vector<int>& wanted_inputs,
                        const std::function<void(const CaseResult&)>& observe = {}, int threads = 1);

/// A metric's values; NaN if the flights do not have it.
std::vector<double> MeasuredValues(const CaseColumns& cases, const std::string& metric);
/// The same for statistics and charts: NaN for every flight that was not completed, even if it measured a
/// value; of a metric on a circle near to the centre of all, so that values may go on beyond the cut.
std::vector<double> CompletedValues(const CaseColumns& cases, const std::string& metric);

/// Flights that were not completed.
std::size_t LostCount(const CaseColumns& cases);

}  // namespace dispersa
