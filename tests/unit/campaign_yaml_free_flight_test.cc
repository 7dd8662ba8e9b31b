// Campaigns that end at apogee or impact, and those that nothing controls: what they need.
#include "core/campaign/case_result.h"
#include "core/campaign/free_flight.h"
#include "core/campaign_yaml/load.h"
#include "tests/test.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_free_flight_test {
namespace {

constexpr const char* kGimbals[] = {
    "gimbal: {pivot_station_m: 9.8, radius_m: 0.3, limit_deg: 6, rate_limit_deg_s: 30, bandwidth_rad_s: 25, "
    "damping_ratio: 0.7, delay_ticks: 1}",
    "gimbal: {pivot_station_m: 3.9, radius_m: 0.3, limit_deg: 6, rate_limit_deg_s: 30, bandwidth_rad_s: 40, "
    "damping_ratio: 0.7, delay_ticks: 1}"};

// The sample without gimbals, reference and autopilot.
void SetFree(const InputFiles& files) {
  files.Edit("vehicle.yaml", kGimbals[0], "nozzle_station_m: 9.8");
  files.Edit("vehicle.yaml", kGimbals[1],
             "nozzle_station_m: 3.9\n    spin_motors: {moment_n_m: 300, duration_s: 2}");
  files.Edit("vehicle.yaml", "{trigger: timer}", "{trigger: burnout_detection, delay_s: 3}");
  files.Edit("vehicle.yaml",
             "reaction_control: {thrust_n: 20, pitch_yaw_arm_m: 1, roll_arm_m: 0.5, "
             "specific_impulse_s: 65, minimum_on_time_ms: 20}",
             "rail: {length_m: 5, azimuth_deg: 120, elevation_deg: 80}");
  files.Edit("campaign.yaml", "reference: reference.yaml\nautopilot: autopilot.yaml\n",
             "flight: {ends: impact, control: none, step_ms: 4}\n");
  files.Edit("campaign.yaml", "pitch_error_peak_deg, below: 0.5", "apogee_altitude_km, above: 50");
}

std::string Texts(const InputFiles& files) {
  return files.Texts(CheckFile(files.Path("campaign.yaml")).errors);
}

TEST(FreeFlightCampaign, NeedsNeitherReferenceNorAutopilot) {
  const InputFiles files;
  SetFree(files);
  ASSERT_EQ(Texts(files), "");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  EXPECT_FALSE(campaign.course.is_controlled);
  EXPECT_EQ(campaign.course.ends, FlightEnd::kImpact);
  EXPECT_DOUBLE_EQ(campaign.autopilot.tick_s, 0.004);
  EXPECT_DOUBLE_EQ(campaign.vehicle.stages[1].spin_motors->moment_n_m, 300.0);
  EXPECT_DOUBLE_EQ(campaign.vehicle.stages[0].gimbal.pivot_station_m, 9.8);
  // What was flown reads as the same campaign.
  EXPECT_EQ(ParseCampaign(campaign.canonical_yaml, "again").id, campaign.id);
}

TEST(FreeFlightCampaign, MeasuresNothingOfControl) {
  const InputFiles files;
  SetFree(files);
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  for (const std::size_t position : MeasuredMetrics(campaign)) {
    const MetricGroup group = Metrics()[position].group;
    EXPECT_NE(group, MetricGroup::kAttitude) << Metrics()[position].name;
    EXPECT_NE(group, MetricGroup::kControlEffort) << Metrics()[position].name;
  }
  EXPECT_EQ(WhyNotMeasured(campaign, "pitch_error_rms_deg"),
            "is of flights with a stage that an autopilot controls");
  EXPECT_EQ(WhyNotMeasured(campaign, "impact_speed_m_s"), "");
  EXPECT_EQ(WhyNotMeasured(campaign, "rail_exit_speed_m_s"), "");
}

// No column is empty in every case by the kind of its flights.
TEST(FreeFlightCampaign, FlightsToInjectionHaveNoColumnsOfOthers) {
  const InputFiles files;
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  for (const std::size_t position : MeasuredMetrics(campaign)) switch (Metrics()[position].needs) {
      case MetricNeeds::kNothing:
      case MetricNeeds::kControl:
      case MetricNeeds::kSectionLoads:  // of its profile
      case MetricNeeds::kLimits:
        break;
      default:
        ADD_FAILURE() << Metrics()[position].name << " needs " << NeedsOf(Metrics()[position]);
    }
  // Thirteen of rails, free stages, apogee and impact, those of the angles of a target, and the propellant
  // left.
  EXPECT_EQ(ResultMetrics(campaign).size() - MeasuredMetrics(campaign).size(), 13u + 3u + 6u);
}

TEST(FreeFlightCampaign, ControlledFlightsMayEndLater) {
  const InputFiles files;
  const Campaign before = LoadCampaign(files.Path("campaign.yaml"));
  files.Edit("campaign.yaml", "autopilot: autopilot.yaml\n",
             "autopilot: autopilot.yaml\nflight: {ends: apogee}\n");
  const Campaign campaign = LoadCampaign(files.Path("campaign.yaml"));
  EXPECT_TRUE(campaign.course.is_controlled);
  EXPECT_NE(campaign.flight_id, before.flight_id);
  EXPECT_EQ(WhyNotMeasured(campaign, "apogee_time_s"), "");
  EXPECT_EQ(WhyNotMeasured(before, "apogee_time_s"),
            "is of flights with flight: {ends: apogee} or {ends: impact}");
  EXPECT_EQ(WhyNotMeasured(campaign, "impact_time_s"), "is of flights with flight: {ends: impact}");
}

TEST(FreeFlightCampaign, HasNoTrajectoryToOptimise) {
  const InputFiles files;
  SetFree(files);
  try {
    LoadOptimization(files.Path("campaign.yaml"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "'trial' has no autopilot, so there is nothing of which to compute a trajectory, allowed: a campaign "
        "without flight: {control: none}");
  }
}

}  // namespace
}  // namespace dispersa::campaign_yaml_free_flight_test
