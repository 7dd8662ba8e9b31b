#include "core/vehicle/normal_force.h"

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/table.h"

namespace dispersa {

NormalForceSlope SlenderBody(const BodyIntegrals& body) {
  const double base_area_m2 = kPi * Square(body.base_radius_m);
  return {2.0 * base_area_m2, 2.0 * (base_area_m2 * body.length_m - body.volume_m3)};
}

double CrossFlowDrag(double cross_flow_mach) {
  static const Table1D curve{
      {0.0, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.4, 1.6, 2.0, 2.5, 3.0, 4.0, 6.0, 8.0},
      {1.20, 1.20, 1.24, 1.32, 1.42, 1.53, 1.64, 1.73, 1.79, 1.79, 1.73, 1.60, 1.51, 1.42, 1.36, 1.33, 1.30,
       1.28, 1.28}};
  return curve(cross_flow_mach);
}

double CrossFlowEndFactor(double fineness, double mach) {
  static const Table1D subsonic{{2.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0},
                                {0.56, 0.62, 0.68, 0.72, 0.75, 0.77, 0.79, 0.82}};
  const double t = Clamp((mach - 0.8) / 0.4, 0.0, 1.0);
  const double supersonic_share = t * t * (3.0 - 2.0 * t);
  const double eta = subsonic(fineness);
  return eta + (1.0 - eta) * supersonic_share;
}

}  // namespace dispersa
