#include "core/dynamics/fall.h"

#include <algorithm>
#include <utility>

namespace dispersa {
namespace {

struct Motion {
  Vector3 p, v;
};

class Faller {
 public:
  Faller(const Environment& environment, const FallingBody& body)
      : environment_(environment),
        drag_per_mass_(body.mass_kg > 0.0 ? body.drag_area_m2 / body.mass_kg : 0.0),
        parachute_per_mass_(body.mass_kg > 0.0 ? body.parachute_drag_area_m2 / body.mass_kg : 0.0) {}

  bool has_parachute() const { return parachute_per_mass_ > 0.0; }
  void OpenParachute() { drag_per_mass_ += std::exchange(parachute_per_mass_, 0.0); }

  double Altitude(const Motion& at) const { return ToGeodetic(environment_.earth, at.p).altitude_m; }
  /// The growth of the altitude, m/s.
  double Climb(const Motion& at) const {
    const Geodetic place = ToGeodetic(environment_.earth, at.p);
    return -at.v.dot(Vector3(NedAxes(place.latitude_rad, place.longitude_rad).col(2)));
  }
  /// The rate at which drag brakes, 1/s.
  double Braking(const Motion& at) const {
    const AirData air = ComputeAirData(environment_, at.p, at.v);
    return air.density_kg_m3 * air.airspeed_m_s * drag_per_mass_;
  }

  /// The Earth is symmetric about its axis, so the motion does not depend on time.
  Motion Step(const Motion& y, double step_s) const {
    const Motion k1 = Rate(y);
    const Motion k2 = Rate(Moved(y, k1, 0.5 * step_s));
    const Motion k3 = Rate(Moved(y, k2, 0.5 * step_s));
    const Motion k4 = Rate(Moved(y, k3, step_s));
    return {y.p + step_s / 6.0 * (k1.p + 2.0 * k2.p + 2.0 * k3.p + k4.p),
            y.v + step_s / 6.0 * (k1.v + 2.0 * k2.v + 2.0 * k3.v + k4.v)};
  }

  /// The part of a step at whose end the altitude is `wanted_m`: secant method between a point above and one
  /// below. `at` receives the end.
  double PartTo(double wanted_m, const Motion& from, double from_m, const Motion& to, double to_m,
                double step_s, Motion& at) const {
    double low_s = 0.0, low_m = from_m - wanted_m, high_s = step_s, high_m = to_m - wanted_m;
    double part_s = step_s;
    at = to;
    for (int i = 0; i < 50 && high_s - low_s > 1e-9; ++i) {
      part_s = low_s + (high_s - low_s) * low_m / (low_m - high_m);
      at = Step(from, part_s);
      const double at_m = Altitude(at) - wanted_m;
      if (at_m > -1e-6 && at_m < 1e-6) break;
      (at_m > 0.0 ? low_s : high_s) = part_s;
      (at_m > 0.0 ? low_m : high_m) = at_m;
    }
    return part_s;
  }
  /// The part of a step, with a climb at its start and none at its end, at which the climb ends: bisection.
  double PartToApogee(const Motion& from, double step_s, Motion& at) const {
    double low_s = 0.0, high_s = step_s;
    for (int i = 0; i < 40; ++i) {
      const double middle_s = 0.5 * (low_s + high_s);
      (Climb(Step(from, middle_s)) > 0.0 ? low_s : high_s) = middle_s;
    }
    at = Step(from, high_s);
    return high_s;
  }

 private:
  static Motion Moved(const Motion& y, const Motion& rate, double step_s) {
    return {y.p + step_s * rate.p, y.v + step_s * rate.v};
  }
  Motion Rate(const Motion& y) const {
    Vector3 acceleration = Gravitation(environment_.earth, y.p);
    if (drag_per_mass_ > 0.0) {
      const AirData air = ComputeAirData(environment_, y.p, y.v);
      acceleration -= 0.5 * air.density_kg_m3 * air.airspeed_m_s * drag_per_mass_ * air.v_AP_I;
    }
    return {y.v, acceleration};
  }

  const Environment& environment_;
  double drag_per_mass_, parachute_per_mass_;
};

Impact ImpactAt(const Environment& environment, const Motion& at, double time_s, double peak_altitude_m) {
  Impact impact;
  impact.time_s = time_s;
  impact.place = ToGeodetic(environment.earth, InertialToEarth(environment.earth, time_s, at.p));
  const double omega = environment.earth.rotation_rate_rad_s;
  impact.speed_m_s = Vector3(at.v.x() + omega * at.p.y(), at.v.y() - omega * at.p.x(), at.v.z()).norm();
  impact.peak_altitude_m = peak_altitude_m;
  return impact;
}

}  // namespace

double TumblingCylinderDragArea(double length_m, double diameter_m) {
  return (0.7198 + 0.3260 * diameter_m / length_m) * length_m * diameter_m;
}

std::optional<Impact> Fall(const Environment& environment, const FallingBody& body, const FallState& start,
                           const FallSteps& steps) {
  return FollowFall(environment, body, start, {}, steps).impact;
}

FallPath FollowFall(const Environment& environment, const FallingBody& body, const FallState& start,
                    const FallEnd& end, const FallSteps& steps) {
  Faller faller(environment, body);
  Motion now{start.p_EoP_I, start.v_IP_I};
  double altitude_m = faller.Altitude(now);
  double peak_m = altitude_m;
  bool climbs = faller.Climb(now) > 0.0;
  FallPath path;
  if (altitude_m <= end.ground_altitude_m) {
    path.impact = ImpactAt(environment, now, start.time_s, peak_m);
    return path;
  }
  const double opens_m = body.parachute_altitude_m;
  bool is_open = !faller.has_parachute();
  for (double time_s = start.time_s; time_s < start.time_s + end.limit_s;) {
    if (!is_open && !climbs && altitude_m <= opens_m) {
      faller.OpenParachute();
      is_open = true;
    }
    double step_s = altitude_m < kFallAir_m ? steps.air_s : steps.vacuum_s;
    if (is_open && body.parachute_drag_area_m2 > 0.0) {
      const double braking_1_s = faller.Braking(now);
      if (braking_1_s * step_s > kParachuteStep) step_s = kParachuteStep / braking_1_s;
    }
    Motion next = faller.Step(now, step_s);
    double next_m = faller.Altitude(next);
    bool next_climbs = faller.Climb(next) > 0.0;
    if (climbs && !next_climbs && !path.apogee) {
      Motion at;
      const double part_s = faller.PartToApogee(now, step_s, at);
      path.apogee = {time_s + part_s, faller.Altitude(at), at.p, at.v};
      peak_m = std::max(peak_m, path.apogee->altitude_m);
      if (end.at_apogee) return path;
    }
    if (next_m <= end.ground_altitude_m) {
      // The length of the last step, in (0, step_s).
      Motion ground;
      const double part_s =
          faller.PartTo(end.ground_altitude_m, now, altitude_m, next, next_m, step_s, ground);
      path.impact = ImpactAt(environment, ground, time_s + part_s, peak_m);
      return path;
    }
    if (!is_open && !climbs && !next_climbs && next_m < opens_m) {
      step_s = faller.PartTo(opens_m, now, altitude_m, next, next_m, step_s, next);
      next_m = opens_m;  // to a micrometre: it opens here
      next_climbs = false;
    }
    now = next;
    altitude_m = next_m;
    climbs = next_climbs;
    peak_m = std::max(peak_m, altitude_m);
    time_s += step_s;
  }
  return path;
}

}  // namespace dispersa
