// Air, the standard's or a measured one, as flights look it up: piecewise polynomials over geometric
// altitude.
#pragma once

#include <cstdint>
#include <vector>

#include "core/environment/weather_table.h"
#include "core/math/aligned_rows.h"

namespace dispersa {

/// Pressure p (Pa) and specific energy p / density (J/kg) over altitude, in cells that end at kinks. A row
/// has 16 doubles: the cell's centre (m), 1 / half width, seven coefficients of p and six of the energy, in
/// rising powers of u = (z - centre) / half width.
///
/// Both polynomials interpolate in Chebyshev points. Cells are halved until both meet the air's
/// equations within a quarter of kAirTableTolerance, or until a half would be narrower than a bucket. From
/// kAtmosphereBottom_m to kAtmosphereTop_m every value of the standard is within that tolerance. Outside,
/// StandardAtmosphere1976's rule holds.
struct AirTable {
  static constexpr int kRowSize = 16;
  static constexpr double kBucket_m = 125.0;  ///< of the standard

  double bucket_m = kBucket_m;  ///< no cell is narrower
  double buckets_per_m = 1.0 / kBucket_m;
  std::vector<double> edges;  ///< lower edges of the cells, then an upper bound of all altitudes
  AlignedRows rows;
  std::vector<std::uint16_t> bucket;  ///< the cell at the lower end of each bucket
};

/// Relative, of pressure and density.
inline constexpr double kAirTableTolerance = 4e-12;

/// Made at the first call, and shared by all flights.
const AirTable& StandardAir();

/// The air of a weather table that has air. Between two of its altitudes pressure and density are
/// exponentials. Below the first one its ratios to the standard hold. Above the last one they fade linearly
/// to 1 over kWindFade_m: from there on the air is the standard's. Values are within kAirTableTolerance of
/// this, and within 1e-5 for 2 m where the table or its fading ends so near to a kink of the standard.
AirTable MeasuredAir(const WeatherTable& table);

}  // namespace dispersa
