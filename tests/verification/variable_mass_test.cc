// Verifies the rotation of bodies that burn, and the motion of stages that separate while they turn, against
// closed forms.
//
// With I the inertia about the moving centre of gravity, l the distance from there aft to the nozzle and no
// outer moment, particles that leave at rest relative to the nozzle take m_dot l² w with them, so that across
// the axis
//   d(I w)/dt = -m_dot l² w,   hence   I w = I0 w0 exp(-int m_dot l² / I dt):
// the angular momentum of what stays, exact for a body that is rigid but for a steady flow along its axis.
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "core/dynamics/integrator.h"
#include "core/dynamics/launcher.h"
#include "core/flight/fly_scenario.h"
#include "core/math/constants.h"
#include "tests/fourth_order.h"
#include "tests/liquid_stage.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::variable_mass_test {
namespace {

// A two-stage body in empty space whose mass, CG and inertia follow its propellant.
class TurningStages : public testing::Test {
 protected:
  static constexpr double kBurn_s[2] = {20.0, 10.0};
  static constexpr double kSeparation_s = 22.0;
  static constexpr double kIgnition_s = 25.0;
  static constexpr double kEnd_s = kIgnition_s + kBurn_s[1];

  struct Body {
    double propellant_kg, dry_kg, dry_cg_m, full_cg_m, dry_inertia, full_inertia, nozzle_m;
  };
  static constexpr Body kBody[2] = {{600.0, 700.0, 6.0, 7.5, 4000.0, 9000.0, 12.0},
                                    {150.0, 100.0, 2.5, 2.0, 60.0, 100.0, 4.0}};

  TurningStages() {
    scenario_.environment.earth = SphericalEarth(6371000.0, false);
    scenario_.environment.earth.mu_m3_s2 = 0.0;
    scenario_.place = {0.5, -1.0, 500e3};
    scenario_.v_EC_N = {30.0, -20.0, 10.0};
    for (int i = 0; i < 2; ++i) {
      const Body& b = kBody[i];
      ScenarioStage stage;
      stage.mass = {{0.0, b.propellant_kg},
                    {b.dry_kg, b.dry_kg + b.propellant_kg},
                    {b.dry_cg_m, b.full_cg_m},
                    {Vector3(50.0, b.dry_inertia, b.dry_inertia).asDiagonal(),
                     Vector3(80.0, b.full_inertia, b.full_inertia).asDiagonal()}};
      scenario_.stages.push_back(stage);
    }
    scenario_.stages[0].separation_time_s = kSeparation_s;
  }

  void Burn() {
    for (int i = 0; i < 2; ++i)
      scenario_.stages[static_cast<std::size_t>(i)].motor =
          ScenarioMotor{.ignition_time_s = i == 0 ? 0.0 : kIgnition_s,
                        .thrust_n = 1000.0,
                        .flow_kg_s = kBody[i].propellant_kg / kBurn_s[i],
                        .nozzle_station_m = kBody[i].nozzle_m,
                        .jet_damping = true};
  }

  // With u = I linear in time, l = A + B u, and the integral of l² / u is closed.
  static double RateKept(int stage) {
    const Body& b = kBody[stage];
    const double flow = b.propellant_kg / kBurn_s[stage];
    const double l0 = b.nozzle_m - b.full_cg_m, l1 = (b.full_cg_m - b.dry_cg_m) / kBurn_s[stage];
    const double u1 = (b.dry_inertia - b.full_inertia) / kBurn_s[stage];
    const double B = l1 / u1, A = l0 - B * b.full_inertia;
    const auto primitive = [&](double u) {
      return (A * A * std::log(u) + 2.0 * A * B * u + 0.5 * B * B * u * u) / u1;
    };
    const double damped = flow * (primitive(b.dry_inertia) - primitive(b.full_inertia));
    return b.full_inertia / b.dry_inertia * std::exp(-damped);
  }

  RigidBodyState Fly(double steps) {
    scenario_.duration_s = kEnd_s;
    scenario_.output_step_s = kEnd_s;
    scenario_.integration_step_s = kEnd_s / steps;
    EXPECT_TRUE(Problems(scenario_).empty());
    return FlyScenario(scenario_).samples.back().state;
  }

  void ExpectFourthOrder(double steps, double rounding,
                         const std::function<double(const RigidBodyState&)>& error) {
    dispersa::ExpectFourthOrder(error(Fly(steps)), error(Fly(2.0 * steps)), rounding);
  }

