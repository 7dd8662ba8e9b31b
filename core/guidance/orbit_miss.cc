#include "core/guidance/orbit_miss.h"

#include <cmath>

#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

// From this eccentricity on the perigee is kept when energy is missing; below, in proportion.
constexpr double kElliptic = 0.01;
// Below this eccentricity the eccentricity vector has no direction to speak of.
constexpr double kTurns = 0.001;

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

// The angle from the ascending node along the orbit to the place.
double ArgumentOfLatitude(const Vector3& p, const Vector3& v) {
  const Vector3 h = p.cross(v);
  const Vector3 towards_node(-h.y(), h.x(), 0.0);
  return Atan2(p.dot(h.cross(towards_node)), h.norm() * p.dot(towards_node));
}

// Part by which an eccentricity grows so that the perigee stays, if energy is missing.
double KeepsPerigee(double eccentricity, double missing_of_energy) {
  return 1.0 + (1.0 - eccentricity) / std::fmax(eccentricity, kElliptic) * missing_of_energy;
}

// From -pi to pi.
double Wrapped(double angle_rad) { return angle_rad - kTwoPi * std::floor(angle_rad / kTwoPi + 0.5); }

double NodeMiss(const GuidanceMission& mission, const Injection& reached) {
  if (!mission.node_rad) return 0.0;
  const Vector3 h = reached.p_EoC_I.cross(reached.v_IC_I);
  return mission.target.velocity_m_s * Sin(mission.target.inclination_rad) *
         Wrapped(Atan2(h.x(), -h.y()) - *mission.node_rad);
}

OrbitMiss MissOfOrbit(const GuidanceMission& mission, const Injection& reached) {
  const TargetOrbit& orbit = *mission.orbit;
  const double mu = mission.earth.mu_m3_s2, speed = mission.target.velocity_m_s;
  const Shape is = ShapeOf(mu, reached.radius_m, reached.at.velocity_m_s, reached.at.flight_path_angle_rad);
  const double energy_m2_s2 = -0.5 * mu / orbit.semi_major_axis_m;
  const double missing = is.energy_m2_s2 - energy_m2_s2;
  const double eccentricity =
      orbit.eccentricity * KeepsPerigee(orbit.eccentricity, missing / std::fabs(energy_m2_s2));
  double along = eccentricity, across = 0.0, place_rad = 0.0;
  std::optional<double> size_m_s;
  if (orbit.argument_of_perigee_rad) {
    const double from_perigee_rad =
        ArgumentOfLatitude(reached.p_EoC_I, reached.v_IC_I) - *orbit.argument_of_perigee_rad;
    const SinCos anomaly = SineCosine(from_perigee_rad);
    along = eccentricity * anomaly.cos;
    across = eccentricity * anomaly.sin;
    if (orbit.true_anomaly_rad) place_rad = Wrapped(from_perigee_rad - *orbit.true_anomaly_rad);
  } else if (const double size = Sqrt(Square(is.along) + Square(is.across)); size > 0.0) {
    along = eccentricity * is.along / size;
    across = eccentricity * is.across / size;
    if (eccentricity > kTurns) size_m_s = speed * (size - eccentricity);
    if (orbit.true_anomaly_rad)
      place_rad = orbit.eccentricity * Wrapped(Atan2(is.across, is.along) - *orbit.true_anomaly_rad);
  }
  return {missing / speed,
          speed * (is.across - across),
          speed * (is.along - along),
          size_m_s,
          is.along,
          is.across,
          speed * (reached.at.inclination_rad - mission.target.inclination_rad),
          NodeMiss(mission, reached),
          speed * place_rad};
}

}  // namespace

OrbitMiss OrbitMissOf(const GuidanceMission& mission, const Injection& reached) {
  if (mission.orbit) return MissOfOrbit(mission, reached);
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
  return {missing / speed,
          speed * (is.across - size * wanted.across),
          speed * (is.along - size * wanted.along),
          {},
          is.along,
          is.across,
          speed * (at.inclination_rad - target.inclination_rad),
          NodeMiss(mission, reached)};
}

}  // namespace dispersa
