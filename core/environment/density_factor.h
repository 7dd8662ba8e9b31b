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
  Table1D by_altitude = {};  ///< empty: 1 everywhere (outside, the end values hold)

  double operator()(double altitude_m) const {
    return by_altitude.x.empty() ? scale : scale * by_altitude(altitude_m);
  }
};

/// Air with its density multiplied by a factor. Temperature and speed of sound are held. Pressure is
/// multiplied too, so the perfect-gas law stays satisfied. Dynamic pressure changes, Mach number does not. As
/// with any density factor at held temperature, the air is no longer in hydrostatic balance.
inline AirState Scaled(const AirState& air, double density_factor) {
  return {air.temperature_k, density_factor * air.pressure_pa, density_factor * air.density_kg_m3,
          air.speed_of_sound_m_s};
}

}  // namespace dispersa
