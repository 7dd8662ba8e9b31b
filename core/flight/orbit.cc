#include "core/flight/orbit.h"

#include <limits>

#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

OrbitElements ElementsOf(const Earth& earth, const Vector3& p, const Vector3& v) {
  OrbitElements e;
  const double r = p.norm();
  e.radius_m = r;
  e.speed_m_s = v.norm();
  const Vector3 h = p.cross(v);
  e.flight_path_angle_rad = Atan2(p.dot(v), h.norm());
  const double node = Atan2(h.x(), -h.y());
  e.ascending_node_rad = h.x() == 0.0 && h.y() == 0.0 ? 0.0 : node < 0.0 ? node + kTwoPi : node;
  if (h.x() != 0.0 || h.y() != 0.0) {
    const Vector3 towards_node = Vector3(-h.y(), h.x(), 0.0).normalized();
    const double along = Atan2(p.dot(h.normalized().cross(towards_node)), p.dot(towards_node));
    e.argument_of_latitude_rad = along < 0.0 ? along + kTwoPi : along;
  }
  e.inclination_rad = Atan2(Sqrt(h.x() * h.x() + h.y() * h.y()), h.z());
  const double energy = 0.5 * e.speed_m_s * e.speed_m_s - earth.mu_m3_s2 / r;
  const Vector3 eccentricity_vector = v.cross(h) / earth.mu_m3_s2 - p / r;
  const double eccentricity = eccentricity_vector.norm();
  e.true_anomaly_rad = Atan2(p.dot(v) * h.norm(), h.squaredNorm() - earth.mu_m3_s2 * r);
  const double perigee = h.squaredNorm() / earth.mu_m3_s2 / (1.0 + eccentricity);
  e.perigee_altitude_m = perigee - earth.equatorial_radius_m;
  e.apogee_altitude_m = energy < 0.0 ? -earth.mu_m3_s2 / energy - perigee - earth.equatorial_radius_m
                                     : std::numeric_limits<double>::infinity();
  return e;
}

}  // namespace dispersa
