#include "core/guidance/orbit_miss.h"

#include <cmath>

#include "core/math/functions.h"

namespace dispersa {

namespace {

// From this eccentricity on the perigee is kept when energy is missing; below, in proportion.
constexpr double kElliptic = 0.01;

// Energy a unit of mass, and the eccentricity vector along the radius and against the path.
struct Shape {
  double energy_m2_s2, along, across;
};
Shape ShapeOf(double mu_m3_s2, double radius_m, double velocity_m_s, double flight_path_angle_rad) {
  const SinCos angle = SineCosine(flight_path_angle_rad);
  const double ratio = radius_m * Square(velocity_m_s) / mu_m3_s2;
  return {0.5 * Square(velocity_m_s) - mu_m3_s2 / radius_m, ratio * Square(angle.cos) - 1.0,
          ratio * angle.sin * angle.cos};
}

}  // namespace

OrbitMiss OrbitMissOf(const GuidanceMission& mission, const Injection& reached) {
  const Arrival &at = reached.at, &target = mission.target;
  const double mu = mission.earth.mu_m3_s2, speed = target.velocity_m_s;
  const Shape is = ShapeOf(mu, reached.radius_m, at.velocity_m_s, at.flight_path_angle_rad);
  // The target's altitude above the same place.
  const Shape wanted =
      ShapeOf(mu, reached.radius_m - at.altitude_m + target.altitude_m, speed, target.flight_path_angle_rad);
  const double missing = is.energy_m2_s2 - wanted.energy_m2_s2;
  const double eccentricity = Sqrt(Square(wanted.along) + Square(wanted.across));
  // Of a (1 - e) with a in proportion to the energy, over e.
  const double keeps_perigee = (1.0 - eccentricity) / std::fmax(eccentricity, kElliptic);
  const double size = 1.0 + keeps_perigee * missing / std::fabs(wanted.energy_m2_s2);
  return {missing / speed, speed * (is.across - size * wanted.across),
          speed * (is.along - size * wanted.along), speed * (at.inclination_rad - target.inclination_rad)};
}

}  // namespace dispersa
