// A first stage that bends and has boosters: its modes against finite elements with bodies on links, its
// forces by hand, momentum at the separation, and flights against CVODE.
#include <Eigen/Dense>

#include "core/campaign_yaml/load.h"
#include "core/dynamics/jettison.h"
#include "core/flight/dispersed_vehicle.h"
#include "core/flight/flight.h"
#include "core/flight/flight_record.h"
#include "core/flight/tick_sample.h"
#include "core/margins/linear_axis.h"
#include "core/structure/beam_elements.h"
#include "core/structure/beam_mesh.h"
#include "core/structure/free_body.h"
#include "core/trajectory/ascent.h"
#include "core/vehicle/mass.h"
#include "tests/bending_in_space.h"
#include "tests/flown_ticks.h"
#include "tests/liquid_stage.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::boosters_bending_test {
namespace {

constexpr int kCount = 4;
constexpr double kDry_kg = 150.0, kGrain_kg = 900.0, kRadius_m = 0.97, kBoost_s = 30.0, kCore_s = 70.7,
                 kThrust_n = 80e3, kNozzle_m = 26.4, kLink_m = 23.0;

Vehicle Boosted(bool apart = false) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  Boosters& b = vehicle.boosters;
  b = {kCount, kDry_kg, kGrain_kg, kRadius_m, 0.62, 21.0, 26.5, kNozzle_m, {}, {22.0, 24.05, 0.6, 0.2}, 0.5};
  b.motor.thrust_n = kThrust_n;
  b.motor.burning_time_s = kBoost_s;
  b.attachment_station_m = kLink_m;
  vehicle.stages[0].liftoff_mass_kg += b.LiftOffMass();
  if (apart) {
    for (int k = 0; k < kCount; ++k) b.angles_rad.push_back(kTwoPi * (k + 0.5) / kCount);
    b.gimbal = vehicle.stages[0].gimbal;
    b.gimbal.nozzle_mass_kg = b.gimbal.nozzle_inertia_kg_m2 = b.gimbal.nozzle_cg_m = 0.0;
    b.towards_rad = {90.0 * kRadPerDeg, 180.0 * kRadPerDeg};
  }
  const std::vector<StructProblem> problems = Problems(vehicle);
  EXPECT_TRUE(problems.empty()) << problems[0].path << ": " << problems[0].message;
  return vehicle;
}

std::string ProblemsOf(const Vehicle& vehicle) {
  std::string text;
  for (const StructProblem& problem : Problems(vehicle))
    text += problem.path + ": " + problem.message + ", allowed: " + problem.allowed + "\n";
  return text;
}

TEST(BoostersBending, NeedAStationOfTheBeam) {
  Vehicle vehicle = Boosted();
  vehicle.boosters.attachment_station_m = 0.0;
  EXPECT_EQ(ProblemsOf(vehicle),
            "boosters: missing key 'attachment_station_m', allowed: the station at which structure_beam "
            "carries them\n");
  vehicle.boosters.attachment_station_m = 26.4;
  EXPECT_EQ(
      ProblemsOf(vehicle),
      "boosters.attachment_station_m: lies outside of the beam, which reaches from station 0.200000 m to "
      "26.300000 m, allowed: a station of the beam\n");
  vehicle.boosters.attachment_station_m = kLink_m;
  for (int stage = 0; stage < 4; ++stage)
    vehicle.structure_beam->table.push_back(
        {stage, 0.0, BeamPlane::kY, 1, 20.0, 100.0, {0.0, 4.0}, {1.0, -1.0}, {-0.5, -0.5}});
  EXPECT_EQ(ProblemsOf(vehicle),
            "structure_beam.modes_table: has the modes of a stack that keeps its boosters, allowed: "
            "structure_beam.stages, from which the modes with them and without them follow\n");
}

LauncherPlant PlantOf(const Vehicle& vehicle) {
  LauncherPlant plant = BuildNominalPlant(vehicle);
  AddBending(vehicle, 0.01, plant);
  return plant;
}

