// The fall of a body without thrust: a point mass with drag, in the air and winds of its flight.
#pragma once

#include <optional>

#include "core/dynamics/air_data.h"
#include "core/math/linear.h"

namespace dispersa {

/// A falling body. It is taken to tumble, so that lift and attitude do not matter.
struct FallingBody {
  double mass_kg = 0.0;
  double drag_area_m2 = 0.0;  ///< drag coefficient times area; 0: no drag
  /// Of a parachute, in addition: it opens at once, in descent, at or below its altitude.
  double parachute_drag_area_m2 = 0.0;
  double parachute_altitude_m = 0.0;
};

/// Drag area (m²) of a randomly tumbling cylinder: coefficient 0.7198 + 0.3260 d / l on the area l d. Source:
/// E. D. Klett, "Drag coefficients and heating ratios for right circular cylinders in free-molecular and
/// continuum flow from Mach 10 to 30", SC-RR-64-2141, Sandia 1964, as NASA's re-entry tools use it.
///
/// The formula is valid for continuum flow at Mach 10 to 30 and for l > d. It is used here at every Mach
/// number. In the last, slow part of a fall the drag is then wrong by some tens of per cent.
double TumblingCylinderDragArea(double length_m, double diameter_m);

struct FallState {
  double time_s = 0.0;  ///< since lift-off, at which I and E coincide
  Vector3 p_EoP_I = Vector3::Zero();
  Vector3 v_IP_I = Vector3::Zero();
};

struct Impact {
  double time_s = 0.0;
  Geodetic place;          ///< on the ground; Earth-fixed longitude
  double speed_m_s = 0.0;  ///< over the ground
  double peak_altitude_m = 0.0;
};

struct FallSteps {
  double air_s = 0.2;     ///< below kFallAir_m
  double vacuum_s = 1.0;  ///< above
};
inline constexpr double kFallAir_m = 130000.0;
inline constexpr double kFallLimit_s = 14400.0;
/// A step under an open parachute is at most this over the rate at which its drag brakes: well within the
/// stability of the method (2.78), and short enough for a fall speed that is right to 1e-4.
inline constexpr double kParachuteStep = 0.25;

/// The point at which a body meets the ellipsoid. Forces: gravitation with J2, drag in the environment's air
/// and wind. Method: classical Runge-Kutta of fourth order; the last step ends on the ground. None if the
/// body does not come down within kFallLimit_s, as in an orbit. A body that is on the ground already stays
/// where it is.
std::optional<Impact> Fall(const Environment& environment, const FallingBody& body, const FallState& start,
                           const FallSteps& steps = {});

/// Where altitude stops growing.
struct Apogee {
  double time_s = 0.0;
  double altitude_m = 0.0;  ///< geodetic
  Vector3 p_EoP_I = Vector3::Zero();
  Vector3 v_IP_I = Vector3::Zero();
};
/// The way of a body from a point, under the forces of Fall.
struct FallPath {
  std::optional<Apogee> apogee;  ///< the first one; none if the body only descends
  std::optional<Impact> impact;  ///< none if the path ends before
};
struct FallEnd {
  bool at_apogee = false;          ///< the path ends at the first apogee, else on the ground
  double ground_altitude_m = 0.0;  ///< geodetic
  double limit_s = kFallLimit_s;   ///< since the start
};
FallPath FollowFall(const Environment& environment, const FallingBody& body, const FallState& start,
                    const FallEnd& end, const FallSteps& steps = {});

}  // namespace dispersa
