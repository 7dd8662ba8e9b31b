// The beam of a vehicle file: values read, and vehicles based on others.
#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/structure/bending_modes.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_beam_test {

TEST(CampaignYamlBeam, ReadsSectionsLumpsAndSensors) {
  const InputFiles files;
  const Vehicle vehicle = LoadVehicle(files.Path("flexible.yaml"));
  EXPECT_EQ(vehicle.name, "two-stage");
  ASSERT_TRUE(vehicle.structure_beam.has_value());
  const StructureBeam& beam = *vehicle.structure_beam;
  EXPECT_TRUE(beam.timoshenko);
  EXPECT_TRUE(beam.rotary_inertia);
  EXPECT_EQ(beam.propellant_levels, 3);
  EXPECT_EQ(beam.sensors[0].name, "gyro");
  const BeamSection& tube = beam.stages[0].sections[0];
  EXPECT_DOUBLE_EQ(tube.thickness_m.bottom, 0.004);
  EXPECT_DOUBLE_EQ(tube.modulus_pa, 200e9);
  EXPECT_NEAR(tube.BendingStiffness(BeamPlane::kZ, 7.0), 200e9 * kPi / 64.0 * (1.0 - std::pow(0.992, 4)),
              1.0);
  // Thin round tube, nu 0.3: kappa 2.6 / 4.9, G = E / 2.6.
  EXPECT_NEAR(tube.ShearStiffness(BeamPlane::kY, 7.0), 200e9 / 4.9 * kPi / 4.0 * (1.0 - 0.992 * 0.992), 1.0);
  const BeamSection& given = beam.stages[1].sections[0];
  EXPECT_DOUBLE_EQ(given.BendingStiffness(BeamPlane::kY, 2.25), 125e6);
  EXPECT_DOUBLE_EQ(given.ShearStiffness(BeamPlane::kY, 1.0), 200e6);
  EXPECT_EQ(beam.stages[0].lumped_masses[0].element, "nozzles");
}

TEST(CampaignYamlBeam, VehiclesWithoutOneStayAsTheyWere) {
  const InputFiles files;
  EXPECT_FALSE(LoadVehicle(files.Path("vehicle.yaml")).structure_beam.has_value());
  EXPECT_FALSE(LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml").structure_beam.has_value());
}

// The base is inlined: the campaign's canonical text names no file, reads back, and flies the base's
// reference.
TEST(CampaignYamlBeam, TheCanonicalTextHoldsBaseAndBeam) {
  const InputFiles files;
  const Campaign rigid = LoadCampaign(files.Path("campaign.yaml"));
  std::vector<InputProblem> rigid_warnings, warnings;
  LoadCampaign(files.Path("campaign.yaml"), {}, &rigid_warnings);
  files.Edit("campaign.yaml", "vehicle: vehicle.yaml", "vehicle: flexible.yaml");
  const Campaign flexible = LoadCampaign(files.Path("campaign.yaml"), {}, &warnings);
  EXPECT_EQ(warnings.size(), rigid_warnings.size());
  EXPECT_THAT(flexible.canonical_yaml, Not(HasSubstr("based_on")));
  EXPECT_THAT(flexible.canonical_yaml, HasSubstr("bending_stiffness_mn_m2: [100, 150]"));
  EXPECT_NE(flexible.flight_id, rigid.flight_id);
  const Campaign again = ParseCampaign(flexible.canonical_yaml, "again");
  EXPECT_EQ(again.canonical_yaml, flexible.canonical_yaml);
  EXPECT_EQ(again.flight_id, flexible.flight_id);
  EXPECT_EQ(again.vehicle.structure_beam->stages[1].sections[0].bending_stiffness_n_m2.bottom, 150e6);
  files.Write("flexible.yaml", "schema: dispersa/vehicle/1\nbased_on: vehicle.yaml\n");
  EXPECT_EQ(LoadCampaign(files.Path("campaign.yaml")).flight_id, rigid.flight_id);
}

TEST(CampaignYamlBeam, TakesATableOfModes) {
  const InputFiles files;
  files.Write("flexible.yaml",
              "schema: dispersa/vehicle/1\nbased_on: vehicle.yaml\nsensors: {inertial_unit: {station_m: 2}}\n"
              "structure_beam: {modes_table: modes.csv}\n");
  const Vehicle vehicle = LoadVehicle(files.Path("flexible.yaml"));
  const std::vector<StackModes> stacks = BuildBendingModes(vehicle);
  ASSERT_EQ(stacks.size(), 2u);
  EXPECT_TRUE(stacks[0].axisymmetric);
  EXPECT_FALSE(stacks[1].axisymmetric);
  EXPECT_NEAR(stacks[1].levels[1][0].modes[0].frequency_rad_s, kTwoPi * 44.0, 1e-12 * kTwoPi * 44.0);
  // The second level's shape has the other sign and half the size in the file; as a mode it is the first
  // one's.
  const BendingMode& empty = stacks[0].levels[1][1].modes[0];
  EXPECT_DOUBLE_EQ(empty.deflection[0], 1.0);
  EXPECT_DOUBLE_EQ(empty.slope_1_m[2], 0.34);
  EXPECT_DOUBLE_EQ(empty.generalized_mass_kg, 1200.0);
  EXPECT_GT(empty.mac, 0.99);
}

}  // namespace dispersa::campaign_yaml_beam_test
