// Verifies that the shipped fixed-step scheme converges at its order, 4, on a flight with a smooth right-hand
// side. The body tumbles and is statically stable, with drag, normal force and rate damping, in the
// troposphere over the rotating ellipsoid with J2, in wind. Differences between successive halvings fall by
// 2^4.
#include "core/flight/fly_scenario.h"
#include "core/math/constants.h"
#include "tests/test.h"

namespace dispersa::scenario_convergence_test {
namespace {

Scenario SmoothFlight() {
  Scenario scenario;
  scenario.environment.wind.steady = {5.0, -8.0};
  scenario.place = {0.5, 0.3, 3000.0};
  scenario.attitude = {0.3, 0.5, 0.2};
  scenario.v_EC_N = {150.0, 40.0, -120.0};
  scenario.rates_rad_s = {0.8, -0.3, 0.4};
  scenario.duration_s = 10.0;
  scenario.output_step_s = 0.5;
  ScenarioStage stage;
  Matrix3 inertia;
  inertia << 4.0, -0.3, 0.2, -0.3, 20.0, 0.1, 0.2, 0.1, 22.0;
  stage.mass = {{0.0}, {60.0}, {0.0}, {inertia}};
  const auto constant = [](double value) {
    return Coefficient{.table = {{0.0, 1.0}, {0.0, kPi}, {value, value, value, value}}};
  };
  BodyAerodynamics& body = stage.aerodynamics;
  body.area_m2 = 0.03;
  body.length_m = 0.6;
  body.span_m = 0.2;
  body.ca = constant(0.3);
  body.cn.table = {{0.0, 1.0}, {0.0, kPi}, {0.0, 2.0 * kPi, 0.0, 2.0 * kPi}};  // 2 per radian
  body.xcp_station_m = constant(0.2);
  body.clp = constant(-0.5);
  body.cmq = constant(-20.0);
  body.cnr = constant(-20.0);
  scenario.stages = {stage};
  return scenario;
}

std::vector<ScenarioSample> Fly(double step_s, Scheme scheme = Scheme::kRungeKutta4) {
  Scenario scenario = SmoothFlight();
  scenario.integration_step_s = step_s;
  const ScenarioFlight flight = FlyScenario(scenario, scheme);
  EXPECT_EQ(flight.outcome, Outcome::kCompleted);
  EXPECT_EQ(flight.samples.size(), 21u);
  return flight.samples;
}

using Distance = std::function<double(const RigidBodyState&, const RigidBodyState&)>;

// Of two flights, root of the sum of squares over their instants: at one instant the leading term of the
// error of an oscillation may pass through zero.
double Difference(const std::vector<ScenarioSample>& a, const std::vector<ScenarioSample>& b,
                  const Distance& distance) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += std::pow(distance(a[i].state, b[i].state), 2);
  return std::sqrt(squares);
}

// The observed order nears 4 as the step falls: to within `slack` at the smallest.
void ExpectOrderFour(double slack, const Distance& distance) {
  const std::vector<ScenarioSample> flights[] = {Fly(0.05), Fly(0.025), Fly(0.0125), Fly(0.00625)};
  const double first = Difference(flights[0], flights[1], distance);
  const double second = Difference(flights[1], flights[2], distance);
  const double third = Difference(flights[2], flights[3], distance);
  EXPECT_NEAR(std::log2(first / second), 4.0, 2.0 * slack) << first << ", " << second << ", " << third;
  EXPECT_NEAR(std::log2(second / third), 4.0, slack) << first << ", " << second << ", " << third;
}

// Much of the leading term cancels in this integral of an oscillation, so the next order shows longer;
// smaller steps meet the rounding of a position (1e-9 m).
TEST(ScenarioConvergence, Position) {
  ExpectOrderFour(0.5, [](const auto& a, const auto& b) { return (a.p_EoC_I - b.p_EoC_I).norm(); });
}

TEST(ScenarioConvergence, Velocity) {
  ExpectOrderFour(0.15, [](const auto& a, const auto& b) { return (a.v_IC_I - b.v_IC_I).norm(); });
}

TEST(ScenarioConvergence, Attitude) {
  ExpectOrderFour(
      0.15, [](const auto& a, const auto& b) { return RotationVector(Inverse(a.q_IB) * b.q_IB).norm(); });
}

TEST(ScenarioConvergence, Rates) {
  ExpectOrderFour(0.15, [](const auto& a, const auto& b) { return (a.w_IB_B - b.w_IB_B).norm(); });
}

// Verifies the flight itself, not only its order, against CVODE with a relative tolerance of 1e-12, restarted
// at every output. The fixed steps of 2 ms still have their own error, a sixteenth of that of 4 ms.
TEST(ScenarioConvergence, AgreesWithCvode) {
  const std::vector<ScenarioSample> exact = Fly(0.05, Scheme::kCvode), fixed = Fly(0.002);
  const auto difference = [&](const Distance& distance) {
    double largest = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i)
      largest = std::max(largest, distance(fixed[i].state, exact[i].state));
    return largest;
  };
  const double position_m =
      difference([](const auto& a, const auto& b) { return (a.p_EoC_I - b.p_EoC_I).norm(); });
  const double velocity_m_s =
      difference([](const auto& a, const auto& b) { return (a.v_IC_I - b.v_IC_I).norm(); });
  const double attitude_rad = difference(
      [](const auto& a, const auto& b) { return RotationVector(Inverse(a.q_IB) * b.q_IB).norm(); });
  EXPECT_LT(position_m, 1e-6);
  EXPECT_LT(velocity_m_s, 1e-7);
  EXPECT_LT(attitude_rad * kDegPerRad, 1e-6);
}

}  // namespace
}  // namespace dispersa::scenario_convergence_test
