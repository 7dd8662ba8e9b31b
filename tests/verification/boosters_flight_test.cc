// Boosters beside the first stage: mass properties by hand, angular momentum and the rocket equation in
// space, and a flight of three and of six degrees of freedom.
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "core/dynamics/integrator.h"
#include "core/dynamics/jettison.h"
#include "core/flight/flight.h"
#include "core/flight/tick_sample.h"
#include "core/math/constants.h"
#include "core/trajectory/ascent.h"
#include "core/vehicle/vehicle_figures.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::boosters_flight_test {
namespace {

// SLV-4 with four small boosters.
Vehicle Boosted(int count = 4) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  Boosters& b = vehicle.boosters;
  b.count = count;
  b.dry_mass_kg = 150.0;
  b.propellant_mass_kg = 900.0;
  b.radius_m = 0.97;
  b.diameter_m = 0.62;
  b.top_station_m = 21.0;
  b.bottom_station_m = 26.5;
  b.nozzle_station_m = 26.4;
  b.motor.thrust_n = 80e3;
  b.motor.burning_time_s = 30.0;
  b.grain = {22.0, 24.05, 0.6, 0.2};
  b.separation_delay_s = 0.5;
  vehicle.stages[0].liftoff_mass_kg += count * (b.dry_mass_kg + b.propellant_mass_kg);
  EXPECT_TRUE(Problems(vehicle).empty());
  return vehicle;
}

// Out of reach of air and gravitation.
LauncherPlant InSpace(const Vehicle& vehicle) {
  LauncherPlant plant = BuildNominalPlant(vehicle);
  plant.environment.earth = SphericalEarth(6371000.0, false);
  plant.environment.earth.mu_m3_s2 = 0.0;
  return plant;
}

struct Coasting {
  const LauncherModel* equations;
  LauncherPhase phase;
};
void Rhs(double t, const double* y, double* dydt, void* context) {
  const auto* self = static_cast<const Coasting*>(context);
  self->equations->Derivative(self->phase, t, y, dydt);
}
void Advance(const LauncherPlant& plant, const LauncherPhase& phase, double from_s, double to_s, double* y) {
  const LauncherModel equations(plant);
  Coasting flight{&equations, phase};
  Integrator integrator(Scheme::kRungeKutta4, kRigidLauncherSize, &Rhs, &flight, nullptr);
  EXPECT_TRUE(integrator.Advance(from_s, to_s, 3000, y));
}

LauncherPhase Boosting() {
  LauncherPhase phase;
  phase.burning = true;
  phase.boosters_burning = kAllBoosters;
  return phase;
}

