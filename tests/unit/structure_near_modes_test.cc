// Sums over a beam's masses as points against twice as many, masses at nodes against the mass matrix, and
// modes sought near the nominal ones against the whole solution.
#include "core/structure/mass_points.h"

#include "core/campaign_yaml/load.h"
#include "core/flight/dispersed_vehicle.h"
#include "core/modes/beam_table.h"
#include "core/modes/load_table.h"
#include "core/structure/beam_mesh.h"
#include "core/structure/near_modes.h"
#include "core/vehicle/mass.h"
#include "tests/liquid_stage.h"
#include "tests/tabulated_masses.h"
#include "tests/test.h"
#include "tests/unit/flexible_sample.h"

namespace dispersa::structure_near_modes_test {
namespace {

Vehicle Flexible() { return LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml"); }

FlightInputs Draws(double dry, double propellant, double payload_kg) {
  FlightInputs inputs;
  for (std::size_t i = 0; i < 4; ++i) {
    inputs.stages[i].dry_mass_factor = i % 2 == 0 ? 1.0 + dry : 1.0 - dry;
    inputs.stages[i].propellant_factor = i % 2 == 0 ? 1.0 - propellant : 1.0 + propellant;
  }
  inputs.payload_mass_kg = payload_kg;
  inputs.payload_element = 1.0;
  return inputs;
}

// The largest departure of a column from another table's, against the largest value of that column.
double DepartureOf(const ModeTable& table, const ModeTable& from, int column) {
  double largest = 0.0, departure = 0.0;
  for (std::size_t level = 0; level < table.propellant_kg.size(); ++level)
    for (int mode = 0; mode < table.modes; ++mode) {
      const int at = static_cast<int>(level);
      largest = std::max(largest, std::fabs(from.Row(0, at, mode)[column]));
      departure =
          std::max(departure, std::fabs(table.Row(0, at, mode)[column] - from.Row(0, at, mode)[column]));
    }
  return largest > 0.0 ? departure / largest : departure;
}

TEST(MassPoints, AreFineEnough) {
  const Vehicle vehicle = Flexible();
  for (int stage = 0; stage < 4; ++stage) {
    const double propellant_kg = 0.6 * vehicle.stages[static_cast<std::size_t>(stage)].propellant_mass_kg;
    const StackModes stack = BuildStackModes(vehicle, stage);
    const BendingMode& mode = stack.levels[0][4].modes[2];
    const double station_m = 0.6 * vehicle.stages[static_cast<std::size_t>(stage)].bottom_station_m;
    const BeamMasses masses = BuildBeamMasses(vehicle, stage, propellant_kg);
    const auto shape = [&](double s) { return ShapeOf(stack, BeamPlane::kY, mode, s); };
    // Between two nodes each: one cell, two, sixteen.
    const auto moment = [&](int cells) {
      std::vector<double> cuts_m = {station_m};
      const std::vector<double>& nodes = stack.station_m[0];
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
        for (int part = 0; part < cells; ++part)
          cuts_m.push_back(nodes[i] + (nodes[i + 1] - nodes[i]) * part / cells);
      return InertiaMoment(MassPointsOf(masses, cuts_m), station_m, AtStations(shape));
    };
    const double fine = moment(16);
    EXPECT_LT(std::fabs(moment(1) / fine - 1.0), 1e-6) << stage;
    EXPECT_LT(std::fabs(moment(2) / fine - 1.0), 1e-7) << stage;
  }
}

// The mass matrix has the same numbers, of tubes, tapered masses, bodies and liquids whose surface lies
// within an element.
TEST(NodeMasses, AreTheMassMatrix) {
  Vehicle liquid = Flexible(), own = FlexibleSample();
  for (const std::size_t stage : {0u, 2u}) MakeLiquid(liquid.stages[stage]);
  BeamStage& first = own.structure_beam->stages[0];
  first.own_masses = true;
  first.sections = {SampleSection("upper", 10.5, 15.0, 4e8), SampleSection("lower", 15.0, 19.0, 6e8)};
  first.sections[0].mass_per_length_kg_m = {500.0, 600.0};
  first.sections[1].mass_per_length_kg_m = {650.0, 620.0};
  for (const Vehicle& vehicle : {Flexible(), liquid, own})
    for (const bool rotary_inertia : {true, false}) {
      Beam beam;
      for (const BeamStage& stage : vehicle.structure_beam->stages)
        beam.sections.insert(beam.sections.end(), stage.sections.begin(), stage.sections.end());
      beam.timoshenko = vehicle.structure_beam->timoshenko;
      beam.rotary_inertia = rotary_inertia;
      const double full_kg = vehicle.stages[0].propellant_mass_kg;
      const std::vector<double> stations =
          MeshStations(beam.sections, BuildBeamMasses(vehicle, 0, full_kg), 60);
      const std::vector<BeamElement> elements = BuildElements(beam, BeamPlane::kY, stations);
      const NodeMassMaker maker(stations, elements, rotary_inertia);
      for (const double fraction : {1.0, 0.83, 0.0}) {
        beam.masses = BuildBeamMasses(vehicle, 0, fraction * full_kg);
        const Eigen::MatrixXd whole = MassMatrix(beam, stations, elements);
        const NodeMasses masses = maker.Of(beam.masses);
        const double largest = whole.maxCoeff();
        ShapeColumns unit(kNodeRows * stations.size(), 1);
        double worst = 0.0;
        for (std::size_t row = 0; row < unit.rows; ++row) {
          std::fill_n(unit.Four(0), unit.rows, FourShapes(0.0));
          unit.Four(0)[row] = 1.0;
          const ShapeColumns column = masses.Times(unit);
          for (std::size_t other = 0; other < unit.rows; ++other) {
            const double exact = whole(static_cast<Eigen::Index>(other), static_cast<Eigen::Index>(row));
            worst = std::max(worst, std::fabs(Values(column.Four(0) + other)[0] - exact));
          }
        }
        EXPECT_LT(worst, 1e-14 * largest) << fraction;
      }
    }
}

// Departures of a stack's modes that are sought near the nominal ones, from those of the whole solution.
struct Departures {
  double frequency = 0.0, mass = 0.0, pivot = 0.0, unit_slope = 0.0, moment = 0.0;

  Departures(const ModeTable& table, const ModeTable& whole)
      : frequency(DepartureOf(table, whole, ModeTable::kFrequency)),
        mass(DepartureOf(table, whole, ModeTable::kInverseMass)),
        pivot(DepartureOf(table, whole, ModeTable::kPivotDeflection)),
        unit_slope(DepartureOf(table, whole, ModeTable::kUnitSlope)),
        moment(DepartureOf(table, whole, ModeTable::kMomentAt + 3)) {}
};

struct DispersedStack {
  StackModes nominal, sought, whole;
  BeamTable of_nominal, of_sought, of_whole;

  DispersedStack(const Vehicle& from, const Vehicle& vehicle, int stage, int modes = 3)
      : nominal(BuildStackModes(from, stage)),
        sought(BuildStackModesNear(vehicle, nominal, modes)),
        whole(BuildStackModes(vehicle, stage)) {
    const LoadTable loads = BuildLoadTable(vehicle, stage);
    of_nominal = BuildBeamTable(from, nominal, loads, modes);
    of_sought = BuildBeamTable(vehicle, sought, loads, modes, &of_nominal);
    of_whole = BuildBeamTable(vehicle, whole, loads, modes);
  }
};

// Three sigma of a new motor at once: 3 % of dry mass, 1 % of propellant, a payload 20 kg heavier. Then ten
// times as much, where one turn of the iteration is not enough. The whole solution has a mesh of its own,
// with a node at each surface of a liquid.
TEST(NearModes, AreThoseOfTheWholeSolution) {
  Vehicle liquid = Flexible();
  for (const std::size_t stage : {0u, 2u}) MakeLiquid(liquid.stages[stage]);
  for (const bool is_liquid : {false, true})
    for (const double scale : {1.0, 10.0})
      for (int stage = 0; stage < 4; ++stage) {
        SCOPED_TRACE("stage " + std::to_string(stage) + ", " + std::to_string(scale) + " times" +
                     (is_liquid ? ", liquid" : ""));
        const Vehicle nominal = is_liquid ? liquid : Flexible();
        const Vehicle vehicle = WithDispersedMasses(nominal, Draws(0.03 * scale, 0.01 * scale, 20.0 * scale));
        // More do not fly in the upper stages: they lie above half the sampling frequency.
        const DispersedStack stack(nominal, vehicle, stage, stage < 2 ? 3 : 1);
        EXPECT_TRUE(scale > 1.0 || !stack.sought.basis) << "they were solved as a whole";
        const Departures departures(stack.of_sought, stack.of_whole),
            from_nominal(stack.of_nominal, stack.of_whole);
        RecordProperty((is_liquid ? "liquid_" : "") + std::to_string(static_cast<int>(scale)) + "_stage_" +
                           std::to_string(stage),
                       std::to_string(1e6 * departures.frequency) + " " +
                           std::to_string(1e6 * departures.mass) + " " +
                           std::to_string(1e6 * departures.unit_slope) + " millionths");
        EXPECT_LT(departures.frequency, is_liquid ? 1e-5 : 1e-6);
        EXPECT_LT(departures.mass, 5e-4);
        EXPECT_LT(departures.pivot, 5e-4);
        EXPECT_LT(departures.unit_slope, 5e-4);
        EXPECT_LT(departures.moment, 1e-4);
        // It is the dispersion that is followed, not the nominal modes that are taken.
        EXPECT_LT(departures.frequency, 0.05 * from_nominal.frequency);
        EXPECT_LT(departures.mass, 0.05 * from_nominal.mass);
        EXPECT_LT(departures.unit_slope, 0.05 * from_nominal.unit_slope);
      }
}

// Where fewer modes fly, only these are sought.
TEST(NearModes, AreTheSameWhereFewerAreSought) {
  const Vehicle nominal = Flexible(), vehicle = WithDispersedMasses(nominal, Draws(0.01, 0.005, 5.0));
  const DispersedStack three(nominal, vehicle, 2), one(nominal, vehicle, 2, 1);
  EXPECT_EQ(three.sought.basis, nullptr);
  for (std::size_t level = 0; level < three.sought.levels[0].size(); ++level) {
    ASSERT_EQ(one.sought.levels[0][level].modes.size(), 1u);
    const BendingMode &a = one.sought.levels[0][level].modes[0], &b = three.sought.levels[0][level].modes[0];
    EXPECT_NEAR(a.frequency_rad_s / b.frequency_rad_s, 1.0, 1e-6);
    EXPECT_NEAR(a.generalized_mass_kg / b.generalized_mass_kg, 1.0, 1e-4);
  }
}

// The nominal masses themselves: the nominal modes, to rounding.
TEST(NearModes, OfTheNominalMassesAreTheNominalOnes) {
  const DispersedStack stack(Flexible(), Flexible(), 0);
  const Departures departures(stack.of_sought, stack.of_whole);
  EXPECT_LT(departures.frequency, 1e-10);
  EXPECT_LT(departures.mass, 1e-9);
  EXPECT_LT(departures.unit_slope, 1e-9);
  for (const BendingLevel& level : stack.sought.levels[0])
    for (const BendingMode& mode : level.modes) EXPECT_NEAR(mode.mac, 1.0, 1e-9);
}

// A stage whose masses a table gives bends by the table's sums. With the table of its own tubes it bends as
// without one, also with drawn masses; a table with another centre of gravity and inertia has other modes.
TEST(NearModes, FollowTheMassTableOfAStage) {
  const Vehicle tubes = Flexible();
  Vehicle tabled = tubes, other = tubes;
  TabulateMasses(tabled, 0, 21);
  TabulateMasses(other, 0, 21);
  for (double& cg_m : other.stages[0].mass_table.cg_station_m) cg_m += 0.1;
  for (double& inertia : other.stages[0].mass_table.transverse_inertia_kg_m2) inertia *= 1.02;
  other.stages[0].flown_mass.rows =
      std::make_shared<const MassRows>(BuildMassRows(other.stages[0].mass_table, DryMass(other, 0)));
  const FlightInputs draws = Draws(0.03, 0.01, 20.0);
  for (const Vehicle& vehicle : {tabled, other}) {
    const DispersedStack stack(vehicle, WithDispersedMasses(vehicle, draws), 0);
    EXPECT_EQ(stack.sought.basis, nullptr);
    const Departures departures(stack.of_sought, stack.of_whole);
    EXPECT_LT(departures.frequency, 1e-6);
    EXPECT_LT(departures.mass, 5e-4);
    EXPECT_LT(departures.moment, 1e-4);
  }
  const auto sought = [&](const Vehicle& vehicle) {
    return BuildStackModesNear(WithDispersedMasses(vehicle, draws), BuildStackModes(vehicle, 0), 3);
  };
  const StackModes of_tubes = sought(tubes), of_table = sought(tabled), of_other = sought(other);
  double farthest = 0.0;
  for (std::size_t level = 0; level < 11; ++level)
    for (std::size_t mode = 0; mode < 3; ++mode) {
      const double exact = of_tubes.levels[0][level].modes[mode].frequency_rad_s;
      EXPECT_NEAR(of_table.levels[0][level].modes[mode].frequency_rad_s / exact, 1.0, 1e-4) << level << mode;
      farthest =
          std::max(farthest, std::fabs(of_other.levels[0][level].modes[mode].frequency_rad_s / exact - 1.0));
    }
  EXPECT_GT(farthest, 1e-3);
}

// Masses with which a mode is hardly recognised: the whole solution, bit by bit.
TEST(NearModes, ThatAreNotRecognisedAreSolvedAsAWhole) {
  const Vehicle nominal = Flexible(), vehicle = WithDispersedMasses(nominal, Draws(0.0, 0.0, 3000.0));
  const DispersedStack stack(nominal, vehicle, 0);
  EXPECT_NE(stack.sought.basis, nullptr);
  EXPECT_TRUE(stack.of_sought.rows == stack.of_whole.rows);
  EXPECT_FALSE(stack.of_sought.rows == stack.of_nominal.rows);
}

// Places that the nominal table has found give the same bits as places found anew.
TEST(ModeTable, IsTheSameWithPlacesOfTheNominalOne) {
  const Vehicle nominal = Flexible(), vehicle = WithDispersedMasses(nominal, Draws(0.03, 0.01, 20.0));
  for (int stage = 0; stage < 4; ++stage) {
    const DispersedStack stack(nominal, vehicle, stage);
    EXPECT_EQ(stack.of_sought.places, stack.of_nominal.places);
    EXPECT_TRUE(BuildBeamTable(vehicle, stack.sought, BuildLoadTable(vehicle, stage), 3).rows ==
                stack.of_sought.rows)
        << stage;
  }
}

}  // namespace
}  // namespace dispersa::structure_near_modes_test
