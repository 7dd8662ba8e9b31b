// Causes that were planted into made-up flights are found, whatever their form; where none was, none is.
#include "core/analysis/drivers.h"

#include "core/math/constants.h"
#include "core/random/draws.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_drivers_test {
namespace {

constexpr char kPeak[] = "pitch_error_peak_deg";

class Planted : public testing::Test {
 protected:
  Planted() {
    for (const char* name :
         {"gyro_bias_pitch_deg_s", "wind_azimuth_deg", "drag_factor", "thrust_misalignment_stage1_deg",
          "thrust_misalignment_clock_stage1_deg", "cg_factor"}) {
      Dispersion dispersion;
      dispersion.name = name;
      dispersion.inputs = {FindInput(name)};
      campaign_.dispersions.push_back(dispersion);
    }
    cases_.inputs.resize(InputCount(kUsualStages));
    cases_.metrics.resize(MetricCount(kUsualStages));
    for (std::uint64_t k = 0; k < 1000; ++k) {
      cases_.index.push_back(k);
      cases_.outcome.push_back(Outcome::kCompleted);
      const auto put = [&](const char* name, double value) {
        cases_.inputs[static_cast<std::size_t>(FindInput(name))].push_back(value);
        return value;
      };
      const auto normal = [&](const char* name) { return Stream(1, k, name).Normal(); };
      bias_.push_back(put("gyro_bias_pitch_deg_s", normal("bias")));
      azimuth_.push_back(put("wind_azimuth_deg", 360.0 * Stream(1, k, "azimuth").Uniform()));
      put("drag_factor", 1.0 + 0.02 * normal("drag"));
      put("cg_factor", 1.0 + 0.02 * normal("cg"));
      tilt_.push_back(put("thrust_misalignment_stage1_deg", std::fabs(normal("tilt"))));
      clock_.push_back(put("thrust_misalignment_clock_stage1_deg", 360.0 * Stream(1, k, "clock").Uniform()));
      noise_.push_back(normal("noise"));
    }
  }

  template <typename F>
  std::vector<Driver> DriversWhen(F metric) {
    std::vector<double> values;
    for (std::size_t k = 0; k < cases_.rows(); ++k) values.push_back(metric(k));
    cases_.metrics[MetricColumn(kPeak)] = values;
    return FindDrivers(campaign_, {kPeak}, cases_).at(0).drivers;
  }

