// The optimal results that the paper prints in its Table 2, and the orbit that it asks for.
#pragma once

#include <cmath>

#include "core/trajectory/reference.h"

namespace dispersa {

inline constexpr double kPaperHeight_km = 500.406;
inline constexpr double kPaperVelocity_m_s = 7612.585;
inline constexpr double kPaperAngle_deg = 0.0000055;

/// Whether a problem's target is the paper's: 500 km, 7612.60 m/s, 0°.
inline bool IsPaperTarget(const TrajectoryProblem& problem) {
  return problem.velocity_reserve_m_s == 0.0 && problem.target_altitude_m == 500e3 &&
         std::fabs(problem.target_velocity_m_s - 7612.60) < 1e-9 &&
         problem.target_flight_path_angle_rad == 0.0;
}

}  // namespace dispersa
