// Boosters with liquid engines: draining tanks beside the axis by hand, the equation of rotation with what
// their flows carry off, the rocket equation with two flows, tanks that are cut off with different rests,
// and flights of three and of six degrees of freedom against CVODE.
#include "core/dynamics/integrator.h"
#include "core/dynamics/jettison.h"
#include "core/flight/flight.h"
#include "core/math/constants.h"
#include "core/trajectory/ascent.h"
#include "core/vehicle/mass.h"
#include "core/vehicle/plausibility.h"
#include "core/vehicle/vehicle_figures.h"
#include "tests/apart_boosters.h"
#include "tests/flown_ticks.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::liquid_boosters_test {
namespace {

constexpr double kDeg = kRadPerDeg;
constexpr double kThrust_n = 20e3, kFlow_kg_s = 25.0, kDry_kg = 100.0, kPropellant_kg = 500.0,
                 kRest_kg = 10.0, kRadius_m = 0.9, kNozzle_m = 19.2, kCore_n = 200e3, kPivot_m = 19.5;

// The sample vehicle, which flies in almost no air, with boosters of oxygen and kerosene at these angles, or
// with two that are all alike.
FlightDefinition Boosted(const std::vector<double>& angles_deg) {
  FlightDefinition definition = HighDefinition();
  Boosters& b = definition.vehicle.boosters;
  b.count = angles_deg.empty() ? 2 : static_cast<int>(angles_deg.size());
  b.dry_mass_kg = kDry_kg;
  b.propellant_mass_kg = kPropellant_kg;
  b.radius_m = kRadius_m;
  b.diameter_m = 0.5;
  b.top_station_m = 13.0;
  b.bottom_station_m = 19.0;
  b.nozzle_station_m = kNozzle_m;
  b.separation_delay_s = 0.5;
  b.tanks = {{"oxygen", 13.2, 15.8, 0.4, 350.0, 1141.0}, {"kerosene", 15.9, 17.6, 0.42, 150.0, 810.0}};
  b.motor.thrust_n = kThrust_n;
  b.motor.burning_time_s = kPropellant_kg / kFlow_kg_s;
  b.motor.specific_impulse_s = kThrust_n / kFlow_kg_s / kStandardGravity;
  b.motor.residual_mass_kg = kRest_kg;
  for (const double angle_deg : angles_deg) b.angles_rad.push_back(angle_deg * kDeg);
  definition.vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
  definition.vehicle.jet_damping = true;
  const std::vector<StructProblem> problems = Problems(definition.vehicle);
  EXPECT_TRUE(problems.empty()) << problems[0].path << ": " << problems[0].message;
  return definition;
}

Vehicle Bare(Vehicle vehicle) {
  vehicle.stages[0].liftoff_mass_kg -= vehicle.boosters.LiftOffMass();
  vehicle.boosters = {};
  return vehicle;
}

// A thin tube, and liquids that stand on the bottoms of their tanks and do not turn about their axes.
void AddBooster(const Boosters& b, double propellant_kg, double y_m, double z_m, std::vector<Part>& parts) {
  parts.push_back({kDry_kg, kDry_kg * 0.0625, kDry_kg * (0.5 * 0.0625 + 3.0), Vector3(16.0, y_m, z_m)});
  for (const Tank& tank : b.tanks) {
    const double kg = propellant_kg * tank.propellant_mass_kg / kPropellant_kg;
    const double height_m = kg / tank.density_kg_m3 / (0.25 * kPi * tank.diameter_m * tank.diameter_m);
    parts.push_back({kg, 0.0, kg * (tank.diameter_m * tank.diameter_m / 16.0 + height_m * height_m / 12.0),
                     Vector3(tank.bottom_station_m - 0.5 * height_m, y_m, z_m)});
  }
}
Bodies ByHand(const FlightDefinition& definition, const LauncherPlant& plant, double since_s) {
  const Vehicle bare = Bare(definition.vehicle);
  const MassProperties own = BuildStackMasses(bare)[0].At(plant.stacks[0].burn.Propellant(since_s));
  std::vector<Part> parts = {{own.mass_kg, own.axial_inertia_kg_m2, own.transverse_inertia_kg_m2,
                              Vector3(own.cg_station_m, 0.0, 0.0)}};
  const Boosters& b = definition.vehicle.boosters;
  for (const EachBooster& one : plant.boosters->each)
    AddBooster(b, one.burn.Propellant(since_s), one.y_m, one.z_m, parts);
  return SumOf(parts);
}

LauncherPhase Boosting(std::size_t count) {
  LauncherPhase phase;
  phase.burning = true;
  phase.boosters_burning = (1u << count) - 1u;
  return phase;
}
std::array<double, kLauncherSize> Far(const Vector3& w) {
  RigidBodyState s;
  s.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
  s.w_IB_B = w;
  std::array<double, kLauncherSize> y{};
  WriteState(s, y.data());
  return y;
}

// Mass, centre and tensor while they burn, while they are still carried with their rests, and afterwards.
TEST(LiquidBoosters, MassesAreThoseOfDrainingTanksAtTheirPlaces) {
  for (const auto& angles : {std::vector<double>{30.0}, {0.0, 70.0, 200.0}, {10.0, 190.0}}) {
    const FlightDefinition definition = Boosted(angles);
    FlightInputs inputs;
    inputs.further[0].nozzle.flow_factor = inputs.further[0].nozzle.thrust_factor = 1.2;
    const LauncherPlant plant = FlightModel(definition).PlantFor(inputs);
    const auto y = Far(Vector3::Zero());
    for (const double since_s : {0.0, 7.0, 15.0, 19.8}) {
      LauncherPhase phase = Boosting(angles.size());
      if (since_s > 19.6) phase.boosters_burning = 0;
      const Bodies all = ByHand(definition, plant, since_s);
      const LauncherInstant now = LauncherModel(plant).Evaluate(phase, since_s, y.data());
      EXPECT_NEAR(now.loads.mass_kg, all.mass_kg, 1e-9 * all.mass_kg) << since_s;
      EXPECT_NEAR(now.cg_station_m, all.cg.x(), 1e-10 * all.cg.x()) << since_s;
      EXPECT_NEAR((now.loads.inertia_kg_m2 - all.inertia).norm(), 0.0, 1e-9 * all.inertia.norm()) << since_s;
    }
    LauncherPhase left = Boosting(0);
    left.jettisoned = kBoostersGone;
    const Vehicle bare = Bare(definition.vehicle);
    const MassProperties own = BuildStackMasses(bare)[0].At(plant.stacks[0].burn.Propellant(21.0));
    const LauncherInstant now = LauncherModel(plant).Evaluate(left, 21.0, y.data());
    EXPECT_NEAR(now.loads.mass_kg, own.mass_kg, 1e-9 * own.mass_kg);
    EXPECT_NEAR(now.cg_station_m, own.cg_station_m, 1e-10 * own.cg_station_m);
  }
}

TEST(LiquidBoosters, WithoutAnglesStandAtEqualOnes) {
  const FlightDefinition definition = Boosted({});
  const LauncherPlant plant = FlightModel(definition).PlantFor({});
  const auto y = Far(Vector3::Zero());
  for (const double since_s : {0.0, 7.0, 15.0, 19.8}) {
    const LauncherPhase phase = Boosting(since_s < 19.6 ? 2 : 0);
    const Bodies all = ByHand(definition, plant, since_s);
    // Where masses are those of a body of revolution, the two count as spread about the axis: by half across.
    const double across = 0.5 * (all.inertia(1, 1) + all.inertia(2, 2));
    const LauncherInstant now = LauncherModel(plant).Evaluate(phase, since_s, y.data());
    EXPECT_NEAR(now.loads.mass_kg, all.mass_kg, 1e-9 * all.mass_kg) << since_s;
    EXPECT_NEAR(now.cg_station_m, all.cg.x(), 1e-10 * all.cg.x()) << since_s;
    EXPECT_NEAR((now.loads.inertia_kg_m2 - all.inertia).norm(), 0.0, 1e-9 * all.inertia.norm()) << since_s;
    const MassProperties on = MassesOn(plant, 0, 0u, plant.stacks[0].burn.Propellant(since_s), since_s);
    EXPECT_NEAR(on.transverse_inertia_kg_m2, across, 1e-9 * across) << since_s;
    EXPECT_NEAR(on.mass_kg, all.mass_kg, 1e-9 * all.mass_kg) << since_s;
  }
}

// I dw/dt + w x I w + dI/dt w + what the flows carry off = M, where dI/dt is the difference of two tensors.
TEST(LiquidBoosters, TurnByTheEquationOfRotation) {
  for (const auto& angles : {std::vector<double>{20.0, 130.0, 250.0}, {10.0, 190.0}, {}}) {
    const FlightDefinition definition = Boosted(angles);
    const bool is_odd = angles.size() == 3;
    FlightInputs inputs;
    if (is_odd) inputs.further[1].nozzle.thrust_factor = inputs.further[1].nozzle.flow_factor = 1.1;
    const LauncherPlant plant = FlightModel(definition).PlantFor(inputs);
    const Vector3 w(0.03, -0.05, 0.04);
    const auto y = Far(w);
    const double since_s = 6.0, h_s = 1e-3;
    const Bodies all = ByHand(definition, plant, since_s);
    Vector3 moment = Vector3(all.cg.x() - kPivot_m, -all.cg.y(), -all.cg.z()).cross(Vector3(kCore_n, 0, 0));
    const double core_kg_s = plant.stacks[0].burn.full_flow_kg_s, lever = all.cg.x() - kPivot_m;
    Vector3 carried = core_kg_s * Vector3(0.16 * w.x(), lever * lever * w.y(), lever * lever * w.z());
    const int count = definition.vehicle.boosters.count;
    for (int k = 0; k < count; ++k) {
      const double at = angles.empty() ? kPi * k : angles[static_cast<std::size_t>(k)] * kDeg;
      const double factor = is_odd && k == 1 ? 1.1 : 1.0;
      const Vector3 arm(all.cg.x() - kNozzle_m, kRadius_m * std::cos(at) - all.cg.y(),
                        kRadius_m * std::sin(at) - all.cg.z());
      moment += arm.cross(Vector3(factor * kThrust_n, 0.0, 0.0));
      carried += factor * kFlow_kg_s * arm.cross(w.cross(arm));
    }
    const Matrix3 rate = (ByHand(definition, plant, since_s + h_s).inertia -
                          ByHand(definition, plant, since_s - h_s).inertia) /
                         (2.0 * h_s);
    std::array<double, kLauncherSize> dydt{};
    LauncherModel(plant).Derivative(Boosting(plant.boosters->each.size()), since_s, y.data(), dydt.data());
    const Vector3 expected = all.inertia.inverse() * (moment - w.cross(all.inertia * w) - rate * w - carried);
    const Vector3 is = ReadState(dydt.data()).w_IB_B;
    // The stage's own flow counts as if C were on the axis. Of an odd set it is beside it: what that flow
    // carries off is wrong by its lever times this distance.
    const double aside_m = all.cg.tail<2>().norm();
    const double beside_1_s2 =
        core_kg_s * std::fabs(lever) * aside_m * w.norm() * all.inertia.inverse().norm();
    EXPECT_NEAR((is - expected).norm(), 0.0, 1e-6 * expected.norm() + beside_1_s2) << angles.size();
    EXPECT_LT(beside_1_s2, 1e-2 * expected.norm());
    EXPECT_GT((all.inertia.inverse() * (rate * w)).norm(), 1e-3 * expected.norm()) << "the surfaces count";
  }
}

// Across the axis, of those all alike: where the centre moves to and where the liquids' surfaces are.
TEST(LiquidBoosters, TheirSurfacesSayHowFastInertiaFalls) {
  const LauncherPlant plant = FlightModel(Boosted({})).PlantFor({});
  const LauncherModel equations(plant);
  const auto y = Far(Vector3::Zero());
  const auto at = [&](double since_s) { return equations.Evaluate(Boosting(0), since_s, y.data()); };
  const double h_s = 1e-3;
  for (const double since_s : {1.0, 10.0, 19.0}) {
    const Matrix3 rate =
        (at(since_s + h_s).loads.inertia_kg_m2 - at(since_s - h_s).loads.inertia_kg_m2) / (2.0 * h_s);
    EXPECT_NEAR((at(since_s).loads.inertia_rate_kg_m2_s - rate).norm(), 0.0, 1e-7 * rate.norm()) << since_s;
  }
}

struct Burning {
  const LauncherModel* equations;
  LauncherPhase phase;
};
void Rhs(double t, const double* y, double* dydt, void* context) {
  const auto* self = static_cast<const Burning*>(context);
  self->equations->Derivative(self->phase, t, y, dydt);
}

// Both flows together, then the stage alone; and what `validate` calls the ideal gain is the same.
TEST(LiquidBoosters, GainTheRocketEquationsSpeed) {
  const Vehicle vehicle = Boosted({}).vehicle;
  LauncherPlant plant = BuildNominalPlant(vehicle);
  plant.environment.earth = SphericalEarth(6371000.0, false);
  plant.environment.earth.mu_m3_s2 = 0.0;
  const double boost_s = plant.boosters->burn.duration_s, core_s = plant.stacks[0].burn.duration_s;
  EXPECT_NEAR(boost_s, (kPropellant_kg - kRest_kg) / kFlow_kg_s, 1e-12);
  RigidBodyState s;
  s.p_EoC_I = {1e9, 0.0, 0.0};
  std::array<double, kLauncherSize> y{};
  WriteState(s, y.data());
  const auto advance = [&](const LauncherPhase& phase, double from_s, double to_s) {
    const LauncherModel equations(plant);
    Burning flight{&equations, phase};
    Integrator integrator(Scheme::kRungeKutta4, kRigidLauncherSize, &Rhs, &flight, nullptr);
    EXPECT_TRUE(integrator.Advance(from_s, to_s, 3000, y.data()));
  };
  LauncherPhase phase = Boosting(2);
  advance(phase, 0.0, boost_s);
  WriteState(AfterJettison(plant, 0, 0u, kBoostersGone, plant.stacks[0].burn.Propellant(boost_s), boost_s,
                           ReadState(y.data())),
             y.data());
  phase.boosters_burning = 0;
  phase.jettisoned = kBoostersGone;
  advance(phase, boost_s, core_s);

  const Stage& core = vehicle.stages[0];
  const double core_kg_s = core.propellant_mass_kg / core.motor.burning_time_s;
  const double both_kg_s = core_kg_s + 2.0 * kFlow_kg_s;
  const double at_boost_kg = core.liftoff_mass_kg - both_kg_s * boost_s;
  const double alone_kg = at_boost_kg - 2.0 * (kDry_kg + kRest_kg);
  const double exact_m_s =
      (core.motor.thrust_n + 2.0 * kThrust_n) / both_kg_s * std::log(core.liftoff_mass_kg / at_boost_kg) +
      core.motor.thrust_n / core_kg_s * std::log(alone_kg / (alone_kg - core_kg_s * (core_s - boost_s)));
  EXPECT_NEAR(ReadState(y.data()).v_IC_I.norm(), exact_m_s, 1e-6);
  EXPECT_NEAR(FiguresOf(vehicle)[0].ideal_delta_v_m_s, exact_m_s, 1e-6);
}

// Throttled, by hand: 250 kg in 10 s, 40 kg on the way down to 0.6, and 200 kg at 15 kg/s.
TEST(LiquidBoosters, BurnAsTheirThrottleSaysAndLeaveWithTheirRests) {
  FlightDefinition definition = Boosted({0.0, 180.0});
  definition.vehicle.boosters.motor.throttle = {{0.0, 10.0, 12.0}, {1.0, 1.0, 0.6}};
  ASSERT_TRUE(Problems(definition.vehicle).empty());
  const double end_s = 12.0 + 200.0 / 15.0;
  FlightResult result;
  const auto ticks = TicksOf(definition, {}, &result);
  ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
  double before_kg = 0.0, dropped_kg = 0.0, dropped_s = 0.0;
  for (const TickSample& s : ticks) {
    if (s.stack != 0 || !s.burning) continue;
    EXPECT_EQ(s.boosting, s.time_s < end_s) << s.time_s;
    const double level = s.time_s < 10.0 ? 1.0 : s.time_s < 12.0 ? 1.0 - 0.2 * (s.time_s - 10.0) : 0.6;
    const double boosters_n = s.boosting ? 2.0 * level * kThrust_n : 0.0;
    EXPECT_NEAR(s.instant.thrust_n, kCore_n + boosters_n, 1e-5) << s.time_s;
    const double mass_kg = s.instant.loads.mass_kg;
    if (before_kg - mass_kg > 150.0) {
      dropped_kg = before_kg - mass_kg - 0.01 * s.instant.flow_kg_s;
      dropped_s = s.time_s;
    }
    before_kg = mass_kg;
  }
  EXPECT_NEAR(dropped_s, end_s + 0.5, 0.011);
  EXPECT_NEAR(dropped_kg, 2.0 * (kDry_kg + kRest_kg), 1e-6);
}

// Cut off by time, a faster engine leaves less. All parts keep their momentum and their common centre.
TEST(LiquidBoosters, SeparationKeepsTheMomentumOfDifferentRests) {
  FlightDefinition definition = Boosted({30.0, 100.0});
  Motor& motor = definition.vehicle.boosters.motor;
  motor.cut_off = CutOff::kAtTime;
  motor.cut_off_s = 12.0;
  FlightInputs inputs;
  inputs.further[1].nozzle.thrust_factor = inputs.further[1].nozzle.flow_factor = 1.1;
  const LauncherPlant plant = FlightModel(definition).PlantFor(inputs);
  const std::vector<EachBooster>& each = plant.boosters->each;
  EXPECT_NEAR(each[0].burn.left_kg, 200.0, 1e-9);
  EXPECT_NEAR(each[1].burn.left_kg, 170.0, 1e-9);
  const double since_s = 12.5;
  std::vector<Bodies> leaving;
  for (const EachBooster& one : each) {
    std::vector<Part> parts;
    AddBooster(definition.vehicle.boosters, one.burn.left_kg, one.y_m, one.z_m, parts);
    leaving.push_back(SumOf(parts));
  }
  EXPECT_GT(ExpectSeparationKeepsMomentum(plant, since_s, ByHand(definition, plant, since_s), leaving), 1e-2);
}

FlightDefinition Steering() {
  FlightDefinition definition = Boosted({15.0, 195.0});
  Boosters& b = definition.vehicle.boosters;
  b.cant_rad = 6.0 * kDeg;
  b.gimbal.limit_rad = 5.0 * kDeg;
  b.gimbal.rate_limit_rad_s = 20.0 * kDeg;
  b.gimbal.bandwidth_rad_s = 30.0;
  b.towards_rad = {90.0 * kDeg, 180.0 * kDeg};
  b.motor.throttle = {{0.0, 8.0, 9.0}, {1.0, 1.0, 0.9}};
  EXPECT_TRUE(Problems(definition.vehicle).empty());
  return definition;
}

// Engines that differ, nozzles that turn: the judge integrates the same equations by other means.
TEST(LiquidBoosters, FlyAsCvodeFliesThem) {
  const FlightDefinition definition = Steering();
  FlightInputs inputs;
  inputs.further[1].nozzle.thrust_factor = inputs.further[1].nozzle.flow_factor = 1.03;
  inputs.further[0].nozzle.line.misalignment_rad.z = 0.004;
  const auto engine = TicksOf(definition, inputs),
             judge = TicksOf(definition, inputs, nullptr, {.scheme = Scheme::kCvode});
  ASSERT_EQ(engine.size(), judge.size());
  double rates = 0.0, speeds = 0.0, greatest = 0.0;
  for (std::size_t i = 0; i < engine.size() && engine[i].time_s < 40.0; ++i) {
    rates = std::max(rates, (engine[i].state.w_IB_B - judge[i].state.w_IB_B).norm());
    speeds = std::max(speeds, (engine[i].state.v_IC_I - judge[i].state.v_IC_I).norm());
    greatest = std::max(greatest, engine[i].state.w_IB_B.norm());
  }
  EXPECT_LT(rates, 1e-4 * greatest);
  EXPECT_LT(speeds, 1e-4);
  EXPECT_GT(engine.size(), 4000u);
}

// The optimiser's point mass carries their rests as the flight does.
TEST(LiquidBoosters, FlyInThreeAndSixDegreesOfFreedom) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  Boosters& b = definition.vehicle.boosters;
  b = {4, 150.0, 900.0, 0.97, 0.62, 21.0, 26.5, 26.4, {}, {}, 0.5};
  b.tanks = {{"oxygen", 21.1, 23.7, 0.6, 630.0, 1141.0}, {"kerosene", 23.8, 25.3, 0.6, 270.0, 810.0}};
  b.motor.thrust_n = 80e3;
  b.motor.burning_time_s = 30.0;
  b.motor.specific_impulse_s = 80e3 * 30.0 / 900.0 / kStandardGravity;
  b.motor.residual_mass_kg = 60.0;
  definition.vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
  const std::vector<StructProblem> problems = Problems(definition.vehicle);
  ASSERT_TRUE(problems.empty()) << problems[0].path << ": " << problems[0].message;
  AscentOptions options;
  options.record = true;
  const FlightProgram program = LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program;
  const AscentResult ascent = FlyAscent(BuildAscentModel(definition.vehicle, 0.01), program, options);
  ASSERT_TRUE(ascent.completed);
  definition.program = ascent.attitude;
  definition.last_ignition_s = ascent.last_ignition_s;
  const FlightResult flown = Fly(FlightModel(definition), {}, {});
  ASSERT_EQ(flown.outcome, Outcome::kCompleted) << flown.reason;
  EXPECT_NEAR(MetricOf(flown, "injection_velocity_m_s"), ascent.orbit.velocity_m_s, 2.0);
  EXPECT_NEAR(MetricOf(flown, "injection_altitude_km"), 1e-3 * ascent.orbit.altitude_m, 2.0);
}

