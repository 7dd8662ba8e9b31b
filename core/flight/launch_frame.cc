#include "core/flight/launch_frame.h"

#include "core/math/functions.h"

namespace dispersa {

LaunchFrame BuildLaunchFrame(const Earth& earth, const LaunchSite& site, double azimuth_rad) {
  LaunchFrame frame;
  frame.p_EoL_I = FromGeodetic(earth, {site.latitude_rad, site.longitude_rad, site.altitude_m});
  frame.v_IL_I = Vector3(0.0, 0.0, earth.rotation_rate_rad_s).cross(frame.p_EoL_I);
  const Matrix3 R_IN = NedAxes(site.latitude_rad, site.longitude_rad);
  const SinCos azimuth = SineCosine(azimuth_rad);
  frame.R_IL.col(0) = azimuth.cos * R_IN.col(0) + azimuth.sin * R_IN.col(1);
  frame.R_IL.col(1) = azimuth.cos * R_IN.col(1) - azimuth.sin * R_IN.col(0);
  frame.R_IL.col(2) = R_IN.col(2);
  frame.q_IL = QuaternionOf(frame.R_IL);
  return frame;
}

}  // namespace dispersa
