// How a quantity spreads over the cases as the flight goes on.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/flight/history.h"

namespace dispersa {

/// Pointwise order statistics of one history column over the flights still flying; NaN where none is defined.
struct Band {
  std::string column;  ///< name in HistoryColumns()
  std::vector<double> min = {}, p01 = {}, p05 = {}, p50 = {}, p95 = {}, p99 = {}, max = {};
};

struct FlightBands {
  double step_s = 0.0;
  std::size_t flights = 0;  ///< that the bands are made of
  std::size_t extreme_flights =
      0;                       ///< others, chosen for being extreme, that only minimum and maximum contain
  std::vector<double> time_s;  ///< multiples of the step, to the end of the longest flight
  std::vector<std::size_t> flying;  ///< flights that last so long
  std::vector<Band> bands;
};

/// Columns of one flight at multiples of a step. A row of the history counts for the multiple at its time, of
/// several at one time (an event) the last; shape (columns, steps).
using SampledFlight = std::vector<std::vector<double>>;
SampledFlight SampleFlight(const History& history, const std::vector<int>& columns, double step_s);

/// Bands of the columns over the flights; the same bits in whatever order the flights come.
FlightBands ComputeBands(const std::vector<SampledFlight>& flights, const std::vector<int>& columns,
                         double step_s);

/// As CSV: time_s, flights, then for each column its _min, _p01, _p05, _p50, _p95, _p99, _max.
std::string BandsCsv(const FlightBands& bands);

}  // namespace dispersa
