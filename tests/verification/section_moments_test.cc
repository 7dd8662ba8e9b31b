// Bending moments along the body, against the equilibrium of the part behind each section and against the
// curvature of an oscillating beam.
#include "core/dynamics/body_sections.h"
#include "core/flight/flight_model.h"
#include "core/math/constants.h"
#include "core/modes/mode_table.h"
#include "core/structure/bending_modes.h"
#include "core/vehicle/mass.h"
#include "tests/liquid_stage.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::section_moments_test {
namespace {

// A part of the vehicle as its file has it.
struct Tube {
  double mass_kg, top_m, bottom_m, gyration2_m2;
};
std::vector<Tube> Tubes(const Vehicle& vehicle, double propellant_kg) {
  std::vector<Tube> tubes;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    const Stage& stage = vehicle.stages[i];
    for (const MassElement& e : stage.structure)
      tubes.push_back(
          {DryMass(vehicle, static_cast<int>(i)) * e.fraction, e.top_station_m, e.bottom_station_m,
           (e.outer_diameter_m * e.outer_diameter_m + e.inner_diameter_m * e.inner_diameter_m) / 16.0});
    if (stage.is_liquid()) {
      // Each tank's share stands on its bottom, as if frozen.
      const double left = i == 0 ? propellant_kg / stage.propellant_mass_kg : 1.0;
      for (const Tank& tank : stage.tanks) {
        const double tank_kg = left * tank.propellant_mass_kg, d2 = tank.diameter_m * tank.diameter_m;
        const double height_m = tank_kg / (tank.density_kg_m3 * 0.25 * kPi * d2);
        tubes.push_back({tank_kg, tank.bottom_station_m - height_m, tank.bottom_station_m, d2 / 16.0});
      }
      continue;
    }
    const Grain& g = stage.grain;
    const double kg = i == 0 ? propellant_kg : stage.propellant_mass_kg;
    const double outer2 = 0.25 * g.outer_diameter_m * g.outer_diameter_m;
    const double inner2 =
        outer2 - kg / (kPi * PropellantDensity(stage) * (g.bottom_station_m - g.top_station_m));
    tubes.push_back({kg, g.top_station_m, g.bottom_station_m, 0.25 * (outer2 + inner2)});
  }
  return tubes;
}

// One section alone.
lanes::Sections<double> Only(const LoadTable& table, int station) {
  lanes::Sections<double> s{};
  lanes::SetSections(s, 0, &table);
  s.first_kg_m[0] = s.first_kg_m[station];
  s.second_kg_m2[0] = s.second_kg_m2[station];
  s.slender_arm_m[0] = s.slender_arm_m[station];
  s.shift_arm[0] = s.shift_arm[station];
  s.stations = 1;
  return s;
}

