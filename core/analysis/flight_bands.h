// The spread of a quantity over the cases, as a function of time.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/flight/history.h"

namespace dispersa {

/// Order statistics of one history column at each time, over the flights that still fly. In the unit of the
/// column. NaN if no flight defines a value.
struct Band {
  std::string column;  ///< of BandColumnNames()
  std::vector<double> min = {}, p00_27 = {}, p01 = {}, p50 = {}, p99 = {}, p99_73 = {}, max = {};
};

/// What a band holds, in the order of its file.
struct BandStatistic {
  const char* name;
  std::vector<double> Band::*values;
  double probability;
};
inline constexpr BandStatistic kBandStatistics[] = {
    {"min", &Band::min, 0.0}, {"p00_27", &Band::p00_27, 0.0027}, {"p01", &Band::p01, 0.01},
    {"p50", &Band::p50, 0.5}, {"p99", &Band::p99, 0.99},         {"p99_73", &Band::p99_73, 0.9973},
    {"max", &Band::max, 1.0}};

/// The columns of a history, and behind them those that are made of several: "q_alpha_pa_rad", dynamic
/// pressure times incidence, and the attitude errors of powered flight, as "pitch_error_powered_deg", which
/// are undefined without thrust.
const std::vector<std::string>& BandColumnNames();
/// Position in BandColumnNames(); -1: none.
int FindBandColumn(std::string_view name);

struct FlightBands {
  double step_s = 0.0;
  std::size_t flights = 0;  ///< flights in all percentiles
  std::size_t extreme_flights =
      0;                       ///< other flights, chosen as extreme, which count only in minimum and maximum
  std::vector<double> time_s;  ///< multiples of the step, to the end of the longest flight
  std::vector<std::size_t> flying;  ///< number of flights that last to this time
  std::vector<Band> bands;
};

/// Columns of one flight at multiples of a step; shape (columns, steps). A row of the history counts for the
/// multiple at its time. If several rows have the same time (an event), the last one counts. A longitude
/// runs on beyond +-180 degrees, so that flights on both sides of the cut have one spread.
using SampledFlight = std::vector<std::vector<double>>;
SampledFlight SampleFlight(const History& history, const std::vector<int>& columns, double step_s);

/// Bands of the columns over the flights. The order of the flights does not change a bit of the result.
FlightBands ComputeBands(const std::vector<SampledFlight>& flights, const std::vector<int>& columns,
                         double step_s);

/// CSV with the columns time_s, flights, and for each history column those of kBandStatistics. `digits`:
/// significant ones of a value; 0: all that are needed to read back the same bits.
std::string BandsCsv(const FlightBands& bands, int digits = 0);

}  // namespace dispersa
