// The stored results by column: what statistics and charts are made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/flight/metrics.h"
#include "core/report/lost_flight.h"
#include "core/report/result_folder.h"

namespace dispersa {

/// Everything in ascending order of case index; NaN = undefined.
struct CaseColumns {
  std::vector<std::uint64_t> index;
  std::vector<Outcome> outcome;
  std::vector<std::vector<double>> inputs;   ///< one column an entry of InputColumns(); only those asked for
  std::vector<LostFlight> lost_flights;      ///< all of them
  std::vector<std::vector<double>> metrics;  ///< one column an entry of MetricNames()

  std::size_t rows() const { return index.size(); }
};

/// Reads all metrics, and those inputs that `wanted_inputs` (positions in InputColumns()) names.
CaseColumns ReadColumns(const ResultFolder& folder, const std::vector<int>& wanted_inputs);

/// A metric's values, NaN for every flight that was not completed whatever it measured until then.
std::vector<double> CompletedValues(const CaseColumns& cases, const std::string& metric);

/// Flights that were not completed.
std::size_t LostCount(const CaseColumns& cases);

}  // namespace dispersa
