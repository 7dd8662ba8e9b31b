#include "core/analysis/flight_bands.h"

#include <algorithm>
#include <cmath>

#include "core/math/circle.h"
#include "core/math/constants.h"
#include "core/results/text.h"
#include "core/statistics/summary.h"

namespace dispersa {

const std::vector<std::string>& BandColumnNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = HistoryColumns();
    all.insert(all.end(), {"q_alpha_pa_rad", "pitch_error_powered_deg", "yaw_error_powered_deg",
                           "roll_error_powered_deg"});
    return all;
  }();
  return names;
}

int FindBandColumn(std::string_view name) {
  const auto& names = BandColumnNames();
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

namespace {

/// Reads band columns out of the rows of a history.
class BandRow {
 public:
  double At(const double* row, int column) const {
    if (column < q_alpha_) return row[column];
    if (column == q_alpha_) return row[qbar_pa_] * row[incidence_deg_] / kDegPerRad;
    return row[thrust_n_] > 0.0 ? row[pitch_error_ + column - q_alpha_ - 1] : kUndefined;
  }

 private:
  const int qbar_pa_ = FindHistoryColumn("qbar_pa"), incidence_deg_ = FindHistoryColumn("incidence_deg"),
            thrust_n_ = FindHistoryColumn("thrust_n");
  const int pitch_error_ = FindHistoryColumn("pitch_error_deg");  // yaw and roll follow it
  const int q_alpha_ = FindBandColumn("q_alpha_pa_rad");
};

}  // namespace

SampledFlight SampleFlight(const History& history, const std::vector<int>& columns, double step_s) {
  static const int longitude_deg = FindHistoryColumn("longitude_deg");
  static const BandRow band_row;
  SampledFlight samples(columns.size());
  const std::size_t width = HistoryColumns().size();
  double end_s = 0.0;
  for (std::size_t at = 0; at < history.values.size(); at += width)
    end_s = std::fmax(end_s, history.values[at]);
  const auto most = static_cast<std::size_t>(std::round(end_s / step_s)) + 1;
  for (std::vector<double>& column : samples) column.assign(most, kUndefined);
  std::size_t steps = 0;
  double last_longitude_deg = 0.0;
  for (std::size_t at = 0; at < history.values.size(); at += width) {
    const double* const row = history.values.data() + at;
    const double time_s = row[0];
    const double multiple = std::round(time_s / step_s);
    if (time_s < 0.0 || !(std::fabs(time_s - multiple * step_s) <= 1e-6)) continue;
    const auto step = static_cast<std::size_t>(multiple);
    steps = std::max(steps, step + 1);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      double& value = samples[i][step];
      value = band_row.At(row, columns[i]);
      if (columns[i] == longitude_deg && std::isfinite(value))
        value = last_longitude_deg = NearTo(last_longitude_deg, value, kCutAt180Deg);
    }
  }
  for (std::vector<double>& column : samples) column.resize(steps);
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
    Band band{.column = BandColumnNames()[static_cast<std::size_t>(columns[i])]};
    for (std::size_t step = 0; step < steps; ++step) {
      std::vector<double> values;
      for (const SampledFlight& flight : flights) {
        if (step < flight[i].size()) values.push_back(flight[i][step]);
      }
      const std::vector<double> sorted = SortedFinite(std::move(values));
      for (const BandStatistic& one : kBandStatistics)
        (band.*one.values).push_back(Quantile(sorted, one.probability));
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
    for (const BandStatistic& one : kBandStatistics) csv += "," + band.column + "_" + one.name;
  }
  csv += "\n";
  for (std::size_t step = 0; step < bands.time_s.size(); ++step) {
    csv += text(bands.time_s[step]) + "," + std::to_string(bands.flying[step]);
    for (const Band& band : bands.bands) {
      for (const BandStatistic& one : kBandStatistics) csv += "," + text((band.*one.values)[step]);
    }
    csv += "\n";
  }
  return csv;
}

}  // namespace dispersa
