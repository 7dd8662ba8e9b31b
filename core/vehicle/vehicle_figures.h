// What a vehicle's file amounts to: the figures by which an engineer recognises a launcher, or a slip of the
// pen.
#pragma once

#include <vector>

#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Of one stage, which carries all above it.
struct StageFigures {
  double own_mass_kg = 0.0;  ///< without what is above; the last one's with the payload
  double dry_mass_kg = 0.0;
  double structural_fraction = 0.0;  ///< dry mass / own mass
  double burning_time_s = 0.0;  ///< of a thrust curve or a liquid stage to its end, else propellant over flow
  double flow_kg_s = 0.0;       ///< at full thrust; of a thrust curve or a liquid stage its mean
  double specific_impulse_s = 0.0;  ///< in vacuum: impulse over the weight of the propellant
  double ideal_delta_v_m_s = 0.0;   ///< K. E. Tsiolkovsky's, in vacuum, without losses
  /// Full thrust over weight: where stage 1 is released (less the pressure of the site's air on the nozzles,
  /// after what the hold-down burns), else at ignition in vacuum. Of a thrust curve or throttle not the full
  /// thrust, but the greatest of the first second, in which motors reach theirs.
  double thrust_to_weight = 0.0;
  double burnout_load_g =
      0.0;  ///< full thrust over the weight of what is left; of a thrust curve the greatest
};

/// Of a vehicle without Problems().
std::vector<StageFigures> FiguresOf(const Vehicle& vehicle);

/// Pressure of the US Standard Atmosphere's lowest layer, Pa; of 11 km above that, since no site is.
double SitePressure(double altitude_m);

}  // namespace dispersa
