// By how much an injection misses its target, in the order in which it matters: energy, path, plane, place.
#pragma once

#include <optional>

#include "core/guidance/predictor.h"

namespace dispersa {

/// Reached minus wanted, in m/s at the target's speed.
struct OrbitMiss {
  double energy_m_s = 0.0;  ///< orbital energy over speed: 1 m/s is 1.8 km of semi-major axis at 500 km
  double radial_m_s = 0.0;  ///< of the eccentricity vector, e sin(true anomaly): of the vertical speed
  double shape_m_s = 0.0;   ///< and e cos(true anomaly)
  /// Where the perigee may turn in its plane, both are one: the length of the eccentricity vector.
  std::optional<double> size_m_s = {};
  double along = 0.0, across = 0.0;  ///< the vector that is reached
  double plane_m_s = 0.0;            ///< inclination
  // Of targets that name a node or a true anomaly, else 0.
  double node_m_s = 0.0;   ///< the plane's turn about the Earth's axis, times sine of inclination
  double place_m_s = 0.0;  ///< along the orbit
};

/// The wanted shape is the target's if the orbit has the target's energy. Else it is that of the orbit with
/// the target's perigee. Near a circular target no lower orbit has this perigee: then it is the circle. About
/// a point mass.
///
/// The plane is two angles, inclination and node. Both together are the angle between the planes, so they
/// count alike. A place comes last, because a wait in orbit corrects it. With an argument of perigee the
/// place is an angle from the node. Without one it is an angle from the perigee, and only the ellipse's turn
/// in its plane is missed: times eccentricity.
OrbitMiss OrbitMissOf(const GuidanceMission& mission, const Injection& reached);

}  // namespace dispersa
