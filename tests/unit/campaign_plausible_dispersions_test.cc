// Dispersions that no vehicle and no day has, with the full text.
#include "core/campaign/plausible_dispersions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/flight/flight_inputs.h"
#include "core/math/constants.h"

namespace dispersa::campaign_plausible_dispersions_test {
namespace {

Dispersion Normal(const char* column, double nominal, double sigma) {
  Dispersion dispersion;
  dispersion.name = column;
  dispersion.distribution.kind = Distribution::kNormal;
  dispersion.distribution.nominal = nominal;
  dispersion.distribution.sigma = sigma;
  dispersion.inputs = {FindInput(column)};
  EXPECT_GE(dispersion.inputs[0], 0) << column;
  return dispersion;
}

std::vector<std::string> Texts(const Campaign& campaign) {
  std::vector<std::string> texts;
  for (const UnusualDispersion& f : UnusualDispersions(campaign))
    texts.push_back(f.key + " " + f.message + " | " + f.allowed);
  return texts;
}

TEST(UnusualDispersions, AreThoseBeyondWhatIsKnown) {
  Campaign campaign;
  campaign.dispersions = {Normal("drag_factor", 1.0, 0.02), Normal("thrust_factor_stage1", 1.0, 0.5),
                          Normal("thrust_factor_stage2", 1.0, 0.5),
                          Normal("gyro_bias_yaw_deg_s", 0.0, 0.02 * kRadPerDeg)};
  EXPECT_THAT(
      Texts(campaign),
      testing::ElementsAre(
          "dispersions.thrust draws from -0.5 to 2.5 (thrust_factor_stage1) but for 0.27 % of the cases "
          "| 0.8 to 1.2 (1 to 5 % of motors)"));
  campaign.dispersions[3].distribution.sigma = 1.0 * kRadPerDeg;
  campaign.dispersions.erase(campaign.dispersions.begin(), campaign.dispersions.begin() + 3);
  EXPECT_THAT(Texts(campaign),
              testing::ElementsAre(
                  "dispersions.gyro_bias.yaw draws from -3 to 3 (gyro_bias_yaw_deg_s) but for 0.27 % of the "
                  "cases | -0.1 to 0.1 (0.0001 to 0.01 deg/s of inertial units)"));
}

TEST(UnusualDispersions, AreThoseOfTheWholeVehicleToo) {
  Campaign campaign;
  campaign.dispersions = {Normal("density_factor", 1.0, 0.15), Normal("inertia_factor", 1.0, 0.15),
                          Normal("loop_delay_s", 0.2, 0.1), Normal("loop_gain_factor", 1.0, 0.3)};
  const auto begins = [](const char* text) { return testing::StartsWith(text); };
  EXPECT_THAT(Texts(campaign), testing::ElementsAre(begins("dispersions.density draws from 0.55 to 1.45"),
                                                    begins("dispersions.inertia draws from 0.55"),
                                                    begins("dispersions.loop_delay draws from -0.1 to 0.5"),
                                                    begins("dispersions.loop_gain draws from 0.1 to 1.9")));
  for (Dispersion& dispersion : campaign.dispersions) dispersion.distribution.sigma /= 10.0;
  EXPECT_THAT(Texts(campaign), testing::IsEmpty());
}

TEST(UnusualDispersions, AreThoseOfOneNozzleAsOfAStage) {
  Campaign campaign;
  campaign.vehicle.stages.resize(1);
  campaign.dispersions = {Normal("nozzle_misalignment_stage1_left_deg", 0.0, 1.0 * kRadPerDeg)};
  EXPECT_THAT(
      Texts(campaign),
      testing::ElementsAre(testing::HasSubstr(
          "draws from -3 to 3 (nozzle_misalignment_stage1_left_deg) but for 0.27 % of the cases | -1.5 "
          "to 1.5 (0.1 to 0.5 deg of solid motors)")));
}

TEST(UnusualDispersions, AreErrorsOfNavigationThatNothingUses) {
  Campaign campaign;
  campaign.dispersions = {Normal("navigation_velocity_error_downrange_m_s", 0.0, 0.1)};
  EXPECT_THAT(
      Texts(campaign),
      testing::ElementsAre(
          "dispersions.navigation_velocity_error nothing uses it: the flight has no closed-loop guidance, "
          "and the autopilot has sensors of its own | guidance: {mode: closed_loop}, or "
          "none of navigation's errors"));
  campaign.guidance.closed_loop = true;
  EXPECT_THAT(Texts(campaign), testing::IsEmpty());
}

TEST(UnusualDispersions, AreTailOffsThatNoStageHas) {
  Campaign campaign;
  campaign.vehicle.stages.resize(2);
  campaign.dispersions = {Normal("tail_off_factor_stage1", 1.0, 0.1),
                          Normal("tail_off_factor_stage2", 1.0, 0.1)};
  EXPECT_THAT(Texts(campaign),
              testing::ElementsAre(
                  "dispersions.tail_off nothing uses it: no stage that it draws for has a tail_off_* | "
                  "tail_off_* of the stages' motors, or no tail_off"));
  campaign.vehicle.stages[1].motor.tail_off_s = 0.3;
  EXPECT_THAT(Texts(campaign), testing::IsEmpty());
}

TEST(UnusualDispersions, AreWindsOfAnotherUnit) {
  Campaign campaign;
  campaign.wind_table = WeatherTable{WindTable{{0.0, 20.0}, {0.0, 3000.0}, {0.0, 4000.0}}};
  EXPECT_THAT(Texts(campaign), testing::ElementsAre("dispersions.wind_profile has a wind of 5000 m/s | up to "
                                                    "150 m/s (the strongest jet streams have 100 "
                                                    "to 120 m/s)"));
  campaign.wind_table = WeatherTable{WindTable{{0.0, 20.0}, {0.0, 30.0}, {0.0, 40.0}}};
  EXPECT_THAT(
      Texts(campaign),
      testing::ElementsAre(
          "dispersions.wind_profile ends at 20 m, above which the wind fades within 10000 m | 5000 m or more "
          "(altitudes may be in kilometres)"));
  campaign.wind_table = WeatherTable{WindTable{{0.0, 20e3}, {0.0, 30.0}, {0.0, 40.0}}};
  EXPECT_THAT(Texts(campaign), testing::IsEmpty());
}

}  // namespace
}  // namespace dispersa::campaign_plausible_dispersions_test
