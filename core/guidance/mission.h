// Data that the guidance of every flight of a campaign has before lift-off: the nominal motors and masses of
// the last two stages, the reference's attitude, and the target.
#pragma once

#include <vector>

#include "core/environment/earth.h"
#include "core/guidance/guidance_config.h"
#include "core/guidance/guidance_limits.h"
#include "core/math/linear.h"
#include "core/vehicle/propulsion.h"

namespace dispersa {

/// The target of a flight: geodetic altitude, inertial speed, inertial flight path angle, inclination.
struct Arrival {
  double altitude_m = 0.0;
  double velocity_m_s = 0.0;
  double flight_path_angle_rad = 0.0;
  double inclination_rad = 0.0;
};

/// Direction of body x in the launch-inertial frame L: R_LB = Ry(pitch) Rz(yaw) Rx(roll).
struct Direction {
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
};
/// Body x in L.
Vector3 UnitVector(const Direction& direction);

/// The reference's attitude on an even grid, linear between and held outside.
struct DirectionTable {
  double start_s = 0.0;
  double step_s = 1.0;
  std::vector<Direction> at;  ///< two at least

  Direction At(double time_s) const;
  /// Its slope, rad/s; 0 outside the table.
  Direction RateAt(double time_s) const;
};

/// A stack with its motor as the documents give them.
struct GuidedStage {
  MotorBurn burn;
  double ignition_mass_kg = 0.0;  ///< with everything above
  bool loses_mass = false;        ///< the reference lets go of something while it burns
};

struct GuidanceMission {
  GuidanceConfig config;
  GuidanceLimits limits;
  Earth earth = Wgs84();
  Matrix3 R_IL = Matrix3::Identity();
  Arrival target;
  GuidedStage below;  ///< the stage before the last
  GuidedStage last;
  double last_ignition_s = 0.0;       ///< of the reference
  double velocity_reserve_m_s = 0.0;  ///< by which the reference arrives faster than the target
  DirectionTable program;             ///< from the ignition of the stage before the last on
};

/// Ideal velocity change of a burn.
double IdealVelocity(const GuidedStage& stage);

}  // namespace dispersa
