// Equivalent parts of the beam: a lumped body and a rod, two sections and one, jettisoned masses and the mass
// model.
#include "core/modes/beam_table.h"
#include "core/structure/bending_modes.h"
#include "core/structure/mass_points.h"
#include "core/vehicle/mass.h"
#include "tests/test.h"
#include "tests/unit/flexible_sample.h"

namespace dispersa::structure_beam_parts_test {
namespace {

double Moment(const BeamMasses& masses, double station_m, StationShape (*shape)(double)) {
  return InertiaMoment(MassPointsOf(masses, {station_m}), station_m, AtStations(shape));
}

// A rod that moves as a rigid body loads a section as a body at one station does that has its mass, centre
// and inertia.
TEST(InertiaMoment, OfALumpedBodyIsThatOfTheRodItStandsFor) {
  constexpr double kTop_m = 2.0, kBottom_m = 5.0, kPerLength_kg_m = 40.0, kGyration2_m2 = 0.3,
                   kSection_m = 7.5;
  const double length_m = kBottom_m - kTop_m, mass_kg = kPerLength_kg_m * length_m;
  BeamMasses rod, lumped;
  rod.spread = {{kTop_m, kBottom_m, {kPerLength_kg_m, kPerLength_kg_m}, {kGyration2_m2, kGyration2_m2}}};
  lumped.fixed = {{kBottom_m, mass_kg, 0.5 * (kTop_m + kBottom_m),
                   mass_kg * (length_m * length_m / 12.0 + kGyration2_m2)}};
  const auto aside = [](double) { return StationShape{1.0, 0.0}; };
  const auto turning = [](double x) { return StationShape{x - 1.0, 1.0}; };
  EXPECT_NEAR(Moment(lumped, kSection_m, aside), Moment(rod, kSection_m, aside), 1e-9);
  EXPECT_NEAR(Moment(lumped, kSection_m, turning), Moment(rod, kSection_m, turning), 1e-9);
  // By hand: m a lever, and its moment of inertia against the turn.
  EXPECT_NEAR(Moment(rod, kSection_m, aside), mass_kg * 4.0, 1e-9);
  EXPECT_NEAR(Moment(rod, kSection_m, turning),
              mass_kg * (2.5 * 4.0 - length_m * length_m / 12.0 - kGyration2_m2), 1e-9);
  // Behind the section it loads nothing.
  EXPECT_EQ(Moment(lumped, 4.9, turning), 0.0);
}

TEST(BeamMasses, HaveWhatIsStillToBeJettisoned) {
  Vehicle vehicle = FlexibleSample();
  vehicle.stages[1].jettisoned = {{"fairing", 120.0, 1.2, 4.0, 1.0, 0.96, JettisonTrigger::kAtTime, 60.0}};
  for (Stage& stage : vehicle.stages) stage.liftoff_mass_kg += 120.0;
  for (int stage = 0; stage < 2; ++stage) {
    const double propellant_kg = 700.0;
    const MassProperties rigid = BuildStackMasses(vehicle)[static_cast<std::size_t>(stage)].At(propellant_kg);
    double mass = 0.0, first = 0.0, second = 0.0;
    const BeamMasses beam = BuildBeamMasses(vehicle, stage, propellant_kg);
    for (const SpreadMass& m : beam.spread) {
      const double length = m.bottom_station_m - m.top_station_m,
                   middle = 0.5 * (m.bottom_station_m + m.top_station_m);
      const double kg = m.MassPerLength(middle) * length;
      mass += kg;
      first += kg * middle;
      second += kg * (m.Gyration2(middle) + length * length / 12.0 + middle * middle);
    }
    for (const FixedMass& m : beam.fixed) {
      mass += m.mass_kg;
      first += m.mass_kg * m.cg_station_m;
      second += m.inertia_kg_m2 + m.mass_kg * m.cg_station_m * m.cg_station_m;
    }
    EXPECT_NEAR(mass, rigid.mass_kg, 1e-9) << stage;
    EXPECT_NEAR(first / mass, rigid.cg_station_m, 1e-11) << stage;
    EXPECT_NEAR(second - first * first / mass, rigid.transverse_inertia_kg_m2, 1e-6) << stage;
  }
}

// Overlapping sections add their stiffness, in bending and in shear: two with half the modulus equal one with
// the whole.
TEST(BeamSections, ThatOverlapAreAsStiffAsOneOfBoth) {
  Vehicle one = FlexibleSample();
  one.structure_beam->timoshenko = true;
  for (BeamStage& stage : one.structure_beam->stages)
    for (BeamSection& section : stage.sections) {
      section.bending_stiffness_n_m2 = {};
      section.outer_diameter_m = {1.0, 1.0};
      section.thickness_m = {0.005, 0.005};
      section.modulus_pa = 7e10;
      section.poisson_ratio = 0.3;
    }
  Vehicle two = one;
  for (BeamStage& stage : two.structure_beam->stages) {
    for (BeamSection& section : stage.sections) section.modulus_pa *= 0.5;
    stage.sections.insert(stage.sections.end(), stage.sections.begin(), stage.sections.end());
  }
  const std::vector<StackModes> whole = BuildBendingModes(one), halves = BuildBendingModes(two);
  for (std::size_t stack = 0; stack < 2; ++stack)
    for (std::size_t mode = 0; mode < 3; ++mode)
      EXPECT_NEAR(halves[stack].levels[0][0].modes[mode].frequency_rad_s /
                      whole[stack].levels[0][0].modes[mode].frequency_rad_s,
                  1.0, 1e-9);
  Vehicle stiff = one;
  stiff.structure_beam->timoshenko = false;
  // Shear counts: percents of the first frequency, more of higher ones.
  EXPECT_LT(whole[0].levels[0][0].modes[2].frequency_rad_s,
            0.97 * BuildBendingModes(stiff)[0].levels[0][0].modes[2].frequency_rad_s);
}

// A stack bends alike in both planes where all that it still has does, whatever has left.
TEST(BendingModes, AreOfOnePlaneWhereTheStackIsRound) {
  Vehicle vehicle = FlexibleSample();
  vehicle.structure_beam->elements = 12;
  vehicle.structure_beam->propellant_levels = 2;
  vehicle.structure_beam->stages[0].sections[0].z_to_y_stiffness = 1.3;
  const std::vector<StackModes> stacks = BuildBendingModes(vehicle);
  EXPECT_FALSE(stacks[0].axisymmetric);
  EXPECT_TRUE(stacks[1].axisymmetric);
  EXPECT_GT(stacks[0].levels[1][0].modes[0].frequency_rad_s,
            1.001 * stacks[0].levels[0][0].modes[0].frequency_rad_s);
  EXPECT_EQ(stacks[1].levels[1][0].modes[0].frequency_rad_s, stacks[1].levels[0][0].modes[0].frequency_rad_s);

  // A flight looks each plane up, and flies only modes that are slow enough in both.
  const LoadTable loads{};
  const double of_y = stacks[0].levels[0].back().modes[0].frequency_rad_s,
               of_z = stacks[0].levels[1].back().modes[0].frequency_rad_s;
  EXPECT_EQ(ModesBelow(vehicle, stacks[0], 0.5 * (of_y + of_z)), 0);
  EXPECT_GE(ModesBelow(vehicle, stacks[0], 1.001 * of_z), 1);
  const ModeTable table = BuildBeamTable(vehicle, stacks[0], loads, 1),
                  round = BuildBeamTable(vehicle, stacks[1], loads, 1);
  EXPECT_EQ(table.planes, 2);
  EXPECT_EQ(round.planes, 1);
  EXPECT_EQ(table.Row(0, 1, 0)[ModeTable::kFrequency], of_y);
  EXPECT_EQ(table.Row(1, 1, 0)[ModeTable::kFrequency], of_z);
}

TEST(ShownStations, AreThoseOfTheSensorsStillThereAndThePivot) {
  const Vehicle vehicle = FlexibleSample();  // gyros at 2 m and 18 m, stages that end at 20 m and 11 m
  const auto names = [&](int stage) {
    std::vector<std::string> all;
    for (const BeamSensor& sensor : ShownStations(vehicle, stage)) all.push_back(sensor.name);
    return all;
  };
  EXPECT_EQ(names(0), (std::vector<std::string>{"gyro", "aft gyro", "nozzle pivot"}));
  EXPECT_EQ(names(1), (std::vector<std::string>{"gyro", "nozzle pivot"}));
  EXPECT_EQ(ShownStations(vehicle, 1).back().station_m, 10.0);
}

// The work that a force along the axis does against a bent beam: each element is compressed by what has to be
// pushed ahead of it. A uniform beam's share ahead grows evenly; a mass at its nose is ahead of all.
TEST(ModeTable, ShorteningCountsTheMassAhead) {
  Vehicle vehicle = FlexibleSample();
  vehicle.structure_beam->elements = 24;
  vehicle.structure_beam->propellant_levels = 2;
  vehicle.structure_beam->stages[0].lumped_masses.clear();
  Stage& last = vehicle.stages[1];
  last.structure = {{"all", 0.5, 1.0, 10.5, 1.0, 0.9}, {"payload", 0.5, 1.0, 1.5, 0.8, 0.0}};
  LumpedMass payload;
  payload.name = payload.element = "payload";
  payload.station_m = 2.0;  // its middle is at 1.25 m
  vehicle.structure_beam->stages[1].lumped_masses = {payload};
  const std::vector<StackModes> stacks = BuildBendingModes(vehicle);
  const LoadTable loads{};
  const ModeTable table = BuildBeamTable(vehicle, stacks[1], loads, 2);
  // Empty: 1 t payload fixed at 2 m, 1 t evenly from 1 to 10.5 m.
  const BendingLevel& empty = stacks[1].levels[0].back();
  ASSERT_EQ(empty.propellant_kg, 0.0);
  for (int j = 0; j < 2; ++j)
    for (int k = 0; k < 2; ++k) {
      double sum = 0.0;
      constexpr int kPlaces = 20000;
      for (int i = 0; i < kPlaces; ++i) {
        const double x = 1.0 + 9.5 * (i + 0.5) / kPlaces;
        const double ahead = 0.5 * (x - 1.0) / 9.5 + (x > 2.0 ? 0.5 : 0.0);
        const auto slope = [&](int mode) {
          return ShapeOf(stacks[1], BeamPlane::kY, empty.modes[static_cast<std::size_t>(mode)], x).slope_1_m;
        };
        sum += ahead * slope(j) * slope(k) * 9.5 / kPlaces;
      }
      // The table sums at 400 places, and the payload counts at one of them.
      EXPECT_NEAR(table.Row(0, 1, k)[ModeTable::kShortening + j], sum,
                  5e-3 * table.Row(0, 1, j)[ModeTable::kShortening + j]);
    }
}

}  // namespace
}  // namespace dispersa::structure_beam_parts_test