  Campaign campaign_;
  CaseColumns cases_;
  std::vector<double> bias_, azimuth_, tilt_, clock_, noise_;
};

TEST_F(Planted, ASymmetricInputIsSeenThroughItsSize) {
  const auto drivers = DriversWhen([&](std::size_t k) { return std::fabs(bias_[k]) + 0.1 * noise_[k]; });
  ASSERT_FALSE(drivers.empty());
  EXPECT_EQ(drivers[0].input, "gyro_bias_pitch_deg_s");
  EXPECT_EQ(drivers[0].feature, "|x|");
  EXPECT_GT(drivers[0].index, 0.9);
  EXPECT_GT(drivers[0].partial, 0.9);
  for (std::size_t i = 1; i < drivers.size(); ++i) EXPECT_LT(drivers[i].index, 0.1);
}

TEST_F(Planted, ACircularInputIsSeenThroughItsCosine) {
  const auto drivers =
      DriversWhen([&](std::size_t k) { return std::cos(azimuth_[k] * kRadPerDeg) + 0.3 * noise_[k]; });
  EXPECT_EQ(drivers[0].input, "wind_azimuth_deg");
  EXPECT_EQ(drivers[0].feature, "cos x");
  EXPECT_GT(drivers[0].index, 0.7);
}

// The size of a factor is its distance from 1.
TEST_F(Planted, ASizeIsTakenAboutTheNominalValue) {
  const std::vector<double> drag = cases_.inputs[static_cast<std::size_t>(FindInput("drag_factor"))];
  const auto drivers =
      DriversWhen([&](std::size_t k) { return std::fabs(drag[k] - 1.0) + 0.001 * noise_[k]; });
  EXPECT_EQ(drivers[0].input, "drag_factor");
  EXPECT_EQ(drivers[0].feature, "|x|");
}

// Three of six soundings are windy, in no order of their numbers: all the variance is between them.
TEST_F(Planted, ANumberOfSomethingHasNoOrder) {
  constexpr char kNumber[] = "weather_sounding";
  campaign_.dispersions.push_back({kNumber, {}, {FindInput(kNumber)}});
  CaseColumn& numbers = cases_.inputs[static_cast<std::size_t>(FindInput(kNumber))];
  for (std::uint64_t k = 0; k < cases_.rows(); ++k)
    numbers.push_back(1.0 + std::floor(6.0 * Stream(2, k, kNumber).Uniform()));
  constexpr double kWind[] = {0.0, 1.0, 1.0, 0.0, 0.0, 1.0};
  const auto windy = [&](std::size_t k) { return kWind[static_cast<std::size_t>(numbers[k]) - 1]; };
  const auto drivers = DriversWhen([&](std::size_t k) { return windy(k) + 0.1 * noise_[k]; });
  EXPECT_EQ(drivers[0].input, kNumber);
  EXPECT_EQ(drivers[0].feature, "which");
  EXPECT_GT(drivers[0].index, 0.95);
  EXPECT_TRUE(std::isnan(drivers[0].partial));
  // Of failures, where the last sounding always fails, it is not told as larger.
  campaign_.requirements = {{.metric = kPeak, .below = 0.9, .above = std::nullopt}};
  DriversWhen([&](std::size_t k) { return numbers[k] > 5.5 ? 1.0 : 0.1 * noise_[k]; });
  for (const FailureDriver& driver : FindFailureDrivers(campaign_, cases_).at(0).drivers)
    EXPECT_NE(driver.input, kNumber);
}

// A gust's azimuth gives a direction to the gust's speed, and not to the wind's.
TEST_F(Planted, AGustIsPairedWithItsOwnSpeed) {
  for (const char* name : {"gust_azimuth_deg", "gust_speed_m_s", "wind_max_speed_m_s"}) {
    ASSERT_GE(FindInput(name), 0) << name;
    Dispersion dispersion;
    dispersion.name = name;
    dispersion.inputs = {FindInput(name)};
    campaign_.dispersions.push_back(dispersion);
    for (std::uint64_t k = 0; k < cases_.rows(); ++k)
      cases_.inputs[static_cast<std::size_t>(FindInput(name))].push_back(
          (std::string(name) == "gust_azimuth_deg" ? 360.0 : 20.0) * Stream(2, k, name).Uniform());
  }
  const std::vector<double> azimuth = cases_.inputs[static_cast<std::size_t>(FindInput("gust_azimuth_deg"))],
                            speed = cases_.inputs[static_cast<std::size_t>(FindInput("gust_speed_m_s"))];
  const auto drivers = DriversWhen(
      [&](std::size_t k) { return speed[k] * std::cos(azimuth[k] * kRadPerDeg) + 0.1 * noise_[k]; });
  EXPECT_EQ(drivers[0].input, "gust_speed_m_s along gust_azimuth_deg");
  EXPECT_EQ(drivers[0].feature, "m cos x");
  EXPECT_GT(drivers[0].index, 0.9);
}

// An input without any effect, drawn with a correlation of 0.9 with the cause.
TEST_F(Planted, WhatIsMerelyDrawnTogetherWithACauseExplainsNothing) {
  CaseColumn& drag = cases_.inputs[static_cast<std::size_t>(FindInput("drag_factor"))];
  for (std::size_t k = 0; k < drag.size(); ++k)
    drag[k] = 0.9 * bias_[k] + std::sqrt(1.0 - 0.81) * Stream(3, k, "beside").Normal();
  const auto drivers = DriversWhen([&](std::size_t k) { return bias_[k] + 0.3 * noise_[k]; });
  ASSERT_EQ(drivers.size(), 1u);
  EXPECT_EQ(drivers[0].input, "gyro_bias_pitch_deg_s");
  EXPECT_THAT(drivers[0].correlated_with, testing::ElementsAre("drag_factor"));
}

TEST_F(Planted, SharesSumToOneAtMostAndFamiliesCountOnce) {
  const auto drivers = DriversWhen([&](std::size_t k) {
    return tilt_[k] * (1.5 + std::sin(clock_[k] * kRadPerDeg)) + bias_[k] + 0.1 * noise_[k];
  });
  double sum = 0.0;
  for (const Driver& driver : drivers) {
    sum += driver.index;
    EXPECT_GT(driver.low, 0.0) << driver.input;
    EXPECT_TRUE(driver.correlated_with.empty());
  }
  EXPECT_LE(sum, 1.0);
  EXPECT_GT(sum, 0.9);
  EXPECT_EQ(drivers.size(), 2u) << "the tilt with its clock, and the bias";
}

TEST_F(Planted, AMagnitudeInADirectionIsSeenAsAPair) {
  const auto drivers = DriversWhen(
      [&](std::size_t k) { return tilt_[k] * std::sin(clock_[k] * kRadPerDeg) + 0.1 * noise_[k]; });
  EXPECT_EQ(drivers[0].input, "thrust_misalignment_stage1_deg along thrust_misalignment_clock_stage1_deg");
  EXPECT_EQ(drivers[0].feature, "m sin x");
  EXPECT_GT(drivers[0].index, 0.9);
}

TEST_F(Planted, LostFlightsAndFewFlightsGiveNoIndex) {
  cases_.outcome.assign(cases_.rows(), Outcome::kLostControl);
  EXPECT_TRUE(DriversWhen([&](std::size_t k) { return bias_[k]; }).empty());
  cases_.outcome.assign(cases_.rows(), Outcome::kCompleted);
  EXPECT_TRUE(DriversWhen([&](std::size_t) { return 1.0; }).empty());
}

TEST_F(Planted, WhatFailingFlightsShareIsFound) {
  campaign_.requirements = {
      {.metric = kPeak, .below = 2.0, .above = std::nullopt, .probability = 0.9, .consumer_risk = 0.1}};
  DriversWhen([&](std::size_t k) { return std::fabs(bias_[k]) + 0.1 * noise_[k]; });
  const FailureDrivers failing = FindFailureDrivers(campaign_, cases_).at(0);
  EXPECT_FALSE(failing.nearest);
  EXPECT_GT(failing.flights, 20u);
  ASSERT_FALSE(failing.drivers.empty());
  EXPECT_EQ(failing.drivers[0].input, "gyro_bias_pitch_deg_s");
  EXPECT_EQ(failing.drivers[0].feature, "|x|");
  EXPECT_TRUE(failing.drivers[0].larger);
  EXPECT_LT(failing.drivers[0].false_discovery_rate, 1e-6);
  campaign_.requirements[0].below = 100.0;  // none fails: the tenth nearest to it
  const FailureDrivers nearest = FindFailureDrivers(campaign_, cases_).at(0);
  EXPECT_TRUE(nearest.nearest);
  EXPECT_GE(nearest.flights, 100u);
  EXPECT_EQ(nearest.drivers.at(0).feature, "|x|");
  // Nothing planted: a false discovery is rare, and stated as such.
  DriversWhen([&](std::size_t k) { return noise_[k]; });
  EXPECT_LE(FindFailureDrivers(campaign_, cases_).at(0).drivers.size(), 1u);
}

// Neither input alone tells the failing flights, because both fail by either sign: their product does.
TEST_F(Planted, ACombinationOfTwoInputsMarksTheFailingFlights) {
  const std::vector<double>& drag = cases_.inputs[static_cast<std::size_t>(FindInput("drag_factor"))];
  Requirement requirement;
  requirement.metric = kPeak;
  requirement.below = 0.5;
  campaign_.requirements = {requirement};
  const auto pairs_when = [&](auto metric) {
    std::vector<double> values;
    for (std::size_t k = 0; k < cases_.rows(); ++k) values.push_back(metric(k));
    cases_.metrics[MetricColumn(kPeak)] = values;
    return FindFailureDrivers(campaign_, cases_).at(0).pairs;
  };
  const auto pairs =
      pairs_when([&](std::size_t k) { return (drag[k] - 1.0) / 0.02 * bias_[k] > 0.8 ? 1.0 : 0.0; });
  ASSERT_FALSE(pairs.empty());
  EXPECT_EQ((std::set<std::string>{pairs[0].first, pairs[0].second}),
            (std::set<std::string>{"gyro_bias_pitch_deg_s", "drag_factor"}));
  EXPECT_GT(pairs[0].correlation, 0.8);
  EXPECT_LT(pairs[0].p, 1e-10);
  EXPECT_LT(pairs[0].false_discovery_rate, 1e-8);
  // Each by itself is no combination, and neither is chance.
  EXPECT_TRUE(pairs_when([&](std::size_t k) { return bias_[k] > 1.5 ? 1.0 : 0.0; }).empty());
  EXPECT_TRUE(pairs_when([&](std::size_t k) { return noise_[k] > 1.0 ? 1.0 : 0.0; }).empty());
}

TEST_F(Planted, InputsThatRankTheFlightsAlikeAreNamedTogether) {
  Dispersion twin;
  twin.name = "mass_flow_factor_stage1";
  twin.inputs = {FindInput("mass_flow_factor_stage1")};
  campaign_.dispersions.push_back(twin);
  const std::vector<double> drag = cases_.inputs[static_cast<std::size_t>(FindInput("drag_factor"))];
  for (const double value : drag)
    cases_.inputs[static_cast<std::size_t>(FindInput("mass_flow_factor_stage1"))].push_back(3.0 - value);
  const auto drivers = DriversWhen([&](std::size_t k) { return drag[k] + 0.001 * noise_[k]; });
  ASSERT_FALSE(drivers.empty());
  // Which of the two comes first is the order of the columns.
  ASSERT_EQ(drivers[0].same_as.size(), 1u);
  EXPECT_NE(drivers[0].input, drivers[0].same_as[0]);
  EXPECT_GT(std::fabs(drivers[0].partial), 0.9);  // beside its twin it had none
  for (std::size_t i = 1; i < drivers.size(); ++i) {
    EXPECT_NE(drivers[i].input, drivers[0].input);
    EXPECT_NE(drivers[i].input, drivers[0].same_as[0]);
  }
}

}  // namespace
}  // namespace dispersa::analysis_drivers_test