// Four tubes and four grains, each about its own axis and then about the vehicle's: Huygens and Steiner.
TEST(Boosters, MassesAreThoseOfTubesAtTheirPlaces) {
  const Vehicle vehicle = Boosted();
  const Boosters& b = vehicle.boosters;
  Vehicle core = vehicle;
  core.boosters = {};
  core.stages[0].liftoff_mass_kg -= b.count * (b.dry_mass_kg + b.propellant_mass_kg);
  const LauncherPlant plant = BuildNominalPlant(vehicle);
  const StackMass alone = BuildStackMasses(core)[0];
  for (const double since_s : {0.0, 11.0, 30.0}) {
    const double propellant_kg = plant.stacks[0].burn.Propellant(since_s);
    const double one_kg = b.propellant_mass_kg * (1.0 - since_s / b.motor.burning_time_s);
    const double outer2 = 0.09, inner2 = outer2 - one_kg / b.propellant_mass_kg * 0.08;
    const MassProperties own = alone.At(propellant_kg);
    double mass = own.mass_kg, first = own.mass_kg * own.cg_station_m;
    mass += b.count * (b.dry_mass_kg + one_kg);
    first += b.count * (b.dry_mass_kg * 23.75 + one_kg * 23.025);
    const double cg = first / mass;
    double axial = own.axial_inertia_kg_m2;
    double about_y = own.transverse_inertia_kg_m2 + own.mass_kg * std::pow(own.cg_station_m - cg, 2);
    for (int i = 0; i < b.count; ++i) {
      const double z = b.radius_m * std::sin(0.5 * kPi * i);
      const double shell2 = 0.31 * 0.31, length2 = 5.5 * 5.5 / 12.0, grain2 = 2.05 * 2.05 / 12.0;
      axial += b.dry_mass_kg * (shell2 + b.radius_m * b.radius_m) +
               one_kg * (0.5 * (outer2 + inner2) + b.radius_m * b.radius_m);
      about_y += b.dry_mass_kg * (0.5 * shell2 + length2 + z * z + std::pow(23.75 - cg, 2)) +
                 one_kg * (0.25 * (outer2 + inner2) + grain2 + z * z + std::pow(23.025 - cg, 2));
    }
    const MassProperties is = MassesOn(plant, 0, 0u, propellant_kg, since_s);
    EXPECT_NEAR(is.mass_kg, mass, 1e-9 * mass) << since_s;
    EXPECT_NEAR(is.cg_station_m, cg, 1e-10 * cg) << since_s;
    EXPECT_NEAR(is.axial_inertia_kg_m2, axial, 1e-9 * axial) << since_s;
    EXPECT_NEAR(is.transverse_inertia_kg_m2, about_y, 1e-9 * about_y) << since_s;
  }
  // Gone, nothing of them is left.
  const MassProperties left = MassesOn(plant, 0, kBoostersGone, 5000.0, 31.0), is = alone.At(5000.0);
  EXPECT_NEAR(left.mass_kg, is.mass_kg, 1e-9 * is.mass_kg);
  EXPECT_NEAR(left.cg_station_m, is.cg_station_m, 1e-11 * is.cg_station_m);
  EXPECT_NEAR(left.axial_inertia_kg_m2, is.axial_inertia_kg_m2, 1e-9 * is.axial_inertia_kg_m2);
  EXPECT_NEAR(left.transverse_inertia_kg_m2, is.transverse_inertia_kg_m2, 1e-9 * is.transverse_inertia_kg_m2);
}

// A heavier second stage, or more propellant in the last, is all that a flight with dispersed masses has
// more.
TEST(Boosters, StayAsTheyAreWhereMassesAreDispersed) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  definition.vehicle = Boosted();
  definition.vehicle.stages[3].jettisoned = {
      {"fairing", 60.0, 0.2, 2.5, 1.0, 0.97, JettisonTrigger::kAtTime, 150.0}};
  const FlightModel model(definition);
  FlightInputs inputs;
  inputs.stages[1].dry_mass_factor = 1.1;
  inputs.stages[3].propellant_factor = 1.02;
  const double more_kg =
      0.1 * DryMass(definition.vehicle, 1) + 0.02 * definition.vehicle.stages[3].propellant_mass_kg;
  const double nominal_kg = model.nominal_plant().stacks[0].mass.fixed_mass_kg;
  EXPECT_NEAR(model.PlantFor(inputs).stacks[0].mass.fixed_mass_kg - nominal_kg, more_kg, 1e-8);
}