Beam BeamOf(const Vehicle& vehicle) {
  Beam beam;
  beam.timoshenko = vehicle.structure_beam->timoshenko;
  for (const BeamStage& stage : vehicle.structure_beam->stages)
    beam.sections.insert(beam.sections.end(), stage.sections.begin(), stage.sections.end());
  return beam;
}

Eigen::Index NodeAt(const std::vector<double>& stations, double station_m) {
  return std::min_element(
             stations.begin(), stations.end(),
             [&](double a, double b) { return std::fabs(a - station_m) < std::fabs(b - station_m); }) -
         stations.begin();
}

// Of the boosters' propellant with so much left in the stage, both burning evenly.
double GrainsAt(double core_kg, double full_kg, double faster = 1.0) {
  const double time_s = kCore_s * (1.0 - core_kg / full_kg);
  return kCount * kGrain_kg * std::max(0.0, 1.0 - faster * time_s / kBoost_s);
}

// The lowest frequencies of the bare core's finite elements and bodies on rigid links, by the general solver.
Eigen::VectorXd Frequencies(const Vehicle& vehicle, double core_kg, double grains_kg) {
  Vehicle core = vehicle;
  core.stages[0].liftoff_mass_kg -= core.boosters.LiftOffMass();
  core.boosters = {};
  Beam beam = BeamOf(vehicle);
  beam.masses = BuildBeamMasses(core, 0, core_kg);
  beam.masses.fixed.push_back({kLink_m, 0.0, kLink_m, 0.0});  // a node
  const std::vector<double> stations =
      MeshStations(beam.sections, beam.masses, vehicle.structure_beam->elements);
  const std::vector<BeamElement> elements = BuildElements(beam, BeamPlane::kY, stations);
  Eigen::MatrixXd mass = MassMatrix(beam, stations, elements);
  const auto hang = [&](double kg, double at_m, double inertia_kg_m2) {
    const Eigen::Index row = kNodeRows * NodeAt(stations, kLink_m);
    const Eigen::Vector2d moves(1.0, at_m - kLink_m), turns(0.0, 1.0);
    mass.block<2, 2>(row, row) += kg * moves * moves.transpose() + inertia_kg_m2 * turns * turns.transpose();
  };
  // Thin tubes and grains that burn from the bore; half of what their place off the axis adds to roll.
  const double apart2 = 0.5 * kRadius_m * kRadius_m, shell2 = 0.5 * 0.31 * 0.31;
  hang(kCount * kDry_kg, 23.75, kCount * kDry_kg * (shell2 + 5.5 * 5.5 / 12.0 + apart2));
  const double outer2 = 0.09, inner2 = outer2 - 0.08 * grains_kg / (kCount * kGrain_kg);
  hang(grains_kg, 23.025, grains_kg * (0.25 * (outer2 + inner2) + 2.05 * 2.05 / 12.0 + apart2));
  // The nose has nodes without mass, so K + s M stands in the place of M: its values are 1 / (omega² + s).
  // The greatest two are those of the rigid motions.
  constexpr double kShift_1_s2 = 300.0;
  const Eigen::Index rows = mass.rows() - 1;  // no bow behind the last node
  const Eigen::MatrixXd shifted = StiffnessMatrix(elements) + kShift_1_s2 * mass;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(mass.topLeftCorner(rows, rows),
                                                                         shifted.topLeftCorner(rows, rows));
  const Eigen::VectorXd values = solver.eigenvalues().reverse().segment(2, 3);
  return (values.cwiseInverse().array() - kShift_1_s2).sqrt();
}

