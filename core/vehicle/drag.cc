#include "core/vehicle/drag.h"

#include <algorithm>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/table.h"

namespace dispersa {
namespace {

double ConeDragSupersonic(double mach, double sine) {
  return 2.1 * Square(sine) + 0.5 * sine / Sqrt(Square(mach) - 1.0);
}

}  // namespace

double ReferenceUnitReynoldsNumber(double mach) {
  // Speed of sound over kinematic viscosity of US76 at the altitudes of the schedule, per metre.
  static const Table1D log_per_mach = [] {
    Table1D table{{0.0, 0.3, 0.8, 1.2, 2.0, 3.0, 5.0, 8.0},
                  {2.3296e7, 2.1276e7, 1.4498e7, 9.5080e6, 4.0423e6, 1.3350e6, 2.3518e5, 1.1118e4}};
    for (double& value : table.y) value = Log(value);
    return table;
  }();
  return mach * Exp(log_per_mach(mach));
}

double SkinFrictionCoefficient(double mach, double length_m, double roughness_m) {
  const double m = std::max(mach, 0.1);
  double reynolds = ReferenceUnitReynoldsNumber(m) * length_m;
  if (roughness_m > 0.0) {
    const double factor = std::max(38.21, 44.62 * Pow(m, 1.16));
    reynolds = std::min(reynolds, factor * Pow(length_m / roughness_m, 1.053));
  }
  reynolds = std::max(reynolds, 1e5);
  return 0.455 / Pow(Log10(reynolds), 2.58) / Pow(1.0 + 0.144 * Square(m), 0.65);
}

double ConePressureDrag(double mach, double sin_half_angle, double incompressible) {
  constexpr double kJoinMach = 1.3;
  const double sonic = sin_half_angle;
  const double sonic_slope = 4.0 / 2.4 * (1.0 - 0.5 * sonic);
  if (mach >= kJoinMach) return ConeDragSupersonic(mach, sin_half_angle);
  if (mach <= 1.0) {
    const double rise = sonic - incompressible;
    if (!(rise > 0.0) || !(mach > 0.0)) return incompressible;
    return incompressible + rise * Pow(mach, sonic_slope / rise);
  }
  const double join = ConeDragSupersonic(kJoinMach, sin_half_angle);
  const double join_slope = -0.5 * sin_half_angle * kJoinMach / Pow(Square(kJoinMach) - 1.0, 1.5);
  const double width = kJoinMach - 1.0;
  const double t = (mach - 1.0) / width;
  // The cubic Hermite polynomial through both ends with their slopes.
  return sonic * (1.0 + 2.0 * t) * Square(1.0 - t) + join * (3.0 - 2.0 * t) * Square(t) +
         width * t * (1.0 - t) * (sonic_slope * (1.0 - t) - join_slope * t);
}

double FlatFaceDrag(double mach) {
  const double m2 = Square(mach);
  const double stagnation = mach < 1.0 ? 1.0 + m2 / 4.0 + Square(m2) / 40.0
                                       : 1.84 - 0.76 / m2 + 0.166 / Square(m2) + 0.035 / (m2 * Square(m2));
  return 0.85 * stagnation;
}

double BaseDrag(double mach) { return mach < 1.0 ? 0.12 + 0.13 * Square(mach) : 0.25 / mach; }

double PressureDragArea(const MouldSection& section, double mach) {
  const double rise_m = section.aft_radius_m - section.fore_radius_m;
  const double length_m = section.end_m - section.start_m;
  const double gain_m2 = kPi * (Square(section.aft_radius_m) - Square(section.fore_radius_m));
  if (rise_m >= 0.0) {
    const double sine = rise_m / Sqrt(Square(rise_m) + Square(length_m));
    const double incompressible = section.IsCurved() ? 0.0 : 0.8 * Square(sine);
    return gain_m2 * ConePressureDrag(mach, sine, incompressible);
  }
  const double fineness = length_m / (-2.0 * rise_m);
  return -gain_m2 * BaseDrag(mach) * Clamp((3.0 - fineness) / 2.0, 0.0, 1.0);
}

}  // namespace dispersa
