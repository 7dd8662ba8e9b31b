// A potential with gravitation as its gradient: a reference that is independent of the product's gravitation.
#pragma once

#include <cmath>

#include "core/environment/earth.h"

namespace dispersa {

/// m²/s², positive, zero at infinity.
inline double GravitationalPotential(const Earth& earth, const Vector3& p_EoP) {
  const double r2 = p_EoP.squaredNorm();
  const double oblate = 0.5 * earth.j2 * earth.equatorial_radius_m * earth.equatorial_radius_m / r2;
  return earth.mu_m3_s2 / std::sqrt(r2) * (1.0 - oblate * (3.0 * p_EoP.z() * p_EoP.z() / r2 - 1.0));
}

}  // namespace dispersa
