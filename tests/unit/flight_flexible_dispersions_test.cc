// A flexible vehicle with dispersed masses: its modes and section loads are those of the dispersed masses.
#include "core/flight/flight_model.h"
#include "core/modes/beam_table.h"
#include "core/vehicle/mass.h"
#include "tests/test.h"
#include "tests/unit/flexible_sample.h"

namespace dispersa::flight_flexible_dispersions_test {
namespace {

FlightDefinition Flexible() {
  FlightDefinition definition = SampleDefinition();
  definition.vehicle = FlexibleSample();
  definition.vehicle.profile = {{ProfileShape::kTangentOgive, 2.0, 1.0},
                                {ProfileShape::kCylinder, 18.0, 1.0}};
  StructureBeam& beam = *definition.vehicle.structure_beam;
  beam.rotary_inertia = false;  // a fuller grain has a narrower bore, hence another inertia
  beam.modes = beam.flown_modes = 2;
  beam.propellant_levels = 3;
  beam.elements = 20;
  return definition;
}

// Everything weighs `factor` times as much.
FlightInputs Heavier(double factor) {
  FlightInputs inputs;
  for (std::size_t stage = 0; stage < 2; ++stage)
    inputs.stages[stage].dry_mass_factor = inputs.stages[stage].propellant_factor = factor;
  return inputs;
}

// If all masses grow in proportion, shapes stay and frequencies fall with the square root: K x = omega² M x.
TEST(FlexibleDispersions, ModesOfAHeavierVehicleAreSlowerByTheRoot) {
  constexpr double kFactor = 1.05;
  const FlightModel model(Flexible());
  const LauncherPlant heavy = model.PlantFor(Heavier(kFactor));
  for (std::size_t stack = 0; stack < 2; ++stack) {
    const ModeTable &before = *model.nominal_plant().stacks[stack].bending,
                    &after = *heavy.stacks[stack].bending;
    ASSERT_EQ(after.modes, before.modes);
    ASSERT_GT(after.modes, 0);
    ASSERT_EQ(after.propellant_kg.size(), before.propellant_kg.size());
    for (int level = 0; level < 3; ++level) {
      EXPECT_NEAR(after.propellant_kg[static_cast<std::size_t>(level)],
                  kFactor * before.propellant_kg[static_cast<std::size_t>(level)], 1e-9);
      for (int mode = 0; mode < after.modes; ++mode) {
        const double *from = before.Row(0, level, mode), *to = after.Row(0, level, mode);
        SCOPED_TRACE(testing::Message() << "stack " << stack << ", level " << level << ", mode " << mode);
        // Of the modes' numerical solution.
        constexpr double kSame = 1e-8;
        EXPECT_NEAR(to[ModeTable::kFrequency] / from[ModeTable::kFrequency], 1.0 / std::sqrt(kFactor), kSame);
        EXPECT_NEAR(to[ModeTable::kInverseMass] / from[ModeTable::kInverseMass], 1.0 / kFactor, kSame);
        for (int column = ModeTable::kPivotDeflection; column < ModeTable::kUpperTurn; ++column)
          EXPECT_NEAR(to[column], from[column], kSame) << column;
      }
    }
  }
}

// A vehicle whose file has the dispersed masses flies the same modes and the same loads.
TEST(FlexibleDispersions, AreThoseOfAVehicleOfThoseMasses) {
  FlightInputs inputs;
  inputs.stages[0].dry_mass_factor = 0.9;
  inputs.stages[1].propellant_factor = 1.05;
  FlightDefinition built = Flexible();
  Stage &first = built.vehicle.stages[0], &second = built.vehicle.stages[1];
  first.liftoff_mass_kg += -600.0 + 50.0;  // of 6 t dry
  second.liftoff_mass_kg += 50.0;          // of 1 t
  second.propellant_mass_kg += 50.0;
  second.motor.burning_time_s *= 1.05;
  second.grain.inner_diameter_m = std::sqrt(0.81 - 1.05 * (0.81 - 0.09));
  const LauncherPlant dispersed = FlightModel(Flexible()).PlantFor(inputs),
                      nominal = FlightModel(Flexible()).PlantFor({});
  for (std::size_t stack = 0; stack < 2; ++stack) {
    const ModeTable &is = *dispersed.stacks[stack].bending, &was = *nominal.stacks[stack].bending;
    // Sections are looked at where the nominal masses have them.
    const LoadTable should_carry =
        BuildLoadTable(built.vehicle, static_cast<int>(stack), nominal.stacks[stack].loads.get());
    const ModeTable should_be = BuildBeamTable(
        built.vehicle, BuildStackModes(built.vehicle, static_cast<int>(stack)), should_carry, is.modes);
    ASSERT_EQ(is.rows.size(), should_be.rows.size());
    double moved = 0.0;
    for (std::size_t i = 0; i < is.rows.size(); ++i) {
      // Sought among the nominal modes, not solved anew.
      EXPECT_NEAR(is.rows[i], should_be.rows[i], 1e-6 * (1.0 + std::fabs(should_be.rows[i])));
      moved = std::max(moved, std::fabs(is.rows[i] - was.rows[i]));
    }
    EXPECT_GT(moved, 1e-3);
    const LoadTable& carries = *dispersed.stacks[stack].loads;
    for (std::size_t i = 0; i < static_cast<std::size_t>(carries.stations); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(carries.first_kg_m[i][k], should_carry.first_kg_m[i][k], 1e-6);
        EXPECT_NEAR(carries.second_kg_m2[i][k], should_carry.second_kg_m2[i][k], 1e-5);
      }
  }
  const LoadTable &carries = *dispersed.stacks[0].loads, &carried = *nominal.stacks[0].loads;
  ASSERT_GT(carries.stations, 7);
  EXPECT_EQ(carries.station_m, carried.station_m);
  EXPECT_NE(carries.first_kg_m[static_cast<std::size_t>(carries.stations) - 1][0],
            carried.first_kg_m[static_cast<std::size_t>(carries.stations) - 1][0]);
}

// Factors on frequency, damping and slope act on the flight's bending, not on its tables.
TEST(FlexibleDispersions, FactorsOfBendingLeaveItsTablesAlone) {
  const FlightModel model(Flexible());
  FlightInputs inputs;
  inputs.bending_frequency_factor[1] = 0.9;
  inputs.bending_damping_factor = 2.0;
  inputs.bending_slope_factor = 1.2;
  const LauncherPlant plant = model.PlantFor(inputs), &nominal = model.nominal_plant();
  EXPECT_EQ(plant.stacks[0].bending, nominal.stacks[0].bending);
  EXPECT_EQ(plant.bending.frequency_factor[0], 1.0);
  EXPECT_EQ(plant.bending.frequency_factor[1], 0.9);
  EXPECT_EQ(nominal.bending.damping_factor, 1.0);
  EXPECT_EQ(plant.bending.damping_factor, 2.0);
  EXPECT_EQ(plant.bending.slope_factor, 1.2);
}

}  // namespace
}  // namespace dispersa::flight_flexible_dispersions_test