// As engines and tanks of stages are.
TEST(LiquidBoosters, AreComparedWithKnownEnginesAndTanks) {
  Vehicle vehicle = Boosted({}).vehicle;
  const auto unusual = [&] {
    std::string paths;
    for (const PlausibilityFinding& finding : Plausibility(vehicle))
      if (finding.path.starts_with("boosters")) paths += finding.path + " ";
    return paths;
  };
  Boosters& b = vehicle.boosters;
  EXPECT_EQ(unusual(), "boosters.motor.liquid.specific_impulse_s ");
  b.motor.specific_impulse_s = 300.0;
  EXPECT_EQ(unusual(), "");
  b.motor.residual_mass_kg = 50.0;
  EXPECT_EQ(unusual(), "boosters.motor.liquid.residual_mass_kg ");
  b.motor.residual_mass_kg = kRest_kg;
  b.tanks[1].density_kg_m3 = 2000.0;
  EXPECT_EQ(unusual(), "boosters.tanks[1].density_kg_m3 boosters.tanks[1].propellant_mass_kg ");
}

TEST(LiquidBoosters, AreCutOffByTimeOrDepletion) {
  Vehicle vehicle = Boosted({0.0, 180.0}).vehicle;
  const auto problems = [&] {
    std::string text;
    for (const StructProblem& problem : Problems(vehicle))
      text += problem.path + ": " + problem.message + ", allowed: " + problem.allowed + "\n";
    return text;
  };
  Boosters& b = vehicle.boosters;
  b.motor.cut_off = CutOff::kAtVelocity;
  b.motor.cut_off_velocity_m_s = 1500.0;
  EXPECT_EQ(problems(),
            "boosters.motor.liquid.cut_off.at: is a speed of the vehicle, but the boosters leave by a clock "
            "after their burnout, allowed: depletion or time\n");
  b.motor.cut_off = CutOff::kAtDepletion;
  b.tanks[0].diameter_m = 0.6;
  EXPECT_EQ(problems(),
            "boosters.tanks[0].diameter_m: is larger than the booster, allowed: at most diameter_m\n");
  b.tanks[0].diameter_m = 0.4;
  b.tanks[1].bottom_station_m = 19.1;
  EXPECT_EQ(
      problems(),
      "boosters.tanks[1].bottom_station_m: lies aft of the booster's bottom_station_m, allowed: at most "
      "bottom_station_m of the booster\n");
}

}  // namespace
}  // namespace dispersa::liquid_boosters_test
