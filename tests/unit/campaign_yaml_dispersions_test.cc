// The dispersions of a campaign file as draws of inputs.
#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_dispersions_test {
namespace {

// Of the test campaign (two stages) with one dispersion in place of its own.
std::vector<Dispersion> Decode(const std::string& line) {
  const InputFiles files;
  std::string text = TextOfFile(files.Path("campaign.yaml"));
  const std::size_t begin = text.find("dispersions:\n");
  text.replace(begin, text.find("requirements:") - begin, "dispersions:\n  " + line + "\n");
  files.Write("campaign.yaml", text);
  return LoadCampaign(files.Path("campaign.yaml")).dispersions;
}

std::vector<std::string> Names(const std::vector<Dispersion>& dispersions) {
  std::vector<std::string> names;
  for (const Dispersion& dispersion : dispersions) names.push_back(dispersion.name);
  return names;
}

std::vector<std::string> Inputs(const Dispersion& dispersion) {
  std::vector<std::string> names;
  for (const int input : dispersion.inputs)
    names.push_back(InputColumns()[static_cast<std::size_t>(input)].name);
  return names;
}

TEST(CampaignYamlDispersions, MisalignmentHasAMagnitudeAndAClockAngleAStage) {
  const auto list = Decode(
      "thrust_misalignment: {distribution: normal, three_sigma_deg: 0.25, clock_angle: uniform, per: stage}");
  EXPECT_THAT(Names(list),
              ElementsAre("thrust_misalignment/stage1", "thrust_misalignment/stage2",
                          "thrust_misalignment/clock/stage1", "thrust_misalignment/clock/stage2"));
  EXPECT_EQ(list[0].distribution.kind, Distribution::kNormal);
  EXPECT_EQ(list[0].distribution.nominal, 0.0);
  EXPECT_EQ(list[0].distribution.sigma, 0.25 * kRadPerDeg / 3.0);
  EXPECT_TRUE(list[0].absolute);
  EXPECT_THAT(Inputs(list[1]), ElementsAre("thrust_misalignment_stage2_deg"));
  EXPECT_EQ(list[2].distribution.kind, Distribution::kUniform);
  EXPECT_EQ(list[2].distribution.low, 0.0);
  EXPECT_EQ(list[2].distribution.high, kTwoPi);
  EXPECT_FALSE(list[2].absolute);
  EXPECT_THAT(Inputs(list[3]), ElementsAre("thrust_misalignment_clock_stage2_deg"));
}

// 0.2 %/K and 15 K: the rate's logarithm has 3 %.
TEST(CampaignYamlDispersions, PropellantTemperatureIsABurnRate) {
  const auto list = Decode(
      "propellant_temperature: {distribution: normal, three_sigma_k: 45, mean_k: -5, "
      "sensitivity_percent_per_k: 0.2, "
      "per: vehicle}");
  EXPECT_THAT(Names(list), ElementsAre("propellant_temperature"));
  EXPECT_THAT(Inputs(list[0]), ElementsAre("thrust_factor_stage1", "mass_flow_factor_stage1",
                                           "thrust_factor_stage2", "mass_flow_factor_stage2"));
  EXPECT_EQ(list[0].distribution.kind, Distribution::kLogNormal);
  EXPECT_DOUBLE_EQ(list[0].distribution.sigma, 0.03);
  EXPECT_DOUBLE_EQ(list[0].distribution.nominal, std::exp(-0.01));
  const auto corners = Decode(
      "propellant_temperature: {distribution: two_point, plus_minus_k: 30, sensitivity_percent_per_k: 0.2, "
      "per: stage}");
  ASSERT_EQ(corners.size(), 2u);
  EXPECT_DOUBLE_EQ(corners[1].distribution.low, std::exp(-0.06));
  EXPECT_DOUBLE_EQ(corners[1].distribution.high, std::exp(0.06));
  EXPECT_EQ(corners[1].distribution.nominal, 1.0);
}

TEST(CampaignYamlDispersions, PerVehicleIsOneDrawForAllStages) {
  const auto list = Decode(
      "thrust_offset: {distribution: uniform, bound_mm: 3, clock_angle: {fixed_deg: 90}, per: vehicle}");
  EXPECT_THAT(Names(list), ElementsAre("thrust_offset", "thrust_offset/clock"));
  EXPECT_EQ(list[0].distribution.low, -0.003);
  EXPECT_EQ(list[0].distribution.high, 0.003);
  EXPECT_THAT(Inputs(list[0]), ElementsAre("thrust_offset_stage1_m", "thrust_offset_stage2_m"));
  EXPECT_EQ(list[1].distribution.kind, Distribution::kConstant);
  EXPECT_THAT(list[1].distribution.values, ElementsAre(90.0 * kRadPerDeg));
}

TEST(CampaignYamlDispersions, PerNozzleIsOneDrawForEach) {
  const auto list = Decode(
      "thrust_misalignment: {distribution: normal, three_sigma_deg: 0.25, clock_angle: uniform, per: "
      "nozzle}");
  ASSERT_EQ(list.size(), 16u);
  EXPECT_EQ(list[0].name, "thrust_misalignment/stage1_right");
  EXPECT_TRUE(list[0].absolute);
  EXPECT_THAT(Inputs(list[0]), ElementsAre("nozzle_misalignment_stage1_right_deg"));
  EXPECT_EQ(list[15].name, "thrust_misalignment/clock/stage2_top");
  EXPECT_THAT(Inputs(list[15]), ElementsAre("nozzle_misalignment_clock_stage2_top_deg"));
  EXPECT_THAT(
      Inputs(Decode(
          "thrust_offset: {distribution: uniform, bound_mm: 3, clock_angle: uniform, per: nozzle}")[5]),
      ElementsAre("nozzle_offset_stage2_left_m"));
  EXPECT_THAT(Inputs(Decode(
                  "thrust: {distribution: normal, sigma_percent: 1, conserve: propellant, per: nozzle}")[7]),
              ElementsAre("nozzle_thrust_factor_stage2_top"));
}

TEST(CampaignYamlDispersions, WhatThrustConservesDecidesTheFlow) {
  const auto impulse =
      Decode("thrust: {distribution: normal, three_sigma_percent: 2, conserve: total_impulse, per: stage}");
  EXPECT_THAT(Names(impulse), ElementsAre("thrust/stage1", "thrust/stage2"));
  EXPECT_EQ(impulse[0].distribution.nominal, 1.0);
  EXPECT_EQ(impulse[0].distribution.sigma, 0.02 / 3.0);
  EXPECT_THAT(Inputs(impulse[0]), ElementsAre("thrust_factor_stage1", "mass_flow_factor_stage1"));
  const auto propellant =
      Decode("thrust: {distribution: normal, sigma_percent: 2, conserve: propellant, per: stage}");
  EXPECT_EQ(propellant[0].distribution.sigma, 0.02);
  EXPECT_THAT(Inputs(propellant[0]), ElementsAre("thrust_factor_stage1"));
  EXPECT_THAT(Inputs(Decode("burn_rate: {distribution: normal, sigma_percent: 2, per: stage}")[1]),
              ElementsAre("thrust_factor_stage2", "mass_flow_factor_stage2"));
  EXPECT_THAT(Inputs(Decode("specific_impulse: {distribution: normal, sigma_percent: 2, per: vehicle}")[0]),
              ElementsAre("specific_impulse_factor_stage1", "specific_impulse_factor_stage2"));
}

TEST(CampaignYamlDispersions, FactorsAreGivenInPercentOrAsSuch) {
  const ScalarDistribution corner =
      Decode("lift_coefficient: {distribution: two_point, plus_minus_percent: 20}")[0].distribution;
  EXPECT_EQ(corner.kind, Distribution::kTwoPoint);
  EXPECT_EQ(corner.nominal, 1.0);
  EXPECT_EQ(corner.low, 0.8);
  EXPECT_EQ(corner.high, 1.2);
  const ScalarDistribution uniform =
      Decode("center_of_pressure: {distribution: uniform, low_percent: -10, high_factor: 1.3}")[0]
          .distribution;
  EXPECT_EQ(uniform.low, 0.9);
  EXPECT_EQ(uniform.high, 1.3);
  EXPECT_THAT(Decode("pn_error: {distribution: values, values_factor: [0.1, 1, 10]}")[0].distribution.values,
              ElementsAre(0.1, 1, 10));
  EXPECT_THAT(Decode("pn_rate: {distribution: values, values_percent: [-50, 0, 50]}")[0].distribution.values,
              ElementsAre(0.5, 1, 1.5));
  const ScalarDistribution biased =
      Decode("density: {distribution: normal, mean_percent: 5, sigma_percent: 2}")[0].distribution;
  EXPECT_EQ(biased.nominal, 1.05);
}

TEST(CampaignYamlDispersions, WindIsFixedOrUniformUpToItsMaximum) {
  const auto fixed = Decode("wind: {max_speed_m_s: 60.96, azimuth: uniform}");
  EXPECT_THAT(Names(fixed), ElementsAre("wind/speed", "wind/azimuth"));
  EXPECT_THAT(fixed[0].distribution.values, ElementsAre(60.96));
  EXPECT_THAT(Inputs(fixed[0]), ElementsAre("wind_max_speed_m_s"));
  const auto uniform = Decode(
      "wind: {max_speed_m_s: 60.96, speed: uniform, azimuth: {distribution: normal, mean_deg: 270, "
      "sigma_deg: 10}, altitude_km: 12, width_km: 6}");
  EXPECT_THAT(Names(uniform), ElementsAre("wind/speed", "wind/azimuth", "wind/altitude", "wind/width"));
  EXPECT_EQ(uniform[0].distribution.low, 0.0);
  EXPECT_EQ(uniform[0].distribution.high, 60.96);
  EXPECT_EQ(uniform[1].distribution.nominal, 270.0 * kRadPerDeg);
  EXPECT_THAT(uniform[2].distribution.values, ElementsAre(12e3));
  EXPECT_THAT(uniform[3].distribution.values, ElementsAre(6e3));
}

TEST(CampaignYamlDispersions, TurbulenceIsNamedOrGivenByNumbers) {
  const auto named = Decode("turbulence: {severity: severe}");
  EXPECT_THAT(Names(named), ElementsAre("turbulence/exceedance", "turbulence/wind_20ft", "turbulence/scale"));
  EXPECT_THAT(Inputs(named[0]), ElementsAre("turbulence_exceedance"));
  EXPECT_THAT(Inputs(named[1]), ElementsAre("turbulence_wind_20ft_m_s"));
  EXPECT_THAT(Inputs(named[2]), ElementsAre("turbulence_scale"));
  EXPECT_EQ(named[0].distribution.values, std::vector<double>{1e-5});
  EXPECT_NEAR(named[1].distribution.values.at(0), 45.0 * 1852.0 / 3600.0, 1e-12);
  EXPECT_EQ(named[2].distribution.values, std::vector<double>{1.0});
  const auto given = Decode(
      "turbulence: {exceedance: 0.02, wind_20ft_m_s: 12, scale: {distribution: uniform, low_factor: 0.5, "
      "high_factor: 2}}");
  EXPECT_EQ(given[0].distribution.values, std::vector<double>{0.02});
  EXPECT_EQ(given[1].distribution.values, std::vector<double>{12.0});
  EXPECT_EQ(given[2].distribution.low, 0.5);
  EXPECT_EQ(given[2].distribution.high, 2.0);
}

TEST(CampaignYamlDispersions, GustIsFixedOrDrawn) {
  const auto list = Decode(
      "gust: {speed_m_s: 9, altitude: {distribution: uniform, low_km: 5, high_km: 15}, length_m: 120, "
      "azimuth: uniform}");
  EXPECT_THAT(Names(list), ElementsAre("gust/speed", "gust/altitude", "gust/length", "gust/azimuth"));
  EXPECT_EQ(list[1].distribution.low, 5000.0);
  EXPECT_THAT(Inputs(list[2]), ElementsAre("gust_length_m"));
}

// The winds themselves, and the altitudes at which they blow.
TEST(CampaignYamlDispersions, WindStatisticsDrawTheWindsOfTheirLevels) {
  const auto list = Decode(
      "wind_profile: {statistics: wind_statistics.csv, correlation_ne: 0.1, correlation_length_km: 3}");
  EXPECT_THAT(Names(list),
              ElementsAre("wind_profile/north1", "wind_profile/east1", "wind_profile/north2",
                          "wind_profile/east2", "wind_profile/altitude1", "wind_profile/altitude2"));
  EXPECT_EQ(list[3].distribution.nominal, 25.0);
  EXPECT_EQ(list[3].distribution.sigma, 12.0);
  EXPECT_THAT(Inputs(list[3]), ElementsAre("wind_profile_east_2_m_s"));
  EXPECT_EQ(list[3].mix.size(), 4u);
  EXPECT_THAT(Inputs(list[5]), ElementsAre("wind_profile_altitude_2_m"));
  EXPECT_EQ(list[5].distribution.values, std::vector<double>{10000.0});
}

TEST(CampaignYamlDispersions, RatesSensorsActuatorsAndLoop) {
  // The last stage separates nothing.
  const auto tip_off = Decode(
      "tip_off_rate: {pitch: {distribution: normal, sigma_deg_s: 0.5}, yaw: {distribution: normal, "
      "sigma_deg_s: 0.5}}");
  EXPECT_THAT(Names(tip_off), ElementsAre("tip_off_rate/pitch/stage1", "tip_off_rate/yaw/stage1"));
  EXPECT_THAT(Inputs(tip_off[1]), ElementsAre("tip_off_yaw_stage1_deg_s"));
  EXPECT_THAT(Inputs(Decode("gyro_bias: {roll: {distribution: normal, sigma_deg_s: 0.01}}")[0]),
              ElementsAre("gyro_bias_roll_deg_s"));
  EXPECT_THAT(Decode("gyro_noise: {distribution: constant, value_deg_s: 0.1}")[0].distribution.values,
              ElementsAre(0.1 * kRadPerDeg));
  const auto position = Decode("navigation_position_error: {distribution: normal, three_sigma_m: 30}");
  EXPECT_THAT(Names(position),
              ElementsAre("navigation_position_error/downrange", "navigation_position_error/right",
                          "navigation_position_error/down"));
  EXPECT_THAT(Inputs(position[2]), ElementsAre("navigation_position_error_down_m"));
  EXPECT_EQ(position[0].distribution.sigma, 10.0);
  const auto velocity = Decode("navigation_velocity_error: {distribution: normal, sigma_m_s: 0.1}");
  EXPECT_THAT(Inputs(velocity[1]), ElementsAre("navigation_velocity_error_right_m_s"));
  EXPECT_THAT(Inputs(Decode("accelerometer_scale: {distribution: normal, sigma_percent: 0.1}")[0]),
              ElementsAre("accelerometer_scale_factor"));
  EXPECT_THAT(Inputs(Decode("actuator_bandwidth: {distribution: uniform, bound_percent: 30}")[0]),
              ElementsAre("actuator_bandwidth_factor"));
  EXPECT_THAT(Decode("loop_delay: {distribution: values, values_ms: [0, 20]}")[0].distribution.values,
              ElementsAre(0.0, 0.02));
  const auto stuck = Decode("stuck_nozzle: {nozzle: any, stage: 2, angle_deg: 3}");
  EXPECT_THAT(Names(stuck), ElementsAre("stuck_nozzle/nozzle", "stuck_nozzle/stage", "stuck_nozzle/angle"));
  EXPECT_THAT(stuck[0].distribution.values, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(stuck[1].distribution.values, ElementsAre(2));
}

TEST(CampaignYamlDispersions, FurtherDistributions) {
  const auto drag = [](const std::string& parameters) {
    return Decode("drag_coefficient: {distribution: " + parameters + "}").at(0).distribution;
  };
  const ScalarDistribution truncated =
      drag("truncated_normal, three_sigma_percent: 6, low_percent: -5, high_factor: 1.03");
  EXPECT_EQ(truncated.kind, Distribution::kTruncatedNormal);
  EXPECT_DOUBLE_EQ(truncated.sigma, 0.02);
  EXPECT_DOUBLE_EQ(truncated.low, 0.95);
  EXPECT_DOUBLE_EQ(truncated.high, 1.03);
  const ScalarDistribution triangular = drag("triangular, low_percent: -5, mode_percent: 1, high_percent: 2");
  EXPECT_EQ(triangular.kind, Distribution::kTriangular);
  EXPECT_DOUBLE_EQ(triangular.nominal, 1.01);
  const ScalarDistribution lognormal = drag("lognormal, sigma_log: 0.05");
  EXPECT_EQ(lognormal.kind, Distribution::kLogNormal);
  EXPECT_EQ(lognormal.nominal, 1.0);
  EXPECT_EQ(lognormal.sigma, 0.05);
  const ScalarDistribution discrete = drag("values, values_factor: [0.9, 1.1], weights: [3, 1]");
  EXPECT_THAT(discrete.weights, ElementsAre(3.0, 1.0));
  const ScalarDistribution empirical = drag("empirical, samples_factor: [1.1, 0.9, 1.0]");
  EXPECT_EQ(empirical.kind, Distribution::kEmpirical);
  EXPECT_THAT(empirical.values, ElementsAre(0.9, 1.0, 1.1));
  const ScalarDistribution rayleigh =
      Decode("thrust_offset: {distribution: rayleigh, sigma_mm: 2, clock_angle: uniform, per: vehicle}")
          .at(0)
          .distribution;
  EXPECT_EQ(rayleigh.kind, Distribution::kRayleigh);
  EXPECT_DOUBLE_EQ(rayleigh.sigma, 2e-3);
}

TEST(CampaignYamlDispersions, SamplesAndListsComeFromTables) {
  const InputFiles files;
  files.Write("samples.csv", "# measured\nsamples_percent\n3\n-2\n1\n");
  files.Edit("campaign.yaml", "distribution: normal, three_sigma_percent: 6.7",
             "distribution: empirical, samples_percent: samples.csv");
  files.Write("runs.csv", "wind_azimuth_deg,gyro_bias_roll_deg_s\n90,0.1\n180,0.2\n");
  files.Edit("campaign.yaml", "method: monte_carlo, cases: 100, seed: 20260101",
             "method: list, cases: 2, seed: 1, table: runs.csv");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  std::vector<double> drag;
  for (const Dispersion& dispersion : campaign.dispersions) {
    if (dispersion.name == "drag_coefficient") drag = dispersion.distribution.values;
  }
  EXPECT_THAT(drag, ElementsAre(0.98, 1.01, 1.03));
  const Dispersion& last = campaign.dispersions.back();
  EXPECT_EQ(last.name, "list/gyro_bias_roll_deg_s");
  EXPECT_THAT(last.distribution.values, ElementsAre(0.1 * kRadPerDeg, 0.2 * kRadPerDeg));
  // The canonical text holds both tables: the same campaign without the files.
  const Campaign again = ParseCampaign(campaign.canonical_yaml, "canonical");
  EXPECT_EQ(again.id, campaign.id);
  EXPECT_EQ(again.flight_id, campaign.flight_id);
}

TEST(CampaignYamlDispersions, CorrelationsAreRowsOfTheCholeskyFactor) {
  const InputFiles files;
  files.Edit("campaign.yaml", "requirements:",
             "correlations:\n  - {of: [thrust/stage1, drag_coefficient], matrix: [[1, 0.6], [0.6, 1]]}\n"
             "requirements:");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  std::size_t thrust = 0, drag = 0;
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i) {
    if (campaign.dispersions[i].name == "thrust/stage1") thrust = i;
    if (campaign.dispersions[i].name == "drag_coefficient") drag = i;
  }
  using testing::Pair;
  EXPECT_THAT(campaign.dispersions[thrust].mix, ElementsAre(Pair(thrust, 1.0)));
  EXPECT_THAT(campaign.dispersions[drag].mix,
              ElementsAre(Pair(thrust, 0.6), Pair(drag, testing::DoubleEq(0.8))));
  // A covariance in the columns' units says the same: sigma 0.02/3 and 0.067/3.
  files.Edit("campaign.yaml", "matrix: [[1, 0.6], [0.6, 1]]",
             "covariance: [[4.444444444444444e-05, 8.933333333333333e-05], "
             "[8.933333333333333e-05, 4.987777777777778e-04]]");
  EXPECT_NEAR(LoadCampaign(files.Path("campaign.yaml")).dispersions[drag].mix[0].second, 0.6, 1e-9);
}

TEST(CampaignYamlDispersions, SaysWhichCorrelationsCannotHoldTogether) {
  const InputFiles files;
  files.Edit(
      "campaign.yaml", "requirements:",
      "correlations:\n  - {of: [thrust/stage1, drag_coefficient, thrust/stage2], matrix: [[1, 0.5, -0.9], "
      "[0.5, 1, 0.4], [-0.9, 0.4, 1]]}\n"
      "requirements:");
  EXPECT_THAT(
      ErrorOf<InputError>([&] { LoadCampaign(files.Path("campaign.yaml")); }),
      testing::EndsWith("correlations[0].matrix: the matrix is not positive definite: 'thrust/stage1' with "
                        "'thrust/stage2' contributes most; all correlations times 0.8 can hold, allowed: "
                        "correlations that can hold together"));
}

TEST(CampaignYaml, RequirementsNameTheirPlan) {
  const InputFiles files;
  files.Edit(
      "campaign.yaml", "requirements:",
      "verdicts: {looks: 4, spending: pocock, joint: holm, stop: when_decided, max_cases: 900}\n"
      "requirements:\n"
      "  - {metric: apogee_km, within: [480, 520], probability: 0.9, consumer_risk: 0.1, anytime: true}");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  EXPECT_TRUE(campaign.verdicts.holm);
  EXPECT_TRUE(campaign.verdicts.stop_when_decided);
  EXPECT_EQ(campaign.sampling.cases, 900u);
  EXPECT_EQ(campaign.requirements[0].plan.kind, PlanKind::kAnytime);
  EXPECT_EQ((*campaign.requirements[0].within)[1], 520.0);
  EXPECT_EQ(campaign.requirements[1].plan, (VerdictPlan{PlanKind::kGroupSequential, 4, Spending::kPocock}));
  EXPECT_EQ(LoadCampaign(files.Path("campaign.yaml"), {.cases = 300, .seed = {}}).sampling.cases, 300u);
  // Requirements do not change a flight.
  const InputFiles plain;
  EXPECT_EQ(LoadCampaign(plain.Path("campaign.yaml")).flight_id, campaign.flight_id);
  EXPECT_NE(LoadCampaign(plain.Path("campaign.yaml")).requirements_id, campaign.requirements_id);
}

}  // namespace
}  // namespace dispersa::campaign_yaml_dispersions_test
