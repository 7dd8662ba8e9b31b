// What a flight tells of its rail, its stages without control, and its way after the last burn.
#pragma once

#include <cmath>

namespace dispersa {

struct FreeFlightSums {
  bool left_rail = false;
  double rail_exit_time_s = 0.0, rail_exit_speed_m_s = 0.0, rail_exit_incidence_rad = 0.0;
  double roll_rate_peak_rad_s = -1.0;     ///< while a stage without gimbal flies; negative without one
  double least_static_margin = HUGE_VAL;  ///< diameters, where there is air; infinite without any
  bool has_apogee = false;
  double apogee_time_s = 0.0, apogee_altitude_m = 0.0;
  bool has_impact = false;
  double impact_time_s = 0.0, impact_latitude_rad = 0.0, impact_longitude_rad = 0.0;
  double impact_downrange_m = 0.0, impact_crossrange_m = 0.0, impact_speed_m_s = 0.0;
};

}  // namespace dispersa
