// Flights of motors with thrust curves. Every corner ends a step, so that the engine's steps keep their order
// with corners between ticks. CVODE, restarted at each corner, shows this. A burn in space gains the velocity
// of the rocket equation, for any curve and burn rate.
#include "tests/burn_in_space.h"
#include "tests/flown_history.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::thrust_curve_flight_test {
namespace {

// SLV-4 with motors that rise, sag, step and tail off within and between ticks of 10 ms; impulse and
// propellant are those of its own motors, thrusts about.
FlightDefinition CurvedDefinition() {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  for (Stage& stage : definition.vehicle.stages) {
    const double impulse_n_s = stage.motor.thrust_n * stage.motor.burning_time_s;
    ThrustCurve curve{{0.0, 0.0713, 0.2351, 11.1234567, 17.4567891, 17.4612345, 29.3, 52.0077, 53.4441},
                      {0.4, 1.02, 0.97, 1.05, 1.0, 0.93, 0.95, 0.9, 0.0}};
    const double stretch = stage.motor.burning_time_s / curve.time_s.back();
    for (double& time_s : curve.time_s) time_s *= stretch;
    const double level = impulse_n_s / curve.Impulse();
    for (double& thrust_n : curve.thrust_n) thrust_n *= level;
    SetThrustCurve(curve, stage.motor);
  }
  return definition;
}

// The speed is held to a limit alone: it differs from CVODE's by 3e-7 m/s at most and 1e-8 in quarter steps,
// with curves and with constant thrust alike. Up to the coast, in which a thruster's firing one cycle earlier
// is another flight (flight_convergence_test.cc).
void ExpectOrder(const FlightInputs& inputs) {
  constexpr double kPowered_s = 165.0;
  const FlightModel model(CurvedDefinition());
  const Flown exact = FlyUntil(model, inputs, Scheme::kCvode, kPowered_s);
  double first_deg = 0.0;
  for (const int steps : {1, 2, 4}) {
    const Flown flown = FlyUntil(model, inputs, Scheme::kSimpson, kPowered_s, steps);
    ASSERT_EQ(flown.history.rows(), exact.history.rows());
    const double pitch_deg = Apart(flown, exact, "pitch_error_deg", kPowered_s);
    const double speed_m_s = Apart(flown, exact, "inertial_velocity_m_s", kPowered_s);
    EXPECT_LT(pitch_deg, 1e-4) << steps << " steps a tick";
    EXPECT_LT(speed_m_s, 1.5e-6) << steps << " steps a tick";
    if (steps == 1)
      first_deg = pitch_deg;
    else  // halving divides by 6 at least, down to CVODE's own tolerance
      EXPECT_LT(pitch_deg, std::max(first_deg / 6.0, 1e-7)) << steps << " steps a tick";
  }
}

TEST(ThrustCurveFlight, KeepsTheStepsOrder) { ExpectOrder({}); }

TEST(ThrustCurveFlight, KeepsTheStepsOrderWithDispersedRates) {
  FlightInputs inputs = Table3Inputs();
  // A burn rate: the curve is drawn together in time.
  for (StageInputs& stage : inputs.stages) stage.mass_flow_factor = stage.thrust_factor;
  ExpectOrder(inputs);
}

TEST(ThrustCurveFlight, GainsTheRocketEquationsSpeed) {
  const Vehicle vehicle = CurvedDefinition().vehicle;
  const LauncherPlant plant = PlantInEmptySpace(vehicle);
  const Stage& stage = vehicle.stages[0];
  const double exhaust_m_s = stage.motor.thrust_curve.Impulse() / stage.propellant_mass_kg;
  const StackMass mass = BuildStackMasses(vehicle)[0];
  const double full_kg = mass.At(stage.propellant_mass_kg).mass_kg, empty_kg = mass.At(0.0).mass_kg;
  const double exact_m_s = exhaust_m_s * std::log(full_kg / empty_kg);
  for (const double rate : {1.0, 1.03}) {
    const double coarse = std::fabs(SpeedGained(plant, stage, rate, rate, 0.4, true) - exact_m_s);
    const double fine = std::fabs(SpeedGained(plant, stage, rate, rate, 0.2, true) - exact_m_s);
    const double across = std::fabs(SpeedGained(plant, stage, rate, rate, 0.2, false) - exact_m_s);
    EXPECT_LT(fine, std::max(coarse / 12.0, 1e-9)) << "burn rate " << rate;  // order 4 gives 16
    EXPECT_LT(fine, 1e-5);
    EXPECT_GT(across, 100.0 * fine) << "the corners hardly matter: this shows nothing";
  }
}

// A flow with a shape of its own: no rocket equation holds, the speed is the integral of P/m. Between corners
// P is linear and m a parabola; ten-point Gauss-Legendre sums over a hundredth of each piece are exact to
// rounding.
TEST(ThrustCurveFlight, GainsTheIntegralOfThrustOverMassWithItsOwnFlow) {
  Vehicle vehicle = CurvedDefinition().vehicle;
  Stage& stage = vehicle.stages[0];
  ThrustCurve curve = stage.motor.thrust_curve;
  for (std::size_t i = 0; i < curve.time_s.size(); ++i)  // the exhaust gets slower by a quarter
    curve.flow_kg_s.push_back(curve.thrust_n[i] * (1.0 + 0.25 * curve.time_s[i] / curve.time_s.back()));
  const double scale = stage.propellant_mass_kg / curve.Flown();
  for (double& flow_kg_s : curve.flow_kg_s) flow_kg_s *= scale;
  SetThrustCurve(curve, stage.motor);
  const LauncherPlant plant = PlantInEmptySpace(vehicle);
  const double empty_kg = BuildStackMasses(vehicle)[0].At(0.0).mass_kg;
  for (const double rate : {1.0, 1.03}) {
    constexpr double kPoint[] = {0.1488743389816312, 0.4333953941292472, 0.6794095682990244,
                                 0.8650633666889845, 0.9739065285171717};
    constexpr double kWeight[] = {0.2955242247147529, 0.2692667193099963, 0.2190863625159820,
                                  0.1494513491505806, 0.0666713443086881};
    double exact_m_s = 0.0, left_kg = stage.propellant_mass_kg;
    for (std::size_t i = 0; i + 1 < curve.time_s.size(); ++i) {
      const double length_s = (curve.time_s[i + 1] - curve.time_s[i]) / rate;
      const double flow = rate * curve.flow_kg_s[i],
                   flow_rise = (rate * curve.flow_kg_s[i + 1] - flow) / length_s;
      const double thrust = rate * curve.thrust_n[i],
                   rise = (rate * curve.thrust_n[i + 1] - thrust) / length_s;
      for (int part = 0; part < 100; ++part) {
        for (int k = 0; k < 10; ++k) {
          const double x = k % 2 == 0 ? kPoint[k / 2] : -kPoint[k / 2];
          const double t = length_s / 100.0 * (part + 0.5 + 0.5 * x);
          exact_m_s += 0.5 * length_s / 100.0 * kWeight[k / 2] * (thrust + rise * t) /
                       (empty_kg + left_kg - t * (flow + 0.5 * flow_rise * t));
        }
      }
      left_kg -= length_s * (flow + 0.5 * flow_rise * length_s);
    }
    EXPECT_NEAR(left_kg, 0.0, 1e-8);
    const double coarse = std::fabs(SpeedGained(plant, stage, rate, rate, 0.4, true) - exact_m_s);
    const double fine = std::fabs(SpeedGained(plant, stage, rate, rate, 0.2, true) - exact_m_s);
    EXPECT_LT(fine, std::max(coarse / 12.0, 1e-9)) << "burn rate " << rate;
    EXPECT_LT(fine, 1e-5);
  }
}

}  // namespace
}  // namespace dispersa::thrust_curve_flight_test
