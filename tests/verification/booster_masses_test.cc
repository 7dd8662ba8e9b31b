// Boosters whose masses are drawn, each its own: shells, loads and mixtures by hand in mass, centre and
// tensor, every kilogram of a flight, momentum at separation, and the moment of a pair that is not alike.
#include "core/flight/dispersed_vehicle.h"
#include "core/flight/flight.h"
#include "core/flight/step_limits.h"
#include "core/math/constants.h"
#include "core/vehicle/mass.h"
#include "tests/apart_boosters.h"
#include "tests/flown_ticks.h"
#include "tests/test.h"
#include "tests/two_liquids.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::booster_masses_test {
namespace {

constexpr double kDeg = kRadPerDeg;
constexpr double kThrust_n = 20e3, kFlow_kg_s = 25.0, kDry_kg = 100.0, kOxygen_kg = 350.0,
                 kKerosene_kg = 150.0, kLoad_kg = kOxygen_kg + kKerosene_kg, kRest_kg = 10.0, kRadius_m = 0.9,
                 kCore_n = 200e3, kPivot_m = 19.5;

// The sample vehicle, which flies in almost no air, with a pair of boosters. `spread`: all alike in the file,
// where a campaign draws values of each.
FlightDefinition Pair(bool liquid, bool spread = false) {
  FlightDefinition definition = HighDefinition();
  Boosters& b = definition.vehicle.boosters;
  b = {2, kDry_kg, kLoad_kg, kRadius_m, 0.5, 13.0, 19.0, 19.2, {}, {15.0, 18.0, 0.48, 0.2}, 0.5};
  b.motor.thrust_n = kThrust_n;
  b.motor.burning_time_s = kLoad_kg / kFlow_kg_s;
  if (spread)
    SpreadOut(b);
  else
    b.angles_rad = {0.0, 180.0 * kDeg};
  if (liquid) {
    b.grain = {};
    b.tanks = {{"oxygen", 13.2, 15.8, 0.4, kOxygen_kg, 1141.0},
               {"kerosene", 15.9, 17.6, 0.42, kKerosene_kg, 810.0}};
    b.motor.specific_impulse_s = kThrust_n / kFlow_kg_s / kStandardGravity;
    b.motor.residual_mass_kg = kRest_kg;
  }
  definition.vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
  definition.vehicle.jet_damping = true;
  EXPECT_TRUE(Problems(definition.vehicle).empty());
  return definition;
}

// What is drawn of each of the pair.
struct Drawn {
  double dry[2] = {1.0, 1.0}, load[2] = {1.0, 1.0}, ratio[2] = {1.0, 1.0};
  FlightInputs Inputs() const {
    FlightInputs in;
    for (std::size_t k = 0; k < 2; ++k) {
      in.further[k].booster.dry_mass_factor = dry[k];
      in.further[k].booster.propellant_factor = load[k];
      in.further[k].booster.mixture_ratio_factor = ratio[k];
    }
    return in;
  }
};
constexpr Drawn kAll = {{1.08, 0.95}, {1.02, 0.97}, {1.04, 0.93}};

constexpr TwoLiquids kLiquids{kOxygen_kg, kKerosene_kg, kRest_kg};
double FlownBy(const Drawn& drawn, std::size_t k, bool liquid, double since_s) {
  const double most_kg = liquid ? kLiquids.Usable(drawn.load[k], drawn.ratio[k]) : drawn.load[k] * kLoad_kg;
  return std::min(kFlow_kg_s * since_s, most_kg);
}

void AddBooster(const Drawn& drawn, std::size_t k, bool liquid, double since_s, std::vector<Part>& parts) {
  const double y_m = k == 0 ? kRadius_m : -kRadius_m, shell_kg = drawn.dry[k] * kDry_kg;
  parts.push_back({shell_kg, shell_kg * 0.0625, shell_kg * (0.5 * 0.0625 + 3.0), Vector3(16.0, y_m, 0.0)});
  const double flown_kg = FlownBy(drawn, k, liquid, since_s);
  if (!liquid) {
    const double kg = drawn.load[k] * kLoad_kg - flown_kg, outer2 = 0.24 * 0.24;
    const double inner2 = outer2 - kg / kLoad_kg * (outer2 - 0.01);
    parts.push_back({kg, 0.5 * kg * (outer2 + inner2), kg * (0.25 * (outer2 + inner2) + 9.0 / 12.0),
                     Vector3(16.5, y_m, 0.0)});
    return;
  }
  const TwoLiquids::Left has = kLiquids.After(flown_kg, drawn.load[k], drawn.ratio[k]);
  const auto add = [&](double kg, double density, double diameter_m, double bottom_m) {
    const double height_m = kg / density / (0.25 * kPi * diameter_m * diameter_m);
    parts.push_back({kg, 0.0, kg * (diameter_m * diameter_m / 16.0 + height_m * height_m / 12.0),
                     Vector3(bottom_m - 0.5 * height_m, y_m, 0.0)});
  };
  add(has.first_kg, 1141.0, 0.4, 15.8);
  add(has.second_kg, 810.0, 0.42, 17.6);
}
Bodies ByHand(const FlightDefinition& definition, const LauncherPlant& plant, const Drawn& drawn,
              double since_s) {
  Vehicle core = definition.vehicle;
  const bool liquid = core.boosters.is_liquid();
  core.stages[0].liftoff_mass_kg -= core.boosters.LiftOffMass();
  core.boosters = {};
  const MassProperties own = BuildStackMasses(core)[0].At(plant.stacks[0].burn.Propellant(since_s));
  std::vector<Part> parts = {{own.mass_kg, own.axial_inertia_kg_m2, own.transverse_inertia_kg_m2,
                              Vector3(own.cg_station_m, 0.0, 0.0)}};
  for (const std::size_t k : {0u, 1u}) AddBooster(drawn, k, liquid, since_s, parts);
  return SumOf(parts);
}

// A pair at its places, and one of boosters that are all alike in the file.
struct Kind {
  bool liquid, spread;
};
constexpr Kind kKinds[] = {{false, false}, {false, true}, {true, false}, {true, true}};

TEST(BoosterMasses, AreThoseOfShellsGrainsAndTanksByHand) {
  for (const auto& [liquid, spread] : kKinds) {
    Drawn drawn = kAll;
    if (!liquid) drawn.ratio[0] = drawn.ratio[1] = 1.0;
    const FlightDefinition definition = Pair(liquid, spread);
    const LauncherPlant plant = FlightModel(definition).PlantFor(drawn.Inputs());
    RigidBodyState s;
    s.p_EoC_I = {Wgs84().equatorial_radius_m + 2e6, 0.0, 0.0};
    std::array<double, kLauncherSize> y{};
    WriteState(s, y.data());
    for (const double since_s : {0.0, 7.0, 18.0, 20.6}) {
      LauncherPhase phase;
      phase.burning = true;
      phase.boosters_burning = since_s < 20.5 ? 3u : 0u;
      const Bodies all = ByHand(definition, plant, drawn, since_s);
      const LauncherInstant now = LauncherModel(plant).Evaluate(phase, since_s, y.data());
      EXPECT_NEAR(now.loads.mass_kg, all.mass_kg, 1e-9 * all.mass_kg) << liquid << " " << since_s;
      EXPECT_NEAR(now.cg_station_m, all.cg.x(), 1e-10 * all.cg.x()) << liquid << " " << since_s;
      EXPECT_NEAR((now.loads.inertia_kg_m2 - all.inertia).norm(), 0.0, 1e-9 * all.inertia.norm())
          << liquid << " " << since_s;
      if (!liquid && since_s > 20.0) continue;  // the grains all together have another end
      const MassProperties on = MassesOn(plant, 0, 0u, plant.stacks[0].burn.Propellant(since_s), since_s);
      EXPECT_NEAR(on.cg_station_m, all.cg.x(), 1e-4 * all.cg.x()) << liquid << " " << since_s;
    }
    EXPECT_GT(std::fabs(ByHand(definition, plant, drawn, 0.0).inertia(0, 1)), 1.0);
  }
}

// The end of the burn, and what stays: of the first tank to run dry only its part of the residual.
TEST(BoosterMasses, AMixtureEndsTheBurnWithTheFirstTank) {
  const FlightModel model(Pair(true));
  for (const double ratio : {0.9, 0.999, 1.0, 1.001, 1.1}) {
    Drawn drawn;
    drawn.load[0] = 0.98;
    drawn.ratio[0] = ratio;
    const LauncherPlant plant = model.PlantFor(drawn.Inputs());
    const MotorBurn& burn = plant.boosters->each[0].burn;
    const double usable_kg = kLiquids.Usable(0.98, ratio);
    EXPECT_NEAR(burn.duration_s, usable_kg / kFlow_kg_s, 1e-9) << ratio;
    EXPECT_NEAR(burn.left_kg, 0.98 * kLoad_kg - usable_kg, 1e-8) << ratio;
    EXPECT_EQ(burn.vacuum_thrust_n, kThrust_n);
    const TwoLiquids::Left left = kLiquids.After(usable_kg, 0.98, ratio);
    const double part = kRest_kg / (0.98 * kLoad_kg);
    EXPECT_NEAR(ratio > 1.0 ? left.first_kg / (0.98 * kOxygen_kg) : left.second_kg / (0.98 * kKerosene_kg),
                part, 1e-9);
    EXPECT_GE(std::min(left.first_kg, left.second_kg), 0.0);
  }
  EXPECT_NEAR(kLiquids.Usable(1.0, 1.0), kLoad_kg - kRest_kg, 1e-9);
}

// Every kilogram from lift-off to the core's burnout, and the jump as they leave.
TEST(BoosterMasses, MassIsWhatHasNotFlownNorLeft) {
  for (const auto& [liquid, spread] : kKinds) {
    Drawn drawn = kAll;
    if (!liquid) drawn.ratio[0] = drawn.ratio[1] = 1.0;
    const FlightDefinition definition = Pair(liquid, spread);
    const double bare_kg =
        definition.vehicle.stages[0].liftoff_mass_kg - definition.vehicle.boosters.LiftOffMass();
    const double core_kg_s =
        definition.vehicle.stages[0].propellant_mass_kg / definition.vehicle.stages[0].motor.burning_time_s;
    double carried_kg = 0.0;
    for (const std::size_t k : {0u, 1u}) carried_kg += drawn.dry[k] * kDry_kg + drawn.load[k] * kLoad_kg;
    FlightResult result;
    const auto ticks = TicksOf(definition, drawn.Inputs(), &result);
    ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
    int with = 0, without = 0;
    for (const TickSample& s : ticks) {
      if (s.stack != 0 || !s.burning) continue;
      double expected_kg = bare_kg - core_kg_s * s.time_s;
      if ((s.jettisoned & kBoostersGone) == 0) {
        expected_kg += carried_kg;
        for (const std::size_t k : {0u, 1u}) expected_kg -= FlownBy(drawn, k, liquid, s.time_s);
        ++with;
      } else {
        ++without;
      }
      ASSERT_NEAR(s.instant.loads.mass_kg, expected_kg, 1e-6) << liquid << " " << s.time_s;
    }
    EXPECT_GT(with, 1900);
    EXPECT_GT(without, 1500);
  }
}

// Shells and rests that differ: all parts keep their momentum and their common centre.
TEST(BoosterMasses, SeparationKeepsTheMomentumOfDifferentBodies) {
  Drawn drawn = kAll;
  drawn.dry[0] = 1.3;
  const FlightDefinition definition = Pair(true, true);
  const LauncherPlant plant = FlightModel(definition).PlantFor(drawn.Inputs());
  const double since_s = 21.0;
  const Bodies all = ByHand(definition, plant, drawn, since_s);
  std::vector<Bodies> leaving;
  for (const std::size_t k : {0u, 1u}) {
    std::vector<Part> parts;
    AddBooster(drawn, k, true, since_s, parts);
    leaving.push_back(SumOf(parts));
  }
  ExpectSeparationKeepsMomentum(plant, since_s, all, leaving);
  EXPECT_GT(std::fabs(all.cg.y()), 1e-3) << "they weigh differently";
}

// The heavier one pulls the centre of gravity over: the nozzles trim the moment of all thrusts about it.
TEST(BoosterMasses, APairThatIsNotAlikeIsTrimmed) {
  Drawn drawn;
  drawn.dry[0] = 1.5;
  const FlightDefinition definition = Pair(true);
  FlightResult result;
  const auto ticks = TicksOf(definition, drawn.Inputs(), &result);
  ASSERT_EQ(result.outcome, Outcome::kCompleted) << result.reason;
  const LauncherPlant plant = FlightModel(definition).PlantFor(drawn.Inputs());
  int seen = 0;
  for (const TickSample& s : ticks) {
    if (s.stack != 0 || s.time_s < 10.0 || s.time_s > 18.0) continue;
    const Bodies all = ByHand(definition, plant, drawn, s.since_ignition_s);
    EXPECT_NEAR(all.cg.y(), 50.0 * kRadius_m / all.mass_kg, 1e-9);
    const double boost = -all.cg.y() * 2.0 * kThrust_n, lever_m = kPivot_m - all.cg.x();
    double core = -all.cg.y() * kCore_n;
    for (const std::size_t k : {2u, 3u}) core -= lever_m * 0.25 * kCore_n * std::sin(s.nozzle_rad[k]);
    EXPECT_NEAR(boost + core, 0.0, 0.04 * std::fabs(all.cg.y() * kCore_n)) << s.time_s;
    ++seen;
  }
  EXPECT_GT(seen, 500);
}

// The vehicle of bending and section loads has them all by their mean, so its mass is the flight's.
TEST(BoosterMasses, TheMeanWeighsWhatTheyWeigh) {
  const FlightDefinition definition = Pair(true);
  const Vehicle mean = WithDispersedMasses(definition.vehicle, kAll.Inputs());
  double whole_kg = definition.vehicle.stages[0].liftoff_mass_kg - definition.vehicle.boosters.LiftOffMass();
  for (const std::size_t k : {0u, 1u}) {
    const Boosters one = BoosterOf(definition.vehicle, kAll.Inputs(), k).one;
    whole_kg += one.dry_mass_kg + one.propellant_mass_kg;
  }
  EXPECT_NEAR(mean.stages[0].liftoff_mass_kg, whole_kg, 1e-9);
  EXPECT_NEAR(DryMass(mean, 0), DryMass(definition.vehicle, 0), 1e-9);
}

TEST(BoosterMasses, AreRefusedWhereNothingHoldsThem) {
  const FlightDefinition definition = Pair(true);
  const auto refusal = [&](const Drawn& drawn) {
    const FlightModel model(definition);
    const FlightInputs in = drawn.Inputs();
    return RefusalOf({definition.vehicle, definition.autopilot, definition.guidance, definition.course, in},
                     model.PlantFor(in), 0.01);
  };
  Drawn full, light, dry;
  full.load[1] = 1.5;
  light.dry[0] = 0.0;
  dry.ratio[1] = -0.1;
  const auto says = [&](const Drawn& drawn, const std::string& why) {
    EXPECT_EQ(refusal(drawn).substr(0, why.size()), why);
  };
  says(full, "the input booster_propellant_factor_nozzle6 is 1.5; allowed: a number above 0 and not above ");
  says(light, "the input booster_dry_mass_factor_nozzle5 is 0; allowed: a number above 0");
  says(dry, "the input booster_mixture_ratio_factor_nozzle6 is -0.1; allowed: a number above 0");
  EXPECT_EQ(refusal(kAll), "");
}

}  // namespace
}  // namespace dispersa::booster_masses_test
