// Bands over more flights than memory holds.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/analysis/flight_bands.h"

namespace dispersa {

/// Takes flights one by one. The first kKept are kept, and bands of no more are ComputeBands'. Once there are
/// more, the range that a quantity had at a step is divided into classes, in which all flights are counted:
/// extremes and numbers of flights stay exact, a percentile is right to a class, 1/128 of the range of the
/// first flights.
///
/// The bands' bits depend on which flights are the first kKept and which come later, not on the order within
/// either.
class BandCounter {
 public:
  static constexpr std::size_t kKept = 256;

  BandCounter(std::vector<int> columns, double step_s) : columns_(std::move(columns)), step_s_(step_s) {}

  void Add(SampledFlight flight);
  /// Widens minimum and maximum only: a flight that was chosen because it is extreme tells nothing of
  /// percentiles.
  void AddExtreme(const SampledFlight& flight);

  FlightBands Bands() const;

 private:
  /// One quantity at one step.
  struct Cell {
    double min = HUGE_VAL, max = -HUGE_VAL;
    double low = 0.0, width = 0.0;       ///< of the classes
    std::vector<std::uint32_t> classes;  ///< below them, they themselves, above them
    std::vector<double> values;  ///< in place of classes where hardly any of the first flights got so far

    void Divide();
    void Count(double value);
    double Quantile(double probability) const;
  };
  struct Extremes {
    std::vector<double> min, max;
  };

  void StartCounting();
  void Count(const SampledFlight& flight);
  FlightBands CountedBands() const;

  std::vector<int> columns_;
  double step_s_;
  std::size_t flights_ = 0;
  std::size_t extreme_flights_ = 0;
  std::vector<SampledFlight> kept_;       ///< until counting starts
  std::vector<std::vector<Cell>> cells_;  ///< from then on, by column and step
  std::vector<std::size_t> flying_;       ///< likewise
  std::vector<Extremes> extremes_;        ///< of AddExtreme, by column
};

}  // namespace dispersa
