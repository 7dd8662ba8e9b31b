// Dispersion of air density as a factor over altitude.
#pragma once

#include <string>
#include <vector>

#include "core/environment/atmosphere.h"
#include "core/math/table.h"

namespace dispersa {

/// Factor on the standard's density: scale times by_altitude(geometric altitude, m).
struct DensityFactor {
  double scale = 1.0;
  Table1D by_altitude = {};  ///< empty means 1 everywhere; the end values hold outside

  double operator()(double altitude_m) const {
    return by_altitude.x.empty() ? scale : scale * by_altitude(altitude_m);
  }
};

/// Air whose density is multiplied by a factor. Temperature and speed of sound are held and pressure is
/// multiplied too, so that the perfect-gas law stays satisfied: dynamic pressure changes and Mach number
/// does not. (Hydrostatic balance is given up, as in any density factor at held temperature.)
AirState Scaled(const AirState& air, double density_factor);

}  // namespace dispersa
