// A vehicle's beam from its file: what is read, what is said about mistakes, and that vehicles can be based on others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/structure/bending_modes.h"
#include "tests/unit/input_files.h"

namespace dispersa {
namespace {

using testing::HasSubstr;
using testing::Not;

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
  EXPECT_NEAR(tube.BendingStiffness(BeamPlane::kZ, 7.0), 200e9 * kPi / 64.0 * (1.0 - std::pow(0.992, 4)), 1.0);
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

// The base is inlined: the campaign's canonical text names no file, reads back, and flies the base's reference.
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
  files.Write("flexible.yaml", "schema: dispersa/vehicle/1\nbased_on: vehicle.yaml\nstructure_beam: {modes_table: modes.csv}\n");
  const Vehicle vehicle = LoadVehicle(files.Path("flexible.yaml"));
  const std::vector<StackModes> stacks = BuildBendingModes(vehicle);
  ASSERT_EQ(stacks.size(), 2u);
  EXPECT_TRUE(stacks[0].axisymmetric);
  EXPECT_FALSE(stacks[1].axisymmetric);
  EXPECT_NEAR(stacks[1].levels[1][0].modes[0].frequency_rad_s, kTwoPi * 44.0, 1e-12 * kTwoPi * 44.0);
  // The second level's shape has the other sign and half the size in the file; as a mode it is the first one's.
  const BendingMode& empty = stacks[0].levels[1][1].modes[0];
  EXPECT_DOUBLE_EQ(empty.deflection[0], 1.0);
  EXPECT_DOUBLE_EQ(empty.slope_1_m[2], 0.34);
  EXPECT_DOUBLE_EQ(empty.generalized_mass_kg, 1200.0);
  EXPECT_GT(empty.mac, 0.99);
}

struct BadInput {
  const char* name;
  const char* from;
  const char* to;
  const char* texts;
};

void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.name; }

class BadBeamTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadBeamTest, IsReportedInFull) {
  const InputFiles files;
  files.Edit("flexible.yaml", GetParam().from, GetParam().to);
  EXPECT_EQ(files.Texts(ValidateFile(files.Path("flexible.yaml"))), GetParam().texts);
}

constexpr BadInput kBadInputs[] = {
    {"NoStiffness", "outer_diameter_m: 1, thickness_mm: 4, modulus_gpa: 200", "z_to_y_stiffness: 1", "?"},
    {"TwoStiffnesses", "modulus_gpa: 200", "modulus_gpa: 200, bending_stiffness_n_m2: 1e8", "?"},
    {"HalfATube", "thickness_mm: 4, ", "", "?"},
    {"ShearMissing", ", shear_stiffness_kn: 200e3", "", "?"},
    {"WrongUnit", "modulus_gpa: 200", "modulus_psi: 3e7", "?"},
    {"ThreeEnds", "[100, 150]", "[100, 150, 200]", "?"},
    {"NegativeEnd", "[100, 150]", "[100, -150]", "?"},
    {"WallTooThick", "thickness_mm: 4", "thickness_mm: 501", "?"},
    {"Gap", "top_station_m: 4, bottom_station_m: 10", "top_station_m: 4.1, bottom_station_m: 10", "?"},
    {"BeyondTheStage", "top_station_m: 4, bottom_station_m: 10", "top_station_m: 4, bottom_station_m: 10.1", "?"},
    {"TooShort", "top_station_m: 4, bottom_station_m: 10", "top_station_m: 4, bottom_station_m: 8.5", "?"},
    {"UnknownElement", "element: nozzles", "element: nozzle", "?"},
    {"StageMissing", "    - sections:\n        - {name: case, top_station_m: 0.5, bottom_station_m: 4, bending_stiffness_mn_m2: [100, 150], shear_stiffness_kn: 200e3}\n", "", "?"},
    {"SomeMasses", "modulus_gpa: 200}", "modulus_gpa: 200}\n        - {name: skirt, top_station_m: 9, bottom_station_m: 10, outer_diameter_m: 1, thickness_mm: 4, modulus_gpa: 200, mass_per_length_kg_m: 9}", "?"},
    {"MassesOfAnother", "modulus_gpa: 200}\n      lumped_masses:\n        - {element: nozzles, station_m: 10}", "modulus_gpa: 200, mass_per_length_kg_m: 30}", "?"},
    {"SensorBehind", "station_m: 1}", "station_m: 11}", "?"},
    {"UnknownTheory", "timoshenko", "timoschenko", "?"},
    {"TooManyModes", "propellant_levels: 3", "propellant_levels: 3\n  modes: 11", "?"},
    {"NoBase", "based_on: vehicle.yaml", "based_on: vehicles.yaml", "?"},
    {"BaseOfAnotherKind", "based_on: vehicle.yaml", "based_on: autopilot.yaml", "?"},
    {"BaseOnABase", "based_on: vehicle.yaml", "based_on: flexible.yaml", "?"},
};

INSTANTIATE_TEST_SUITE_P(CampaignYamlBeam, BadBeamTest, testing::ValuesIn(kBadInputs),
                         [](const auto& each) { return std::string(each.param.name); });

class BadModesTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadModesTest, IsReportedInFull) {
  const InputFiles files;
  files.Write("flexible.yaml", "schema: dispersa/vehicle/1\nbased_on: vehicle.yaml\nstructure_beam:\n  modes_table: modes.csv\n");
  files.Edit("modes.csv", GetParam().from, GetParam().to);
  EXPECT_EQ(files.Texts(ValidateFile(files.Path("flexible.yaml"))), GetParam().texts);
}

constexpr BadInput kBadModes[] = {
    {"UnknownColumn", "frequency_hz", "frequency", "?"},
    {"UnknownPlane", "2,500,z,1,44,220,0,1,-1", "2,500,x,1,44,220,0,1,-1", "?"},
    {"HalfAMode", "1,0,y,1,15,300,0,-0.5,0.2", "1,0,y,1.5,15,300,0,-0.5,0.2", "?"},
    {"NoSuchStage", "2,500,z,1,44,220,0,1,-1", "3,500,z,1,44,220,0,1,-1", "?"},
    {"StationsFall", "1,0,y,1,15,300,5,0.3,0", "1,0,y,1,15,300,11,0.3,0", "?"},
    {"OtherStations", "1,0,y,1,15,300,5,0.3,0", "1,0,y,1,15,300,6,0.3,0", "?"},
    {"TwoFrequencies", "1,0,y,1,15,300,5,0.3,0", "1,0,y,1,16,300,5,0.3,0", "?"},
    {"StageWithoutModes", "2,500,y,1,40,200,0,1,-1\n2,500,y,1,40,200,4,1,1\n2,500,z,1,44,220,0,1,-1\n2,500,z,1,44,220,4,0.9,1\n", "", "?"},
    {"MorePropellantThanThere", "2,500,z,1,44,220,0,1,-1\n2,500,z,1,44,220,4,0.9,1", "2,501,z,1,44,220,0,1,-1\n2,501,z,1,44,220,4,0.9,1", "?"},
    {"OnlyPlaneZ", "2,500,y,1,40,200,0,1,-1\n2,500,y,1,40,200,4,1,1\n", "", "?"},
};

INSTANTIATE_TEST_SUITE_P(CampaignYamlBeam, BadModesTest, testing::ValuesIn(kBadModes),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace dispersa
