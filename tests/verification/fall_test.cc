// The fall of a spent stage, against Kepler's ellipse without air, against a terminal velocity with air, and
// with halved steps.
#include "core/dynamics/fall.h"

#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::fall_test {
namespace {

constexpr double kRadius_m = 6378137.0;
constexpr double kMu = 3.986004418e14;

Environment Airless(const Earth& earth) {
  Environment environment;
  environment.earth = earth;
  environment.density.scale = 0.0;
  return environment;
}

/// A stage of slv4 after its separation, on a day with wind.
Environment Windy() {
  Environment environment;
  environment.wind.jets = {{60.0, 12000.0, 12000.0, 0.3}};
  return environment;
}
const FallingBody kStage{2000.0, TumblingCylinderDragArea(6.7, 1.0)};
FallState SecondStage() {
  const Earth earth = Wgs84();
  const Geodetic site{0.4, 1.1, 85e3};
  const Matrix3 axes = NedAxes(site.latitude_rad, site.longitude_rad);
  return {125.0, FromGeodetic(earth, site),
          2600.0 * axes.col(0) + 500.0 * axes.col(1) - 1500.0 * axes.col(2)};
}

// The angle and the time from a point on an ellipse to where it meets the sphere, from Kepler's equation.
TEST(Fall, WithoutAirIsKeplersEllipse) {
  const Earth earth = SphericalEarth(kRadius_m, false);
  ASSERT_EQ(earth.mu_m3_s2, kMu);
  for (const auto& [altitude_m, speed_m_s, angle_deg] :
       {std::array{60e3, 2200.0, 40.0}, std::array{130e3, 4500.0, 20.0}, std::array{250e3, 6800.0, 5.0},
        std::array{100e3, 3000.0, -10.0}}) {
    const double r = kRadius_m + altitude_m, gamma = angle_deg * kRadPerDeg;
    const double a = 1.0 / (2.0 / r - speed_m_s * speed_m_s / kMu);
    const double h = r * speed_m_s * std::cos(gamma);
    const double e = std::sqrt(1.0 - h * h / (kMu * a));
    const auto eccentric = [&](double radius) { return std::acos((1.0 - radius / a) / e); };
    const auto mean_anomaly_s = [&](double anomaly) {
      return (anomaly - e * std::sin(anomaly)) * std::sqrt(a * a * a / kMu);
    };
    const auto true_anomaly = [&](double anomaly) {
      return 2.0 * std::atan2(std::sqrt(1.0 + e) * std::sin(0.5 * anomaly),
                              std::sqrt(1.0 - e) * std::cos(0.5 * anomaly));
    };
    // Rising it is before apogee (eccentric anomaly below pi), and the ground is met after it.
    const double start = gamma >= 0.0 ? eccentric(r) : 2.0 * kPi - eccentric(r);
    const double end = 2.0 * kPi - eccentric(kRadius_m);
    double range_rad = true_anomaly(end) - true_anomaly(start);
    if (range_rad < 0.0) range_rad += 2.0 * kPi;
    const double fall_s = mean_anomaly_s(end) - mean_anomaly_s(start);

    const FallState from{
        10.0, {r, 0.0, 0.0}, {speed_m_s * std::sin(gamma), speed_m_s * std::cos(gamma), 0.0}};
    const auto impact = Fall(Airless(earth), {1000.0, 1.0}, from);
    ASSERT_TRUE(impact);
    // Centimetres of a range of up to thousands of kilometres: the method's own error at steps of 0.2 s and 1
    // s.
    EXPECT_NEAR(impact->place.longitude_rad * kRadius_m, range_rad * kRadius_m, 0.02) << speed_m_s;
    EXPECT_NEAR(impact->time_s - 10.0, fall_s, 1e-5) << speed_m_s;
    EXPECT_NEAR(impact->place.altitude_m, 0.0, 1e-5);
    EXPECT_NEAR(impact->speed_m_s, std::sqrt(kMu * (2.0 / kRadius_m - 1.0 / a)), 1e-5);
    const double peak = gamma >= 0.0 ? a * (1.0 + e) - kRadius_m : altitude_m;
    EXPECT_NEAR(impact->peak_altitude_m, peak, 2.0);  // of the steps, not between them
  }
}

// The Earth turns below a body whose path stands still: the longitude is less by what it turned.
TEST(Fall, TheEarthTurnsBelow) {
  const FallState from{10.0, {kRadius_m + 130e3, 0.0, 0.0}, {1500.0, 4000.0, 0.0}};
  const auto still = Fall(Airless(SphericalEarth(kRadius_m, false)), {1000.0, 0.0}, from);
  const auto turning = Fall(Airless(SphericalEarth(kRadius_m, true)), {1000.0, 0.0}, from);
  ASSERT_TRUE(still && turning);
  EXPECT_NEAR(turning->time_s, still->time_s, 1e-9);
  const double turned = SphericalEarth(kRadius_m, true).rotation_rate_rad_s * turning->time_s;
  EXPECT_NEAR(still->place.longitude_rad - turning->place.longitude_rad, turned, 1e-12);
}

// A body dropped from 3 km comes down at the speed at which drag bears its weight, to the percent by which
// the air gets denser while it falls; in a steady wind it is carried along.
TEST(Fall, DragBearsTheWeight) {
  Environment environment;
  environment.earth = SphericalEarth(kRadius_m, false);
  environment.wind.steady = {0.0, 10.0};
  const FallingBody body{500.0, 6.0};
  const auto impact = Fall(environment, body, {0.0, {kRadius_m + 3000.0, 0.0, 0.0}, Vector3::Zero()});
  ASSERT_TRUE(impact);
  const double density = StandardAtmosphere1976(0.0).density_kg_m3;
  const double weight = body.mass_kg * kMu / (kRadius_m * kRadius_m);
  const double terminal = std::sqrt(2.0 * weight / (density * body.drag_area_m2));
  EXPECT_NEAR(std::sqrt(impact->speed_m_s * impact->speed_m_s - 100.0), terminal, 0.01 * terminal);
  // Blown east at 10 m/s once it is carried: a little less than the whole fall.
  const double east_m = impact->place.longitude_rad * kRadius_m;
  EXPECT_LT(east_m, 10.0 * impact->time_s);
  EXPECT_GT(east_m, 0.9 * 10.0 * impact->time_s);
}

TEST(Fall, HalvedStepsMoveTheImpactByCentimetres) {
  const auto coarse = Fall(Windy(), kStage, SecondStage());
  const auto fine = Fall(Windy(), kStage, SecondStage(), {0.1, 0.5});
  ASSERT_TRUE(coarse && fine);
  const Vector3 away = FromGeodetic(Wgs84(), coarse->place) - FromGeodetic(Wgs84(), fine->place);
  EXPECT_LT(away.norm(), 0.1);
  EXPECT_NEAR(coarse->time_s, fine->time_s, 1e-3);
  EXPECT_LT(fine->speed_m_s, 200.0);  // it has slowed down to its terminal velocity
}

TEST(Fall, ABodyInOrbitStaysUpAndOneOnTheGroundWhereItIs) {
  const Earth earth = Wgs84();
  const Geodetic high{0.0, 0.0, 500e3};
  EXPECT_FALSE(Fall(Environment{}, {370.0, 1.0}, {0.0, FromGeodetic(earth, high), {0.0, 0.0, 7612.6}}));
  const auto down =
      Fall(Environment{}, kStage, {60.0, FromGeodetic(earth, {0.3, 0.2, -1.0}), {0.0, 0.0, 0.0}});
  ASSERT_TRUE(down);
  EXPECT_EQ(down->time_s, 60.0);
  EXPECT_NEAR(down->place.latitude_rad, 0.3, 1e-12);
}

TEST(Fall, KlettsCylinder) { EXPECT_DOUBLE_EQ(TumblingCylinderDragArea(2.0, 1.0), (0.7198 + 0.1630) * 2.0); }

}  // namespace
}  // namespace dispersa::fall_test