  Scenario scenario_;
};

// Both burns with their own jet damping and moving CG; separation changes no rate.
TEST_F(TurningStages, TheFlowTakesAngularMomentumWithIt) {
  Burn();
  scenario_.rates_rad_s = {0.0, 0.02, 0.0};
  const double rate = 0.02 * RateKept(0) * RateKept(1);
  ExpectFourthOrder(70.0, 1e-14, [&](const RigidBodyState& s) { return std::fabs(s.w_IB_B.y() - rate); });
  scenario_.rates_rad_s = {0.0, 0.0, -0.02};
  ExpectFourthOrder(70.0, 1e-14, [&](const RigidBodyState& s) { return std::fabs(s.w_IB_B.z() + rate); });
}

// Nothing burns: the upper stage leaves from where its CG is, with the velocity that its CG has there.
TEST_F(TurningStages, TheUpperStageLeavesWithTheVelocityOfItsOwnCg) {
  scenario_.rates_rad_s = {0.0, 0.3, 0.0};
  const RigidBodyState start = InitialState(scenario_);
  // Without a motor nothing leaves: both stages keep their propellant.
  const double ahead_m = kBody[0].full_cg_m - kBody[1].full_cg_m;
  const double turned = 0.3 * kSeparation_s;
  const Vector3 forward = Rotate(start.q_IB, {std::cos(turned), 0.0, -std::sin(turned)});
  const Vector3 up = Rotate(start.q_IB, {-std::sin(turned), 0.0, -std::cos(turned)});
  const Vector3 v = start.v_IC_I + 0.3 * ahead_m * up;
  const Vector3 p = start.p_EoC_I + start.v_IC_I * kEnd_s + ahead_m * forward +
                    0.3 * ahead_m * up * (kEnd_s - kSeparation_s);
  ExpectFourthOrder(100.0, 1e-12, [&](const RigidBodyState& s) { return (s.v_IC_I - v).norm(); });
  // A coordinate of 7e6 m is rounded by 1e-9 m at each of some hundred steps.
  ExpectFourthOrder(100.0, 5e-8, [&](const RigidBodyState& s) { return (s.p_EoC_I - p).norm(); });
}

// The launcher's first burn in empty space, with the grain's inertia, which is no linear function of time:
// the integral by quadrature.
class TurningLauncher : public testing::Test {
 protected:
  TurningLauncher() {
    plant_ = BuildNominalPlant(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml"));
    plant_.environment.earth.mu_m3_s2 = 0.0;
    plant_.stacks[0].aerodynamics = {};
    phase_.burning = true;
  }
  const LauncherStack& stack() const { return plant_.stacks[0]; }

  Vector3 RatesAtBurnout(const Vector3& rates) {
    std::array<double, kLauncherSize> y{};
    RigidBodyState start;
    start.p_EoC_I = {7e6, 0.0, 0.0};
    start.w_IB_B = rates;
    WriteState(start, y.data());
    const LauncherModel equations(plant_);
    equations_ = &equations;
    Integrator integrator(Scheme::kRungeKutta4, kRigidLauncherSize, &Rhs, this, nullptr);
    EXPECT_TRUE(integrator.Advance(0.0, stack().burn.duration_s, 2000, y.data()));
    return ReadState(y.data()).w_IB_B;
  }

  // Factor of a rate over the burn: I of a MassProperties, and the square of the arm.
  double RateKept(double MassProperties::*inertia, const std::function<double(const MassProperties&)>& arm2) {
    const auto at = [&](double t) { return stack().mass.At(stack().burn.Propellant(t)); };
    const double T = stack().burn.duration_s;
    const double damped = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        [&](double t) { return stack().burn.full_flow_kg_s * arm2(at(t)) / (at(t).*inertia); }, 0.0, T);
    return at(0.0).*inertia / (at(T).*inertia) * std::exp(plant_.jet_damping ? -damped : 0.0);
  }

  LauncherPlant plant_;
  LauncherPhase phase_;
  const LauncherModel* equations_ = nullptr;

 private:
  static void Rhs(double t, const double* y, double* dydt, void* context) {
    const auto* self = static_cast<const TurningLauncher*>(context);
    self->equations_->Derivative(self->phase_, t, y, dydt);
  }
};

TEST_F(TurningLauncher, KeepsItsAngularMomentumButForTheFlows) {
  for (const bool jet_damping : {true, false}) {
    plant_.jet_damping = jet_damping;
    const double lateral = RateKept(&MassProperties::transverse_inertia_kg_m2, [&](const MassProperties& m) {
      return std::pow(stack().gimbal.pivot_station_m - m.cg_station_m, 2);
    });
    const double axial = RateKept(&MassProperties::axial_inertia_kg_m2, [&](const MassProperties&) {
      return std::pow(stack().gimbal.radius_m, 2);
    });
    // About one axis at a time the equations are linear; 2000 steps leave 1e-12 of a rate.
    EXPECT_NEAR(RatesAtBurnout({0.0, 0.01, 0.0}).y() / 0.01, lateral, 1e-11);
    EXPECT_NEAR(RatesAtBurnout({0.0, 0.0, 0.01}).z() / 0.01, lateral, 1e-11);
    EXPECT_NEAR(RatesAtBurnout({0.01, 0.0, 0.0}).x() / 0.01, axial, 1e-11);
  }
}

// Tanks that drain have their own moments and derivatives; the law is the same.
TEST_F(TurningLauncher, KeepsItsAngularMomentumButForTheFlowsOfDrainingTanks) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  MakeLiquid(vehicle.stages[0]);
  vehicle.stages[0].motor.residual_mass_kg = 0.02 * vehicle.stages[0].propellant_mass_kg;
  plant_.stacks[0].mass = BuildStackMasses(vehicle)[0];
  plant_.stacks[0].burn = BuildBurn(vehicle.stages[0], 1.0, 1.0);
  const double lateral = RateKept(&MassProperties::transverse_inertia_kg_m2, [&](const MassProperties& m) {
    return std::pow(stack().gimbal.pivot_station_m - m.cg_station_m, 2);
  });
  const double axial = RateKept(&MassProperties::axial_inertia_kg_m2,
                                [&](const MassProperties&) { return std::pow(stack().gimbal.radius_m, 2); });
  EXPECT_NEAR(RatesAtBurnout({0.0, 0.01, 0.0}).y() / 0.01, lateral, 1e-11);
  EXPECT_NEAR(RatesAtBurnout({0.01, 0.0, 0.0}).x() / 0.01, axial, 1e-11);
}

