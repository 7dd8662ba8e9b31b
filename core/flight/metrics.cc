#include "core/flight/metrics.h"

#include <algorithm>
#include <cassert>

namespace dispersa {

const std::vector<std::string>& MetricNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list = {"pitch_error_rms_deg", "pitch_error_peak_deg",
                                     "pitch_error_peak_time_s"};
    for (int stage = 1; stage <= kMaxStages; ++stage) {
      const std::string suffix = "_stage" + std::to_string(stage);
      list.push_back("pitch_error_rms" + suffix + "_deg");
      list.push_back("pitch_error_peak" + suffix + "_deg");
      list.push_back("pitch_error_peak_time" + suffix + "_s");
    }
    const std::vector<std::string> rest = {
        "pitch_error_rms_coast_deg", "pitch_error_peak_coast_deg", "pitch_error_peak_time_coast_s",
        "pitch_error_itae_deg_s2",
        "yaw_error_rms_deg", "yaw_error_peak_deg", "roll_error_rms_deg", "roll_error_peak_deg",
        "deflection_peak_deg", "deflection_rms_deg", "deflection_rate_peak_deg_s",
        "deflection_saturated_fraction", "deflection_travel_deg", "deflection_limit_cycle_deg",
        "q_max_pa", "q_alpha_max_pa_rad", "alpha_max_deg", "axial_load_max_g", "lateral_load_max_g",
        "structural_limit_exceeded",
        "handover_attitude_error_deg", "handover_rate_error_deg_s", "rcs_propellant_kg",
        "injection_altitude_km", "injection_velocity_m_s", "injection_flight_path_angle_deg",
        "apogee_km", "perigee_km", "inclination_deg",
        "injection_altitude_error_km", "injection_velocity_error_m_s",
        "injection_flight_path_angle_error_deg",
        "lyapunov_outside_fraction", "lyapunov_decreasing_fraction", "adaptation_norm_peak_deg_s2", "rules_fired"};
    list.insert(list.end(), rest.begin(), rest.end());
    return list;
  }();
  return names;
}

namespace {
constexpr const char* kOutcomeNames[kOutcomeCount] = {
    "completed", "lost_control", "structural_limit", "impact", "numerical_failure", "timeout"};
}

std::size_t MetricColumn(const std::string& name) {
  const std::vector<std::string>& names = MetricNames();
  const auto found = std::find(names.begin(), names.end(), name);
  assert(found != names.end());
  return static_cast<std::size_t>(found - names.begin());
}

const char* OutcomeName(Outcome outcome) { return kOutcomeNames[static_cast<int>(outcome)]; }

bool ParseOutcome(const std::string& name, Outcome* outcome) {
  for (int i = 0; i < kOutcomeCount; ++i) {
    if (name != kOutcomeNames[i]) continue;
    *outcome = static_cast<Outcome>(i);
    return true;
  }
  return false;
}

}  // namespace dispersa