// d(I w)/dt = -sum of m_dot l² w, l from C to where each flow leaves: variable_mass_test has the law for one.
TEST(Boosters, TheirFlowTakesAngularMomentumWithIt) {
  const Vehicle vehicle = Boosted();
  const LauncherPlant plant = InSpace(vehicle);
  const BoosterSet& set = *plant.boosters;
  const Gimbal& gimbal = plant.stacks[0].gimbal;
  const double core_kg_s = plant.stacks[0].burn.full_flow_kg_s, beside_kg_s = set.burn.full_flow_kg_s;
  const double end_s = set.burn.duration_s;
  const auto masses = [&](double t) { return MassesOn(plant, 0, 0u, plant.stacks[0].burn.Propellant(t), t); };
  const auto kept = [&](double MassProperties::*inertia, const auto& taken_kg_m2_s) {
    const double damped = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        [&](double t) { return taken_kg_m2_s(t) / (masses(t).*inertia); }, 0.0, end_s);
    return masses(0.0).*inertia / (masses(end_s).*inertia) * std::exp(-damped);
  };
  const double across = kept(&MassProperties::transverse_inertia_kg_m2, [&](double t) {
    const double cg = masses(t).cg_station_m, r = set.radius_m;
    return core_kg_s * std::pow(gimbal.pivot_station_m - cg, 2) +
           beside_kg_s * (std::pow(set.nozzle_station_m - cg, 2) + 0.5 * r * r);
  });
  const double about = kept(&MassProperties::axial_inertia_kg_m2, [&](double) {
    return core_kg_s * gimbal.radius_m * gimbal.radius_m + beside_kg_s * set.radius_m * set.radius_m;
  });
  for (const auto& [axis, expected] : {std::pair{0, about}, {1, across}, {2, across}}) {
    RigidBodyState s;
    s.p_EoC_I = {1e9, 0.0, 0.0};
    s.w_IB_B[axis] = 0.01;
    std::array<double, kLauncherSize> y{};
    WriteState(s, y.data());
    Advance(plant, Boosting(), 0.0, end_s, y.data());
    EXPECT_NEAR(ReadState(y.data()).w_IB_B[axis] / 0.01, expected, 1e-9) << axis;
  }
}

// In two steps; and what `validate` calls the ideal gain is the same.
TEST(Boosters, GainTheRocketEquationsSpeed) {
  const Vehicle vehicle = Boosted();
  const LauncherPlant plant = InSpace(vehicle);
  const double boost_s = plant.boosters->burn.duration_s, core_s = plant.stacks[0].burn.duration_s;
  RigidBodyState s;
  s.p_EoC_I = {1e9, 0.0, 0.0};
  std::array<double, kLauncherSize> y{};
  WriteState(s, y.data());
  LauncherPhase phase = Boosting();
  Advance(plant, phase, 0.0, boost_s, y.data());
  WriteState(AfterJettison(plant, 0, 0u, kBoostersGone, plant.stacks[0].burn.Propellant(boost_s), boost_s,
                           ReadState(y.data())),
             y.data());
  phase.boosters_burning = 0;
  phase.jettisoned = kBoostersGone;
  Advance(plant, phase, boost_s, core_s, y.data());

  const Stage& core = vehicle.stages[0];
  const Boosters& b = vehicle.boosters;
  const double core_kg_s = core.propellant_mass_kg / core.motor.burning_time_s;
  const double beside_kg_s = b.count * b.propellant_mass_kg / b.motor.burning_time_s;
  const double at_boost_kg = core.liftoff_mass_kg - (core_kg_s + beside_kg_s) * boost_s;
  const double alone_kg = at_boost_kg - b.count * b.dry_mass_kg;
  const double exact_m_s =
      (core.motor.thrust_n + b.count * b.motor.thrust_n) / (core_kg_s + beside_kg_s) *
          std::log(core.liftoff_mass_kg / at_boost_kg) +
      core.motor.thrust_n / core_kg_s * std::log(alone_kg / (alone_kg - core_kg_s * (core_s - boost_s)));
  EXPECT_NEAR(ReadState(y.data()).v_IC_I.norm(), exact_m_s, 1e-6);
  EXPECT_NEAR(FiguresOf(vehicle)[0].ideal_delta_v_m_s, exact_m_s, 1e-6);
}

// The most that the vehicle is loaded with: at the boosters' end or at the stage's own, by hand.
TEST(Boosters, LoadTheVehicleMostWhereItPushesMostForItsMass) {
  for (const double boost_n : {80e3, 400e3}) {
    Vehicle vehicle = Boosted();
    vehicle.boosters.motor.thrust_n = boost_n;
    const Stage& core = vehicle.stages[0];
    const Boosters& b = vehicle.boosters;
    const double left_kg = core.liftoff_mass_kg - b.count * b.propellant_mass_kg -
                           core.propellant_mass_kg * b.motor.burning_time_s / core.motor.burning_time_s;
    const double at_boosters_end = (core.motor.thrust_n + b.count * boost_n) / left_kg;
    const double empty_kg =
        core.liftoff_mass_kg - core.propellant_mass_kg - b.count * (b.propellant_mass_kg + b.dry_mass_kg);
    const double at_its_own = core.motor.thrust_n / empty_kg;
    EXPECT_EQ(at_boosters_end > at_its_own, boost_n > 100e3);
    EXPECT_NEAR(FiguresOf(vehicle)[0].burnout_load_g,
                std::max(at_boosters_end, at_its_own) / kStandardGravity, 1e-9);
  }
}

