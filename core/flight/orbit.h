// Two-body elements of a state: what injection is judged by.
#pragma once

#include "core/environment/earth.h"
#include "core/math/linear.h"

namespace dispersa {

struct OrbitElements {
  double speed_m_s = 0.0;              ///< inertial
  double flight_path_angle_rad = 0.0;  ///< inertial, above the plane normal to the radius
  double inclination_rad = 0.0;
  double apogee_altitude_m = 0.0;   ///< above the equatorial radius, infinite if unbound
  double perigee_altitude_m = 0.0;  ///< negative when the orbit meets the Earth
  double radius_m = 0.0;            ///< of the place
  double ascending_node_rad = 0.0;  ///< from I's x axis, 0 to 2 pi (0 for an equatorial orbit)
  double argument_of_latitude_rad =
      0.0;                        ///< of the place, from the node, 0 to 2 pi (0 for an equatorial orbit)
  double true_anomaly_rad = 0.0;  ///< of the place, from the perigee, -pi to pi (0 for a circle)
};

/// Osculating Keplerian elements about a point mass at the Earth's centre.
OrbitElements ElementsOf(const Earth& earth, const Vector3& p_EoP_I, const Vector3& v_IP_I);

}  // namespace dispersa
