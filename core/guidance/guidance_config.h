// How a flight is guided, as its campaign says: plain data, SI and radians.
#pragma once

#include "core/math/constants.h"

namespace dispersa {

struct GuidanceConfig {
  bool closed_loop = false;      ///< else the reference's attitude and ignition time are flown as they are
  bool steers_last_burn = true;  ///< else that burn is flown as it was planned at its ignition
  double period_s = 1.0;         ///< between two solutions while a motor burns
  /// Of the commanded attitude under thrust, which the gimbals follow.
  double turn_rate_rad_s = 3.0 * kRadPerDeg;
  double turn_acceleration_rad_s2 = 2.0 * kRadPerDeg;
  /// And in the coast, where reaction control follows.
  double coast_rate_rad_s = 0.5 * kRadPerDeg;
  double coast_acceleration_rad_s2 = 0.05 * kRadPerDeg;
  /// The last stage ignites only with attitude and rate this near to what is commanded.
  double settled_angle_rad = 0.25 * kRadPerDeg;
  double settled_rate_rad_s = 0.2 * kRadPerDeg;
};

}  // namespace dispersa
