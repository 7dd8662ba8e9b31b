// Verifies the engine's equations of motion against solutions in closed form and against conserved
// quantities.
//
// Flights use the shipped fixed-step scheme, of order 4. The error against an exact solution must therefore
// fall by 2^4 when the step is halved, and no tolerance is needed. The test asks for 12, because terms of
// higher order are still visible. A wrong equation leaves an error that does not fall. `rounding` bounds the
// contribution of double arithmetic. The error at the longer step must be well above it, or the test would
// show nothing.
#include <boost/math/special_functions/jacobi_elliptic.hpp>

#include "core/flight/fly_scenario.h"
#include "core/math/constants.h"
#include "tests/fourth_order.h"
#include "tests/gravitational_potential.h"
#include "tests/test.h"

namespace dispersa::closed_forms_test {
namespace {

using State = RigidBodyState;

// A body of 1000 kg at rest, 500 km above a sphere that does not turn.
Scenario Body(const Vector3& inertia_kg_m2) {
  Scenario scenario;
  scenario.environment.earth = SphericalEarth(6371000.0, false);
  scenario.place = {0.5, -1.0, 500e3};
  ScenarioStage stage;
  stage.mass = {{0.0}, {1000.0}, {0.0}, {inertia_kg_m2.asDiagonal()}};
  scenario.stages = {stage};
  return scenario;
}

State Fly(Scenario scenario, double duration_s, double steps) {
  scenario.duration_s = duration_s;
  scenario.output_step_s = duration_s;
  scenario.integration_step_s = duration_s / steps;
  const ScenarioFlight flight = FlyScenario(scenario);
  EXPECT_EQ(flight.outcome, Outcome::kCompleted);
  EXPECT_EQ(flight.samples.size(), 2u);
  return flight.samples.back().state;
}

// The error, a length not below 0, at `steps` steps and at twice as many.
void ExpectFourthOrder(const Scenario& scenario, double duration_s, double steps, double rounding,
                       const std::function<double(const State&)>& error) {
  dispersa::ExpectFourthOrder(error(Fly(scenario, duration_s, steps)),
                              error(Fly(scenario, duration_s, 2.0 * steps)), rounding);
}

double Distance(const Quaternion& a, const Quaternion& b) { return RotationVector(Inverse(a) * b).norm(); }

// Two bodies after `t`: Lagrange's coefficients with the change of eccentric anomaly by Newton's method
// (Battin, An Introduction to the Mathematics and Methods of Astrodynamics, 4.3).
struct Orbit {
  Vector3 p;
  Vector3 v;
};
Orbit Kepler(double mu, const Vector3& p0, const Vector3& v0, double t) {
  const double r0 = p0.norm();
  const double a = 1.0 / (2.0 / r0 - v0.squaredNorm() / mu);
  const double sigma = p0.dot(v0) / std::sqrt(mu);
  const double n = std::sqrt(mu / a) / a;
  double x = n * t;
  for (int i = 0; i < 50; ++i) {
    const double one_minus_cos = 2.0 * std::pow(std::sin(0.5 * x), 2);
    const double f = x + sigma / std::sqrt(a) * one_minus_cos - (1.0 - r0 / a) * std::sin(x) - n * t;
    const double slope = 1.0 + sigma / std::sqrt(a) * std::sin(x) - (1.0 - r0 / a) * std::cos(x);
    x -= f / slope;
  }
  const double one_minus_cos = 2.0 * std::pow(std::sin(0.5 * x), 2);
  const double f = 1.0 - a / r0 * one_minus_cos;
  const double g = a * sigma / std::sqrt(mu) * one_minus_cos + r0 * std::sqrt(a / mu) * std::sin(x);
  const Vector3 p = f * p0 + g * v0;
  const double r = p.norm();
  const double f_rate = -std::sqrt(mu * a) / (r * r0) * std::sin(x);
  const double g_rate = 1.0 - a / r * one_minus_cos;
  return {p, f_rate * p0 + g_rate * v0};
}

TEST(ClosedForms, TorqueFreeSymmetricTop) {
  constexpr double axial = 300.0, across = 900.0, spin = 1.2, nutation = 0.4, t = 20.0;
  Scenario scenario = Body({axial, across, across});
  scenario.rates_rad_s = {spin, nutation, 0.0};
  const State start = InitialState(scenario);

  // Rates across the axis turn in the body; the axis cones about the angular momentum.
  const double turn = spin * (across - axial) / across * t;
  const Vector3 rates(spin, nutation * std::cos(turn), -nutation * std::sin(turn));
  const Vector3 h_B(axial * spin, across * nutation, 0.0);
  const Vector3 precession_I = Rotate(start.q_IB, h_B) / across;
  const Quaternion attitude =
      FromRotationVector(precession_I * t) * start.q_IB * FromRotationVector({turn, 0.0, 0.0});
  ExpectFourthOrder(scenario, t, 200.0, 1e-12, [&](const State& s) { return (s.w_IB_B - rates).norm(); });
  ExpectFourthOrder(scenario, t, 200.0, 1e-12, [&](const State& s) { return Distance(attitude, s.q_IB); });
}

// Landau and Lifshitz, Mechanics, §37: rotation about the axis of the largest moment.
TEST(ClosedForms, TorqueFreeAsymmetricTop) {
  constexpr double a = 400.0, b = 700.0, c = 900.0, t = 30.0;
  const Vector3 start(0.5, 0.0, 0.9);
  Scenario scenario = Body({a, b, c});
  scenario.rates_rad_s = start;

  const double twice_energy = a * start.x() * start.x() + c * start.z() * start.z();
  const double square = Vector3(a * start.x(), 0.0, c * start.z()).squaredNorm();
  ASSERT_GT(square, twice_energy * b);
  const double argument = t * std::sqrt((c - b) * (square - twice_energy * a) / (a * b * c));
  const double modulus =
      std::sqrt((b - a) * (twice_energy * c - square) / ((c - b) * (square - twice_energy * a)));
  double cn = 0.0;
  double dn = 0.0;
  const double sn = boost::math::jacobi_elliptic(modulus, argument, &cn, &dn);
  const Vector3 rates(start.x() * cn, std::sqrt((twice_energy * c - square) / (b * (c - b))) * sn,
                      start.z() * dn);
  ExpectFourthOrder(scenario, t, 300.0, 1e-12, [&](const State& s) { return (s.w_IB_B - rates).norm(); });
}

TEST(ClosedForms, KeplerRevolution) {
  Scenario scenario = Body({500.0, 500.0, 500.0});
  scenario.v_EC_N = {4000.0, 6900.0, 0.0};
  const State start = InitialState(scenario);
  const double mu = scenario.environment.earth.mu_m3_s2;
  const double a = 1.0 / (2.0 / start.p_EoC_I.norm() - start.v_IC_I.squaredNorm() / mu);
  const double period_s = kTwoPi * a * std::sqrt(a / mu);
  ExpectFourthOrder(scenario, period_s, 600.0, 1e-5,
                    [&](const State& s) { return (s.p_EoC_I - start.p_EoC_I).norm(); });
  ExpectFourthOrder(scenario, period_s, 600.0, 1e-8,
                    [&](const State& s) { return (s.v_IC_I - start.v_IC_I).norm(); });
}

// From the surface and back to it: range angle and time of flight of the free-flight ellipse.
TEST(ClosedForms, VacuumBallisticArc) {
  constexpr double speed = 4000.0, elevation = 40.0 * kRadPerDeg, azimuth = 60.0 * kRadPerDeg;
  Scenario scenario = Body({500.0, 500.0, 500.0});
  scenario.place.altitude_m = 0.0;
  const double level = speed * std::cos(elevation);
  scenario.v_EC_N = {level * std::cos(azimuth), level * std::sin(azimuth), -speed * std::sin(elevation)};
  const State start = InitialState(scenario);
  const double mu = scenario.environment.earth.mu_m3_s2;
  const double radius = start.p_EoC_I.norm();

  const double q = speed * speed * radius / mu;
  const double eccentricity =
      std::sqrt(std::pow(q - 1.0, 2) * std::pow(std::cos(elevation), 2) + std::pow(std::sin(elevation), 2));
  const double a = radius / (2.0 - q);
  const double half_range =
      std::atan(q * std::sin(elevation) * std::cos(elevation) / (1.0 - q * std::pow(std::cos(elevation), 2)));
  // Eccentric anomaly at launch, from the apogee.
  const double anomaly = std::acos((1.0 - radius / a) / eccentricity) - kPi;
  const double time_s =
      2.0 * a * std::sqrt(a / mu) * (std::fabs(anomaly) + eccentricity * std::sin(std::fabs(anomaly)));
  const Vector3 normal = start.p_EoC_I.cross(start.v_IC_I).normalized();
  const Vector3 landing = Rotate(FromRotationVector(2.0 * half_range * normal), start.p_EoC_I);
  ExpectFourthOrder(scenario, time_s, 30.0, 1e-6,
                    [&](const State& s) { return (s.p_EoC_I - landing).norm(); });
}

// At rest on the turning Earth and dropped: in I it begins a very flat ellipse.
TEST(ClosedForms, FallOnARotatingEarth) {
  Scenario scenario = Body({500.0, 500.0, 500.0});
  scenario.environment.earth = SphericalEarth(6371000.0, true);
  const Earth& earth = scenario.environment.earth;
  const State start = InitialState(scenario);
  constexpr double t = 300.0;
  const Orbit end = Kepler(earth.mu_m3_s2, start.p_EoC_I, start.v_IC_I, t);
  ExpectFourthOrder(scenario, t, 10.0, 1e-7, [&](const State& s) { return (s.p_EoC_I - end.p).norm(); });
  ExpectFourthOrder(scenario, t, 10.0, 1e-9, [&](const State& s) { return (s.v_IC_I - end.v).norm(); });
}

// A body that falls from rest on the equator lands east of its plumb line by w g t³ / 3, g less the
// centrifugal acceleration. The next terms are (w t)² and the growth of g over the fall, 2 s / R: together
// below 2e-5.
TEST(ClosedForms, EastwardDeflection) {
  Scenario scenario = Body({500.0, 500.0, 500.0});
  scenario.environment.earth = SphericalEarth(6371000.0, true);
  scenario.place = {0.0, 0.0, 2000.0};
  const Earth& earth = scenario.environment.earth;
  constexpr double t = 3.0;
  const Vector3 p_EoC_E = InertialToEarth(earth, t, Fly(scenario, t, 30.0).p_EoC_I);
  const double radius = earth.equatorial_radius_m + 2000.0;
  const double w = earth.rotation_rate_rad_s;
  const double g = earth.mu_m3_s2 / (radius * radius) - w * w * radius;
  EXPECT_NEAR(p_EoC_E.y() / (w * g * t * t * t / 3.0), 1.0, 2e-5);
}

// Tsiolkovsky, without gravity, over two stages; the separation moves the state forward to the new CG.
TEST(ClosedForms, RocketEquation) {
  Scenario scenario = Body({500.0, 500.0, 500.0});
  scenario.environment.earth.mu_m3_s2 = 0.0;
  scenario.rates_are_inertial = true;
  const Matrix3 inertia = Vector3(100.0, 800.0, 800.0).asDiagonal();
  const auto stage = [&](double dry_kg, double propellant_kg, double cg_m, double ignition_s,
                         double thrust_n) {
    ScenarioStage s;
    s.mass = {{0.0, propellant_kg}, {dry_kg, dry_kg + propellant_kg}, {cg_m, cg_m}, {inertia, inertia}};
    s.motor = ScenarioMotor{};
    s.motor->ignition_time_s = ignition_s;
    s.motor->thrust_n = thrust_n;
    s.motor->flow_kg_s = propellant_kg / 40.0;
    s.motor->nozzle_station_m = 10.0;
    return s;
  };
  scenario.stages = {stage(1500.0, 4000.0, 6.0, 0.0, 250e3), stage(200.0, 900.0, 2.0, 50.0, 60e3)};
  scenario.stages[0].separation_time_s = 45.0;
  ASSERT_TRUE(Problems(scenario).empty());
  const State start = InitialState(scenario);
  const Vector3 axis_I = Rotate(start.q_IB, {1.0, 0.0, 0.0});

  const double first = 250e3 / 100.0 * std::log(5500.0 / 1500.0);
  const double second = 60e3 / 22.5 * std::log(1100.0 / 200.0);
  // Distance of a burn from rest: exhaust speed times (t - m1 / flow * ln(m0 / m1)).
  const double way = 2500.0 * (40.0 - 15.0 * std::log(5500.0 / 1500.0)) + first * 60.0 + (6.0 - 2.0) +
                     60e3 / 22.5 * (40.0 - 200.0 / 22.5 * std::log(1100.0 / 200.0)) + second * 10.0;
  const auto along = [&](const State& s) { return (s.v_IC_I - start.v_IC_I).dot(axis_I); };
  ExpectFourthOrder(scenario, 100.0, 40.0, 1e-9,
                    [&](const State& s) { return std::fabs(along(s) - (first + second)); });
  ExpectFourthOrder(scenario, 100.0, 40.0, 1e-7,
                    [&](const State& s) { return (s.p_EoC_I - start.p_EoC_I - way * axis_I).norm(); });
}

// Thrust beside the CG, no gravity: a constant moment about y turns the body by M t² / (2 I).
TEST(ClosedForms, ThrustOffsetMoment) {
  Scenario scenario = Body({500.0, 500.0, 500.0});
  scenario.environment.earth.mu_m3_s2 = 0.0;
  const Matrix3 inertia = Vector3(100.0, 800.0, 800.0).asDiagonal();
  ScenarioStage& stage = scenario.stages[0];
  stage.mass = {{0.0, 100.0}, {900.0, 1000.0}, {4.0, 4.0}, {inertia, inertia}};
  stage.motor =
      ScenarioMotor{.thrust_n = 2000.0, .flow_kg_s = 10.0, .nozzle_station_m = 9.0, .nozzle_z_m = 0.02};
  const State end = Fly(scenario, 4.0, 100.0);
  // Nozzle below (z down): the thrust lifts the nose. Linear in time, so the scheme is exact.
  EXPECT_NEAR(end.w_IB_B.y(), 0.02 * 2000.0 / 800.0 * 4.0, 1e-13);
  EXPECT_NEAR(end.w_IB_B.x(), 0.0, 1e-15);
  EXPECT_NEAR(end.w_IB_B.z(), 0.0, 1e-15);
}

// A burning body whose moments of inertia fall with its propellant, and no gravity.
class BurningBody : public ::testing::Test {
 protected:
  static constexpr double kBurn_s = 20.0;
  static constexpr double kArm_m = 0.3;
  BurningBody() : scenario_(Body({500.0, 500.0, 500.0})) {
    scenario_.environment.earth.mu_m3_s2 = 0.0;
    ScenarioStage& stage = scenario_.stages[0];
    stage.mass = {{0.0, 600.0}, {400.0, 1000.0}, {4.0, 4.0}, {dry_.asDiagonal(), full_.asDiagonal()}};
    stage.motor =
        ScenarioMotor{.thrust_n = 3e4, .flow_kg_s = 600.0 / kBurn_s, .nozzle_station_m = 4.0 + kArm_m};
  }
  ScenarioMotor& motor() { return *scenario_.stages[0].motor; }

