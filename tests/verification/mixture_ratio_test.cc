// Liquid stages whose engines draw another mixture than their tanks hold: masses by hand, the end of the burn
// with the first tank, every kilogram of a flight, and a burn again.
#include "core/flight/dispersed_vehicle.h"
#include "core/flight/flight.h"
#include "core/flight/flight_sums.h"
#include "core/flight/metrics.h"
#include "core/flight/step_limits.h"
#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "tests/apart_boosters.h"
#include "tests/flown_ticks.h"
#include "tests/test.h"
#include "tests/two_liquids.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::mixture_ratio_test {
namespace {

constexpr double kOxygen_kg = 2800.0, kKerosene_kg = 1200.0, kLoad_kg = kOxygen_kg + kKerosene_kg,
                 kRest_kg = 40.0, kThrust_n = 200e3, kFlow_kg_s = 100.0;

// The sample vehicle with two tanks in its first stage.
FlightDefinition Liquid() {
  FlightDefinition definition = HighDefinition();
  Stage& stage = definition.vehicle.stages[0];
  stage.grain = {};
  stage.tanks = {{"oxygen", 12.0, 15.2, 1.1, kOxygen_kg, 1141.0},
                 {"kerosene", 15.3, 17.4, 1.1, kKerosene_kg, 810.0}};
  stage.motor.specific_impulse_s = kThrust_n / kFlow_kg_s / kStandardGravity;
  stage.motor.residual_mass_kg = kRest_kg;
  EXPECT_TRUE(Problems(definition.vehicle).empty());
  return definition;
}

constexpr TwoLiquids kLiquids{kOxygen_kg, kKerosene_kg, kRest_kg};

FlightInputs Drawn(double load, double ratio) {
  FlightInputs in;
  in.stages[0].propellant_factor = load;
  in.stages[0].mixture_ratio_factor = ratio;
  return in;
}

// The dry stage with the stack above, and the liquids as cylinders that have no moment about the axis.
Bodies ByHand(const FlightDefinition& definition, double load, double ratio, double flown_kg) {
  const MassProperties dry = BuildStackMasses(definition.vehicle)[0].At(0.0);
  std::vector<Part> parts = {{dry.mass_kg, dry.axial_inertia_kg_m2, dry.transverse_inertia_kg_m2,
                              Vector3(dry.cg_station_m, 0.0, 0.0)}};
  const TwoLiquids::Left has = kLiquids.After(flown_kg, load, ratio);
  for (const auto& [kg, density, bottom_m] :
       {std::array{has.first_kg, 1141.0, 15.2}, {has.second_kg, 810.0, 17.4}}) {
    const double height_m = kg / density / (0.25 * kPi * 1.21);
    parts.push_back({kg, 0.0, kg * (1.21 / 16.0 + height_m * height_m / 12.0),
                     Vector3(bottom_m - 0.5 * height_m, 0.0, 0.0)});
  }
  return SumOf(parts);
}

TEST(MixtureRatio, MassesAreThoseOfTheTanksByHand) {
  const FlightDefinition definition = Liquid();
  RigidBodyState s;
  s.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
  std::array<double, kLauncherSize> y{};
  WriteState(s, y.data());
  LauncherPhase phase;
  phase.burning = true;
  for (const auto& [load, ratio] : {std::pair{1.0, 1.0}, {1.0, 1.03}, {0.98, 0.95}}) {
    const LauncherPlant plant = FlightModel(definition).PlantFor(Drawn(load, ratio));
    for (const double since_s : {0.0, 10.0, 36.0}) {
      const Bodies all = ByHand(definition, load, ratio, kFlow_kg_s * since_s);
      const LauncherInstant now = LauncherModel(plant).Evaluate(phase, since_s, y.data());
      EXPECT_NEAR(now.loads.mass_kg, all.mass_kg, 1e-9 * all.mass_kg) << ratio << " " << since_s;
      EXPECT_NEAR(now.cg_station_m, all.cg.x(), 1e-10 * all.cg.x()) << ratio << " " << since_s;
      EXPECT_NEAR((now.loads.inertia_kg_m2 - all.inertia).norm(), 0.0, 1e-9 * all.inertia.norm())
          << ratio << " " << since_s;
    }
  }
}

TEST(MixtureRatio, EndsTheBurnWithTheFirstTank) {
  const FlightModel model(Liquid());
  EXPECT_NEAR(kLiquids.Usable(1.0, 1.0), kLoad_kg - kRest_kg, 1e-9);
  for (const double ratio : {0.9, 0.999, 1.0, 1.001, 1.1}) {
    const MotorBurn& burn = model.PlantFor(Drawn(0.98, ratio)).stacks[0].burn;
    const double usable_kg = kLiquids.Usable(0.98, ratio);
    EXPECT_NEAR(burn.duration_s, usable_kg / kFlow_kg_s, 1e-9) << ratio;
    EXPECT_NEAR(burn.left_kg, 0.98 * kLoad_kg - usable_kg, 1e-8) << ratio;
    EXPECT_EQ(burn.vacuum_thrust_n, kThrust_n);
    const TwoLiquids::Left left = kLiquids.After(usable_kg, 0.98, ratio);
    EXPECT_NEAR(ratio > 1.0 ? left.first_kg / (0.98 * kOxygen_kg) : left.second_kg / (0.98 * kKerosene_kg),
                kRest_kg / (0.98 * kLoad_kg), 1e-9);
  }
}

// Every kilogram of the first burn, and what falls with the stage.
TEST(MixtureRatio, MassIsWhatHasNotFlown) {
  const FlightDefinition definition = Liquid();
  const double ratio = 1.05, whole_kg = definition.vehicle.stages[0].liftoff_mass_kg;
  FlightResult result;
  const auto ticks = TicksOf(definition, Drawn(1.0, ratio), &result);
  ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
  int seen = 0;
  for (const TickSample& s : ticks) {
    if (s.stack != 0) continue;
    const double flown_kg = std::min(kFlow_kg_s * s.time_s, kLiquids.Usable(1.0, ratio));
    ASSERT_NEAR(s.instant.loads.mass_kg, whole_kg - flown_kg, 1e-6) << s.time_s;
    ++seen;
  }
  EXPECT_GT(seen, 3700);
  EXPECT_GT(kLoad_kg - kLiquids.Usable(1.0, ratio), kRest_kg + 50.0)
      << "5 % of the smaller tank's flow stays";
}

// Two burns of the same tanks, the first one for 15 s.
FlightDefinition WithRestart() {
  FlightDefinition definition = Liquid();
  std::vector<Stage>& stages = definition.vehicle.stages;
  Stage again = stages[0];
  stages[0].motor.cut_off = CutOff::kAtTime;
  stages[0].motor.cut_off_s = 15.0;
  again.restarts = true;
  again.ignition = IgnitionTrigger::kBurnoutDetection;
  again.ignition_delay_s = 2.0;
  const double left = 1.0 - 15.0 * kFlow_kg_s / kLoad_kg;
  again.liftoff_mass_kg -= (1.0 - left) * kLoad_kg;
  again.propellant_mass_kg *= left;
  again.motor.burning_time_s *= left;
  for (Tank& tank : again.tanks) tank.propellant_mass_kg *= left;
  stages.insert(stages.begin() + 1, again);
  std::vector<AeroTable>& tables = definition.vehicle.aerodynamics;
  tables.insert(tables.begin(), tables.front());
  return definition;
}

// The mixture goes on, and the second burn ends with the first tank.
TEST(MixtureRatio, GoesOnInABurnAgain) {
  const FlightDefinition definition = WithRestart();
  const double ratio = 0.95;
  const LauncherPlant plant = BuildNominalPlant(WithDispersedMasses(definition.vehicle, Drawn(1.0, ratio)));
  const MotorBurn& burn = plant.stacks[1].burn;
  EXPECT_NEAR(burn.propellant_mass_kg, kLoad_kg - 1500.0, 1e-8);
  EXPECT_NEAR(burn.left_kg, kLoad_kg - kLiquids.Usable(1.0, ratio), 1e-8);
  EXPECT_NEAR(burn.duration_s, (kLiquids.Usable(1.0, ratio) - 1500.0) / kFlow_kg_s, 1e-9);
  const Bodies all = ByHand(definition, 1.0, ratio, 2000.0);
  const MassProperties at = plant.stacks[1].mass.At(kLoad_kg - 2000.0);
  EXPECT_NEAR(at.mass_kg, all.mass_kg, 1e-9 * all.mass_kg);
  EXPECT_NEAR(at.cg_station_m, all.cg.x(), 1e-10 * all.cg.x());
  EXPECT_NEAR(at.transverse_inertia_kg_m2, all.inertia(1, 1), 1e-9 * all.inertia(1, 1));
}

// It does so too where the flight computer ends the first burn, at once or with a tail-off.
TEST(MixtureRatio, GoesOnAfterACommandedCutOff) {
  for (const double tail_off_s : {0.0, 0.5})
    for (const double ratio : {0.95, 1.05}) {
      FlightDefinition definition = WithRestart();
      for (std::size_t i : {0u, 1u}) definition.vehicle.stages[i].motor.tail_off_s = tail_off_s;
      definition.vehicle.stages[0].motor.cut_off = CutOff::kAtVelocity;
      LauncherPlant plant = BuildNominalPlant(WithDispersedMasses(definition.vehicle, Drawn(1.0, ratio)));
      CommandCutOffOf(definition.vehicle, 0, 15.0, plant);
      const MotorBurn &first = plant.stacks[0].burn, &second = plant.stacks[1].burn;
      EXPECT_NEAR(first.left_kg, kLoad_kg - (15.0 + 0.5 * tail_off_s) * kFlow_kg_s, 1e-8);
      EXPECT_NEAR(second.propellant_mass_kg, first.left_kg, 1e-8);
      EXPECT_NEAR(second.left_kg, kLoad_kg - kLiquids.Usable(1.0, ratio), 1e-8);
    }
}

double MetricOf(const FlightResult& result, const char* name) { return result.metrics[MetricColumn(name)]; }

// The residual of the flight's mixture is no propellant that is left; a burn without a command has none.
TEST(PropellantLeft, IsWhatACommandLeavesUsable) {
  const double ratio = 1.05, usable_kg = kLiquids.Usable(1.0, ratio);
  for (const auto& [cut_off_s, left_kg] : {std::pair{15.0, usable_kg - 1500.0}, {100.0, 0.0}}) {
    FlightDefinition definition = WithRestart();
    definition.vehicle.stages[0].motor.cut_off_s = cut_off_s;
    FlightResult result;
    TicksOf(definition, Drawn(1.0, ratio), &result);
    EXPECT_NEAR(MetricOf(result, "propellant_left_kg"), left_kg, 1e-6) << cut_off_s << result.reason;
    EXPECT_NEAR(MetricOf(result, "propellant_left_stage1_kg"), left_kg, 1e-6) << cut_off_s;
    EXPECT_TRUE(std::isnan(MetricOf(result, "propellant_left_stage2_kg"))) << cut_off_s;
    EXPECT_EQ(MetricOf(result, "depleted"), left_kg > 0.0 ? 0.0 : 1.0) << cut_off_s;
    definition.vehicle.stages[1].motor.cut_off = CutOff::kAtTime;
    definition.vehicle.stages[1].motor.cut_off_s = 8.0;
    TicksOf(definition, Drawn(1.0, ratio), &result);
    EXPECT_NEAR(MetricOf(result, "propellant_left_stage1_kg"), left_kg, 1e-6) << cut_off_s;
    EXPECT_NEAR(MetricOf(result, "propellant_left_stage2_kg"), std::max(left_kg - 800.0, 0.0), 1e-6)
        << cut_off_s;
    EXPECT_EQ(MetricOf(result, "propellant_left_kg"), MetricOf(result, "propellant_left_stage2_kg"));
  }
}
TEST(PropellantLeft, IsOfVehiclesWithCutOffsThatGotThere) {
  FlightDefinition definition = Liquid();
  const auto has = [&] {
    return HasMetric(Metrics()[MetricColumn("depleted")],
                     KindOf(definition.vehicle, definition.autopilot, definition.course));
  };
  EXPECT_FALSE(has());
  definition.vehicle.stages[0].motor.cut_off = CutOff::kAtVelocity;
  EXPECT_TRUE(has());
  FlightSums sums;
  sums.unburnt_kg[0] = 7.0;
  const auto left_kg = [&] { return Measure(sums, definition).metrics[MetricColumn("propellant_left_kg")]; };
  EXPECT_TRUE(std::isnan(left_kg()));
  sums.burnt_out = 1;
  EXPECT_EQ(left_kg(), 7.0);
}

TEST(MixtureRatio, IsRefusedWhereItIsNone) {
  const FlightDefinition definition = Liquid();
  const FlightModel model(definition);
  const FlightInputs none = Drawn(1.0, 0.0);
  EXPECT_EQ(
      RefusalOf({definition.vehicle, definition.autopilot, definition.guidance, definition.course, none},
                model.PlantFor(none), 0.01),
      "the input mixture_ratio_factor_stage1 is 0; allowed: a number above 0");
}

}  // namespace
}  // namespace dispersa::mixture_ratio_test
