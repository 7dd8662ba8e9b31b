// Jettison: mass properties, the jump of the state, its time in three and six degrees of freedom, and its
// velocity gain by the rocket equation.
#include "core/dynamics/jettison.h"
#include "core/flight/flight.h"
#include "core/margins/linear_axis.h"
#include "core/math/constants.h"
#include "core/trajectory/ascent.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::jettison_test {
namespace {

constexpr double kFairing_kg = 60.0;

Jettison Fairing(JettisonTrigger trigger, double threshold) {
  return {"fairing", kFairing_kg, 0.2, 2.5, 1.0, 0.97, trigger, threshold};
}

// SLV-4 with a part of its last stage's mass as a fairing.
Vehicle WithFairing(JettisonTrigger trigger, double threshold) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  vehicle.stages[3].jettisoned = {Fairing(trigger, threshold)};
  return vehicle;
}

FlightProgram Program() { return LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km.yaml").program; }

AscentResult Ascend(const Vehicle& vehicle, double step_factor = 1.0, bool record = false) {
  AscentOptions options;
  options.record = record;
  options.steps = {step_factor * options.steps.air_s, step_factor * options.steps.burn_s,
                   step_factor * options.steps.coast_s};
  return FlyAscent(BuildAscentModel(vehicle, 0.01), Program(), options);
}

// A vehicle that never had the fairing has the same stacks as one that has let go of it.
TEST(Jettison, LeavesTheStacksOfAVehicleWithoutIt) {
  const Vehicle with = WithFairing(JettisonTrigger::kAtTime, 100.0);
  Vehicle without = with;
  without.stages[3].jettisoned.clear();
  for (Stage& stage : without.stages) stage.liftoff_mass_kg -= kFairing_kg;
  const LauncherPlant plant = BuildNominalPlant(with), bare = BuildNominalPlant(without);
  for (int stack = 0; stack < 4; ++stack) {
    const StackMass& expected = bare.stacks[static_cast<std::size_t>(stack)].mass;
    const double propellant_kg = 0.4 * expected.propellant_mass_kg;
    const MassProperties left = MassOf(plant, stack, 1u).At(propellant_kg), is = expected.At(propellant_kg);
    EXPECT_NEAR(left.mass_kg, is.mass_kg, 1e-12 * is.mass_kg) << stack;
    EXPECT_NEAR(left.cg_station_m, is.cg_station_m, 1e-12 * is.cg_station_m) << stack;
    EXPECT_NEAR(left.axial_inertia_kg_m2, is.axial_inertia_kg_m2, 1e-10 * is.axial_inertia_kg_m2) << stack;
    EXPECT_NEAR(left.transverse_inertia_kg_m2, is.transverse_inertia_kg_m2,
                1e-10 * is.transverse_inertia_kg_m2)
        << stack;
    EXPECT_GT(MassOf(plant, stack, 0u).At(propellant_kg).mass_kg, is.mass_kg + kFairing_kg - 1e-6) << stack;
  }
}

// The rest goes on as it was: its centre of gravity is another point of the same turning body.
TEST(Jettison, MovesTheStateToTheCentreOfGravityOfWhatIsLeft) {
  const LauncherPlant plant = BuildNominalPlant(WithFairing(JettisonTrigger::kAtTime, 100.0));
  RigidBodyState s;
  s.p_EoC_I = {6.6e6, 1e5, -2e4};
  s.v_IC_I = {10.0, 3e3, 50.0};
  s.q_IB = FromRotationVector(Vector3(0.3, -0.7, 1.1));
  s.w_IB_B = {0.01, -0.03, 0.02};
  const double propellant_kg = 1000.0;
  const RigidBodyState after = AfterJettison(plant, 1, 0u, 1u, propellant_kg, 0.0, s);
  const double step_m = MassOf(plant, 1, 0u).At(propellant_kg).cg_station_m -
                        MassOf(plant, 1, 1u).At(propellant_kg).cg_station_m;
  ASSERT_LT(step_m, -0.05);  // aft
  const Matrix3 R_IB = RotationMatrix(s.q_IB);
  const Vector3 arm = R_IB * Vector3(step_m, 0.0, 0.0);
  EXPECT_NEAR((after.p_EoC_I - s.p_EoC_I - arm).norm(), 0.0, 1e-9);
  EXPECT_NEAR((after.v_IC_I - s.v_IC_I - (R_IB * s.w_IB_B).cross(arm)).norm(), 0.0, 1e-12);
  EXPECT_EQ(after.w_IB_B, s.w_IB_B);
}

// In the coast: what the last stage then gains is the rocket equation's, since nothing else acts along its
// way that depends on its mass.
TEST(Jettison, IsWorthWhatTheRocketEquationSays) {
  const Vehicle kept = WithFairing(JettisonTrigger::kAtTime, 1e6);
  const Vehicle dropped = WithFairing(JettisonTrigger::kAtTime, 300.0);
  const AscentResult with = Ascend(kept), without = Ascend(dropped);
  ASSERT_TRUE(with.completed && without.completed);
  EXPECT_EQ(with.jettison_s, std::vector<double>{HUGE_VAL});
  ASSERT_EQ(without.jettison_s.size(), 1u);
  EXPECT_NEAR(without.jettison_s[0], 300.0, 1e-9);
  const Stage& last = kept.stages[3];
  const double exhaust_m_s = last.motor.thrust_n * last.motor.burning_time_s / last.propellant_mass_kg;
  const auto gain = [&](double mass_kg) { return std::log(mass_kg / (mass_kg - last.propellant_mass_kg)); };
  const double expected_m_s =
      exhaust_m_s * (gain(last.liftoff_mass_kg - kFairing_kg) - gain(last.liftoff_mass_kg));
  const double found_m_s = without.orbit.velocity_m_s - with.orbit.velocity_m_s;
  // The rest is gravity along a path that the faster stage turns sooner.
  EXPECT_NEAR(found_m_s, expected_m_s, 0.01 * expected_m_s);
}

// On the first tick on which it is due, whatever the steps.
TEST(Jettison, HappensOnATickWhateverTheSteps) {
  const struct {
    JettisonTrigger trigger;
    double threshold;
  } triggers[] = {{JettisonTrigger::kAtTime, 150.123},
                  {JettisonTrigger::kAtAltitude, 110e3},
                  {JettisonTrigger::kAtHeatFlux, 1135.0}};
  for (const auto& each : triggers) {
    const Vehicle vehicle = WithFairing(each.trigger, each.threshold);
    const AscentResult ascent = Ascend(vehicle, 1.0, true), fine = Ascend(vehicle, 0.25);
    const double at_s = ascent.jettison_s[0];
    EXPECT_NEAR(at_s / 0.01, std::round(at_s / 0.01), 1e-6);
    EXPECT_NEAR(fine.jettison_s[0], at_s, 1e-9);
    // In six degrees of freedom, on a path that differs by its pitch errors.
    FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
    definition.vehicle = vehicle;
    definition.program = ascent.attitude;
    definition.jettison_s = ascent.jettison_s;
    const FlightModel model(definition);
    double before_kg = 0.0, after_kg = 0.0, flown_s = 0.0, flux = 0.0, altitude_m = 0.0;
    FlightOptions options;
    options.observe = [&](const TickSample& s) {
      const double mass_kg = s.instant.loads.mass_kg;
      // The stage burns less than this in a tick of the coast.
      if (flown_s == 0.0 && before_kg - mass_kg > 0.9 * kFairing_kg &&
          before_kg - mass_kg < 2.0 * kFairing_kg) {
        flown_s = s.time_s;
        after_kg = mass_kg;
        altitude_m = s.instant.air.place.altitude_m;
        const double speed =
            (s.state.v_IC_I - Vector3(0.0, 0.0, Wgs84().rotation_rate_rad_s).cross(s.state.p_EoC_I)).norm();
        flux = 0.5 * s.instant.air.density_kg_m3 * std::pow(speed, 3);
      }
      if (flown_s == 0.0) before_kg = mass_kg;
    };
    const FlightResult flown = Fly(model, {}, options);
    EXPECT_EQ(flown.outcome, Outcome::kCompleted);
    EXPECT_NEAR(flown_s, at_s, 0.3) << "of " << at_s;
    if (each.trigger == JettisonTrigger::kAtAltitude) {
      EXPECT_NEAR(altitude_m, each.threshold, 50.0);
    }
    if (each.trigger == JettisonTrigger::kAtHeatFlux) {
      EXPECT_NEAR(flux, each.threshold, 0.01 * each.threshold);
    }
    EXPECT_NEAR(MetricOf(flown, "injection_velocity_m_s"), ascent.orbit.velocity_m_s, 2.0);
  }
}

// Margins are those of what is left: its loop's gain is the effectiveness that the autopilot counts on,
// before and after.
TEST(Jettison, MarginsAreOfWhatIsLeft) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "pd");
  definition.vehicle = WithFairing(JettisonTrigger::kAtTime, 100.0);
  definition.jettison_s = {100.0};
  const FlightModel model(definition);
  std::vector<double> found_1_s2, known_1_s2;
  FlightOptions options;
  options.observe = [&](const TickSample& s) {
    if (!s.burning || s.stack != 1 || std::fabs(std::fabs(s.time_s - 100.0) - 4.0) > 1e-6) return;
    found_1_s2.push_back(LineariseAxis(model.nominal_plant(), s, kPitch, model.sensors()).a(1, 2));
    known_1_s2.push_back(
        LineariseLaw(model.autopilot(), 1, s.since_ignition_s, kPitch, false).effectiveness_1_s2);
  };
  Fly(model, {}, options);
  ASSERT_EQ(found_1_s2.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(found_1_s2[i], known_1_s2[i], 1e-3 * known_1_s2[i]) << i;
}

// The autopilot's knowledge follows the nominal jettison.
TEST(Jettison, TheAutopilotKnowsWhenItHappens) {
  const LauncherPlant plant = BuildNominalPlant(WithFairing(JettisonTrigger::kAtTime, 100.0));
  const StageControl kept = BuildStageControl(plant, 1, 80.0),
                     gone = BuildStageControl(plant, 1, 80.0, {100.0});
  const auto& at_s = kept.pitch_effectiveness_1_s2.x;
  for (std::size_t i = 0; i < at_s.size(); ++i) {
    const double ratio = gone.pitch_effectiveness_1_s2.y[i] / kept.pitch_effectiveness_1_s2.y[i];
    if (80.0 + at_s[i] < 100.0)
      EXPECT_EQ(ratio, 1.0) << at_s[i];
    else
      EXPECT_GT(ratio, 1.001) << at_s[i];  // less inertia
  }
}

}  // namespace
}  // namespace dispersa::jettison_test
