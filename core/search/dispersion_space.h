// The dispersions of a campaign as coordinates that are independent and standard normal, so that a distance
// from nothing dispersed has a meaning (A. M. Hasofer and N. C. Lind, J. Eng. Mech. Div. ASCE 100 (1974)
// 111-121).
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/flight/flight_inputs.h"

namespace dispersa {

enum class CoordinateKind {
  kNormal,     ///< 0 is the law's median, or the least magnitude of a law of magnitudes
  kDirection,  ///< an angle over a full turn: any value is as likely as any other, so that it adds no
               ///< distance
  kHeld,       ///< a law of single values: held at its middle one
};

struct Coordinate {
  std::string name;  ///< the dispersion's
  CoordinateKind kind = CoordinateKind::kNormal;
};

class DispersionSpace {
 public:
  /// As if every dispersion were drawn at random, whatever the campaign's design.
  explicit DispersionSpace(const Campaign& campaign);

  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  /// What a flight applies at each point; one value a coordinate.
  std::vector<FlightInputs> Inputs(const std::vector<std::vector<double>>& points) const;
  /// A dispersion's value at a point, in the internal unit of its input.
  double Value(std::size_t coordinate, const std::vector<double>& point) const;

 private:
  Campaign list_;  ///< only what a design of listed points needs
  std::vector<Dispersion> dispersions_;
  std::vector<Coordinate> coordinates_;
  std::vector<std::array<double, 2>> truncation_;
};

}  // namespace dispersa
