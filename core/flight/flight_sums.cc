#include "core/flight/flight_sums.h"

#include <bit>
#include <cmath>
#include <limits>

#include "core/flight/flight_model.h"
#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

double Rms(const ErrorSums& e) { return e.count > 0.0 ? Sqrt(e.squares / e.count) * kDegPerRad : kUndefined; }
double Peak(const ErrorSums& e) { return e.count > 0.0 ? e.peak * kDegPerRad : kUndefined; }
double Ratio(double part, double whole) { return whole > 0.0 ? part / whole : kUndefined; }

void Append(const ErrorSums& e, std::vector<double>& m) {
  m.insert(m.end(), {Rms(e), Peak(e), e.count > 0.0 ? e.peak_time_s : kUndefined});
}

ErrorSums Total(const ErrorSums (&stages)[kMaxStages]) {
  ErrorSums total;
  for (const ErrorSums& stage : stages) {
    total.squares += stage.squares;
    total.count += stage.count;
    if (stage.peak <= total.peak) continue;
    total.peak = stage.peak;
    total.peak_time_s = stage.peak_time_s;
  }
  return total;
}

}  // namespace

bool ExceedsStructure(const StructuralLimits& limits, const FlightSums& sums) {
  const auto exceeded = [](double value, double limit) { return limit > 0.0 && value > limit; };
  return exceeded(sums.q_alpha_max_pa_rad, limits.q_alpha_pa_rad) ||
         exceeded(sums.axial_load_max_g, limits.axial_load_g) ||
         exceeded(sums.lateral_load_max_g, limits.lateral_load_g);
}

std::vector<double> MetricsOf(const FlightSums& s, const FlightDefinition& definition) {
  std::vector<double> m;
  const ErrorSums pitch = Total(s.pitch);
  Append(pitch, m);
  for (const ErrorSums& stage : s.pitch) Append(stage, m);
  Append(s.coast, m);
  m.push_back(s.itae_rad_s2 * kDegPerRad);
  m.insert(m.end(), {Rms(s.yaw), Peak(s.yaw), Rms(s.roll), Peak(s.roll)});
  m.insert(m.end(), {Peak(s.deflection), Rms(s.deflection), s.deflection_rate_peak_rad_s * kDegPerRad,
                     Ratio(s.saturated_ticks, pitch.count), s.travel_rad * kDegPerRad,
                     s.limit_cycle_rad >= 0.0 ? s.limit_cycle_rad * kDegPerRad : kUndefined});
  m.insert(m.end(), {s.q_max_pa, s.q_alpha_max_pa_rad, s.alpha_max_rad * kDegPerRad, s.axial_load_max_g,
                     s.lateral_load_max_g, ExceedsStructure(definition.vehicle.limits, s) ? 1.0 : 0.0});
  m.push_back(s.handed_over ? s.handover_angle_rad * kDegPerRad : kUndefined);
  m.push_back(s.handed_over ? s.handover_rate_rad_s * kDegPerRad : kUndefined);
  m.push_back(s.expelled_kg);

  const InjectionTarget& target = definition.target;
  const OrbitElements& e = s.orbit;
  for (const double value :
       {s.injection_altitude_m * 1e-3, e.speed_m_s, e.flight_path_angle_rad * kDegPerRad,
        e.apogee_altitude_m * 1e-3, e.perigee_altitude_m * 1e-3, e.inclination_rad * kDegPerRad,
        (s.injection_altitude_m - target.altitude_m) * 1e-3, e.speed_m_s - target.velocity_m_s,
        (e.flight_path_angle_rad - target.flight_path_angle_rad) * kDegPerRad})
    m.push_back(s.injected && std::isfinite(value) ? value : kUndefined);

  m.push_back(Ratio(s.v_outside_ticks, pitch.count));
  m.push_back(Ratio(s.v_falling_ticks, s.v_outside_ticks));
  m.push_back(s.adaptation_peak_rad_s2 * kDegPerRad);
  m.push_back(std::popcount(s.rules_fired));
  return m;
}

}  // namespace dispersa