TEST(Boosters, FlyInThreeAndSixDegreesOfFreedom) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  definition.vehicle = Boosted();
  AscentOptions options;
  options.record = true;
  const AscentModel ascent_model = BuildAscentModel(definition.vehicle, 0.01);
  const FlightProgram program = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program;
  const AscentResult ascent = FlyAscent(ascent_model, program, options);
  ASSERT_TRUE(ascent.completed);
  options.record = false;
  options.steps = HalvedSteps(options.steps);
  const AscentResult fine = FlyAscent(ascent_model, program, options);
  EXPECT_NEAR(fine.orbit.velocity_m_s, ascent.orbit.velocity_m_s, 1e-3);
  definition.program = ascent.attitude;
  definition.last_ignition_s = ascent.last_ignition_s;
  const FlightModel model(definition);
  double before_kg = 0.0, dropped_kg = 0.0, dropped_s = 0.0, thrust_n = 0.0;
  FlightOptions watching;
  watching.observe = [&](const TickSample& s) {
    const double mass_kg = s.instant.loads.mass_kg;
    if (s.time_s == 0.0) thrust_n = s.instant.thrust_n;
    if (dropped_s == 0.0 && before_kg - mass_kg > 500.0) {
      dropped_s = s.time_s;
      dropped_kg = before_kg - mass_kg;
    }
    before_kg = mass_kg;
  };
  const FlightResult flown = Fly(model, {}, watching);
  ASSERT_EQ(flown.outcome, Outcome::kCompleted) << flown.reason;
  EXPECT_NEAR(thrust_n, 593e3 + 4 * 80e3, 1e-6);
  EXPECT_NEAR(dropped_s, 30.5, 0.011);
  EXPECT_NEAR(dropped_kg, 4 * 150.0 + 0.01 * 18760.0 / 70.7, 1e-6);
  EXPECT_NEAR(MetricOf(flown, "injection_velocity_m_s"), ascent.orbit.velocity_m_s, 2.0);
  EXPECT_NEAR(MetricOf(flown, "injection_altitude_km"), 1e-3 * ascent.orbit.altitude_m, 2.0);
}

// The core goes on alone above the air: its incidence is a phase of its own, from the boosters' separation to
// the stage's depletion.
TEST(Boosters, LeaveACoreThatIsSteered) {
  const Vehicle vehicle = Boosted();
  FlightProgram program = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program;
  AscentOptions options;
  options.record = true;
  const AscentModel model = BuildAscentModel(vehicle, 0.01);
  const AscentResult straight = FlyAscent(model, program, options);
  const double begin_rad = 0.06, end_rad = 0.02;
  program.steering[0] = {begin_rad, end_rad};
  const AscentResult steered = FlyAscent(model, program, options);
  ASSERT_TRUE(straight.completed && steered.completed);
  EXPECT_GT(steered.orbit.altitude_m, straight.orbit.altitude_m + 1e3);
  // Burnout after 30 s is detected on a tick; the boosters leave 0.5 s later.
  const double left_s = 30.5, whole_s = vehicle.stages[0].motor.burning_time_s - left_s;
  int seen = 0;
  for (const AscentSample& s : steered.samples) {
    if (s.stage != 1 || s.time_s < program.t2_s || s.time_s > left_s + whole_s) continue;
    const double since_s = s.time_s - left_s, x = std::clamp(since_s / kSteeringRise_s, 0.0, 1.0);
    const double risen = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
    EXPECT_NEAR(s.alpha_rad, risen * (begin_rad + since_s / whole_s * (end_rad - begin_rad)), 1e-6)
        << since_s;
    seen += since_s > 0.0;
  }
  EXPECT_GT(seen, 20);
}

}  // namespace
}  // namespace dispersa::boosters_flight_test
