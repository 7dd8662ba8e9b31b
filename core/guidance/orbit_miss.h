// By how much an injection misses its target, in the order in which it matters: energy, path, plane.
#pragma once

#include "core/guidance/predictor.h"

namespace dispersa {

/// Reached minus wanted, in m/s at the target's speed.
struct OrbitMiss {
  double energy_m_s = 0.0;  ///< orbital energy over speed: 1 m/s is 1.8 km of semi-major axis at 500 km
  double radial_m_s = 0.0;  ///< of the eccentricity vector, e sin(true anomaly): of the vertical speed
  double shape_m_s = 0.0;   ///< and e cos(true anomaly)
  double plane_m_s = 0.0;   ///< inclination
};

/// The wanted shape is the target's if the orbit has the target's energy. Else it is that of the orbit with
/// the target's perigee. Near a circular target no lower orbit has this perigee: then it is the circle. About
/// a point mass.
OrbitMiss OrbitMissOf(const GuidanceMission& mission, const Injection& reached);

}  // namespace dispersa
