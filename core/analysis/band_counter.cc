#include "core/analysis/band_counter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/statistics/summary.h"

namespace dispersa {
namespace {

constexpr std::size_t kClasses = 256;  ///< over twice the range of the first flights
/// Fewer values than these do not show a range.
constexpr std::size_t kFewValues = 16;

}  // namespace

void BandCounter::Cell::Divide() {
  if (values.size() < kFewValues) return;
  const double range = max - min;
  const double room = range > 0.0 ? 0.5 * range : 1e-9 * std::fabs(max) + 1e-12;
  low = min - room;
  width = (range + 2.0 * room) / static_cast<double>(kClasses);
  classes.assign(kClasses + 2, 0);
  for (const double value : std::exchange(values, {})) Count(value);
}

void BandCounter::Cell::Count(double value) {
  if (!std::isfinite(value)) return;
  min = std::min(min, value);
  max = std::max(max, value);
  if (classes.empty()) {
    values.push_back(value);
    return;
  }
  const double position = std::floor((value - low) / width) + 1.0;
  ++classes[static_cast<std::size_t>(std::clamp(position, 0.0, static_cast<double>(kClasses + 1)))];
}

/// Linear between order statistics, as dispersa::Quantile. The values of a class are taken as evenly spread
/// over it.
double BandCounter::Cell::Quantile(double probability) const {
  if (classes.empty()) return dispersa::Quantile(SortedFinite(values), probability);
  const auto count = std::accumulate(classes.begin(), classes.end(), std::uint64_t{0});
  const double rank = probability * static_cast<double>(count - 1);
  double before = 0.0;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const double inside = classes[k];
    if (before + inside <= rank) {
      before += inside;
      continue;
    }
    const double edge = low + width * (static_cast<double>(k) - 1.0);
    const double from = std::clamp(k == 0 ? min : edge, min, max);
    const double to = std::clamp(k == kClasses + 1 ? max : edge + width, min, max);
    return from + (to - from) * std::min(1.0, (rank - before + 0.5) / inside) + 0.0;
  }
  return max;
}

void BandCounter::Add(SampledFlight flight) {
  ++flights_;
  if (flights_ <= kKept) {
    kept_.push_back(std::move(flight));
    return;
  }
  if (flights_ == kKept + 1) StartCounting();
  Count(flight);
}

void BandCounter::StartCounting() {
  cells_.resize(columns_.size());
  for (const SampledFlight& flight : kept_) Count(flight);
  kept_.clear();
  kept_.shrink_to_fit();
  for (std::vector<Cell>& column : cells_) {
    for (Cell& cell : column) cell.Divide();
  }
}

void BandCounter::Count(const SampledFlight& flight) {
  const std::size_t steps = flight.empty() ? 0 : flight[0].size();
  if (flying_.size() < steps) flying_.resize(steps);
  for (std::size_t step = 0; step < steps; ++step) ++flying_[step];
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (cells_[i].size() < flying_.size()) cells_[i].resize(flying_.size());
    for (std::size_t step = 0; step < steps; ++step) cells_[i][step].Count(flight[i][step]);
  }
}

void BandCounter::AddExtreme(const SampledFlight& flight) {
  ++extreme_flights_;
  extremes_.resize(columns_.size());
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    Extremes& extremes = extremes_[i];
    if (extremes.min.size() < flight[i].size()) {
      extremes.min.resize(flight[i].size(), HUGE_VAL);
      extremes.max.resize(flight[i].size(), -HUGE_VAL);
    }
    for (std::size_t step = 0; step < flight[i].size(); ++step) {
      if (!std::isfinite(flight[i][step])) continue;
      extremes.min[step] = std::min(extremes.min[step], flight[i][step] + 0.0);
      extremes.max[step] = std::max(extremes.max[step], flight[i][step] + 0.0);
    }
  }
}

FlightBands BandCounter::CountedBands() const {
  FlightBands bands;
  bands.step_s = step_s_;
  bands.flights = flights_;
  bands.flying = flying_;
  for (std::size_t step = 0; step < flying_.size(); ++step)
    bands.time_s.push_back(static_cast<double>(step) * step_s_);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    Band band{.column = BandColumnNames()[static_cast<std::size_t>(columns_[i])]};
    for (const Cell& cell : cells_[i]) {
      const bool any = cell.min <= cell.max;
      for (const BandStatistic& one : kBandStatistics)
        (band.*one.values)
            .push_back(!any                     ? kUndefined
                       : one.probability == 0.0 ? cell.min + 0.0
                       : one.probability == 1.0 ? cell.max + 0.0
                                                : cell.Quantile(one.probability));
    }
    bands.bands.push_back(std::move(band));
  }
  return bands;
}

FlightBands BandCounter::Bands() const {
  FlightBands bands = cells_.empty() ? ComputeBands(kept_, columns_, step_s_) : CountedBands();
  bands.extreme_flights = extreme_flights_;
  for (std::size_t i = 0; i < extremes_.size(); ++i) {
    Band& band = bands.bands[i];
    const Extremes& extremes = extremes_[i];
    // An extreme flight can last longer than all others: these steps have a minimum and a maximum, but no
    // percentiles.
    for (std::size_t step = bands.time_s.size(); step < extremes.min.size(); ++step) {
      bands.time_s.push_back(static_cast<double>(step) * step_s_);
      bands.flying.push_back(0);
    }
    for (const BandStatistic& one : kBandStatistics)
      (band.*one.values).resize(bands.time_s.size(), kUndefined);
    for (std::size_t step = 0; step < extremes.min.size(); ++step) {
      if (extremes.min[step] > extremes.max[step]) continue;
      band.min[step] = std::fmin(band.min[step], extremes.min[step]);
      band.max[step] = std::fmax(band.max[step], extremes.max[step]);
    }
  }
  return bands;
}

}  // namespace dispersa
