#include "core/analysis/flight_bands.h"

#include <algorithm>
#include <cmath>

#include "core/results/text.h"
#include "core/statistics/summary.h"

namespace dispersa {

SampledFlight SampleFlight(const History& history, const std::vector<int>& columns, double step_s) {
  SampledFlight samples(columns.size());
  for (std::size_t row = 0; row < history.rows(); ++row) {
    const double time_s = history.at(row, 0);
    const double multiple = std::round(time_s / step_s);
    if (time_s < 0.0 || std::fabs(time_s - multiple * step_s) > 1e-6) continue;
    const auto step = static_cast<std::size_t>(multiple);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      samples[i].resize(std::max(samples[i].size(), step + 1), kUndefined);
      samples[i][step] = history.at(row, columns[i]);
    }
  }
  return samples;
}

FlightBands ComputeBands(const std::vector<SampledFlight>& flights, const std::vector<int>& columns,
                         double step_s) {
  FlightBands bands;
  bands.step_s = step_s;
  bands.flights = flights.size();
  std::size_t steps = 0;
  for (const SampledFlight& flight : flights) {
    if (!flight.empty()) steps = std::max(steps, flight[0].size());
  }
  for (std::size_t step = 0; step < steps; ++step) {
    bands.time_s.push_back(static_cast<double>(step) * step_s);
    bands.flying.push_back(static_cast<std::size_t>(
        std::count_if(flights.begin(), flights.end(),
                      [&](const SampledFlight& flight) { return flight[0].size() > step; })));
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    Band band{.column = HistoryColumns()[static_cast<std::size_t>(columns[i])]};
    for (std::size_t step = 0; step < steps; ++step) {
      std::vector<double> values;
      for (const SampledFlight& flight : flights) {
        if (step < flight[i].size()) values.push_back(flight[i][step]);
      }
      const std::vector<double> sorted = SortedFinite(std::move(values));
      band.min.push_back(Quantile(sorted, 0.0));
      band.p01.push_back(Quantile(sorted, 0.01));
      band.p05.push_back(Quantile(sorted, 0.05));
      band.p50.push_back(Quantile(sorted, 0.50));
      band.p95.push_back(Quantile(sorted, 0.95));
      band.p99.push_back(Quantile(sorted, 0.99));
      band.max.push_back(Quantile(sorted, 1.0));
    }
    bands.bands.push_back(std::move(band));
  }
  return bands;
}

std::string BandsCsv(const FlightBands& bands, int digits) {
  const auto text = [digits](double value) {
    return digits == 0 ? ShortestText(value) : DigitsText(value, digits);
  };
  std::string csv = "time_s,flights";
  for (const Band& band : bands.bands) {
    for (const char* statistic : {"min", "p01", "p05", "p50", "p95", "p99", "max"}) {
      csv += "," + band.column + "_" + statistic;
    }
  }
  csv += "\n";
  for (std::size_t step = 0; step < bands.time_s.size(); ++step) {
    csv += text(bands.time_s[step]) + "," + std::to_string(bands.flying[step]);
    for (const Band& band : bands.bands) {
      for (const auto* values :
           {&band.min, &band.p01, &band.p05, &band.p50, &band.p95, &band.p99, &band.max}) {
        csv += "," + text((*values)[step]);
      }
    }
    csv += "\n";
  }
  return csv;
}

}  // namespace dispersa
