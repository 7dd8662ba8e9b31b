// Figures that follow from a vehicle's file. An engineer recognises a launcher, or a slip of the pen, by
// them.
#pragma once

#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Figures of one stage, which carries all stages above it.
struct StageFigures {
  double own_mass_kg = 0.0;  ///< without the stages above, for the last stage with the payload
  double dry_mass_kg = 0.0;
  double structural_fraction = 0.0;  ///< dry mass / own mass
  double burning_time_s = 0.0;  ///< of a thrust curve or a liquid stage to its end, else propellant over flow
  double flow_kg_s = 0.0;       ///< at full thrust, for a thrust curve or a liquid stage the mean
  double specific_impulse_s = 0.0;  ///< in vacuum: impulse over the weight of the propellant
  double ideal_delta_v_m_s = 0.0;   ///< K. E. Tsiolkovsky's, in vacuum, without losses
  /// Full thrust over weight. Stage 1: at release, less the pressure of the site's air on the nozzles, after
  /// the burn of the hold-down. Other stages: at ignition in vacuum. A thrust curve or throttle counts by its
  /// greatest thrust of the first second, in which motors reach full thrust.
  double thrust_to_weight = 0.0;
  double burnout_load_g =
      0.0;  ///< full thrust over the remaining weight, for a thrust curve its greatest value
};

/// Precondition: a vehicle without Problems().
std::vector<StageFigures> FiguresOf(const Vehicle& vehicle);

/// Pressure of the US Standard Atmosphere's lowest layer, Pa. Above 11 km, where no site is, that of 11 km.
double SitePressure(double altitude_m);

}  // namespace dispersa
