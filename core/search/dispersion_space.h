// The dispersions of a campaign as independent standard normal coordinates. The distance from the origin,
// where nothing is dispersed, then has a meaning (A. M. Hasofer and N. C. Lind, J. Eng. Mech. Div. ASCE 100
// (1974) 111-121).
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/flight/flight_inputs.h"

namespace dispersa {

enum class CoordinateKind {
  kNormal,     ///< 0 is the median, or the least magnitude if the distribution is of magnitudes
  kDirection,  ///< an angle over a full turn: all values are equally likely, so it adds no distance
  kHeld,       ///< a distribution of single values: held at the middle one
};

struct Coordinate {
  std::string name;  ///< the dispersion's
  CoordinateKind kind = CoordinateKind::kNormal;
};

class DispersionSpace {
 public:
  /// Treats every dispersion as drawn at random, for any design of the campaign.
  explicit DispersionSpace(const Campaign& campaign);

  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  /// The inputs of a flight at each point. A point has one value for each coordinate.
  std::vector<FlightInputs> Inputs(const std::vector<std::vector<double>>& points) const;
  /// A dispersion's value at a point, in the internal unit of its input (SI, rad).
  double Value(std::size_t coordinate, const std::vector<double>& point) const;

 private:
  Campaign list_;  ///< holds only what a design of listed points needs
  std::vector<Dispersion> dispersions_;
  std::vector<Coordinate> coordinates_;
  std::vector<std::array<double, 2>> truncation_;
};

}  // namespace dispersa
