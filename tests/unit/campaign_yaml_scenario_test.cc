// Scenario files: values read, and full texts for mistakes.
#include <gtest/gtest.h>

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "tests/unit/bad_input.h"

namespace dispersa::campaign_yaml_scenario_test {
namespace {

TEST(CampaignYamlScenario, IsReadCompletely) {
  const InputFiles files;
  EXPECT_EQ(files.Texts(CheckFile(files.Path("scenario.yaml")).errors), "");
  EXPECT_TRUE(IsScenarioFile(files.Path("scenario.yaml")));
  EXPECT_FALSE(IsScenarioFile(files.Path("campaign.yaml")));
  EXPECT_FALSE(IsScenarioFile(files.Path("none.yaml")));

  const Scenario scenario = LoadScenario(files.Path("scenario.yaml"));
  EXPECT_EQ(scenario.name, "trial_flight");
  EXPECT_EQ(scenario.duration_s, 60.0);
  EXPECT_EQ(scenario.output_step_s, 0.5);
  EXPECT_EQ(scenario.integration_step_s, 0.02);

  const Earth& earth = scenario.environment.earth;
  EXPECT_EQ(earth.equatorial_radius_m, 6371e3);
  EXPECT_EQ(earth.flattening, 0.0);
  EXPECT_EQ(earth.j2, 0.0);
  EXPECT_EQ(earth.rotation_rate_rad_s, Wgs84().rotation_rate_rad_s);

  // From the west, so eastward; the table adds.
  const WindNorthEast wind = Evaluate(scenario.environment.wind, 5000.0);
  EXPECT_NEAR(wind.east_m_s, 10.0 + 10.0, 1e-12);
  EXPECT_NEAR(wind.north_m_s, 1.5, 1e-12);
  // The middle of the gust, from the north, at 3250 m.
  EXPECT_NEAR(Evaluate(scenario.environment.wind, 3250.0).north_m_s, 0.975 - 5.0, 1e-12);

  EXPECT_EQ(scenario.place.latitude_rad, 10.0 * kRadPerDeg);
  EXPECT_EQ(scenario.place.longitude_rad, 20.0 * kRadPerDeg);
  EXPECT_EQ(scenario.place.altitude_m, 100.0);
  EXPECT_EQ(scenario.attitude.yaw, 90.0 * kRadPerDeg);
  EXPECT_EQ(scenario.attitude.pitch, 60.0 * kRadPerDeg);
  EXPECT_EQ(scenario.attitude.roll, 5.0 * kRadPerDeg);
  EXPECT_EQ(scenario.v_EC_N, Vector3(1.0, 2.0, -3.0));
  EXPECT_FALSE(scenario.rates_are_inertial);
  EXPECT_EQ(scenario.rates_rad_s, Vector3(kRadPerDeg, 0.0, -kRadPerDeg));

  ASSERT_EQ(scenario.stages.size(), 2u);
  const ScenarioStage& booster = scenario.stages[0];
  EXPECT_EQ(booster.mass.mass_kg, (std::vector<double>{500.0, 900.0, 1500.0}));
  EXPECT_EQ(booster.mass.cg_station_m, (std::vector<double>{4.0, 4.5, 5.0}));
  EXPECT_EQ(booster.mass.inertia_kg_m2[1], Matrix3(Vector3(80.0, 1500.0, 1500.0).asDiagonal()));
  EXPECT_FALSE(booster.inertial_damping_rates);
  EXPECT_EQ(booster.separation_time_s, 22.0);
  EXPECT_EQ(booster.motor->thrust_n, 60e3);
  EXPECT_EQ(booster.motor->flow_kg_s, 50.0);
  EXPECT_EQ(booster.motor->nozzle_exit_area_m2, 0.05);
  EXPECT_EQ(booster.motor->nozzle_y_m, 0.01);
  EXPECT_TRUE(booster.motor->jet_damping);
  EXPECT_TRUE(booster.motor->inertia_rate);
  EXPECT_EQ(BurnTime(booster), 20.0);
  const BodyAerodynamics& body = booster.aerodynamics;
  EXPECT_EQ(body.area_m2, 0.5);
  EXPECT_EQ(body.span_m, 0.8);
  EXPECT_EQ(body.length_m, 0.9);
  EXPECT_EQ(body.ca.table(1.5, 0.1), 0.3);
  EXPECT_NEAR(body.cn.table(1.5, 5.0 * kRadPerDeg), 0.225, 1e-15);
  EXPECT_NEAR(body.xcp_station_m.table(1.0, 0.1), 4.75, 1e-15);
  EXPECT_NEAR(body.xcp_station_m.table(3.0, 0.1), 4.65, 1e-15);
  EXPECT_NEAR(body.clp.table(1.0, 0.0), -0.3, 1e-15);
  EXPECT_EQ(body.cmq.table(1.0, 0.0), -30.0);
  // The engine looks these three up at one place.
  EXPECT_EQ(body.ca.table.x, body.cn.table.x);
  EXPECT_EQ(body.ca.table.y, body.xcp_station_m.table.y);

  const ScenarioStage& upper = scenario.stages[1];
  EXPECT_EQ(upper.motor->flow_kg_s, 8.0);
  EXPECT_FALSE(upper.motor->jet_damping);
  EXPECT_FALSE(upper.separation_time_s.has_value());
  EXPECT_TRUE(upper.inertial_damping_rates);
  // A product of inertia is an integral; the tensor has its negative.
  EXPECT_EQ(upper.mass.inertia_kg_m2[0](0, 2), -1.0);
  EXPECT_NEAR(upper.aerodynamics.cd.table(3.0, 45.0 * kRadPerDeg), 0.8, 1e-15);
  EXPECT_TRUE(upper.aerodynamics.ca.empty());
}

class BadScenarioTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadScenarioTest, IsReportedInFull) {
  EXPECT_EQ(TextsAbout("scenario.yaml", GetParam()), GetParam().texts);
}

constexpr BadInput kBadScenarios[] = {
    {"ZeroInertia", "scenario.yaml", "ixx_kg_m2: [10, 30]", "ixx_kg_m2: [0, 30]",
     "scenario.yaml:45:19: stages[1].mass_properties.ixx_kg_m2[0]: the inertia tensor is not positive "
     "definite, allowed: positive moments, and products small enough that every principal moment is "
     "positive\n"},
    {"ProductTooLarge", "scenario.yaml", "ixz_kg_m2: [1, 1]", "ixz_kg_m2: [1, 80]",
     "scenario.yaml:45:23: stages[1].mass_properties.ixx_kg_m2[1]: the inertia tensor is not positive "
     "definite, allowed: positive moments, and products small enough that every principal moment is "
     "positive\n"},
    {"InertiaOfNoBody", "scenario.yaml", "ixx_kg_m2: [10, 30]", "ixx_kg_m2: [10, 3000]",
     "scenario.yaml:45:23: stages[1].mass_properties.ixx_kg_m2[1]: no body has these moments of inertia, "
     "allowed: "
     "principal moments of which none exceeds the sum of the two others\n"},
    {"PropellantNotMonotone", "scenario_mass.csv", "400,900", "1000,1500",
     "scenario_mass.csv:4:1: stages[0].mass_properties.propellant_kg[2]: is not above the one before, "
     "allowed: propellant strictly increasing\n"},
    {"InconsistentMasses", "scenario_mass.csv", "400,900", "400,950",
     "scenario_mass.csv:3:5: stages[0].mass_properties.mass_kg[1]: is not the mass without propellant plus "
     "the propellant, allowed: 900.000000\n"},
    {"NoEmptyRow", "scenario.yaml", "propellant_kg: [0, 200]", "propellant_kg: [20, 200]",
     "scenario.yaml:42:23: stages[1].mass_properties.propellant_kg[0]: does not begin without propellant, "
     "allowed: 0\nscenario.yaml:43:22: stages[1].mass_properties.mass_kg[1]: is not the mass without "
     "propellant plus the propellant, allowed: 280.000000\n"},
    {"UpperHeavier", "scenario.yaml", "mass_kg: [100, 300]", "mass_kg: [400, 600]",
     "scenario.yaml:43:16: stages[1].mass_properties.mass_kg: the stage is not lighter than what it "
     "separates from is without propellant, allowed: less than 500.000000\n"},
    {"NozzleAheadOfCg", "scenario.yaml", "nozzle_station_m: 9", "nozzle_station_m: 4.9",
     "scenario.yaml:38:31: stages[0].motor.nozzle_station_m: is not aft of the centre of gravity, which "
     "reaches station 5.000000 m, allowed: a station aft of the centre of gravity\n"},
    {"TwoFlows", "scenario.yaml", "flow_kg_s: 8", "flow_kg_s: 8, burning_time_s: 30",
     "scenario.yaml:50:79: stages[1].motor.burning_time_s: 'flow_kg_s' and 'burning_time_s' are both given, "
     "allowed: one of "
     "flow_kg_s, burning_time_s\n"},
    {"NoFlow", "scenario.yaml", "flow_kg_s: 8, ", "",
     "scenario.yaml:50:12: stages[1].motor: missing key 'flow_kg_s' or 'burning_time_s', allowed: one of "
     "them\n"},
    {"IgnitionBeforeSeparation", "scenario.yaml", "ignition_time_s: 25", "ignition_time_s: 21",
     "scenario.yaml:50:30: stages[1].motor.ignition_time_s: is before the stage flies on its own, allowed: "
     "not below 22.000000\n"},
    {"LastSeparates", "scenario.yaml", "nozzle_station_m: 4}",
     "nozzle_station_m: 4}\n    separation_time_s: 50",
     "scenario.yaml:51:24: stages[1].separation_time_s: the last stage separates from nothing, allowed: no "
     "separation_time_s in the last stage\n"},
    {"MachNotMonotone", "scenario.yaml", "mach: [0, 2, 4], xcp", "mach: [0, 4, 2], xcp",
     "scenario.yaml:33:36: stages[0].aerodynamics.xcp_station_m.mach[2]: is not above the one before, "
     "allowed: values strictly increasing\n"},
    {"GridHasHole", "scenario_cn.csv", "3,10,0.5", "3,20,0.5",
     "scenario_cn.csv:5:6: cn[3]: the row does not continue the grid, allowed: a full grid: rows of "
     "increasing "
     "mach, each mach with the same increasing incidences\n"},
    {"WindNotMonotone", "scenario_wind.csv", "10000,3,20", "0,3,20",
     "scenario_wind.csv:3:1: altitude_m[1]: is not above the one before, allowed: values strictly "
     "increasing\n"},
    {"NoArgument", "scenario.yaml", "cd: {incidence_deg: [0, 90], cd: [0.4, 1.2]}", "cd: {cd: [0.4, 1.2]}",
     "scenario.yaml:49:73: stages[1].aerodynamics.cd: the table has no argument, allowed: a column mach, "
     "incidence_deg or both\n"},
    {"NoChord", "scenario.yaml", "      chord_m: 0.9\n", "",
     "scenario.yaml:27:7: stages[0].aerodynamics: missing key 'chord_m' or 'chord_km' or 'chord_mm' or "
     "'chord_um', allowed: a number above 0\n"},
    {"NoRadius", "scenario.yaml", "radius_km: 6371, ", "",
     "scenario.yaml:4:8: earth: missing key 'radius_m' or 'radius_km' or 'radius_mm' or 'radius_um', "
     "allowed: a number above 0\n"},
    {"FeetPerSecond", "scenario.yaml", "velocity_north_m_s: 1", "velocity_north_ft_s: 1",
     "scenario.yaml:16:3: initial.velocity_north_ft_s: the unit of 'velocity_north_ft_s' is not known here, "
     "allowed: velocity_north_m_s, velocity_north_km_s, velocity_north_km_h\n"},
    {"WithoutRateFrame", "scenario.yaml", "  rates_relative_to: earth\n", "",
     "scenario.yaml:10:3: initial: missing key 'rates_relative_to', allowed: one of inertial, earth\n"},
    {"BodyAndStages", "scenario.yaml", "stages:\n",
     "body: {mass_properties: {mass_kg: 1, ixx_kg_m2: 1, iyy_kg_m2: 1, izz_kg_m2: 1}}\nstages:\n",
     "scenario.yaml:1:1: 'body' and 'stages' are both given, allowed: either a body or a list of stages\n"},
    {"StepLongerThanFlight", "scenario.yaml", "output_step_s: 0.5", "output_step_s: 90",
     "scenario.yaml:52:16: output_step_s: is longer than the flight, allowed: not above duration_s\n"},
    {"TooManySteps", "scenario.yaml", "integration_step_s: 0.02", "integration_step_s: 1e-9",
     "scenario.yaml:53:21: integration_step_s: gives more than ten million steps, allowed: a longer step\n"},
    {"MissingTable", "scenario.yaml", "cn: scenario_cn.csv", "cn: none.csv",
     "scenario.yaml:32:11: stages[0].aerodynamics.cn: file 'none.csv' not found, allowed: a file, named "
     "relative to this one\n"},
};

INSTANTIATE_TEST_SUITE_P(Scenario, BadScenarioTest, testing::ValuesIn(kBadScenarios),
                         [](const auto& test) { return test.param.name; });

TEST(CampaignYamlScenario, BodyWithoutInertia) {
  const InputFiles files;
  const std::string text = ReadWholeFile(files.Path("scenario.yaml"));
  const std::size_t begin = text.find("stages:");
  const std::size_t end = text.find("duration_s:");
  const std::string head = text.substr(0, begin);
  const std::string tail = text.substr(end);
  files.Write(
      "scenario.yaml",
      head + "body: {mass_properties: {mass_kg: 2, ixx_kg_m2: 0, iyy_kg_m2: 1, izz_kg_m2: 1}}\n" + tail);
  EXPECT_EQ(
      files.Texts(CheckFile(files.Path("scenario.yaml")).errors),
      "scenario.yaml:23:49: body.mass_properties.ixx_kg_m2: the inertia tensor is not positive definite, "
      "allowed: positive moments, and products small enough that every principal moment is positive\n");
  files.Write("scenario.yaml", head + tail);
  EXPECT_EQ(files.Texts(CheckFile(files.Path("scenario.yaml")).errors),
            "scenario.yaml:1:1: nothing is there to fly, allowed: either a body or a list of stages\n");
}

}  // namespace
}  // namespace dispersa::campaign_yaml_scenario_test
