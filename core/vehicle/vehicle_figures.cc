#include "core/vehicle/vehicle_figures.h"

#include <algorithm>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {

double SitePressure(double altitude_m) {
  // NOAA-S/T 76-1562: 288.15 K and 101325 Pa at the sea, -6.5 K/km; geometric altitude for the geopotential
  // one.
  return 101325.0 * Pow(1.0 - 6.5e-3 / 288.15 * std::min(altitude_m, 11000.0), 5.25588);
}

std::vector<StageFigures> FiguresOf(const Vehicle& vehicle) {
  std::vector<StageFigures> all;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    const Stage& stage = vehicle.stages[i];
    const double thrust_n = stage.motor.thrust_n;
    const double empty_kg = stage.liftoff_mass_kg - stage.propellant_mass_kg;
    StageFigures one;
    one.dry_mass_kg = DryMass(vehicle, static_cast<int>(i));
    one.own_mass_kg = one.dry_mass_kg + stage.propellant_mass_kg;
    one.structural_fraction = one.dry_mass_kg / one.own_mass_kg;
    one.flow_kg_s = stage.propellant_mass_kg / stage.motor.burning_time_s;
    one.specific_impulse_s = thrust_n / (one.flow_kg_s * kStandardGravity);
    one.ideal_delta_v_m_s = thrust_n / one.flow_kg_s * Log(stage.liftoff_mass_kg / empty_kg);
    if (i == 0) {
      const double released_kg = empty_kg + BuildBurn(stage, 1.0, 1.0).Propellant(vehicle.hold_down_s);
      const double against_air_n = SitePressure(vehicle.site.altitude_m) * stage.motor.nozzle_exit_area_m2;
      one.thrust_to_weight = (thrust_n - against_air_n) / (released_kg * kStandardGravity);
    } else {
      one.thrust_to_weight = thrust_n / (stage.liftoff_mass_kg * kStandardGravity);
    }
    one.burnout_load_g = thrust_n / (empty_kg * kStandardGravity);
    all.push_back(one);
  }
  return all;
}

}  // namespace dispersa
