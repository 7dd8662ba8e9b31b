// The launch-inertial frame L of attitude_program.h in the inertial frame I.
#pragma once

#include "core/environment/earth.h"
#include "core/math/rotation.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

struct LaunchFrame {
  Vector3 p_EoL_I = Vector3::Zero();   ///< the launch site at lift-off
  Vector3 v_IL_I = Vector3::Zero();    ///< its velocity, which the Earth carries
  Matrix3 R_IL = Matrix3::Identity();  ///< columns: downrange, right, down
  Quaternion q_IL;
};

/// I and E coincide at lift-off, time 0.
LaunchFrame BuildLaunchFrame(const Earth& earth, const LaunchSite& site, double azimuth_rad);

}  // namespace dispersa
