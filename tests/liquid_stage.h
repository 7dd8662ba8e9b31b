// SLV-4 with a liquid stage or boosters instead of solid ones, of the same masses, thrust and specific
// impulse. Their liquids are made up: dense enough for the volume of the grain.
#pragma once

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Two tanks, one ahead of the other, that fill 90 % of the grain's length between them. Body is a Stage or
/// Boosters.
template <class Body>
void MakeLiquid(Body& body) {
  const double length_m = body.grain.bottom_station_m - body.grain.top_station_m;
  const double middle_m = body.grain.top_station_m + 0.55 * length_m,
               diameter_m = body.grain.outer_diameter_m;
  body.tanks = {
      {"oxidizer", body.grain.top_station_m, middle_m, diameter_m, 0.65 * body.propellant_mass_kg, 0.0},
      {"fuel", middle_m, body.grain.bottom_station_m, diameter_m, 0.35 * body.propellant_mass_kg, 0.0}};
  for (Tank& tank : body.tanks) tank.density_kg_m3 = tank.propellant_mass_kg / (0.9 * tank.Volume());
  body.grain = {};
}

}  // namespace dispersa