TEST(BoostersBending, ModesAreThoseOfABeamWithBodiesOnLinks) {
  const Vehicle vehicle = Boosted();
  const StackModes stack = BuildStackModes(vehicle, 0);
  const double full_kg = vehicle.stages[0].propellant_mass_kg;
  ASSERT_EQ(stack.levels[0].size(), 12u);
  // Over the boosters' burn, and one behind it.
  EXPECT_NEAR(stack.levels[0][10].propellant_kg, full_kg * (1.0 - kBoost_s / kCore_s), 1e-9 * full_kg);
  for (const BendingLevel& level : stack.levels[0]) {
    const Eigen::VectorXd exact =
        Frequencies(vehicle, level.propellant_kg, GrainsAt(level.propellant_kg, full_kg));
    for (std::size_t mode = 0; mode < 3; ++mode)
      EXPECT_NEAR(level.modes[mode].frequency_rad_s / exact[static_cast<Eigen::Index>(mode)], 1.0, 2e-6)
          << level.propellant_kg << " kg, mode " << mode;
  }
  // Without boosters: the vehicle that never had any.
  Vehicle core = vehicle;
  core.stages[0].liftoff_mass_kg -= core.boosters.LiftOffMass();
  core.boosters = {};
  const StackModes left = BuildStackModes(vehicle, 0, kBoostersGone), bare = BuildStackModes(core, 0);
  for (std::size_t level = 0; level < bare.levels[0].size(); ++level)
    for (std::size_t mode = 0; mode < 3; ++mode)
      EXPECT_NEAR(left.levels[0][level].modes[mode].frequency_rad_s,
                  bare.levels[0][level].modes[mode].frequency_rad_s, 1e-7);
}

// Grains, and tanks that keep a rest.
TEST(BoostersBending, TheBeamWeighsWhatTheVehicleWeighs) {
  for (const auto& [apart, liquid] : {std::pair{false, false}, {true, false}, {false, true}, {true, true}}) {
    Vehicle vehicle = Boosted(apart);
    if (liquid) {
      MakeLiquid(vehicle.boosters);
      vehicle.boosters.motor.residual_mass_kg = 20.0;
      ASSERT_TRUE(Problems(vehicle).empty());
    }
    const LauncherPlant plant = PlantOf(vehicle);
    for (const double since_s : {0.0, 11.0, 29.9, 30.3}) {
      const double propellant_kg = plant.stacks[0].burn.Propellant(since_s);
      const MassProperties rigid = MassesOn(plant, 0, 0u, propellant_kg, since_s);
      const FreeBody beam(BuildBeamMasses(vehicle, 0, propellant_kg), {});
      EXPECT_NEAR(beam.mass_kg, rigid.mass_kg, 1e-10 * rigid.mass_kg);
      EXPECT_NEAR(beam.cg_station_m, rigid.cg_station_m, 1e-10 * rigid.cg_station_m);
      EXPECT_NEAR(beam.inertia_kg_m2, rigid.transverse_inertia_kg_m2, 1e-10 * beam.inertia_kg_m2);
    }
  }
}

// Boosters whose propellant burns 3 % faster than the stage's have other masses than the table. README of
// core/structure states this.
TEST(BoostersBending, BoostersThatBurnFasterHardlyChangeTheModes) {
  const Vehicle vehicle = Boosted();
  const double full_kg = vehicle.stages[0].propellant_mass_kg;
  double worst = 0.0;
  for (const double since_s : {10.0, 20.0, 29.0}) {
    const double core_kg = full_kg * (1.0 - since_s / kCore_s);
    const Eigen::VectorXd tabled = Frequencies(vehicle, core_kg, GrainsAt(core_kg, full_kg)),
                          flown = Frequencies(vehicle, core_kg, GrainsAt(core_kg, full_kg, 1.03));
    worst = std::max(worst, (flown.array() / tabled.array() - 1.0).abs().maxCoeff());
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 5e-4);
  EXPECT_GT(worst, 1e-5);
}

