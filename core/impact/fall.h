// The fall of what flies on without thrust: a point mass with drag, in the air and winds of its flight.
#pragma once

#include <optional>

#include "core/dynamics/air_data.h"
#include "core/math/linear.h"

namespace dispersa {

/// What falls. It tumbles, so that no lift and no attitude matter.
struct FallingBody {
  double mass_kg = 0.0;
  double drag_area_m2 = 0.0;  ///< drag coefficient times area; 0: no drag
};

/// Drag area of a randomly tumbling cylinder: coefficient 0.7198 + 0.3260 d / l on the area l d (E. D. Klett,
/// "Drag coefficients and heating ratios for right circular cylinders in free-molecular and continuum flow
/// from Mach 10 to 30", SC-RR-64-2141, Sandia 1964, as NASA's re-entry tools use it). For continuum flow at
/// Mach 10 to 30 and l > d; taken for every Mach number, which misjudges the last, slow part of a fall by
/// some tens of per cent of its drag.
double TumblingCylinderDragArea(double length_m, double diameter_m);

struct FallState {
  double time_s = 0.0;  ///< since lift-off, when I and E coincided
  Vector3 p_EoP_I = Vector3::Zero();
  Vector3 v_IP_I = Vector3::Zero();
};

struct Impact {
  double time_s = 0.0;
  Geodetic place;          ///< on the ellipsoid; longitude fixed to the Earth
  double speed_m_s = 0.0;  ///< over the ground
  double peak_altitude_m = 0.0;
};

struct FallSteps {
  double air_s = 0.2;     ///< below kFallAir_m
  double vacuum_s = 1.0;  ///< above
};
inline constexpr double kFallAir_m = 130000.0;
inline constexpr double kFallLimit_s = 14400.0;

/// Where a body meets the ellipsoid: gravitation with J2, drag in the environment's air and wind, by the
/// classical Runge-Kutta method of fourth order; the last step ends on the ground. None within kFallLimit_s:
/// it is in orbit. A body that is on the ground already stays where it is.
std::optional<Impact> Fall(const Environment& environment, const FallingBody& body, const FallState& start,
                           const FallSteps& steps = {});

}  // namespace dispersa