// A side force at the pivot and the flow from the side, in each plane, with these parts of the propellant
// left.
void ExpectBalance(const Vehicle& vehicle, const std::vector<double>& parts) {
  const LauncherPlant plant = BuildNominalPlant(vehicle);
  const LoadTable& table = *plant.stacks[0].loads;
  const double side_n = 4e3, normal_n = 2e4, xcp_m = 9.3, pivot_m = vehicle.stages[0].gimbal.pivot_station_m;
  const auto share_of = [&](const LiftPiece& piece) {
    return piece.area_to - piece.area_from + (xcp_m - table.lift.slender_station_m) * piece.shift_1_m;
  };
  double shares = 0.0, centroid = 0.0;
  for (const LiftPiece& piece : table.lift.pieces) {
    shares += share_of(piece);
    centroid += share_of(piece) * piece.Middle();
  }
  EXPECT_NEAR(shares, 1.0, 1e-12);
  EXPECT_NEAR(centroid, xcp_m, 1e-9);

  for (const double part : parts) {
    const double propellant = part * vehicle.stages[0].propellant_mass_kg;
    const MassProperties mass = plant.stacks[0].mass.At(propellant);
    const double acceleration = (side_n - normal_n) / mass.mass_kg;
    const double turn = (side_n * (mass.cg_station_m - pivot_m) - normal_n * (mass.cg_station_m - xcp_m)) /
                        mass.transverse_inertia_kg_m2;
    for (int station = 0; station < table.stations; ++station) {
      const double s = table.station_m[static_cast<std::size_t>(station)];
      double behind = side_n * (s - pivot_m);
      for (const LiftPiece& piece : table.lift.pieces)
        if (piece.Middle() > s) behind -= normal_n * share_of(piece) * (s - piece.Middle());
      for (const Tube& tube : Tubes(vehicle, propellant)) {
        const double from = std::max(tube.top_m, s), length = tube.bottom_m - from;
        if (length <= 0.0 || tube.mass_kg == 0.0) continue;
        const double kg = tube.mass_kg * length / (tube.bottom_m - tube.top_m);
        const double middle = 0.5 * (from + tube.bottom_m), second = length * length / 12.0;
        // The integral of (a + turn (cg - x)) (s - x) over the piece.
        behind -= kg * ((acceleration + turn * (mass.cg_station_m - middle)) * (s - middle) + turn * second);
        behind -= kg * turn * tube.gyration2_m2;
      }
      const lanes::Sections<double> body = Only(table, station);
      const lanes::NormalForce<double> along_y{normal_n, 0.0, xcp_m, 1.0, 0.0, 500.0},
          along_z{normal_n, 0.0, xcp_m, 0.0, 1.0, 500.0};
      const lanes::SideForce<double>* const round = nullptr;
      const double y =
          lanes::LargestOf(
              body, along_y, round,
              lanes::BodyMotion<double>{propellant, mass.cg_station_m, acceleration, 0.0, 0.0, turn}, 0.0)
              .moment_n_m;
      // The yaw plane's air is its own.
      const lanes::SideForce<double> side{normal_n, 0.0, xcp_m};
      const lanes::NormalForce<double> other{2.0 * normal_n, 0.0, xcp_m + 1.0, 1.0, 0.0, 500.0};
      EXPECT_EQ(
          lanes::LargestOf(
              body, other, &side,
              lanes::BodyMotion<double>{propellant, mass.cg_station_m, acceleration, 0.0, 0.0, turn}, 0.0)
              .moment_n_m,
          y);
      // Turning about -y moves what lies ahead along z.
      const double z =
          lanes::LargestOf(
              body, along_z, round,
              lanes::BodyMotion<double>{propellant, mass.cg_station_m, 0.0, acceleration, -turn, 0.0}, 0.0)
              .moment_n_m;
      EXPECT_NEAR(y, std::fabs(behind), 1e-6) << station;  // of up to 1e5 N m
      EXPECT_NEAR(z, std::fabs(behind), 1e-6) << station;
    }
  }
}

// Scouts feel 1 N m and a further station 1.1: each lane looks there, unless the flight has seen so much more
// that the scouts would know.
TEST(SectionMoments, AreLookedForBeyondTheScoutsWhereTheyMayBeTheLargest) {
  using Four = lanes::Pack<4>;
  LoadTable table;
  table.stations = kScoutStations + 2;
  table.scouts_see = 0.9;
  table.slender_arm_m.fill(1.0);
  table.slender_arm_m[kScoutStations] = 1.1;
  lanes::Sections<Four> body{};
  for (int lane = 0; lane < 4; ++lane) lanes::SetSections(body, lane, &table);
  const double just = 1.0 / (lanes::kScoutMargin * table.scouts_see);
  const double seen[4] = {0.0, 0.999 * just, 1.001 * just, 100.0}, found[4] = {1.1, 1.1, 1.0, 1.0};
  Four seen_n_m(0.0);
  for (int lane = 0; lane < 4; ++lane) lanes::Lane(seen_n_m, lane) = seen[lane];
  const Four none(0.0), one(1.0);
  const lanes::NormalForce<Four> air{one, none, none, one, none, Four(500.0)};
  const lanes::SideForce<Four>* const round = nullptr;
  const Four largest = lanes::LargestOf(body, air, round,
                                        lanes::BodyMotion<Four>{none, none, none, none, none, none}, seen_n_m)
                           .moment_n_m;
  for (int lane = 0; lane < 4; ++lane) EXPECT_DOUBLE_EQ(lanes::Lane(largest, lane), found[lane]) << lane;
}

