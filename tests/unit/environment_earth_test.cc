#include "core/environment/earth.h"

#include "core/math/constants.h"
#include "tests/gravitational_potential.h"
#include "tests/test.h"

namespace dispersa::environment_earth_test {

constexpr double kPolarRadius = 6356752.314245;  // WGS-84, TR8350.2, to the micrometre

double LongitudeDifference(double a, double b) { return std::remainder(a - b, kTwoPi); }

void ExpectNear(const Vector3& actual, const Vector3& expected, double tolerance) {
  EXPECT_NEAR(actual.x(), expected.x(), tolerance);
  EXPECT_NEAR(actual.y(), expected.y(), tolerance);
  EXPECT_NEAR(actual.z(), expected.z(), tolerance);
}

// Positions around 1e7 m carry roundings of 1e-9 m; a few of them add up.
constexpr double kPosition = 1e-8;
// Two units in the last place of an angle near pi.
constexpr double kAngle = 1e-15;

TEST(Geodetic, RoundTrip) {
  const Earth earth = Wgs84();
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> latitude(-kPi / 2, kPi / 2);
  std::uniform_real_distribution<double> longitude(-kPi, kPi);
  std::uniform_real_distribution<double> altitude(-1e4, 2e6);
  for (int i = 0; i < 20000; ++i) {
    const Geodetic place{latitude(generator), longitude(generator), altitude(generator)};
    const Vector3 p_EoP_E = FromGeodetic(earth, place);
    const Geodetic back = ToGeodetic(earth, p_EoP_E);
    EXPECT_NEAR(back.latitude_rad, place.latitude_rad, kAngle);
    EXPECT_NEAR(LongitudeDifference(back.longitude_rad, place.longitude_rad), 0.0, kAngle);
    EXPECT_NEAR(back.altitude_m, place.altitude_m, kPosition);
    ExpectNear(FromGeodetic(earth, back), p_EoP_E, 2.0 * kPosition);
  }
}

TEST(Geodetic, AxisEquatorAndDateLine) {
  const Earth earth = Wgs84();
  const Geodetic pole = ToGeodetic(earth, {0.0, 0.0, kPolarRadius + 1000.0});
  EXPECT_DOUBLE_EQ(pole.latitude_rad, kPi / 2);
  EXPECT_EQ(pole.longitude_rad, 0.0);
  EXPECT_NEAR(pole.altitude_m, 1000.0, 1e-6);
  EXPECT_DOUBLE_EQ(ToGeodetic(earth, {0.0, 0.0, -kPolarRadius}).latitude_rad, -kPi / 2);
  const Geodetic equator = ToGeodetic(earth, {-6378137.0, 0.0, 0.0});
  EXPECT_EQ(equator.latitude_rad, 0.0);
  EXPECT_DOUBLE_EQ(equator.longitude_rad, kPi);
  EXPECT_NEAR(equator.altitude_m, 0.0, kPosition);
}

TEST(Geodetic, OnASphereIsGeocentric) {
  const Earth sphere = SphericalEarth(6371000.0, false);
  const Vector3 p_EoP_E(4.1e6, -2.2e6, 5.3e6);
  const Geodetic geodetic = ToGeodetic(sphere, p_EoP_E);
  EXPECT_NEAR(geodetic.latitude_rad, std::asin(p_EoP_E.z() / p_EoP_E.norm()), kAngle);
  EXPECT_NEAR(geodetic.longitude_rad, std::atan2(p_EoP_E.y(), p_EoP_E.x()), kAngle);
  EXPECT_NEAR(geodetic.altitude_m, p_EoP_E.norm() - 6371000.0, kPosition);
}

// Central differences of the potential over 2d. Truncation is (d/r)² of the fourth term, about 2e-10 of g
// for d = 100 m; the rounding of 6e7 m²/s² over 200 m gives 4e-11 m/s². J2 itself is 1e-2 m/s², and a
// wrong factor on one axis is 2e-3 of it or more.
TEST(Gravitation, IsTheGradientOfThePotential) {
  const Earth earth = Wgs84();
  constexpr double d = 100.0;
  for (const Vector3& p_EoP :
       {Vector3(4.0e6, 3.0e6, 4.5e6), Vector3(-3.1e6, 4.4e6, -4.1e6), Vector3(1.0e6, -0.5e6, 6.5e6),
        Vector3(6.2e6, 1.5e6, 0.9e6), Vector3(5.0e6, -6.0e6, 2.0e6), Vector3(7.0e6, 0.0, 0.0),
        Vector3(0.0, 0.0, -7.0e6)}) {
    Vector3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 step = d * Vector3::Unit(axis);
      gradient[axis] =
          (GravitationalPotential(earth, p_EoP + step) - GravitationalPotential(earth, p_EoP - step)) /
          (2.0 * d);
    }
    ExpectNear(Gravitation(earth, p_EoP), gradient, 1e-8);
  }
}