// Modes of drawn masses, sought among the nominal ones, with and without boosters.
TEST(BoostersBending, DrawnMassesHaveModesNearTheNominalOnes) {
  const Vehicle nominal = Boosted();
  FlightInputs inputs;
  inputs.stages[0].dry_mass_factor = 1.03;
  inputs.stages[1].dry_mass_factor = 0.97;
  inputs.stages[2].dry_mass_factor = 1.02;
  inputs.stages[0].propellant_factor = 1.01;
  const Vehicle vehicle = WithDispersedMasses(nominal, inputs);
  for (const unsigned gone : {0u, kBoostersGone}) {
    const StackModes near = BuildStackModes(nominal, 0, gone);
    const StackModes sought = BuildStackModesNear(vehicle, near, 3),
                     whole = BuildStackModes(vehicle, 0, gone);
    ASSERT_EQ(sought.levels[0].size(), whole.levels[0].size());
    for (std::size_t level = 0; level < whole.levels[0].size(); ++level)
      for (std::size_t mode = 0; mode < 3; ++mode) {
        const BendingMode &found = sought.levels[0][level].modes[mode],
                          &exact = whole.levels[0][level].modes[mode];
        EXPECT_NEAR(found.frequency_rad_s / exact.frequency_rad_s, 1.0, 2e-6) << gone << level << mode;
        EXPECT_NEAR(found.generalized_mass_kg / exact.generalized_mass_kg, 1.0, 1e-3)
            << gone << level << mode;
      }
  }
}

// In the middle of the boosters' burn, which is a level of the table.
struct InSpace : BendingInSpace {
  explicit InSpace(const Vehicle& v) : BendingInSpace(v, 0.5 * kBoost_s) {
    plant.flow_coriolis = false;
    phase.boosters_burning = (1u << kCount) - 1u;
  }
  void Change(const std::function<void(BoosterSet&)>& change) {
    BoosterSet set = *plant.boosters;
    change(set);
    plant.boosters = std::make_shared<const BoosterSet>(std::move(set));
  }
};

// By how much a side force at the boosters' nozzles bends the finite elements: the slope at the nose against
// the motion as a rigid body.
double ElasticSlope(const Vehicle& vehicle, double propellant_kg, double force_n, double at_station_m) {
  Beam beam = BeamOf(vehicle);
  beam.masses = BuildBeamMasses(vehicle, 0, propellant_kg);
  const std::vector<double> stations =
      MeshStations(beam.sections, beam.masses, vehicle.structure_beam->elements);
  const std::vector<BeamElement> elements = BuildElements(beam, BeamPlane::kZ, stations);
  const Eigen::MatrixXd mass = MassMatrix(beam, stations, elements), stiffness = StiffnessMatrix(elements);
  const Eigen::MatrixXd rigid = RigidShapes(stations, 0.0);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(mass.rows());
  const Eigen::Index link = kNodeRows * NodeAt(stations, kLink_m);
  force[link] = force_n;
  force[link + 1] = force_n * (kNozzle_m - kLink_m);
  const Eigen::Matrix2d of_rigid = rigid.transpose() * mass * rigid;
  const Eigen::VectorXd relieved =
      force - mass * rigid * (of_rigid.inverse() * (rigid.transpose() * force)).eval();
  const Eigen::Index free = mass.rows() - 2;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(mass.rows());
  x.tail(free) = stiffness.bottomRightCorner(free, free).ldlt().solve(relieved.tail(free));
  x -= rigid * (of_rigid.inverse() * (rigid.transpose() * (mass * x))).eval();
  return x[kNodeRows * NodeAt(stations, at_station_m) + 1];
}