// Bending adds 1 N m to a scout and 5 N m beyond: it is no part of what the scouts see.
struct FarBending {
  void AddAt(int station, double& y_n_m, double& z_n_m) const {
    if (station == 2) y_n_m += 1.0;
    if (station == kScoutStations + 1) z_n_m += 5.0;
  }
  double Most() const { return 5.0; }
};
TEST(SectionMoments, OfBendingAreLookedForWhereItsBoundMayBeTheLargest) {
  LoadTable table;
  table.stations = kScoutStations + 2;
  table.scouts_see = 1.0 / lanes::kScoutMargin;
  table.slender_arm_m.fill(1.0);
  lanes::Sections<double> body{};
  lanes::SetSections(body, 0, &table);
  const lanes::NormalForce<double> air{1.0, 0.0, 0.0, 1.0, 0.0, 500.0};
  const lanes::SideForce<double>* const round = nullptr;
  const auto found = [&](double seen_n_m) {
    return lanes::LargestOf(body, air, round, lanes::BodyMotion<double>{}, seen_n_m, FarBending{}).moment_n_m;
  };
  for (const double seen_n_m : {0.0, 1.5, 4.0, 5.999})
    EXPECT_DOUBLE_EQ(found(seen_n_m), std::hypot(1.0, 5.0));
  for (const double seen_n_m : {6.001, 100.0}) EXPECT_DOUBLE_EQ(found(seen_n_m), 1.0);
}

TEST(SectionMoments, HoldTheBalanceOfWhatLiesBehindTheSection) {
  ExpectBalance(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml"), {1.0, 0.37, 0.0});
}

// Surfaces that pass a section make its load no polynomial: the table is exact where it was taken.
TEST(SectionMoments, HoldTheBalanceOfLiquidsFullHalfFullAndEmpty) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  for (const std::size_t stage : {0u, 2u}) MakeLiquid(vehicle.stages[stage]);  // that drains, and that waits
  ExpectBalance(vehicle, {1.0, 0.5, 0.0});
}

// Of a ringing beam what its inertia loads a section with is what the section's stiffness holds: E I theta'.
// They share the mode alone.
void ExpectRinging(const Vehicle& vehicle, std::size_t at_level) {
  LauncherPlant plant = BuildNominalPlant(vehicle);
  const std::vector<StackModes> stacks = BuildBendingModes(vehicle);
  AddBending(vehicle, 0.01, plant);
  const ModeTable& table = *plant.stacks[0].bending;
  const LoadTable& loads = *plant.stacks[0].loads;
  const BendingLevel& level = stacks[0].levels[0][at_level];
  constexpr double kStep_m = 0.02;
  double largest = 0.0;
  for (std::size_t mode = 0; mode < 2; ++mode) {
    const double omega2 = std::pow(level.modes[mode].frequency_rad_s, 2);
    double most = 0.0;
    std::vector<double> held, loaded;
    for (std::size_t i = 0; i < static_cast<std::size_t>(loads.stations); ++i) {
      const double s = loads.station_m[i];
      double stiffness = 0.0;
      // At a node curvature may jump. Where the stiffness tapers, an element has the curvature of a uniform
      // one.
      bool skip = false;
      for (const BeamStage& stage : vehicle.structure_beam->stages)
        for (const BeamSection& section : stage.sections)
          if (s > section.top_station_m && s < section.bottom_station_m) {
            stiffness += section.BendingStiffness(BeamPlane::kY, s);
            skip = skip || section.outer_diameter_m.top != section.outer_diameter_m.bottom;
          }
      for (const double node_m : stacks[0].station_m[0]) skip = skip || std::fabs(s - node_m) < kStep_m;
      if (skip) continue;
      const auto slope = [&](double at) {
        return ShapeOf(stacks[0], BeamPlane::kY, level.modes[mode], at).slope_1_m;
      };
      held.push_back(stiffness * (slope(s + kStep_m) - slope(s - kStep_m)) / (2.0 * kStep_m));
      loaded.push_back(omega2 * table.Row(0, static_cast<int>(at_level),
                                          static_cast<int>(mode))[ModeTable::kMomentAt + i]);
      most = std::max(most, std::fabs(held.back()));
    }
    EXPECT_GT(held.size(), 10u);
    for (std::size_t i = 0; i < held.size(); ++i) {
      largest = std::max(largest, std::fabs(std::fabs(held[i]) - std::fabs(loaded[i])) / most);
      EXPECT_GT(held[i] * loaded[i] * held[3] * loaded[3], 0.0) << "one sign along the beam";
    }
  }
  // The elements' curvature is linear within each.
  EXPECT_LT(largest, 0.02);
}

TEST(SectionMoments, OfARingingBeamAreItsStiffnessTimesItsCurvature) {
  ExpectRinging(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml"), 0);
}

TEST(SectionMoments, OfARingingBeamWithLiquidsAreItsStiffnessTimesItsCurvature) {
  Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  MakeLiquid(vehicle.stages[0]);
  vehicle.structure_beam->propellant_levels = 3;
  for (const std::size_t level : {0u, 1u}) ExpectRinging(vehicle, level);
}

}  // namespace
}  // namespace dispersa::section_moments_test
