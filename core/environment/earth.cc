#include "core/environment/earth.h"

#include "core/math/functions.h"

namespace dispersa {
namespace {

// Bowring's iteration is Newton's: the first step leaves 3e-13 rad near the Earth, the second its rounding.
constexpr int kBowringSteps = 2;

}  // namespace

Earth Wgs84() { return {3.986004418e14, 6378137.0, 1.0 / 298.257223563, 7.292115e-5, 1.08262982e-3}; }

Earth SphericalEarth(double radius_m, bool rotating) {
  const Earth wgs84 = Wgs84();
  return {wgs84.mu_m3_s2, radius_m, 0.0, rotating ? wgs84.rotation_rate_rad_s : 0.0, 0.0};
}

Vector3 Gravitation(const Earth& earth, const Vector3& p_EoP) {
  const double r2 = p_EoP.squaredNorm();
  const double central = -earth.mu_m3_s2 / (r2 * Sqrt(r2));
  const double oblate = 1.5 * earth.j2 * Square(earth.equatorial_radius_m) / r2;
  const double polar = 5.0 * Square(p_EoP.z()) / r2;
  const double equatorial_factor = central * (1.0 - oblate * (polar - 1.0));
  const double polar_factor = central * (1.0 - oblate * (polar - 3.0));
  return {equatorial_factor * p_EoP.x(), equatorial_factor * p_EoP.y(), polar_factor * p_EoP.z()};
}

Geodetic ToGeodetic(const Earth& earth, const Vector3& p_EoP_E) {
  const double a = earth.equatorial_radius_m;
  const double aspect = 1.0 - earth.flattening;  // b / a
  const double b = a * aspect;
  const double e2 = earth.flattening * (2.0 - earth.flattening);  // first eccentricity squared
  const double axial = e2 * a / aspect;                           // e'² b
  const double equatorial = e2 * a;

  const double z = p_EoP_E.z();
  const double rho = Sqrt(Square(p_EoP_E.x()) + Square(p_EoP_E.y()));
  // Direction (c, s) of the parametric latitude; a pair instead of a tangent is regular at the poles. The
  // first guess is tan(beta) = b z / (a rho) (1 + e'² b / r).
  double c = a * rho;
  double s = b * z * (1.0 + axial / Sqrt(Square(rho) + Square(z)));
  double north = 0.0;
  double outward = 0.0;
  for (int step = 0; step < kBowringSteps; ++step) {
    const double inverse_length = 1.0 / Sqrt(Square(c) + Square(s));
    c *= inverse_length;
    s *= inverse_length;
    north = z + axial * s * s * s;
    outward = rho - equatorial * c * c * c;
    c = outward;
    s = aspect * north;
  }
  const double inverse_length = 1.0 / Sqrt(Square(outward) + Square(north));
  const double sin_latitude = north * inverse_length;
  const double cos_latitude = outward * inverse_length;
  const double altitude = rho * cos_latitude + z * sin_latitude - a * Sqrt(1.0 - e2 * Square(sin_latitude));
  return {Atan2(north, outward), Atan2(p_EoP_E.y(), p_EoP_E.x()), altitude};
}

Vector3 FromGeodetic(const Earth& earth, const Geodetic& place) {
  const SinCos latitude = SineCosine(place.latitude_rad);
  const SinCos longitude = SineCosine(place.longitude_rad);
  const double e2 = earth.flattening * (2.0 - earth.flattening);
  const double normal_radius = earth.equatorial_radius_m / Sqrt(1.0 - e2 * Square(latitude.sin));
  const double rho = (normal_radius + place.altitude_m) * latitude.cos;
  return {rho * longitude.cos, rho * longitude.sin,
          (normal_radius * (1.0 - e2) + place.altitude_m) * latitude.sin};
}

Matrix3 NedAxes(double latitude_rad, double longitude_rad) {
  const SinCos latitude = SineCosine(latitude_rad);
  const SinCos longitude = SineCosine(longitude_rad);
  Matrix3 R_EN;
  R_EN << -latitude.sin * longitude.cos, -longitude.sin, -latitude.cos * longitude.cos,  //
      -latitude.sin * longitude.sin, longitude.cos, -latitude.cos * longitude.sin,       //
      latitude.cos, 0.0, -latitude.sin;
  return R_EN;
}

Vector3 InertialToEarth(const Earth& earth, double time_s, const Vector3& v_I) {
  const SinCos turn = SineCosine(earth.rotation_rate_rad_s * time_s);
  return {turn.cos * v_I.x() + turn.sin * v_I.y(), turn.cos * v_I.y() - turn.sin * v_I.x(), v_I.z()};
}

}  // namespace dispersa
