// The flight program's attitude: the reference attitude over time since lift-off.
//
// Frame L (launch-inertial) is frozen at lift-off. Its origin is the launch site: x is horizontal along the
// launch azimuth, y is horizontal to the right, z points down along the geodetic vertical. The attitude of
// the body in L is a 2-3-1 sequence: pitch about y, yaw about z, roll about x. Pitch is 90° at lift-off. The
// sequence stays regular through the whole flight. Euler angles against the local horizon do not.
#pragma once

#include <vector>

#include "core/math/rotation.h"

namespace dispersa {

/// One row of the program. Angles in rad, rates in rad/s (derivatives of the angles).
struct AttitudeKnot {
  double time_s = 0.0;
  double pitch = 0.0;
  double yaw = 0.0;
  double roll = 0.0;
  double pitch_rate = 0.0;
  double yaw_rate = 0.0;
  double roll_rate = 0.0;
};

/// Reference attitude and its angular velocity relative to L, in reference body axes R.
struct ReferenceAttitude {
  PitchYawRoll angles;
  Quaternion q_LR;
  Vector3 w_LR_R = Vector3::Zero();
};

/// Cubic Hermite interpolation between knots of strictly increasing time. Before the first knot and after the
/// last one the value is held.
struct AttitudeProgram {
  double launch_azimuth_rad = 0.0;
  std::vector<AttitudeKnot> knots;  ///< at least two

  ReferenceAttitude At(double time_s) const;
};

}  // namespace dispersa
