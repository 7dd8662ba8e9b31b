// The standard's air as flights look it up: piecewise polynomials over geometric altitude.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math/aligned_rows.h"

namespace dispersa {

/// Pressure p (Pa) and specific energy p / density (J/kg) of StandardAtmosphere1976, in cells that end at the
/// standard's own kinks. A row has 16 doubles: the cell's centre (m), 1 / half width, seven coefficients of p
/// and six of the energy, in rising powers of u = (z - centre) / half width.
///
/// Both polynomials interpolate in Chebyshev points. Cells are halved until both meet the standard's
/// equations within a quarter of kAirTableTolerance, or until a half would be narrower than a bucket. From
/// kAtmosphereBottom_m to kAtmosphereTop_m every value is within that tolerance. Outside,
/// StandardAtmosphere1976's rule holds.
struct AirTable {
  static constexpr int kRowSize = 16;
  static constexpr double kBucket_m = 125.0;  ///< no cell is narrower

  std::vector<double> edges;  ///< lower edges of the cells, then an upper bound of all altitudes
  AlignedRows rows;
  std::vector<std::uint16_t> bucket;  ///< the cell at the lower end of each bucket
};

/// Relative, of pressure and density.
inline constexpr double kAirTableTolerance = 4e-12;

/// Made at the first call, and shared by all flights.
const AirTable& StandardAir();

}  // namespace dispersa
