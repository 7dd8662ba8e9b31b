// What a flight has accumulated for its metrics, as plain numbers: filled by the engine lane by lane, read
// once when the flight ends. Angles in rad.
#pragma once

#include <cstdint>

#include "core/flight/orbit.h"
#include "core/guidance/outcome.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

/// Of a signed angle over ticks.
struct ErrorSums {
  double squares = 0.0;
  double peak = -1.0;        ///< largest magnitude; negative without ticks
  double peak_time_s = 0.0;  ///< when it was first reached
  double count = 0.0;
};

struct FlightSums {
  ErrorSums pitch[kMaxStages];  ///< powered flight, by stage
  ErrorSums coast;              ///< pitch
  ErrorSums yaw, roll;          ///< powered flight
  ErrorSums deflection;         ///< each nozzle counts
  double itae_rad_s2 = 0.0;
  double deflection_rate_peak_rad_s = 0.0;
  double saturated_ticks = 0.0;
  double travel_rad = 0.0;
  double ripple_rad = -1.0;       ///< negative without a whole window
  double limit_cycle_rad = -1.0;  ///< likewise; 0: none
  double q_max_pa = 0.0, q_alpha_max_pa_rad = 0.0, alpha_max_rad = 0.0;
  double axial_load_max_g = 0.0, lateral_load_max_g = 0.0;
  double bending_moment_max_n_m = 0.0, bending_moment_station_m = 0.0;
  bool handed_over = false;
  double handover_angle_rad = 0.0, handover_rate_rad_s = 0.0;
  double expelled_kg = 0.0;
  bool injected = false;
  double injection_altitude_m = 0.0;
  OrbitElements orbit;
  GuidanceOutcome guidance;  ///< of a flight that is guided
  double v_outside_ticks = 0.0, v_falling_ticks = 0.0;
  double adaptation_peak_rad_s2 = 0.0;
  std::uint32_t rules_fired = 0;
};

/// Of all stages together; a peak that several share is the first one's.
ErrorSums Total(const ErrorSums (&stages)[kMaxStages]);
}  // namespace dispersa