// Momentum and centre of mass of everything, including the flow inside and the expelled mass. On board: the
// momentum of the body, and that of the flow. The latter is m_dot times its way aft, from the grain to the
// exit. Expelled mass has the velocity of the nozzle plus the relative velocity that makes the thrust.
class FlowThroughATurningLauncher : public TurningLauncher {
 protected:
  static constexpr int kMomentum = kRigidLauncherSize, kPlace = kMomentum + 3, kSize = kPlace + 3;

  struct OnBoard {
    Vector3 momentum, first_moment;
  };
  OnBoard At(double t, const double* y) const {
    const RigidBodyState s = ReadState(y);
    const double mass = stack().mass.At(stack().burn.Propellant(t)).mass_kg;
    const double way_m = stack().gimbal.pivot_station_m - stack().mass.grain_station_m;
    const Vector3 forward = Rotate(s.q_IB, {1.0, 0.0, 0.0});
    return {mass * s.v_IC_I - stack().burn.full_flow_kg_s * way_m * forward, mass * s.p_EoC_I};
  }
  // Largest change of momentum and first moment of everything over the burn, of what the flow takes.
  std::array<double, 2> Lost() {
    std::array<double, kSize> y{};
    RigidBodyState start;
    start.p_EoC_I = {100.0, 200.0, -300.0};
    start.v_IC_I = {3.0, -2.0, 1.0};
    start.w_IB_B = {0.02, -0.05, 0.03};
    WriteState(start, y.data());
    const LauncherModel equations(plant_);
    equations_ = &equations;
    const OnBoard first = At(0.0, y.data());
    Integrator integrator(Scheme::kRungeKutta4, kSize, &Rhs, this, nullptr);
    EXPECT_TRUE(integrator.Advance(0.0, stack().burn.duration_s, 4000, y.data()));
    const OnBoard last = At(stack().burn.duration_s, y.data());
    const Vector3 momentum(y[kMomentum], y[kMomentum + 1], y[kMomentum + 2]),
        place(y[kPlace], y[kPlace + 1], y[kPlace + 2]);
    return {(last.momentum + momentum - first.momentum).norm() / momentum.norm(),
            (last.first_moment + place - first.first_moment).norm() / place.norm()};
  }

 private:
  static void Rhs(double t, const double* y, double* dydt, void* context) {
    const auto* self = static_cast<const FlowThroughATurningLauncher*>(context);
    self->equations_->Derivative(self->phase_, t, y, dydt);
    const RigidBodyState s = ReadState(y);
    const double flow = self->stack().burn.full_flow_kg_s;
    const double aft_m = self->stack().gimbal.pivot_station_m -
                         self->stack().mass.At(self->stack().burn.Propellant(t)).cg_station_m;
    const Vector3 nozzle = Rotate(s.q_IB, {-aft_m, 0.0, 0.0});
    const Vector3 thrust = Rotate(s.q_IB, {self->stack().burn.vacuum_thrust_n, 0.0, 0.0});
    const Vector3 leaving =
        flow * (s.v_IC_I + Rotate(s.q_IB, s.w_IB_B.cross(Vector3(-aft_m, 0.0, 0.0)))) - thrust;
    // The first moment grows by the momentum on board and loses what leaves where it leaves.
    const Vector3 parting = flow * (s.p_EoC_I + nozzle) - self->At(t, y).momentum;
    for (int i = 0; i < 3; ++i) {
      dydt[kMomentum + i] = leaving[i];
      dydt[kPlace + i] = parting[i];
    }
  }
};

TEST_F(FlowThroughATurningLauncher, KeepsMomentumAndCentreOfMassOfEverything) {
  const std::array<double, 2> lost = Lost();
  plant_.flow_coriolis = false;
  const std::array<double, 2> lost_without = Lost();
  // Rounding of 4000 steps.
  EXPECT_LT(lost[0], 1e-12);
  EXPECT_LT(lost[1], 1e-12);
  EXPECT_GT(lost_without[0], 1e-4);
  EXPECT_GT(lost_without[1], 1e-5);
}

}  // namespace
}  // namespace dispersa::variable_mass_test
