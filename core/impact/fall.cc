#include "core/impact/fall.h"

#include <algorithm>

namespace dispersa {
namespace {

struct Motion {
  Vector3 p, v;
};

class Faller {
 public:
  Faller(const Environment& environment, const FallingBody& body)
      : environment_(environment),
        drag_per_mass_(body.mass_kg > 0.0 ? body.drag_area_m2 / body.mass_kg : 0.0) {}

  double Altitude(const Motion& at) const { return ToGeodetic(environment_.earth, at.p).altitude_m; }

  /// The Earth is symmetric about its axis, so the motion does not depend on time.
  Motion Step(const Motion& y, double step_s) const {
    const Motion k1 = Rate(y);
    const Motion k2 = Rate(Moved(y, k1, 0.5 * step_s));
    const Motion k3 = Rate(Moved(y, k2, 0.5 * step_s));
    const Motion k4 = Rate(Moved(y, k3, step_s));
    return {y.p + step_s / 6.0 * (k1.p + 2.0 * k2.p + 2.0 * k3.p + k4.p),
            y.v + step_s / 6.0 * (k1.v + 2.0 * k2.v + 2.0 * k3.v + k4.v)};
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
  double drag_per_mass_;
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
  const Faller faller(environment, body);
  Motion now{start.p_EoP_I, start.v_IP_I};
  double altitude_m = faller.Altitude(now);
  double peak_m = altitude_m;
  if (altitude_m <= 0.0) return ImpactAt(environment, now, start.time_s, peak_m);
  for (double time_s = start.time_s; time_s < start.time_s + kFallLimit_s;) {
    const double step_s = altitude_m < kFallAir_m ? steps.air_s : steps.vacuum_s;
    const Motion next = faller.Step(now, step_s);
    const double next_m = faller.Altitude(next);
    if (next_m <= 0.0) {
      // The length of the last step, in (0, step_s): secant method between a point above the ground and one
      // below.
      double low_s = 0.0, low_m = altitude_m, high_s = step_s, high_m = next_m;
      Motion ground = next;
      double part_s = step_s;
      for (int i = 0; i < 50 && high_s - low_s > 1e-9; ++i) {
        part_s = low_s + (high_s - low_s) * low_m / (low_m - high_m);
        ground = faller.Step(now, part_s);
        const double at_m = faller.Altitude(ground);
        if (at_m > -1e-6 && at_m < 1e-6) break;
        (at_m > 0.0 ? low_s : high_s) = part_s;
        (at_m > 0.0 ? low_m : high_m) = at_m;
      }
      return ImpactAt(environment, ground, time_s + part_s, peak_m);
    }
    now = next;
    altitude_m = next_m;
    peak_m = std::max(peak_m, altitude_m);
    time_s += step_s;
  }
  return std::nullopt;
}

}  // namespace dispersa
