// The beam of a vehicle file: values read, messages about mistakes, and vehicles based on others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/structure/bending_modes.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_beam_test {
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
  EXPECT_EQ(files.Texts(CheckFile(files.Path("flexible.yaml")).errors), GetParam().texts);
}

constexpr BadInput kBadInputs[] = {
    {"NoSensors", "\nsensors: {inertial_unit: {station_m: 2}}", "",
     "flexible.yaml:1:1: missing key 'sensors', allowed: where the sensors of a vehicle that bends are: "
     "sensors: "
     "{inertial_unit: {station_m: x}}\n"},
    {"DampingNegative", "theory: timoshenko", "damping_ratio: -0.01\n  theory: timoshenko",
     "flexible.yaml:4:18: structure_beam.damping_ratio: -0.01 is out of range, allowed: a number from 0 to "
     "0.5\n"},
    {"NozzlesOfOneStage", "\nsensors:",
     "\nnozzles: [{mass_kg: 5, cg_aft_of_pivot_m: 0.1, inertia_about_hinge_kg_m2: 1}]\nsensors:",
     "flexible.yaml:15:10: nozzles: the list has 1, the vehicle 2 stages, allowed: one entry a stage, or "
     "none\n"},
    {"NoStiffness", "outer_diameter_m: 1, thickness_mm: 4, modulus_gpa: 200", "z_to_y_stiffness: 1",
     "flexible.yaml:10:11: structure_beam.stages[0].sections[0]: missing key "
     "'bending_stiffness_n_m2' or 'outer_diameter_m', allowed: bending_stiffness_n_m2, or a tube: "
     "outer_diameter_m, thickness_m and modulus_gpa\n"},
    {"TwoStiffnesses", "modulus_gpa: 200", "modulus_gpa: 200, bending_stiffness_n_m2: 1e8",
     "flexible.yaml:10:144: structure_beam.stages[0].sections[0].bending_stiffness_n_m2: both a bending "
     "stiffness and a tube "
     "are given, allowed: bending_stiffness_n_m2, or a tube: outer_diameter_m, thickness_m and "
     "modulus_gpa\n"},
    {"HalfATube", "thickness_mm: 4, ", "",
     "flexible.yaml:10:11: structure_beam.stages[0].sections[0]: missing key 'thickness_m' or "
     "'thickness_km' or 'thickness_mm' or 'thickness_um', allowed: a number above 0 and not above 100\n"},
    {"ShearMissing", ", shear_stiffness_kn: 200e3", "",
     "flexible.yaml:14:11: structure_beam.stages[1].sections[0]: missing key 'shear_stiffness_n' or "
     "'shear_stiffness_kn', allowed: a number above 0 and not above 1000000000000000\n"},
    {"WrongUnit", "modulus_gpa: 200", "modulus_psi: 3e7",
     "flexible.yaml:10:102: structure_beam.stages[0].sections[0].modulus_psi: the unit of "
     "'modulus_psi' is not known here, allowed: modulus_gpa, modulus_mpa, modulus_pa\n"},
    {"ThreeEnds", "[100, 150]", "[100, 150, 200]",
     "flexible.yaml:14:90: structure_beam.stages[1].sections[0].bending_stiffness_mn_m2: the list has "
     "3, allowed: a list of 2\n"},
    {"NegativeEnd", "[100, 150]", "[100, -150]",
     "flexible.yaml:14:96: structure_beam.stages[1].sections[0].bending_stiffness_mn_m2[1]: -150 is "
     "out of range, allowed: a number above 0 and not above 1000000000\n"},
    {"WallTooThick", "thickness_mm: 4", "thickness_mm: 501",
     "flexible.yaml:10:99: structure_beam.stages[0].sections[0].thickness_mm: is more than half of "
     "outer_diameter_m, allowed: up to half of the diameter, a solid rod\n"},
    {"NoLength", "top_station_m: 4, bottom_station_m: 10", "top_station_m: 4, bottom_station_m: 4.0005",
     "flexible.yaml:10:60: structure_beam.stages[0].sections[0].bottom_station_m: is not a millimetre "
     "aft of top_station_m, allowed: a station larger than top_station_m by 0.001 m or more\n"},
    {"Gap", "top_station_m: 4, bottom_station_m: 10", "top_station_m: 4.1, bottom_station_m: 10",
     "flexible.yaml:10:9: structure_beam.stages[0].sections: the beam has a gap from station 4.000000 "
     "m to 4.100000 m, allowed: sections of this stage and those above that follow one another "
     "without a gap\n"},
    {"BeyondTheStage", "top_station_m: 4, bottom_station_m: 10", "top_station_m: 4, bottom_station_m: 10.1",
     "flexible.yaml:10:60: structure_beam.stages[0].sections[0].bottom_station_m: lies aft of the "
     "stage's bottom_station_m, allowed: at most bottom_station_m of the stage\n"},
    {"TooShort", "top_station_m: 4, bottom_station_m: 10", "top_station_m: 4, bottom_station_m: 8.5",
     "flexible.yaml:10:9: structure_beam.stages[0].sections: the stage's grain lies outside of the "
     "beam, which reaches from station 0.500000 m to 8.500000 m, allowed: sections along the whole "
     "grain\n"
     "flexible.yaml:10:9: structure_beam.stages[0].sections: 'case' of the stage's structure lies "
     "outside of the beam, which reaches from station 0.500000 m to 8.500000 m, allowed: sections "
     "along the whole element, or the element among lumped_masses\n"
     "flexible.yaml:12:41: structure_beam.stages[0].lumped_masses[0].station_m: lies outside of the "
     "beam, which reaches from station 0.500000 m to 8.500000 m, allowed: a station of the beam\n"},
    {"UnknownElement", "element: nozzles", "element: nozzle",
     "flexible.yaml:12:21: structure_beam.stages[0].lumped_masses[0].element: 'nozzle' is no element "
     "of the stage's structure and no body that it jettisons, allowed: one of case, nozzles\n"},
    {"StageMissing",
     "    - sections:\n        - {name: case, top_station_m: 0.5, bottom_station_m: 4, "
     "bending_stiffness_mn_m2: [100, 150], shear_stiffness_kn: 200e3}\n",
     "", "flexible.yaml:9:5: structure_beam.stages: the list has 1, allowed: a list of 2\n"},
    {"SomeMasses", "modulus_gpa: 200}",
     "modulus_gpa: 200}\n        - {name: skirt, top_station_m: 9, bottom_station_m: 10, outer_diameter_m: "
     "1, thickness_mm: 4, modulus_gpa: 200, mass_per_length_kg_m: 9}",
     "flexible.yaml:10:9: structure_beam.stages[0].sections: some sections have a mass per length and "
     "some have none, allowed: mass_per_length_kg_m in every section of the stage, or in none: then "
     "the stage's structure says what it weighs\n"},
    {"MassesOfAnother",
     "modulus_gpa: 200}\n      lumped_masses:\n        - {element: nozzles, station_m: 10}",
     "modulus_gpa: 200, mass_per_length_kg_m: 30}",
     "flexible.yaml:10:9: structure_beam.stages[0].sections: the masses do not fit the stage's: they "
     "are 180.000000 kg with the centre of gravity at station 7.000000 m, the dry stage is 500.000000 "
     "kg at 7.625000 m; the mass per length would be multiplied by 1.571348 to 6.391720, allowed: "
     "masses that are multiplied by 0.500000 to 2.000000 to have the mass, centre of gravity and "
     "inertia of the dry stage\n"},
    {"SensorBehind", "station_m: 1}", "station_m: 11}",
     "flexible.yaml:7:31: structure_beam.sensors[0].station_m: lies aft of the vehicle, allowed: at "
     "most 10.000000 m\n"},
    {"UnknownTheory", "timoshenko", "timoschenko",
     "flexible.yaml:4:11: structure_beam.theory: 'timoschenko' is not a choice (did you mean "
     "'timoshenko'?), allowed: one of euler_bernoulli, timoshenko\n"},
    {"TooManyModes", "propellant_levels: 3", "propellant_levels: 3\n  modes: 11",
     "flexible.yaml:6:10: structure_beam.modes: 11 is out of range, allowed: a whole number from 1 to "
     "10\n"},
    {"NoBase", "based_on: vehicle.yaml", "based_on: vehicles.yaml",
     "flexible.yaml:2:11: based_on: file 'vehicles.yaml' not found, allowed: a file, named relative to this "
     "one\n"},
    {"BaseOfAnotherKind", "based_on: vehicle.yaml", "based_on: autopilot.yaml",
     "autopilot.yaml:1:9: schema: 'dispersa/autopilot/1' is not the schema of this kind of file, "
     "allowed: schema: dispersa/vehicle/1\n"},
    {"BaseOnABase", "based_on: vehicle.yaml", "based_on: flexible.yaml",
     "flexible.yaml:2:11: based_on: 'flexible.yaml' is based on this file itself, allowed: the name of a "
     "vehicle file that is not based on this one\n"},
};