  Vector3 dry_{60.0, 500.0, 550.0};
  Vector3 full_{160.0, 1700.0, 1500.0};
  Scenario scenario_;
};

// Without jet damping I w is constant: d(I w)/dt = 0.
TEST_F(BurningBody, SpinsUpAsItsInertiaFalls) {
  scenario_.rates_rad_s = {0.7, 0.0, 0.0};
  const double spin = 0.7 * full_.x() / dry_.x();
  // The scheme is exact for 1 / (1 - k t).
  EXPECT_NEAR(Fly(scenario_, kBurn_s, 10.0).w_IB_B.x(), spin, 1e-14);
}

// So is R I w while it tumbles.
TEST_F(BurningBody, KeepsItsAngularMomentumInSpace) {
  scenario_.rates_rad_s = {0.3, -0.2, 0.25};
  const State start = InitialState(scenario_);
  const Vector3 h_I = Rotate(start.q_IB, full_.cwiseProduct(start.w_IB_B));
  ExpectFourthOrder(scenario_, kBurn_s, 200.0, 1e-10, [&](const State& s) {
    return (Rotate(s.q_IB, dry_.cwiseProduct(s.w_IB_B)) - h_I).norm();
  });
}

// The flow takes m_dot l² w with it. With dI/dm = k, d ln w = -(k - l²)/k d ln I: a power of I.
TEST_F(BurningBody, JetDampingAcrossTheAxis) {
  motor().jet_damping = true;
  scenario_.rates_rad_s = {0.0, 0.02, 0.0};
  const double k = (full_.y() - dry_.y()) / 600.0;
  const double rate = 0.02 * std::pow(full_.y() / dry_.y(), (k - kArm_m * kArm_m) / k);
  ExpectFourthOrder(scenario_, kBurn_s, 10.0, 1e-14,
                    [&](const State& s) { return std::fabs(s.w_IB_B.y() - rate); });
}

// With the term switched off a body that spins about a principal axis keeps its rate.
TEST_F(BurningBody, KeepsItsRateWithoutTheInertiaRateTerm) {
  motor().inertia_rate = 0.0;
  scenario_.rates_rad_s = {0.7, 0.0, 0.0};
  EXPECT_EQ(Fly(scenario_, kBurn_s, 100.0).w_IB_B, Vector3(0.7, 0.0, 0.0));
}

double Energy(const Earth& earth, const State& s) {
  return 0.5 * s.v_IC_I.squaredNorm() - GravitationalPotential(earth, s.p_EoC_I);
}

TEST(Conservation, EnergyAndAngularMomentumOfAnOrbit) {
  Scenario scenario = Body({500.0, 500.0, 500.0});
  scenario.v_EC_N = {4000.0, 6900.0, 300.0};
  const Earth& earth = scenario.environment.earth;
  const State start = InitialState(scenario);
  const double energy = Energy(earth, start);
  const Vector3 momentum = start.p_EoC_I.cross(start.v_IC_I);
  ExpectFourthOrder(scenario, 6000.0, 300.0, 1e-6,
                    [&](const State& s) { return std::fabs(Energy(earth, s) - energy); });
  ExpectFourthOrder(scenario, 6000.0, 300.0, 0.1,
                    [&](const State& s) { return (s.p_EoC_I.cross(s.v_IC_I) - momentum).norm(); });
}

// J2 has no moment about the polar axis.
TEST(Conservation, EnergyAndPolarAngularMomentumWithJ2) {
  Scenario scenario = Body({500.0, 500.0, 500.0});
  scenario.environment.earth = Wgs84();
  scenario.v_EC_N = {4000.0, 6500.0, 300.0};
  const Earth& earth = scenario.environment.earth;
  const State start = InitialState(scenario);
  const double energy = Energy(earth, start);
  const Vector3 momentum = start.p_EoC_I.cross(start.v_IC_I);
  ExpectFourthOrder(scenario, 6000.0, 300.0, 1e-6,
                    [&](const State& s) { return std::fabs(Energy(earth, s) - energy); });
  ExpectFourthOrder(scenario, 6000.0, 300.0, 0.1,
                    [&](const State& s) { return std::fabs(s.p_EoC_I.cross(s.v_IC_I).z() - momentum.z()); });
  // It does turn the plane of the orbit: the other two components change by far more.
  const State end = Fly(scenario, 6000.0, 300.0);
  const Vector3 change = end.p_EoC_I.cross(end.v_IC_I) - momentum;
  EXPECT_GT(change.head<2>().norm(), 1e-4 * momentum.norm());
}

TEST(Conservation, RotationalEnergyAndAngularMomentumOfATumblingBody) {
  const Vector3 inertia(400.0, 700.0, 900.0);
  Scenario scenario = Body(inertia);
  scenario.rates_rad_s = {0.4, 0.7, -0.3};
  const State start = InitialState(scenario);
  const auto momentum = [&](const State& s) { return Rotate(s.q_IB, inertia.cwiseProduct(s.w_IB_B)); };
  const auto energy = [&](const State& s) { return 0.5 * s.w_IB_B.dot(inertia.cwiseProduct(s.w_IB_B)); };
  ExpectFourthOrder(scenario, 60.0, 600.0, 1e-10,
                    [&](const State& s) { return (momentum(s) - momentum(start)).norm(); });
  ExpectFourthOrder(scenario, 60.0, 600.0, 1e-10,
                    [&](const State& s) { return std::fabs(energy(s) - energy(start)); });
}

}  // namespace
}  // namespace dispersa::closed_forms_test