TEST(BoostersBending, ASteadyForceOfTheirNozzlesBendsTheBodyAsItBendsTheBeam) {
  double last = 1.0;
  for (const int modes : {1, 3, 5}) {
    Vehicle vehicle = Boosted(true);
    vehicle.structure_beam->modes = vehicle.structure_beam->flown_modes = modes;
    InSpace flight(vehicle);
    flight.plant.stacks[0].burn.vacuum_thrust_n = 0.0;
    const double small_n = 1e3, tilt = 0.05, force_n = kCount * small_n * std::sin(tilt);
    const double exact = ElasticSlope(vehicle, flight.propellant_kg(), force_n, 1.65);
    for (const int plane : {0, 1}) {
      flight.Change([&](BoosterSet& set) {
        for (EachBooster& one : set.each) {
          one.burn.vacuum_thrust_n = small_n;
          one.along =
              Vector3(std::cos(tilt), plane == 0 ? std::sin(tilt) : 0.0, plane == 1 ? std::sin(tilt) : 0.0);
        }
      });
      const auto rates = flight.Rates();
      double slope = 0.0;
      for (int mode = 0; mode < modes; ++mode) {
        const double w = flight.At(mode, ModeTable::kFrequency);
        slope += flight.At(mode, ModeTable::kUnitSlope) *
                 rates[static_cast<std::size_t>(kModalRate + plane * kModes + mode)] / (w * w);
      }
      const double error = std::fabs(slope / exact - 1.0);
      EXPECT_LT(error, 0.7 * last) << "plane " << plane << ", " << modes << " modes";
      if (plane == 1) last = error;
    }
  }
  RecordProperty("of_five_modes", std::to_string(last));
  EXPECT_LT(last, 0.03);
}

// Thrust of both at the displaced ends of their links along the turned axes. The axial force at a section is
// that of the mass ahead, less the boosters' where their link is ahead.
TEST(BoostersBending, ABentBodyMovesTheirThrustAndIsCompressedByWhatItCarries) {
  for (const bool apart : {false, true}) {
    InSpace flight(Boosted(apart));
    const auto straight = flight.Rates();
    const StackModes stack = BuildStackModes(flight.vehicle, 0);
    const BendingLevel& level = stack.levels[0][5];
    ASSERT_NEAR(level.propellant_kg, flight.propellant_kg(), 1e-6);
    const double core_n = flight.plant.stacks[0].burn.vacuum_thrust_n, boost_n = kCount * kThrust_n, q = 0.02;
    const MassProperties mass = MassesOn(flight.plant, 0, 0u, flight.propellant_kg(), flight.time_s);
    const double pivot_m = flight.plant.stacks[0].gimbal.pivot_station_m;
    const std::vector<MassPoint> points =
        MassPointsOf(BuildBeamMasses(flight.vehicle, 0, flight.propellant_kg()), stack.station_m[0]);
    const auto shape = [&](int mode, double s) {
      return ShapeOf(stack, BeamPlane::kY, level.modes[static_cast<std::size_t>(mode)], s);
    };
    const auto at_nozzle = [&](int mode) {
      const StationShape link = shape(mode, kLink_m);
      return link.deflection + link.slope_1_m * (kNozzle_m - kLink_m);
    };
    // Work of compression by a unit of one mode on another.
    const auto carried = [&](int mode, int other) {
      constexpr int kPieces = 4000;
      const double top_m = stack.station_m[0].front(),
                   piece_m = (stack.station_m[0].back() - top_m) / kPieces;
      double sum = 0.0, ahead_kg = 0.0;
      std::size_t next = 0;
      for (int i = 0; i < kPieces; ++i) {
        const double s = top_m + piece_m * (i + 0.5);
        for (; next < points.size() && points[next].fixed_at_m <= s; ++next) ahead_kg += points[next].mass_kg;
        const double axial_n = (core_n + boost_n) * ahead_kg / mass.mass_kg - (s > kLink_m ? boost_n : 0.0);
        sum += axial_n * shape(mode, s).slope_1_m * shape(other, s).slope_1_m * piece_m;
      }
      return sum;
    };
    for (int mode = 0; mode < 3; ++mode) {
      const double core_side = -core_n * shape(mode, pivot_m).slope_1_m * q;
      const double boost_side = -boost_n * shape(mode, kLink_m).slope_1_m * q;
      const double moment = core_side * (pivot_m - mass.cg_station_m) +
                            boost_side * (kNozzle_m - mass.cg_station_m) +
                            core_n * shape(mode, pivot_m).deflection * q + boost_n * at_nozzle(mode) * q;
      for (int plane = 0; plane < kPlanes; ++plane) {
        InSpace bent = flight;
        bent.y[static_cast<std::size_t>(kModalState + plane * kModes + mode)] = q;
        const auto rates = bent.Rates();
        const std::size_t across = plane == 1 ? 5 : 4, turning = plane == 1 ? 11 : 12;
        const double side = (core_side + boost_side) / mass.mass_kg;
        EXPECT_NEAR(rates[across] - straight[across], side, 1e-5 * std::fabs(side));
        const double about = (plane == 1 ? 1.0 : -1.0) * moment / mass.transverse_inertia_kg_m2;
        EXPECT_NEAR(rates[turning] - straight[turning], about, 1e-5 * std::fabs(about));
        for (int other = 0; other < 3; ++other) {
          const double w = flight.At(other, ModeTable::kFrequency);
          const double driven = flight.At(other, ModeTable::kInverseMass) *
                                (core_side * shape(other, pivot_m).deflection +
                                 boost_side * at_nozzle(other) + carried(mode, other) * q);
          const std::size_t at = static_cast<std::size_t>(kModalRate + plane * kModes + other);
          EXPECT_NEAR(rates[at] + (other == mode ? w * w * q : 0.0), driven, 2e-3 * std::fabs(driven) + 1e-5)
              << apart << ", modes " << mode << " and " << other;
        }
      }
    }
  }
}

