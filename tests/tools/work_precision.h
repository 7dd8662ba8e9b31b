// Work and precision of the integration of a whole closed-loop flight.
#pragma once

#include <string>
#include <vector>

#include "core/dynamics/integrator.h"

namespace dispersa {

/// One way to integrate one flight; differences against CVODE (relative tolerance 1e-12) on the same tick, so
/// that only the integration differs, never the controller.
struct WorkPoint {
  std::string flight;  ///< "nominal" or "table3", every dispersion of Table 3 at its full size
  double tick_s = 0.0;
  Scheme scheme = Scheme::kSimpson;
  int steps = 0;  ///< a tick; 0 of CVODE, which chooses its own
  double cpu_s = 0.0;
  double altitude_difference_m = 0.0;       ///< at injection
  double velocity_difference_m_s = 0.0;     ///< likewise
  double pitch_error_difference_deg = 0.0;  ///< the largest over the flight, at steps of 0.1 s
  double pitch_error_rms_deg = 0.0;
  double pitch_error_peak_deg = 0.0;
};

inline constexpr double kShippedTick_s = 0.01;
inline constexpr int kShippedSteps = 1;
inline bool IsShipped(const WorkPoint& p) {
  return p.tick_s == kShippedTick_s && p.scheme == Scheme::kSimpson && p.steps == kShippedSteps;
}

/// The shipped scheme with 1, 2 and 4 steps a tick for ticks of 2.5 to 20 ms, under the shipped autopilot; on
/// its tick the classical Runge-Kutta method besides. `campaigns` is the folder of the shipped campaigns.
/// Takes minutes.
std::vector<WorkPoint> MeasureWorkPrecision(const std::string& campaigns);

std::string WorkPrecisionCsv(const std::vector<WorkPoint>& points);

}  // namespace dispersa