INSTANTIATE_TEST_SUITE_P(CampaignYamlBeam, BadBeamTest, testing::ValuesIn(kBadInputs),
                         [](const auto& each) { return std::string(each.param.name); });

class BadModesTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadModesTest, IsReportedInFull) {
  const InputFiles files;
  files.Write("flexible.yaml",
              "schema: dispersa/vehicle/1\nbased_on: vehicle.yaml\nsensors: {inertial_unit: {station_m: 2}}\n"
              "structure_beam:\n  modes_table: modes.csv\n");
  files.Edit("modes.csv", GetParam().from, GetParam().to);
  EXPECT_EQ(files.Texts(CheckFile(files.Path("flexible.yaml")).errors), GetParam().texts);
}

constexpr BadInput kBadModes[] = {
    {"UnknownColumn", "frequency_hz", "frequency",
     "modes.csv:1:32: missing unit (did you mean 'frequency_hz'?), allowed: frequency_hz, frequency_rad_s\n"},
    {"UnknownPlane", "2,500,z,1,44,220,0,1,-1", "2,500,x,1,44,220,0,1,-1",
     "modes.csv:10:7: plane[8]: 'x' is not a choice, allowed: one of y, z\n"},
    {"HalfAMode", "1,0,y,1,15,300,0,-0.5,0.2", "1,0,y,1.5,15,300,0,-0.5,0.2",
     "modes.csv:5:7: mode[3]: '1.5' is not a whole number, allowed: a whole number\n"},
    {"NoSuchStage", "2,500,z,1,44,220,0,1,-1", "3,500,z,1,44,220,0,1,-1",
     "modes.csv:10:1: stage[8]: 3 is out of range, allowed: a number from 1 to 2\n"},
    {"StationsFall", "1,0,y,1,15,300,5,0.3,0", "1,0,y,1,15,300,11,0.3,0",
     "modes.csv:7:16: station_m[5]: the stations of a mode do not increase, allowed: rows of increasing "
     "station_m\n"},
    {"OtherStations", "1,0,y,1,15,300,5,0.3,0", "1,0,y,1,15,300,6,0.3,0",
     "modes.csv:5:16: station_m[3]: the mode has other stations than the first of its stage and plane, "
     "allowed: the "
     "same stations for all modes of a stage and plane\n"},
    {"TwoFrequencies", "1,0,y,1,15,300,5,0.3,0", "1,0,y,1,16,300,5,0.3,0",
     "modes.csv:6:9: frequency_hz[4]: frequency or generalized mass change within a mode, allowed: the same "
     "in all "
     "rows of a mode\n"},
    {"StageWithoutModes",
     "2,500,y,1,40,200,0,1,-1\n2,500,y,1,40,200,4,1,1\n2,500,z,1,44,220,0,1,-1\n2,500,z,1,44,220,4,0.9,1\n",
     "",
     "modes.csv:1:1: structure_beam.modes_table: has no modes of stage 2, allowed: modes of every "
     "stage's stack\n"},
    {"MorePropellantThanThere", "2,500,z,1,44,220,0,1,-1\n2,500,z,1,44,220,4,0.9,1",
     "2,501,z,1,44,220,0,1,-1\n2,501,z,1,44,220,4,0.9,1",
     "modes.csv:1:1: structure_beam.modes_table: has modes of stage 2 at 501.000000 kg, allowed: at "
     "most the stage's propellant, 500.000000 kg\n"},
    {"OnlyPlaneZ", "2,500,y,1,40,200,0,1,-1\n2,500,y,1,40,200,4,1,1\n", "",
     "modes.csv:8:7: plane[6]: the stage has modes in plane z and none in plane y, allowed: plane y, which "
     "stands for both, or both planes\n"},
};

INSTANTIATE_TEST_SUITE_P(CampaignYamlBeam, BadModesTest, testing::ValuesIn(kBadModes),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace dispersa::campaign_yaml_beam_test
