// Bands over more flights than memory holds.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/analysis/flight_bands.h"

namespace dispersa {

/// Percentile bands over the flights of a campaign, added one by one. The first kKept flights are kept; up to
/// that number the bands are those of ComputeBands(). With more flights, the range of a quantity at each step
/// is divided into classes, and all flights are counted in them. Minimum, maximum and the numbers of flights
/// stay exact. A percentile is right to the width of a class: 1/128 of the range of the first flights.
///
/// The bits of the bands depend on which flights are the first kKept. They do not depend on the order of
/// flights among the first, nor among the later ones.
class BandCounter {
 public:
  static constexpr std::size_t kKept = 256;

  BandCounter(std::vector<int> columns, double step_s) : columns_(std::move(columns)), step_s_(step_s) {}

  void Add(SampledFlight flight);
  /// Widens minimum and maximum only. A flight chosen because it is extreme says nothing about percentiles.
  void AddExtreme(const SampledFlight& flight);

  FlightBands Bands() const;

 private:
  /// One quantity at one step.
  struct Cell {
    double min = HUGE_VAL, max = -HUGE_VAL;
    double low = 0.0, width = 0.0;       ///< of the classes
    std::vector<std::uint32_t> classes;  ///< counts: below the classes, in each class, above the classes
    std::vector<double> values;  ///< in place of classes, at steps that few of the first flights reached

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
  std::vector<SampledFlight> kept_;       ///< until the number of flights exceeds kKept
  std::vector<std::vector<Cell>> cells_;  ///< from then on, by column and step
  std::vector<std::size_t> flying_;       ///< from then on, flights that last to the step
  std::vector<Extremes> extremes_;        ///< of the flights of AddExtreme(), by column
};

}  // namespace dispersa