// One booster with more thrust: its couple turns the links.
TEST(BoostersBending, AnOddThrustTurnsTheirLink) {
  InSpace flight(Boosted(true));
  const auto even = flight.Rates();
  constexpr double kMore_n = 5e3;
  flight.Change([&](BoosterSet& set) { set.each[0].burn.vacuum_thrust_n += kMore_n; });
  const auto odd = flight.Rates();
  const double lever_m = kRadius_m * std::sqrt(0.5);
  for (int mode = 0; mode < 3; ++mode) {
    const double turned = flight.At(mode, ModeTable::kInverseMass) *
                          flight.At(mode, ModeTable::kBoosterSlope) * lever_m * kMore_n;
    for (int plane = 0; plane < kPlanes; ++plane) {
      const std::size_t at = static_cast<std::size_t>(kModalRate + plane * kModes + mode);
      EXPECT_NEAR(odd[at] - even[at], turned, 1e-6 * std::fabs(turned)) << mode << plane;
    }
  }
}

TEST(BoostersBending, LeavesTheMassesTheirMomentum) {
  const Vehicle vehicle = Boosted();
  const LauncherPlant plant = PlantOf(vehicle);
  const double since_s = kBoost_s + 0.5, propellant_kg = plant.stacks[0].burn.Propellant(since_s);
  const StackModes whole = BuildStackModes(vehicle, 0);
  const BendingLevel &burnt = whole.levels[0][10], &behind = whole.levels[0][11];
  const double within = (burnt.propellant_kg - propellant_kg) / (burnt.propellant_kg - behind.propellant_kg);
  ASSERT_GT(within, 0.0);
  ASSERT_LT(within, 1.0);
  const BeamMasses rest = BuildBeamMasses(vehicle, 0, propellant_kg, kBoostersGone);
  const MassProperties mass = MassesOn(plant, 0, kBoostersGone, propellant_kg, since_s);
  const std::vector<MassPoint> points = MassPointsOf(rest, whole.station_m[0]);
  for (int plane = 0; plane < kPlanes; ++plane)
    for (std::size_t mode = 0; mode < 3; ++mode) {
      // Sums of the flown shape over the masses that stay.
      double momentum = 0.0, angular = 0.0;
      for (const MassPoint& m : points) {
        const StationShape a = ShapeOf(whole, BeamPlane::kY, burnt.modes[mode], m.fixed_at_m),
                           b = ShapeOf(whole, BeamPlane::kY, behind.modes[mode], m.fixed_at_m);
        const double turn = a.slope_1_m + within * (b.slope_1_m - a.slope_1_m);
        const double move =
            a.deflection + within * (b.deflection - a.deflection) + turn * (m.cg_station_m - m.fixed_at_m);
        momentum += m.mass_kg * move;
        angular += m.mass_kg * move * (m.cg_station_m - mass.cg_station_m) + m.inertia_kg_m2 * turn;
      }
      double modal[2 * kPlanes * kModes] = {};
      const double q_m = 0.003, rate_m_s = -0.2;
      modal[plane * kModes + static_cast<int>(mode)] = q_m;
      modal[(kPlanes + plane) * kModes + static_cast<int>(mode)] = rate_m_s;
      RigidBodyState state;
      state.q_IB = FromRotationVector(Vector3(0.3, -0.7, 1.1));
      const RigidBodyState before = state;
      LetGoBent(plant.stacks[0], 0u, kBoostersGone, propellant_kg, modal, state);
      const Vector3 along = plane == 0 ? Vector3::UnitY() : Vector3::UnitZ(),
                    about = plane == 0 ? Vector3(-Vector3::UnitZ()) : Vector3(Vector3::UnitY());
      const double move = momentum / mass.mass_kg, turn = angular / mass.transverse_inertia_kg_m2;
      EXPECT_GT(std::fabs(move), 1e-6);
      const auto expect = [&](const Vector3& found, const Vector3& wanted, const char* what) {
        EXPECT_LT((found - wanted).norm(), 1e-6 * wanted.norm()) << what << plane << mode;
      };
      expect(state.p_EoC_I, Rotate(before.q_IB, Vector3(move * q_m * along)), "place");
      expect(state.v_IC_I, Rotate(before.q_IB, Vector3(move * rate_m_s * along)), "speed");
      expect(RotationVector(Inverse(before.q_IB) * state.q_IB), turn * q_m * about, "turn");
      expect(state.w_IB_B, turn * rate_m_s * about, "rate");
    }
}

