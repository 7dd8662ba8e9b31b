// Scenario files: values read.
#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

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
  EXPECT_EQ(booster.motor->inertia_rate, 1.0);
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

TEST(CampaignYamlScenario, BodyWithoutInertia) {
  const InputFiles files;
  const std::string text = TextOfFile(files.Path("scenario.yaml"));
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
