// The Earth: shape, rotation, gravitation, and coordinates on it.
//
// E is fixed to the Earth: x through longitude 0 on the equator, z through the north pole. I is inertial
// and coincides with E at time 0. N is north, east, down at a place. Eo is the centre of the Earth.
#pragma once

#include "core/math/linear.h"

namespace dispersa {

struct Earth {
  double mu_m3_s2;
  double equatorial_radius_m;
  double flattening;
  double rotation_rate_rad_s;
  double j2;
};

/// WGS-84 (NIMA TR8350.2) with J2 = 1.08262982e-3 of EGM96, as NASA/TM-2015-218675 uses them.
Earth Wgs84();
/// A sphere with WGS-84's mu and no J2, rotating at WGS-84's rate or not at all.
Earth SphericalEarth(double radius_m, bool rotating);

/// Gravitation (m/s², without centrifugal term) at a position other than the centre: central term and J2. In
/// the axes of the position, E or I, which share z.
Vector3 Gravitation(const Earth& earth, const Vector3& p_EoP);

/// Latitude is that of the ellipsoid's normal. Altitude is measured along it above the ellipsoid.
struct Geodetic {
  double latitude_rad;
  double longitude_rad;  ///< (-pi, pi]
  double altitude_m;
};
/// Two steps of Bowring's iteration (Survey Review 28, 1985). From -100 km up the error is the rounding of a
/// double: below 2000 km at most 5e-9 m in altitude and 5e-16 rad in latitude. On the axis longitude is 0.
Geodetic ToGeodetic(const Earth& earth, const Vector3& p_EoP_E);
/// p_EoP_E, m.
Vector3 FromGeodetic(const Earth& earth, const Geodetic& place);

/// R_EN, shape (3, 3): columns north, east, down in E. With geodetic latitude, down is the normal of the
/// ellipsoid.
Matrix3 NedAxes(double latitude_rad, double longitude_rad);

/// Components in E of a vector given in I. It changes axes only: a velocity stays relative to I.
Vector3 InertialToEarth(const Earth& earth, double time_s, const Vector3& v_I);

}  // namespace dispersa