FlightDefinition DefinitionOf(const Vehicle& vehicle) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS, "flexible");
  definition.vehicle = vehicle;
  for (RateGyro& gyro : definition.vehicle.sensors.rate_gyros) gyro.quantum_rad_s = 0.0;
  AscentOptions options;
  options.record = true;
  const FlightProgram program =
      LoadReference(DISPERSA_CAMPAIGNS "/references/slv4_500km_reserve.yaml").program;
  const AscentResult ascent = FlyAscent(BuildAscentModel(vehicle, 0.01), program, options);
  definition.program = ascent.attitude;
  definition.last_ignition_s = ascent.last_ignition_s;
  definition.earlier_ignition_s = ascent.earlier_ignition_s;
  return definition;
}

std::vector<TickSample> Flown(const FlightModel& model, Scheme scheme = FlightOptions{}.scheme) {
  return TicksBetween(model, Table3Inputs(), 25.0, 40.0, scheme);
}
// The largest coordinate of a mode, and the largest difference between two flights.
struct Apart {
  double largest_m = 0.0, difference_m = 0.0;
  Apart(const std::vector<TickSample>& flown, const std::vector<TickSample>& other) {
    EXPECT_EQ(flown.size(), other.size());
    for (std::size_t i = 0; i < std::min(flown.size(), other.size()); ++i)
      for (int plane = 0; plane < kPlanes; ++plane)
        for (int mode = 0; mode < 3; ++mode) {
          const std::size_t at = static_cast<std::size_t>(plane * kModes + mode);
          largest_m = std::max(largest_m, std::fabs(other[i].bending[at]));
          difference_m = std::max(difference_m, std::fabs(flown[i].bending[at] - other[i].bending[at]));
        }
  }
};

// Through the separation in dense air, with nozzles that turn.
TEST(BoostersBending, FliesAsCvodeFliesIt) {
  const FlightModel model(DefinitionOf(Boosted(true)));
  const std::vector<TickSample> flown = Flown(model);
  const Apart apart(flown, Flown(model, Scheme::kCvode));
  EXPECT_GT(apart.largest_m, 1e-4);
  EXPECT_LT(apart.difference_m, 1e-3 * apart.largest_m);
  EXPECT_EQ(flown.front().jettisoned, 0u);
  EXPECT_EQ(flown.back().jettisoned, kBoostersGone);
}

