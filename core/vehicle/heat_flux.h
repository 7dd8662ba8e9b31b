// Free-molecular heating, by which a flight computer lets go of a fairing.
#pragma once

#include "core/math/functions.h"

namespace dispersa {

/// Below this altitude a heat flux is no free-molecular one: it is not looked at.
inline constexpr double kFreeMolecularAltitude_m = 80e3;

/// Heating of a surface normal to the flow, rho v³ / 2, W/m², with an accommodation coefficient of 1. The
/// speed is that over the rotating Earth. User's manuals limit it after the fairing's jettison (1135 W/m² for
/// Ariane 5, Vega and others).
inline double HeatFlux(double density_kg_m3, double ground_speed_m_s) {
  return 0.5 * density_kg_m3 * ground_speed_m_s * Square(ground_speed_m_s);
}

}  // namespace dispersa
