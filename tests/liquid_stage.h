// SLV-4 with a liquid stage instead of a solid one, of the same masses, thrust and specific impulse. Its
// liquids are made up: dense enough for the volume of the grain.
#pragma once

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Two tanks, one ahead of the other, that fill 90 % of the grain's length between them.
inline void MakeLiquid(Stage& stage) {
  const double length_m = stage.grain.bottom_station_m - stage.grain.top_station_m;
  const double middle_m = stage.grain.top_station_m + 0.55 * length_m,
               diameter_m = stage.grain.outer_diameter_m;
  stage.tanks = {
      {"oxidizer", stage.grain.top_station_m, middle_m, diameter_m, 0.65 * stage.propellant_mass_kg, 0.0},
      {"fuel", middle_m, stage.grain.bottom_station_m, diameter_m, 0.35 * stage.propellant_mass_kg, 0.0}};
  for (Tank& tank : stage.tanks) tank.density_kg_m3 = tank.propellant_mass_kg / (0.9 * tank.Volume());
  stage.grain = {};
}

}  // namespace dispersa