// Outside the body the potential is harmonic, so the divergence of gravitation vanishes: a check of J2
// that the potential above cannot make. Over 2 km truncation and rounding stay below 1e-13 1/s²; a factor
// of 5z²/r² - 1 on the z axis would leave 1e-9.
TEST(Gravitation, IsFreeOfDivergence) {
  const Earth earth = Wgs84();
  const Vector3 p_EoP(4.0e6, -3.0e6, 4.5e6);
  double divergence = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 step = 1000.0 * Vector3::Unit(axis);
    divergence += (Gravitation(earth, p_EoP + step)[axis] - Gravitation(earth, p_EoP - step)[axis]) / 2000.0;
  }
  EXPECT_NEAR(divergence, 0.0, 1e-12);
}

TEST(Gravitation, OnASphereIsCentral) {
  const Earth sphere = SphericalEarth(6371000.0, true);
  const Vector3 p_EoP(4.0e6, -3.0e6, 4.5e6);
  const double r = p_EoP.norm();
  ExpectNear(Gravitation(sphere, p_EoP), -sphere.mu_m3_s2 / (r * r * r) * p_EoP, 1e-14);
}

TEST(NedAxes, ColumnsAreNorthEastDown) {
  const Matrix3 R_EN = NedAxes(0.0, 0.0);
  ExpectNear(R_EN.col(0), {0.0, 0.0, 1.0}, 0.0);
  ExpectNear(R_EN.col(1), {0.0, 1.0, 0.0}, 0.0);
  ExpectNear(R_EN.col(2), {-1.0, 0.0, 0.0}, 0.0);
}

// Down is where altitude falls at one metre a metre; north is where latitude grows, east longitude.
TEST(NedAxes, FollowTheGeodeticCoordinates) {
  const Earth earth = Wgs84();
  const Geodetic place{0.7, -2.0, 12000.0};
  const Matrix3 R_EN = NedAxes(place.latitude_rad, place.longitude_rad);
  EXPECT_NEAR((R_EN.transpose() * R_EN - Matrix3::Identity()).norm(), 0.0, 1e-15);
  EXPECT_NEAR(R_EN.determinant(), 1.0, 1e-15);
  const Vector3 p_EoP_E = FromGeodetic(earth, place);
  ExpectNear(FromGeodetic(earth, {0.7, -2.0, 11000.0}), p_EoP_E + 1000.0 * R_EN.col(2), kPosition);
  const Vector3 north = FromGeodetic(earth, {0.7 + 1e-6, -2.0, 12000.0}) - p_EoP_E;
  const Vector3 east = FromGeodetic(earth, {0.7, -2.0 + 1e-6, 12000.0}) - p_EoP_E;
  // A chord of 1e-6 rad leans by half that angle.
  ExpectNear(north.normalized(), R_EN.col(0), 1e-6);
  ExpectNear(east.normalized(), R_EN.col(1), 1e-6);
}

TEST(EarthRotation, TurnsEastward) {
  const Earth earth = Wgs84();
  const Vector3 v_E(1.0, 2.0, 3.0);
  ExpectNear(InertialToEarth(earth, 0.0, v_E), v_E, 0.0);
  const double quarter = kPi / 2 / earth.rotation_rate_rad_s;
  ExpectNear(InertialToEarth(earth, quarter, {0.0, 1.0, 0.0}), {1.0, 0.0, 0.0}, 1e-15);
  const double turn = earth.rotation_rate_rad_s * 1234.0;
  const Vector3 v_I(std::cos(turn) - 2.0 * std::sin(turn), std::sin(turn) + 2.0 * std::cos(turn), 3.0);
  ExpectNear(InertialToEarth(earth, 1234.0, v_I), v_E, 2e-15);
  const Earth still = SphericalEarth(6371000.0, false);
  ExpectNear(InertialToEarth(still, 1234.0, v_E), v_E, 0.0);
  EXPECT_EQ(SphericalEarth(6371000.0, true).rotation_rate_rad_s, earth.rotation_rate_rad_s);
}

}  // namespace dispersa::environment_earth_test
