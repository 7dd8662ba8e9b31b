#include "core/trajectory/aim.h"

#include <cmath>

#include "core/environment/earth.h"
#include "core/math/assertion.h"
#include "core/math/functions.h"

namespace dispersa {

void AimAt(const TrajectoryProblem& problem, Vehicle& vehicle) {
  if (vehicle.stages.empty()) return;
  Motor& engine = vehicle.stages.back().motor;
  if (engine.cut_off != CutOff::kAtTarget || problem.velocity_is_free) return;
  AimedEnergy& aim = engine.aimed_energy;
  aim.is_known = true;
  aim.mu_m3_s2 = Wgs84().mu_m3_s2;
  aim.is_ellipse = problem.target_apogee_m.has_value();
  aim.altitude_m = problem.target_altitude_m;
  aim.velocity_m_s = problem.target_velocity_m_s;
  if (aim.is_ellipse) aim.energy_m2_s2 = -0.5 * aim.mu_m3_s2 / EllipseOf(problem).semi_major_axis_m;
}

AimedEllipse EllipseOf(const TrajectoryProblem& problem) {
  DISPERSA_ASSERT(problem.target_apogee_m.has_value());
  const double perigee_m = Wgs84().equatorial_radius_m + problem.target_altitude_m;
  const double apogee_m = Wgs84().equatorial_radius_m + *problem.target_apogee_m;
  return {0.5 * (perigee_m + apogee_m), (apogee_m - perigee_m) / (apogee_m + perigee_m)};
}

AimedPlace PlaceAimedAt(const TrajectoryProblem& problem) {
  DISPERSA_ASSERT(problem.target_true_anomaly_rad || !problem.is_entered_anywhere);
  const double mu = Wgs84().mu_m3_s2;
  const AimedEllipse ellipse = EllipseOf(problem);
  const SinCos anomaly = SineCosine(problem.target_true_anomaly_rad.value_or(0.0));
  const double e = ellipse.eccentricity, along = 1.0 + e * anomaly.cos;
  const double radius_m = ellipse.semi_major_axis_m * (1.0 - e * e) / along;
  return {radius_m - Wgs84().equatorial_radius_m,
          Sqrt(mu * (2.0 / radius_m - 1.0 / ellipse.semi_major_axis_m)), Atan2(e * anomaly.sin, along)};
}

double AimedAltitude(const TrajectoryProblem& problem) {
  return problem.target_true_anomaly_rad ? PlaceAimedAt(problem).altitude_m : problem.target_altitude_m;
}

PlaceInOrbit PlaceOf(const Orbit& orbit) {
  const double mu = Wgs84().mu_m3_s2;
  const SinCos angle = SineCosine(orbit.flight_path_angle_rad);
  const double ratio = orbit.radius_m * Square(orbit.velocity_m_s) / mu;
  const double along = ratio * Square(angle.cos) - 1.0, across = ratio * angle.sin * angle.cos;
  return {orbit.radius_m / (2.0 - ratio), Sqrt(Square(along) + Square(across)), Atan2(across, along)};
}

}  // namespace dispersa
