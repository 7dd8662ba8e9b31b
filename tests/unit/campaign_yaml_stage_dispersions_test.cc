// Dispersions of stages, masses, events and lift-off: the draws they become.
#include "core/campaign/case_design.h"
#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_stage_dispersions_test {
namespace {

// The test campaign (two stages) with one dispersion in place of its own.
void SetDispersion(const InputFiles& files, const std::string& line) {
  std::string text = TextOfFile(files.Path("campaign.yaml"));
  const std::size_t begin = text.find("dispersions:\n");
  text.replace(begin, text.find("requirements:") - begin, "dispersions:\n  " + line + "\n");
  files.Write("campaign.yaml", text);
}

Campaign Load(const std::string& line) {
  const InputFiles files;
  SetDispersion(files, line);
  return LoadCampaign(files.Path("campaign.yaml"));
}

// "name: input input" of each.
std::vector<std::string> Fed(const std::string& line) {
  std::vector<std::string> all;
  for (const Dispersion& dispersion : Load(line).dispersions) {
    std::string text = dispersion.name + ":";
    for (const int input : dispersion.inputs)
      text += " " + InputColumns()[static_cast<std::size_t>(input)].name;
    all.push_back(text);
  }
  return all;
}

TEST(StageDispersions, NameTheirStages) {
  EXPECT_THAT(Fed("burn_rate: {distribution: normal, sigma_percent: 2, per: stage, stage: 2}"),
              ElementsAre("burn_rate/stage2: thrust_factor_stage2 mass_flow_factor_stage2"));
  EXPECT_THAT(Fed("dry_mass: {distribution: normal, sigma_percent: 1, per: vehicle, stage: [2, 1]}"),
              ElementsAre("dry_mass/stages_1_2: dry_mass_factor_stage1 dry_mass_factor_stage2"));
  EXPECT_THAT(Fed("dry_mass: {distribution: normal, sigma_percent: 1, per: vehicle}"),
              ElementsAre("dry_mass: dry_mass_factor_stage1 dry_mass_factor_stage2"));
  EXPECT_THAT(
      Fed("thrust: [{distribution: normal, sigma_percent: 2, conserve: propellant, per: stage, stage: 1}, "
          "{distribution: uniform, bound_percent: 1, conserve: propellant, per: nozzle, stage: 2}]"),
      ElementsAre("thrust/stage1: thrust_factor_stage1",
                  "thrust/stage2_right: nozzle_thrust_factor_stage2_right",
                  "thrust/stage2_left: nozzle_thrust_factor_stage2_left",
                  "thrust/stage2_bottom: nozzle_thrust_factor_stage2_bottom",
                  "thrust/stage2_top: nozzle_thrust_factor_stage2_top"));
  EXPECT_THAT(Fed("tip_off_rate: {roll: {distribution: normal, sigma_deg_s: 1, stage: 1}}"),
              ElementsAre("tip_off_rate/roll/stage1: tip_off_roll_stage1_deg_s"));
}

TEST(StageDispersions, OfTheWholeVehicleUnlessStagesAreNamed) {
  const std::string normal = "{distribution: normal, sigma_percent: 1";
  EXPECT_THAT(Fed("drag_coefficient: " + normal + "}"), ElementsAre("drag_coefficient: drag_factor"));
  EXPECT_THAT(Fed("drag_coefficient: " + normal + ", stage: 2}"),
              ElementsAre("drag_coefficient/stage2: drag_factor_stage2"));
  EXPECT_THAT(Fed("actuator_bandwidth: " + normal + ", per: stage}"),
              ElementsAre("actuator_bandwidth/stage1: actuator_bandwidth_factor_stage1",
                          "actuator_bandwidth/stage2: actuator_bandwidth_factor_stage2"));
  EXPECT_THAT(Fed("inertia: " + normal + ", per: vehicle, stage: [1, 2]}"),
              ElementsAre("inertia/stages_1_2: inertia_factor_stage1 inertia_factor_stage2"));
}

TEST(StageDispersions, MassesEventsAndLiftOff) {
  EXPECT_THAT(Fed("propellant_load: {distribution: normal, sigma_percent: 1, per: stage}"),
              ElementsAre("propellant_load/stage1: propellant_factor_stage1",
                          "propellant_load/stage2: propellant_factor_stage2"));
  const Campaign payload = Load("payload_mass: {distribution: uniform, bound_kg: 20, element: case}");
  EXPECT_EQ(payload.dispersions[0].distribution.low, -20.0);
  EXPECT_THAT(payload.dispersions[1].distribution.values, ElementsAre(1.0));
  EXPECT_THAT(Fed("payload_mass: {distribution: uniform, bound_kg: 20, element: case}"),
              ElementsAre("payload_mass: payload_mass_kg", "payload_mass/element: payload_element"));
  EXPECT_THAT(Fed("product_of_inertia: {xz: {distribution: normal, sigma_kg_m2: 1, per: stage, stage: 1}}"),
              ElementsAre("product_of_inertia/xz/stage1: product_of_inertia_xz_stage1_kg_m2"));
  // The first stage's ignition is before lift-off, the last one does not separate.
  EXPECT_THAT(Fed("ignition_delay: {distribution: uniform, low_ms: 0, high_ms: 200, per: stage}"),
              ElementsAre("ignition_delay/stage2: ignition_delay_stage2_s"));
  EXPECT_THAT(Fed("separation_delay: {distribution: normal, sigma_s: 0.05, per: stage}"),
              ElementsAre("separation_delay/stage1: separation_delay_stage1_s"));
  EXPECT_THAT(Fed("launch_azimuth_error: {distribution: normal, three_sigma_deg: 0.3}"),
              ElementsAre("launch_azimuth_error: launch_azimuth_error_deg"));
  EXPECT_THAT(Fed("initial_attitude_error: {pitch: {distribution: normal, three_sigma_deg: 0.1}, "
                  "yaw: {distribution: normal, three_sigma_deg: 0.1}}"),
              ElementsAre("initial_attitude_error/pitch: initial_pitch_error_deg",
                          "initial_attitude_error/yaw: initial_yaw_error_deg"));
}

TEST(StageDispersions, DepartureByItsComponents) {
  const std::string line =
      "thrust_misalignment: {distribution: normal, three_sigma_deg: 0.25, draw: per_axis, per: stage, stage: "
      "2}";
  EXPECT_THAT(Fed(line), ElementsAre("thrust_misalignment/y/stage2: thrust_misalignment_y_stage2_deg",
                                     "thrust_misalignment/z/stage2: thrust_misalignment_z_stage2_deg"));
  EXPECT_THAT(
      Fed("center_of_gravity_offset: {distribution: normal, sigma_mm: 3, draw: per_axis, per: vehicle}"),
      ElementsAre("center_of_gravity_offset/y: cg_offset_y_stage1_m cg_offset_y_stage2_m",
                  "center_of_gravity_offset/z: cg_offset_z_stage1_m cg_offset_z_stage2_m"));
  EXPECT_EQ(Fed("thrust_offset: {distribution: normal, sigma_mm: 3, draw: per_axis, per: nozzle}").at(8),
            "thrust_offset/z/stage1_right: nozzle_offset_z_stage1_right_m");
}

// Three standard deviations about an axis: 0.25 deg drawn by components; with a half-normal magnitude and a
// uniform clock angle the mean square of the magnitude is shared by the axes, 0.25 / sqrt(2).
TEST(StageDispersions, WhatTheTwoReadingsOfAMisalignmentHaveAboutAnAxis) {
  const auto three_sigma_deg = [](const std::string& how) {
    const CaseDesign design(
        Load("thrust_misalignment: {distribution: normal, three_sigma_deg: 0.25, " + how + "}"));
    constexpr int kCases = 20000;
    double squares = 0.0;
    for (int i = 0; i < kCases; ++i) {
      const FlightInputs in = design.Draw(static_cast<std::uint64_t>(i));
      const double y = in.stages[0].thrust.misalignment_rad.magnitude *
                           std::cos(in.stages[0].thrust.misalignment_rad.clock_rad) +
                       in.stages[0].thrust.misalignment_rad.y;
      squares += y * y / kCases;
    }
    return 3.0 * std::sqrt(squares) * kDegPerRad;
  };
  // Four standard errors of a standard deviation, of the half-normal's heavier tail too.
  EXPECT_NEAR(three_sigma_deg("draw: per_axis, per: stage"), 0.25, 4.0 * 0.25 / std::sqrt(2.0 * 20000));
  EXPECT_NEAR(three_sigma_deg("clock_angle: uniform, per: stage"), 0.25 / std::sqrt(2.0),
              4.0 * 0.177 / std::sqrt(20000));
}

}  // namespace
}  // namespace dispersa::campaign_yaml_stage_dispersions_test
