// The effect of dispersed masses on a vehicle and its flight, against closed forms. The sample vehicle flies
// in almost no air.
#include <Eigen/LU>

#include "core/dynamics/integrator.h"
#include "core/flight/dispersed_vehicle.h"
#include "core/flight/flight.h"
#include "core/flight/sequence.h"
#include "core/flight/tick_sample.h"
#include "core/math/constants.h"
#include "core/math/rotation.h"
#include "core/modes/mode_table.h"
#include "core/vehicle/mass.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::flight_mass_dispersions_test {
namespace {

constexpr double kExhaust_m_s = 200e3 / 100.0;  // of the sample's first stage: thrust over flow

// The last tick of the first stage's burn.
TickSample AtBurnout(const FlightInputs& inputs) {
  const FlightModel model(HighDefinition());
  TickSample last;
  FlightOptions options;
  options.observe = [&](const TickSample& s) {
    if (s.stack == 0 && s.burning) last = s;
  };
  Fly(model, inputs, options);
  return last;
}

double Climbing(const TickSample& s) { return s.state.v_IC_I.dot(s.state.p_EoC_I.normalized()); }

// Of the rocket equation: the speed that the first stage gives.
double Given(double full_kg, double burnt_kg) { return kExhaust_m_s * std::log(full_kg / burnt_kg); }

LauncherPlant PlantOf(const FlightInputs& inputs) { return FlightModel(SampleDefinition()).PlantFor(inputs); }

TEST(DryMass, WeighsTheStageAndEverythingBelow) {
  FlightInputs inputs;
  inputs.stages[1].dry_mass_factor = 1.1;  // of 2 t
  const LauncherPlant nominal = PlantOf({}), heavy = PlantOf(inputs);
  EXPECT_NEAR(heavy.stacks[1].mass.fixed_mass_kg, nominal.stacks[1].mass.fixed_mass_kg + 200.0, 1e-9);
  EXPECT_NEAR(heavy.stacks[0].mass.fixed_mass_kg, nominal.stacks[0].mass.fixed_mass_kg + 200.0, 1e-9);
  // The second stage's one element: its centre 5.75 m aft of the nose, wherever the rest is.
  const MassProperties before = nominal.stacks[0].mass.At(4000.0), after = heavy.stacks[0].mass.At(4000.0);
  EXPECT_NEAR(after.cg_station_m, (13000.0 * before.cg_station_m + 200.0 * 5.75) / 13200.0, 1e-12);
  // Steiner: the tube's own inertia, and two masses that turn about their common centre.
  const double own = 200.0 * ((1.0 + 0.81) / 16.0 + 9.5 * 9.5 / 12.0);
  const double apart = before.cg_station_m - 5.75;
  EXPECT_NEAR(after.transverse_inertia_kg_m2,
              before.transverse_inertia_kg_m2 + own + 13000.0 * 200.0 / 13200.0 * apart * apart, 1e-6);
  EXPECT_EQ(heavy.stacks[0].burn.duration_s, nominal.stacks[0].burn.duration_s);
}

TEST(DryMass, CostsTheSpeedOfTheRocketEquation) {
  FlightInputs inputs;
  inputs.stages[0].dry_mass_factor = 1.01;  // of 6 t
  const TickSample nominal = AtBurnout({}), heavy = AtBurnout(inputs);
  EXPECT_EQ(heavy.time_s, nominal.time_s);
  const double expected = Given(13060.0, 9060.0) - Given(13000.0, 9000.0);
  EXPECT_NEAR(Climbing(heavy) - Climbing(nominal), expected, 2e-3 * std::fabs(expected));
}

TEST(PropellantLoad, LengthensTheBurnAndNarrowsTheBore) {
  FlightInputs inputs;
  inputs.stages[0].propellant_factor = 1.01;
  const LauncherPlant nominal = PlantOf({}), full = PlantOf(inputs);
  const MotorBurn &before = nominal.stacks[0].burn, &after = full.stacks[0].burn;
  EXPECT_DOUBLE_EQ(after.propellant_mass_kg, 4040.0);
  EXPECT_DOUBLE_EQ(after.full_flow_kg_s, before.full_flow_kg_s);
  EXPECT_EQ(after.vacuum_thrust_n, before.vacuum_thrust_n);
  EXPECT_DOUBLE_EQ(after.duration_s, 40.4);
  const StackMass& mass = full.stacks[0].mass;
  EXPECT_NEAR(mass.grain_inner_per_kg_m2 / nominal.stacks[0].mass.grain_inner_per_kg_m2, 1.0,
              1e-12);  // by density
  EXPECT_EQ(mass.fixed_mass_kg, nominal.stacks[0].mass.fixed_mass_kg);
  // A tube of 1.2 m and the narrower bore: web area 1 % larger.
  const double bore2 = 1.44 - 1.01 * (1.44 - 0.16);
  EXPECT_NEAR(mass.At(4040.0).axial_inertia_kg_m2 - mass.At(0.0).axial_inertia_kg_m2,
              4040.0 * (1.44 + bore2) / 8.0, 1e-8);
  // Of an upper stage it is a load for the lower one.
  FlightInputs upper;
  upper.stages[1].propellant_factor = 1.01;
  EXPECT_NEAR(PlantOf(upper).stacks[0].mass.fixed_mass_kg, nominal.stacks[0].mass.fixed_mass_kg + 10.0, 1e-9);
  EXPECT_DOUBLE_EQ(LargestPropellantFactor(SampleVehicle().stages[0]), 1.44 / (1.44 - 0.16));
}

TEST(PropellantLoad, GivesTheSpeedOfTheRocketEquationLessGravitation) {
  FlightInputs inputs;
  inputs.stages[0].propellant_factor = 1.01;
  const TickSample nominal = AtBurnout({}), full = AtBurnout(inputs);
  EXPECT_NEAR(full.time_s - nominal.time_s, 0.4, 1e-9);
  const double g = Wgs84().mu_m3_s2 / nominal.state.p_EoC_I.squaredNorm();
  // A tick before burnout both have burnt all but a tick's flow; the Earth's turning carries 0.03 m/s² of the
  // weight.
  const double around = nominal.state.v_IC_I.cross(nominal.state.p_EoC_I.normalized()).squaredNorm() /
                        nominal.state.p_EoC_I.norm();
  const double expected = Given(13040.0, 9001.0) - Given(13000.0, 9001.0) - (g - around) * 0.4;
  EXPECT_GT(std::fabs(expected), 1.0);
  EXPECT_NEAR(Climbing(full) - Climbing(nominal), expected, 5e-3 * std::fabs(expected));
}

TEST(PayloadMass, IsCarriedByItsElement) {
  FlightDefinition definition = HighDefinition();
  definition.vehicle.stages[1].structure = {{"body", 0.7, 2.0, 10.5, 1.0, 0.9},
                                            {"payload", 0.3, 1.0, 2.0, 0.8, 0.0}};
  const FlightModel model(definition);
  FlightInputs inputs;
  inputs.payload_mass_kg = 90.0;
  inputs.payload_element = 2.0;
  const LauncherPlant nominal = model.PlantFor({}), heavy = model.PlantFor(inputs);
  const MassProperties before = nominal.stacks[1].mass.At(0.0), after = heavy.stacks[1].mass.At(0.0);
  EXPECT_NEAR(after.mass_kg, before.mass_kg + 90.0, 1e-9);
  EXPECT_NEAR(after.cg_station_m,
              (before.mass_kg * before.cg_station_m + 90.0 * 1.5) / (before.mass_kg + 90.0), 1e-12);
  const double own = 90.0 * (0.64 / 16.0 + 1.0 / 12.0), apart = before.cg_station_m - 1.5;
  EXPECT_NEAR(after.transverse_inertia_kg_m2 - before.transverse_inertia_kg_m2,
              own + before.mass_kg * 90.0 / (before.mass_kg + 90.0) * apart * apart, 1e-7);
  EXPECT_NEAR(after.axial_inertia_kg_m2 - before.axial_inertia_kg_m2, 90.0 * 0.64 / 8.0, 1e-9);
  // Momentum: the same thrust moves more.
  FlightInputs plain;
  const auto at_burnout = [&](const FlightInputs& in) {
    TickSample last;
    FlightOptions options;
    options.observe = [&](const TickSample& s) {
      if (s.stack == 0 && s.burning) last = s;
    };
    Fly(model, in, options);
    return Climbing(last);
  };
  const double expected = Given(13090.0, 9090.0) - Given(13000.0, 9000.0);
  EXPECT_NEAR(at_burnout(inputs) - at_burnout(plain), expected, 2e-3 * std::fabs(expected));
}

// Nobody tells the control laws or the guidance.
TEST(DispersedMasses, AreNotKnownOnBoard) {
  const FlightModel model(SampleDefinition());
  FlightInputs inputs;
  inputs.stages[0].dry_mass_factor = 1.1;
  const StageControl nominal = BuildStageControl(model.nominal_plant(), 0);
  EXPECT_NE(BuildStageControl(model.PlantFor(inputs), 0).pitch_effectiveness_1_s2.y,
            nominal.pitch_effectiveness_1_s2.y);
  EXPECT_EQ(model.autopilot().stages[0].pitch_effectiveness_1_s2.y, nominal.pitch_effectiveness_1_s2.y);
}

// An inertia with products turns as Euler's equation says.
TEST(ProductsOfInertia, TurnTheVehicleAsEulerSays) {
  FlightInputs inputs;
  inputs.stages[0].product_of_inertia_xy_kg_m2 = 300.0;
  inputs.stages[0].product_of_inertia_xz_kg_m2 = -500.0;
  inputs.stages[0].product_of_inertia_yz_kg_m2 = 700.0;
  const LauncherPlant plant = PlantOf(inputs);
  const LauncherModel equations(plant), plain(PlantOf({}));
  RigidBodyState state;
  state.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
  state.w_IB_B = {0.3, -0.2, 0.1};
  std::array<double, kLauncherSize> y{}, dydt{};
  WriteState(state, y.data());
  y[kNozzleAngle] = 0.02;
  LauncherPhase phase;
  phase.burning = true;
  equations.Derivative(phase, 10.0, y.data(), dydt.data());
  const BodyLoads loads = equations.Evaluate(phase, 10.0, y.data()).loads;
  const BodyLoads straight = plain.Evaluate(phase, 10.0, y.data()).loads;
  EXPECT_EQ(loads.moment_n_m, straight.moment_n_m);
  const double a = straight.inertia_kg_m2(0, 0), t = straight.inertia_kg_m2(1, 1);
  Matrix3 inertia;
  inertia << a, -300.0, 500.0, -300.0, t, -700.0, 500.0, -700.0, t;
  EXPECT_EQ(loads.inertia_kg_m2, inertia);
  const Vector3 w = state.w_IB_B;
  const Vector3 moment = loads.moment_n_m - loads.inertia_rate_kg_m2_s * w - w.cross(inertia * w);
  const Vector3 expected = inertia.inverse() * moment;
  const Vector3 turned = ReadState(dydt.data()).w_IB_B;
  EXPECT_NEAR((turned - expected).norm(), 0.0, 1e-13 * expected.norm());
}

TEST(StackFactors, ActOnTheirStackAlone) {
  FlightInputs inputs;
  inputs.stages[1].drag_factor = 1.1;
  inputs.stages[1].lift_factor = 1.2;
  inputs.stages[1].cp_factor = 1.3;
  inputs.stages[1].cg_factor = 0.9;
  inputs.stages[1].inertia_factor = 1.4;
  inputs.stages[1].actuator_bandwidth_factor = 0.5;
  inputs.drag_factor = 1.01;  // the whole vehicle's multiplies
  const LauncherPlant plant = PlantOf(inputs);
  EXPECT_EQ(plant.stacks[0].aerodynamics.ca.factor, 1.01);
  EXPECT_EQ(plant.stacks[1].aerodynamics.ca.factor, 1.01 * 1.1);
  EXPECT_EQ(plant.stacks[0].aerodynamics.cn.factor, 1.0);
  EXPECT_EQ(plant.stacks[1].aerodynamics.cn.factor, 1.2);
  EXPECT_EQ(plant.stacks[1].aerodynamics.xcp_station_m.factor, 1.3);
  EXPECT_EQ(plant.stacks[0].gimbal.bandwidth_rad_s, 25.0);
  EXPECT_EQ(plant.stacks[1].gimbal.bandwidth_rad_s, 12.5);
  const LauncherModel changed(plant), nominal(PlantOf({}));
  RigidBodyState state;
  state.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
  std::array<double, kLauncherSize> y{};
  WriteState(state, y.data());
  for (int stack = 0; stack < 2; ++stack) {
    LauncherPhase phase;
    phase.stack = stack;
    const LauncherInstant now = changed.Evaluate(phase, 0.0, y.data()),
                          before = nominal.Evaluate(phase, 0.0, y.data());
    EXPECT_DOUBLE_EQ(now.cg_station_m, (stack == 1 ? 0.9 : 1.0) * before.cg_station_m);
    EXPECT_DOUBLE_EQ(now.loads.inertia_kg_m2(1, 1),
                     (stack == 1 ? 1.4 : 1.0) * before.loads.inertia_kg_m2(1, 1));
  }
  // The upper stack leaves from where its own centre is.
  const RigidBodyState left = AfterSeparation(plant, 0, 0u, state);
  const double from = plant.stacks[0].mass.At(0.0).cg_station_m;
  const double to = 0.9 * plant.stacks[1].mass.At(1000.0).cg_station_m;
  EXPECT_NEAR((left.p_EoC_I - state.p_EoC_I).norm(), from - to, 1e-8);
}

// The place of the nose, wherever the centre of gravity is. At rest a point of the body stays when masses
// leave.
Vector3 NoseOf(const LauncherPlant& plant, int stack, double propellant_kg, const RigidBodyState& state) {
  LauncherPhase phase;
  phase.stack = stack;
  LauncherPlant left = plant;
  left.stacks[static_cast<std::size_t>(stack)].burn.propellant_mass_kg = propellant_kg;
  std::array<double, kLauncherSize> y{};
  WriteState(state, y.data());
  return AtPoint(state, Vector3(LauncherModel(left).Evaluate(phase, 0.0, y.data()).cg_station_m, 0.0, 0.0))
      .p_EoC_I;
}

TEST(CentreOfGravity, AtSeparationLeavesTheNoseWhereItIs) {
  FlightInputs inputs;
  inputs.cg_factor = 1.03;
  inputs.stages[0].cg_factor = 0.98;
  const LauncherPlant plant = PlantOf(inputs);
  RigidBodyState state;
  state.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
  state.q_IB = FromRotationVector(Vector3(0.3, -0.8, 0.5));
  for (const double left_kg : {0.0, 900.0}) {
    const RigidBodyState above = AfterSeparation(plant, 0, 0u, state, left_kg);
    EXPECT_GT((above.p_EoC_I - state.p_EoC_I).norm(), 1.0);
    EXPECT_NEAR((NoseOf(plant, 1, 1000.0, above) - NoseOf(plant, 0, left_kg, state)).norm(), 0.0, 2e-9)
        << left_kg;
  }
  // The propellant left by the burn counts if no other value is given.
  LauncherPlant leaving = plant;
  leaving.stacks[0].burn.left_kg = 900.0;
  EXPECT_EQ(AfterSeparation(leaving, 0, 0u, state).p_EoC_I,
            AfterSeparation(plant, 0, 0u, state, 900.0).p_EoC_I);
}

}  // namespace
}  // namespace dispersa::flight_mass_dispersions_test
