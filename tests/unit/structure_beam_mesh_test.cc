// A stack's mesh is as fine as its modes need.
#include "core/structure/beam_mesh.h"

#include "core/campaign_yaml/load.h"
#include "core/structure/bending_modes.h"
#include "core/structure/free_free_modes.h"
#include "core/structure/near_modes.h"
#include "tests/test.h"

namespace dispersa::structure_beam_mesh_test {
namespace {

BeamSection Tube(double top_m, double bottom_m, double stiffness) {
  BeamSection section;
  section.top_station_m = top_m;
  section.bottom_station_m = bottom_m;
  section.bending_stiffness_n_m2 = {3e8 * stiffness, 3e8 * stiffness};
  section.shear_stiffness_n = {2e8 * stiffness, 2e8 * stiffness};
  return section;
}

// A beam with rotary inertia, whose error falls with the square.
Beam Stubby() { return {{Tube(0.0, 6.0, 1.0)}, {{{0.0, 6.0, {700.0, 700.0}, {0.6, 0.6}}}, {}}, true}; }

TEST(BeamMesh, IsRefinedUntilTwiceTheLengthChangesNothing) {
  const Beam beam = Stubby();
  std::size_t last = 0;
  for (const int modes : {1, 3, 8}) {
    const BeamMesh mesh = RefinedMesh(beam, BeamPlane::kY, {beam.masses}, 4, modes);
    EXPECT_GE(mesh.elements.size(), last) << modes;
    last = mesh.elements.size();
    EXPECT_LE(mesh.difference, kMeshDifference) << modes;
    EXPECT_GT(mesh.difference, 0.0) << modes;
    // The error that is left is a third of it.
    const std::vector<double> fine = MeshStations(beam.sections, beam.masses, 640);
    const NearModes exact(fine, BuildElements(beam, BeamPlane::kY, fine), true),
        found(mesh.stations, mesh.elements, true);
    const FreeFreeModes a = found.Lowest(beam.masses, modes), b = exact.Lowest(beam.masses, modes);
    for (Eigen::Index mode = 0; mode < modes; ++mode)
      EXPECT_NEAR(a.frequency_rad_s[mode] / b.frequency_rad_s[mode], 1.0, 1e-3) << modes << ", " << mode;
  }
  EXPECT_GT(last, 8u);
}

// Each of the masses counts, and the given number is the least.
TEST(BeamMesh, LooksAtEachOfTheMasses) {
  const Beam beam = Stubby();
  BeamMasses heavy = beam.masses;
  heavy.spread.push_back({2.0, 2.5, {9e4, 9e4}, {4.0, 4.0}});
  const auto size = [&](const std::vector<BeamMasses>& masses, int elements) {
    return RefinedMesh(beam, BeamPlane::kY, masses, elements, 4).elements.size();
  };
  EXPECT_GE(size({beam.masses}, 100), 100u);
  EXPECT_EQ(size({heavy, beam.masses}, 4), std::max(size({heavy}, 4), size({heavy, beam.masses}, 4)));
  EXPECT_GT(size({beam.masses, heavy}, 4), size({beam.masses}, 4));
}

// A mesh that cannot get fine enough says by how much it is not.
TEST(BeamMesh, EndsAtTheMostElements) {
  Beam beam = Stubby();
  beam.sections = {Tube(0.0, 3.0, 1e-4), Tube(3.0, 6.0, 1.0)};
  beam.masses.spread[0].gyration2_m2 = {60.0, 60.0};
  const BeamMesh mesh = RefinedMesh(beam, BeamPlane::kY, {beam.masses}, 20, 10);
  EXPECT_LE(mesh.elements.size(), kMostElements);
  EXPECT_GT(2 * mesh.elements.size(), kMostElements);
  EXPECT_GT(mesh.difference, kMeshDifference);
}

// The iteration from cosines finds what the whole solution has.
TEST(BeamMesh, LowestModesAreThoseOfTheWholeSolution) {
  const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4_flexible.yaml");
  Beam beam;
  beam.timoshenko = true;
  for (const BeamStage& stage : vehicle.structure_beam->stages)
    beam.sections.insert(beam.sections.end(), stage.sections.begin(), stage.sections.end());
  beam.masses = BuildBeamMasses(vehicle, 0, 0.5 * vehicle.stages[0].propellant_mass_kg);
  const std::vector<double> stations = MeshStations(beam.sections, beam.masses, 40);
  const std::vector<BeamElement> elements = BuildElements(beam, BeamPlane::kY, stations);
  const FreeFreeModes whole = SolveFreeFree(stations, elements, MassMatrix(beam, stations, elements), 6),
                      found = NearModes(stations, elements, true).Lowest(beam.masses, 6);
  for (Eigen::Index mode = 0; mode < 6; ++mode) {
    EXPECT_NEAR(found.frequency_rad_s[mode] / whole.frequency_rad_s[mode], 1.0, 1e-11) << mode;
    const double sign = found.shape(0, mode) * whole.shape(0, mode) < 0.0 ? -1.0 : 1.0;
    const double largest = whole.shape.col(mode).cwiseAbs().maxCoeff();
    EXPECT_LT((sign * found.shape.col(mode) - whole.shape.col(mode)).cwiseAbs().maxCoeff(), 1e-7 * largest)
        << mode;
  }
}

}  // namespace
}  // namespace dispersa::structure_beam_mesh_test
