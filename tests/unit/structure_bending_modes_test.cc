// The beam of a vehicle has the masses of the rigid vehicle. Its modes keep their numbers and signs over the
// burn.
#include <Eigen/Eigenvalues>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/structure/beam_elements.h"
#include "core/structure/beam_mesh.h"
#include "core/structure/bending_modes.h"
#include "core/structure/free_free_modes.h"
#include "core/structure/mode_tracking.h"
#include "core/vehicle/mass.h"
#include "tests/liquid_stage.h"
#include "tests/test.h"
#include "tests/unit/flexible_sample.h"

namespace dispersa::structure_bending_modes_test {
namespace {

Vehicle Slv4() { return LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml"); }

/// The mass properties of a stack's finite elements at a propellant level.
BeamMassProperties BeamWeight(const Vehicle& vehicle, int stage, double propellant_kg) {
  Beam beam;
  for (std::size_t i = static_cast<std::size_t>(stage); i < vehicle.structure_beam->stages.size(); ++i) {
    const auto& sections = vehicle.structure_beam->stages[i].sections;
    beam.sections.insert(beam.sections.end(), sections.begin(), sections.end());
  }
  beam.timoshenko = vehicle.structure_beam->timoshenko;
  beam.masses = BuildBeamMasses(vehicle, stage, propellant_kg);
  // One mesh for all levels, as BuildBendingModes has it.
  const double full_kg = vehicle.stages[static_cast<std::size_t>(stage)].propellant_mass_kg;
  const std::vector<double> stations =
      MeshStations(beam.sections, BuildBeamMasses(vehicle, stage, full_kg), 30);
  return PropertiesOf(MassMatrix(beam, stations, BuildElements(beam, BeamPlane::kY, stations)), stations);
}

void ExpectRigidMasses(const Vehicle& vehicle) {
  const std::vector<StackMass> stacks = BuildStackMasses(vehicle);
  for (std::size_t stage = 0; stage < stacks.size(); ++stage) {
    for (const double fraction : {1.0, 0.7, 0.3, 0.0}) {
      const double propellant_kg = fraction * stacks[stage].propellant_mass_kg;
      const MassProperties rigid = stacks[stage].At(propellant_kg);
      const BeamMassProperties beam = BeamWeight(vehicle, static_cast<int>(stage), propellant_kg);
      EXPECT_NEAR(beam.mass_kg / rigid.mass_kg, 1.0, 1e-12) << stage << ", " << fraction;
      EXPECT_NEAR(beam.cg_station_m / rigid.cg_station_m, 1.0, 1e-12) << stage << ", " << fraction;
      // The rigid one is a difference of moments about the nose, which are up to ten times as large.
      EXPECT_NEAR(beam.transverse_inertia_kg_m2 / rigid.transverse_inertia_kg_m2, 1.0, 1e-11)
          << stage << ", " << fraction;
    }
  }
}

TEST(BendingModes, TheBeamWeighsWhatTheVehicleWeighs) {
  ExpectRigidMasses(FlexibleSample());
  ExpectRigidMasses(Slv4());
  // Surfaces of liquids lie within elements.
  Vehicle liquid = Slv4();
  for (const std::size_t stage : {0u, 2u}) MakeLiquid(liquid.stages[stage]);
  ExpectRigidMasses(liquid);
}

TEST(BendingModes, OwnMassesAreScaledToTheVehicles) {
  Vehicle vehicle = FlexibleSample();
  BeamStage& first = vehicle.structure_beam->stages[0];
  first.own_masses = true;
  first.sections = {SampleSection("upper", 10.5, 15.0, 4e8), SampleSection("lower", 15.0, 19.0, 6e8)};
  first.sections[0].mass_per_length_kg_m = {500.0, 600.0};
  first.sections[1].mass_per_length_kg_m = {650.0, 620.0};
  first.lumped_masses[0].element.clear();
  first.lumped_masses[0].mass_kg = 1400.0;
  first.lumped_masses[0].cg_station_m = 19.6;
  first.lumped_masses[0].inertia_kg_m2 = 150.0;
  EXPECT_TRUE(Problems(vehicle).empty());
  ExpectRigidMasses(vehicle);
  // Within the bounds, and by less than the bounds: the masses above are the vehicle's but for a tenth.
  const OwnMassScale scale = ScaleOwnMasses(vehicle, 0);
  EXPECT_GT(scale.least, 0.7);
  EXPECT_LT(scale.greatest, 1.4);
  // The vehicle's own distribution is not scaled.
  first.sections = {SampleSection("case", 11.0, 19.0, 5e8)};
  first.sections[0].mass_per_length_kg_m = {562.5, 562.5};
  first.sections[0].modulus_pa = 70e9;
  first.sections[0].outer_diameter_m = {1.2, 1.2};
  first.sections[0].thickness_m = {0.05, 0.05};
  first.lumped_masses[0].mass_kg = 1500.0;
  first.lumped_masses[0].cg_station_m = 19.5;
  first.lumped_masses[0].inertia_kg_m2 = 1500.0 * (0.8 * 0.8 / 16.0 + 1.0 / 12.0);
  const OwnMassScale same = ScaleOwnMasses(vehicle, 0);
  EXPECT_NEAR(same.least, 1.0, 1e-12);
  EXPECT_NEAR(same.greatest, 1.0, 1e-12);
}

TEST(BendingModes, OfTheShippedVehicleLieWhereOthersFoundThem) {
  // An independent beam of slv4.yaml's masses had 3.1 to 3.6 Hz over the burn of stage 1 and 6.9 to 8.1 Hz
  // over that of stage 2; half or twice the stiffness 2.2 to 4.4 Hz in stage 1.
  const std::vector<StackModes> stacks = BuildBendingModes(Slv4());
  ASSERT_EQ(stacks.size(), 4u);
  const auto first_hz = [&](std::size_t stage, bool full) {
    const std::vector<BendingLevel>& levels = stacks[stage].levels[0];
    return (full ? levels.front() : levels.back()).modes[0].frequency_rad_s / kTwoPi;
  };
  for (const bool full : {true, false}) {
    EXPECT_GT(first_hz(0, full), 2.2);
    EXPECT_LT(first_hz(0, full), 4.4);
    EXPECT_GT(first_hz(1, full), 6.9 / std::sqrt(2.0));
    EXPECT_LT(first_hz(1, full), 8.1 * std::sqrt(2.0));
  }
}

TEST(BendingModes, KeepNameAndSignOverTheBurn) {
  for (const Vehicle& vehicle : {FlexibleSample(), Slv4()}) {
    for (const StackModes& stack : BuildBendingModes(vehicle)) {
      const std::vector<BendingLevel>& levels = stack.levels[0];
      ASSERT_EQ(static_cast<int>(levels.size()), vehicle.structure_beam->propellant_levels);
      EXPECT_EQ(levels.back().propellant_kg, 0.0);
      for (std::size_t mode = 0; mode < levels[0].modes.size(); ++mode) {
        EXPECT_GT(levels[0].modes[mode].deflection.front(), 0.0);
        for (std::size_t i = 1; i < levels.size(); ++i) {
          const BendingMode& before = levels[i - 1].modes[mode];
          const BendingMode& now = levels[i].modes[mode];
          EXPECT_GT(now.mac, 0.9);
          // A tenth of the propellant: less mass, and no jump of the shape.
          EXPECT_LT(std::fabs(now.frequency_rad_s / before.frequency_rad_s - 1.0), 0.2);
          double largest = 0.0;
          for (std::size_t k = 0; k < now.deflection.size(); ++k)
            largest = std::max(largest, std::fabs(now.deflection[k] - before.deflection[k]));
          EXPECT_LT(largest, 0.6);  // another mode, or the same with the other sign, differs by 1 or more
        }
      }
    }
  }
}

// From full to empty in one step, a mode is only half recognised. The reported value is the least resemblance
// on the way, not that of the last step.
TEST(BendingModes, TellTheLeastResemblanceOnTheWay) {
  Vehicle vehicle = Slv4();
  vehicle.structure_beam->propellant_levels = 2;
  const std::vector<BendingLevel> whole = BuildBendingModes(vehicle)[0].levels[0];
  vehicle.structure_beam->propellant_levels = 3;
  const std::vector<BendingLevel> halves = BuildBendingModes(vehicle)[0].levels[0];
  bool was_least_before = false;
  for (std::size_t mode = 0; mode < whole[0].modes.size(); ++mode) {
    const double first = halves[1].modes[mode].mac, second = halves[2].modes[mode].mac;
    EXPECT_EQ(whole[1].modes[mode].mac, std::fmin(first, second)) << mode;
    was_least_before |= first < second;
  }
  EXPECT_TRUE(was_least_before) << "or the last step alone would do";
}

TEST(BendingModes, ShapesAreWhatTheEquationsMeanByThem) {
  const Vehicle vehicle = FlexibleSample();
  const std::vector<StackModes> stacks = BuildBendingModes(vehicle);
  const StackModes& stack = stacks[0];
  const BendingMode& mode = stack.levels[0].front().modes[1];
  const std::vector<double>& stations = stack.station_m[0];
  double largest = 0.0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const StationShape at = ShapeOf(stack, BeamPlane::kY, mode, stations[i]);
    EXPECT_NEAR(at.deflection, mode.deflection[i], 1e-13);
    EXPECT_NEAR(at.slope_1_m, mode.slope_1_m[i], 1e-13);
    largest = std::max(largest, std::fabs(at.deflection));
  }
  EXPECT_DOUBLE_EQ(largest, 1.0);
  // Without shear the slope is the derivative, inside as at the straight ends.
  for (const double station : {0.2, 3.3, 10.4, 14.2, 19.8}) {
    const double step = 1e-5;
    const double ahead = ShapeOf(stack, BeamPlane::kY, mode, station + step).deflection;
    const double behind = ShapeOf(stack, BeamPlane::kY, mode, station - step).deflection;
    EXPECT_NEAR(ShapeOf(stack, BeamPlane::kY, mode, station).slope_1_m, (ahead - behind) / (2.0 * step),
                1e-8);
  }
  // Twice the kinetic energy of a unit rate, by Simpson's rule over what the beam is made of.
  double twice_energy = 0.0;
  const BeamMasses masses = BuildBeamMasses(vehicle, 0, vehicle.stages[0].propellant_mass_kg);
  for (const SpreadMass& m : masses.spread) {
    constexpr int kSteps = 2000;
    const double h = (m.bottom_station_m - m.top_station_m) / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
      const double s = m.top_station_m + i * h;
      const StationShape at = ShapeOf(stack, BeamPlane::kY, mode, s);
      const double weight = (i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * h / 3.0;
      twice_energy += weight * m.MassPerLength(s) *
                      (at.deflection * at.deflection + m.Gyration2(s) * at.slope_1_m * at.slope_1_m);
    }
  }
  for (const FixedMass& m : masses.fixed) {
    const StationShape at = ShapeOf(stack, BeamPlane::kY, mode, m.station_m);
    const double moved = at.deflection + (m.cg_station_m - m.station_m) * at.slope_1_m;
    twice_energy += m.mass_kg * moved * moved + m.inertia_kg_m2 * at.slope_1_m * at.slope_1_m;
  }
  EXPECT_NEAR(mode.generalized_mass_kg / twice_energy, 1.0, 1e-6);
  // Along() is the same, level by level.
  const ModeAlong along = Along(stack, BeamPlane::kZ, 1, 18.0);
  ASSERT_EQ(along.propellant_kg.size(), 11u);
  EXPECT_EQ(along.frequency_rad_s.front(), mode.frequency_rad_s);
  EXPECT_EQ(along.slope_1_m.front(), ShapeOf(stack, BeamPlane::kY, mode, 18.0).slope_1_m);
}

TEST(BendingModes, PlaneZOfAStifferBeamIsItsOwn) {
  Vehicle vehicle = FlexibleSample();
  for (BeamStage& stage : vehicle.structure_beam->stages) stage.sections[0].z_to_y_stiffness = 1.21;
  const std::vector<StackModes> stacks = BuildBendingModes(vehicle);
  EXPECT_FALSE(stacks[0].axisymmetric);
  for (std::size_t mode = 0; mode < 3; ++mode) {
    for (std::size_t i = 0; i < 11; ++i) {
      EXPECT_NEAR(stacks[0].levels[1][i].modes[mode].frequency_rad_s /
                      stacks[0].levels[0][i].modes[mode].frequency_rad_s,
                  1.1, 1e-9);
    }
  }
}

// A stiffness without end is a rigid vehicle: modes rise with its root, and what is rigid stays.
TEST(BendingModes, RiseWithTheRootOfTheStiffness) {
  Vehicle vehicle = FlexibleSample();
  const double soft = BuildBendingModes(vehicle)[0].levels[0].front().modes[0].frequency_rad_s;
  for (BeamStage& stage : vehicle.structure_beam->stages) {
    for (BeamSection& s : stage.sections)
      s.bending_stiffness_n_m2 = {1e6 * s.bending_stiffness_n_m2.top, 1e6 * s.bending_stiffness_n_m2.bottom};
  }
  EXPECT_NEAR(BuildBendingModes(vehicle)[0].levels[0].front().modes[0].frequency_rad_s / soft, 1000.0, 1e-8);
}

// Two oscillators whose frequencies cross while they stay what they are: by frequency alone they would swap.
TEST(ModeTracking, FollowsAModeThroughACrossing) {
  const Eigen::Matrix2d mass = Eigen::Vector2d(3.0, 0.2).asDiagonal();
  Eigen::MatrixXd before;
  for (double place = -1.0; place <= 1.0; place += 0.125) {
    // Nearly uncoupled, never equal: the crossing itself lies between two places.
    Eigen::Matrix2d stiffness;
    const double offset = 0.4 * (place + 0.03);
    stiffness << 3.0 * (1.0 + offset), 1e-3, 1e-3, 0.2 * (1.0 - offset);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass);
    Eigen::MatrixXd now = solver.eigenvectors();
    // Solvers give any sign.
    if (now(0, 0) * place < 0.0) now.col(0) *= -1.0;
    if (before.size() > 0) {
      const std::vector<ModeMatch> matches = MatchModes(before, now, mass);
      Eigen::MatrixXd ordered(2, 2);
      for (Eigen::Index mode = 0; mode < 2; ++mode) {
        const ModeMatch& match = matches[static_cast<std::size_t>(mode)];
        EXPECT_GT(match.mac, 0.9);
        ordered.col(mode) = match.sign * now.col(match.index);
      }
      now = ordered;
      EXPECT_GT(now(0, 0) * before(0, 0), 0.0);
      EXPECT_GT(now(1, 1) * before(1, 1), 0.0);
    }
    before = now;
  }
  // The lower one was the heavy oscillator at the beginning; at the end it is the higher one, under the same
  // name.
  EXPECT_GT(std::fabs(before(0, 0)), 10.0 * std::fabs(before(0, 1)));
}

// Orthogonal by mass, though not to the eye: without the weight their criterion would be 0.6.
TEST(ModeTracking, WeighsByMass) {
  const Eigen::Matrix2d mass = Eigen::Vector2d(1.0, 9.0).asDiagonal();
  Eigen::MatrixXd modes(2, 2);
  modes << 3.0, 3.0, 1.0, -1.0;
  const std::vector<ModeMatch> matches = MatchModes(modes, -modes, mass);
  for (Eigen::Index mode = 0; mode < 2; ++mode) {
    EXPECT_EQ(matches[static_cast<std::size_t>(mode)].index, mode);
    EXPECT_EQ(matches[static_cast<std::size_t>(mode)].sign, -1.0);
    EXPECT_DOUBLE_EQ(matches[static_cast<std::size_t>(mode)].mac, 1.0);
  }
  EXPECT_DOUBLE_EQ(MatchModes(modes.col(0), modes.col(1), mass)[0].mac, 0.0);
}

}  // namespace
}  // namespace dispersa::structure_bending_modes_test