// The flight's own separation: place and speed of the centre of gravity, then what bending adds to both.
TEST(BoostersBending, AFlightPassesItsBendingOnAtTheSeparation) {
  const FlightModel model(DefinitionOf(Boosted()));
  FlightRecord record(model, {});
  const LauncherPlant& plant = record.plant;
  const double time_s = record.events.front().time_s + kBoost_s + 0.5;
  const double propellant_kg = plant.stacks[0].burn.Propellant(kBoost_s + 0.5);
  std::array<double, kLauncherSize> y{};
  RigidBodyState state;
  state.p_EoC_I = Vector3(6.4e6, 1e5, 2e5);
  state.v_IC_I = Vector3(100.0, -300.0, 50.0);
  state.q_IB = FromRotationVector(Vector3(0.3, -0.7, 1.1));
  state.w_IB_B = Vector3(0.1, -0.02, 0.03);
  WriteState(state, y.data());
  for (int plane = 0; plane < kPlanes; ++plane) {
    y[static_cast<std::size_t>(kModalState + plane * kModes)] = 0.01;
    y[static_cast<std::size_t>(kModalRate + plane * kModes + 1)] = 0.2;
  }
  std::array<double, kLauncherSize> expected = y;
  RigidBodyState left = AfterJettison(plant, 0, 0u, kBoostersGone, propellant_kg, kBoost_s + 0.5, state);
  LetGoBent(plant.stacks[0], 0u, kBoostersGone, propellant_kg, expected.data() + kModalState, left);
  WriteState(left, expected.data());
  record.LetGoOfBoosters(0u, time_s, propellant_kg, y.data());
  EXPECT_EQ(y, expected);
  EXPECT_GT(std::fabs(y[kModalState] - 0.01), 1e-5);
}

// Bodies of their own with fixed nozzles, at equal angles, are boosters that are all alike. Where both stand
// between the planes their inertia is the same about y and z. The couple of their flows drives the modes of
// bodies of their own alone: that is left.
TEST(BoostersBending, AlikeOnesFlyAsBodiesOfTheirOwn) {
  Vehicle vehicle = Boosted(true);
  vehicle.boosters.gimbal = {};
  vehicle.boosters.towards_rad.clear();
  const Apart apart(Flown(FlightModel(DefinitionOf(vehicle))), Flown(FlightModel(DefinitionOf(Boosted()))));
  EXPECT_GT(apart.largest_m, 1e-4);
  EXPECT_LT(apart.difference_m, 1e-3 * apart.largest_m);
}

// The slopes that sensors feel, and the lowest mode, are those of the stack that flies.
TEST(BoostersBending, MarginsSeeTheStackWithoutThemWhenTheyHaveLeft) {
  const FlightModel model(DefinitionOf(Boosted()));
  const LauncherPlant& plant = model.nominal_plant();
  std::vector<TickSample> samples = TicksBetween(model, {}, 19.995, 40.005);
  ASSERT_EQ(samples.back().time_s, 40.0);
  for (const TickSample& s : {samples.front(), samples.back()}) {
    const AxisPlant linear = LineariseAxis(plant, s, kPitch, model.sensors());
    const unsigned gone = s.time_s > 30.0 ? kBoostersGone : 0u;
    const double propellant_kg = plant.stacks[0].burn.Propellant(s.since_ignition_s);
    const ModeTable& table = *plant.stacks[0].BendingWithout(gone);
    EXPECT_DOUBLE_EQ(linear.lowest_mode_rad_s, table.At(0, 0, ModeTable::kFrequency, propellant_kg));
    EXPECT_DOUBLE_EQ(linear.attitude[4], table.At(0, 0, ModeTable::kUnitSlope, propellant_kg));
    EXPECT_NE(
        linear.attitude[4],
        plant.stacks[0].BendingWithout(gone ^ kBoostersGone)->At(0, 0, ModeTable::kUnitSlope, propellant_kg));
  }
}

}  // namespace
}  // namespace dispersa::boosters_bending_test
