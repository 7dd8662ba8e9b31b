// The report shows a dispersion that did not reach the flights, or reached them wrongly.
#include "core/analysis/dispersion_summary.h"

#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_dispersions_test {
namespace {

using report_test::MakeCampaign;

constexpr double kRadPerDegree = std::numbers::pi / 180.0;

Dispersion Normal(const std::string& input, double mean, double sigma) {
  Dispersion dispersion;
  dispersion.name = input;
  dispersion.distribution.kind = Distribution::kNormal;
  dispersion.distribution.nominal = mean;
  dispersion.distribution.sigma = sigma;
  dispersion.inputs = {FindInput(input)};
  return dispersion;
}

template <typename Draw>
DispersionSummary Summarized(const Dispersion& dispersion, std::size_t n, Draw draw,
                             SamplingMethod method = SamplingMethod::kMonteCarlo) {
  Campaign campaign = MakeCampaign(n);
  campaign.sampling.method = method;
  campaign.dispersions = {dispersion};
  CaseColumns cases;
  cases.inputs.resize(InputCount(kUsualStages));
  for (std::size_t i = 0; i < n; ++i)
    cases.inputs[static_cast<std::size_t>(dispersion.inputs[0])].push_back(draw());
  return SummarizeDispersions(campaign, cases).at(0);
}

TEST(Dispersions, AgreeWithWhatIsDeclared) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal(1.0, 0.02 / 3.0);
  const DispersionSummary summary =
      Summarized(Normal("thrust_factor_stage1", 1.0, 0.02 / 3.0), 2000, [&] { return normal(generator); });
  EXPECT_EQ(summary.declared, "normal, mean 1, 3σ 0.02");
  EXPECT_EQ(summary.input, "thrust_factor_stage1");
  EXPECT_EQ(summary.consistent, true);
}

TEST(Dispersions, ThatWereNeverAppliedAreFound) {
  EXPECT_EQ(Summarized(Normal("thrust_factor_stage1", 1.0, 0.02 / 3.0), 200, [] { return 1.0; }).consistent,
            false);
}

TEST(Dispersions, AThirdOfTheSpreadIsFound) {  // sigma taken for three sigma
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal(1.0, 0.02 / 9.0);
  EXPECT_EQ(
      Summarized(Normal("thrust_factor_stage1", 1.0, 0.02 / 3.0), 200, [&] { return normal(generator); })
          .consistent,
      false);
}

TEST(Dispersions, AMagnitudeIsHalfNormal) {
  Dispersion tilt = Normal("thrust_misalignment_stage2_deg", 0.0, 0.25 / 3.0 * kRadPerDegree);
  tilt.absolute = true;
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal(0.0, 0.25 / 3.0);
  const DispersionSummary summary = Summarized(tilt, 2000, [&] { return std::fabs(normal(generator)); });
  // Mean sigma sqrt(2/pi), standard deviation sigma sqrt(1 - 2/pi), in degrees. Rounding only.
  EXPECT_NEAR(*summary.expected_mean, 0.25 / 3.0 * std::sqrt(2.0 / std::numbers::pi), 1e-15);
  EXPECT_NEAR(*summary.expected_std, 0.25 / 3.0 * std::sqrt(1.0 - 2.0 / std::numbers::pi), 1e-15);
  EXPECT_EQ(summary.declared, "magnitude of normal, mean 0 °, 3σ 0.25 °");
  EXPECT_EQ(summary.consistent, true);
}

TEST(Dispersions, ADirectionFromHalfATurnHasItsMoments) {
  Dispersion azimuth = Normal("wind_azimuth_deg", 0.0, 0.0);
  azimuth.distribution = {.kind = Distribution::kUniform,
                          .nominal = 0.0,
                          .sigma = 0.0,
                          .low = 0.0,
                          .high = std::numbers::pi,
                          .values = {}};
  std::mt19937_64 generator(4);
  std::uniform_real_distribution<double> uniform(0.0, 180.0);
  const DispersionSummary summary = Summarized(azimuth, 2000, [&] { return uniform(generator); });
  EXPECT_NEAR(*summary.expected_mean, 90.0, 1e-12);
  EXPECT_NEAR(*summary.expected_std, 180.0 / std::sqrt(12.0), 1e-12);
  EXPECT_EQ(summary.declared, "uniform, 0 to 180 °");
  EXPECT_EQ(summary.consistent, true);
}

TEST(Dispersions, AConstantHasNoSpread) {
  Dispersion speed = Normal("wind_max_speed_m_s", 0.0, 0.0);
  speed.distribution = {.kind = Distribution::kConstant,
                        .nominal = 60.96,
                        .sigma = 0.0,
                        .low = 0.0,
                        .high = 0.0,
                        .values = {60.96}};
  EXPECT_EQ(Summarized(speed, 50, [] { return 60.96; }).consistent, true);
  EXPECT_EQ(Summarized(speed, 50, [] { return 60.0; }).consistent, false);
  EXPECT_EQ(Summarized(speed, 50, [] { return 60.96; }).declared, "constant 60.96 m/s");
}

TEST(Dispersions, AFewCasesOrADesignDecideNothing) {
  const Dispersion thrust = Normal("thrust_factor_stage1", 1.0, 0.02 / 3.0);
  EXPECT_FALSE(Summarized(thrust, 9, [] { return 1.0; }).consistent.has_value());
  EXPECT_FALSE(Summarized(
                   thrust, 100, [] { return 1.0; }, SamplingMethod::kOneAtATime)
                   .consistent.has_value());
}

TEST(Dispersions, TwoThatFeedOneInputPromiseNothingAboutIt) {
  Campaign campaign = MakeCampaign(20);
  campaign.dispersions = {Normal("drag_factor", 1.0, 0.1), Normal("drag_factor", 1.0, 0.2)};
  CaseColumns cases;
  cases.inputs.resize(InputCount(kUsualStages));
  cases.inputs[static_cast<std::size_t>(FindInput("drag_factor"))] = std::vector<double>(20, 1.0);
  for (const DispersionSummary& summary : SummarizeDispersions(campaign, cases)) {
    EXPECT_FALSE(summary.expected_mean.has_value());
  }
  EXPECT_EQ(DispersedInputs(campaign), std::vector<int>{FindInput("drag_factor")});
}

// Directions: 0 and 360 degrees are the same.
TEST(Dispersions, OfADirectionAreNearToTheDeclaredMean) {
  for (const double mean_deg : {0.0, 90.0, 359.0}) {
    SCOPED_TRACE(mean_deg);
    std::mt19937_64 generator(3);
    std::normal_distribution<double> normal(mean_deg, 5.0);
    const auto in_range = [&] {
      const double value = normal(generator);
      return value - 360.0 * std::floor(value / 360.0);
    };
    const DispersionSummary summary =
        Summarized(Normal("wind_azimuth_deg", mean_deg * kRadPerDegree, 5.0 * kRadPerDegree), 2000, in_range);
    EXPECT_EQ(summary.consistent, true);
    EXPECT_NEAR(*summary.expected_mean, mean_deg, 1e-9);
    EXPECT_NEAR(summary.drawn.mean, mean_deg, 0.5);
    EXPECT_NEAR(summary.drawn.std, 5.0, 0.3);
  }
}

TEST(Dispersions, ADirectionFromAnywhereHasNoMean) {
  std::mt19937_64 generator(4);
  std::uniform_real_distribution<double> uniform(0.0, 360.0);
  for (const char* input : {"wind_azimuth_deg", "thrust_misalignment_clock_stage1_deg"}) {
    Dispersion dispersion = Normal(input, 0.0, 0.0);
    dispersion.distribution.kind = Distribution::kUniform;
    dispersion.distribution.high = 2.0 * std::numbers::pi;
    const DispersionSummary summary = Summarized(dispersion, 2000, [&] { return uniform(generator); });
    EXPECT_EQ(summary.declared, "uniform, 0 to 360 °");
    EXPECT_EQ(summary.consistent, true);
    EXPECT_EQ(summary.drawn.n, 2000u);
    EXPECT_TRUE(std::isnan(summary.drawn.mean));
    EXPECT_FALSE(summary.expected_mean);
    // A wind from the south alone is no draw from everywhere.
    EXPECT_EQ(Summarized(dispersion, 2000, [&] { return 0.5 * uniform(generator); }).consistent, false);
  }
}

}  // namespace
}  // namespace dispersa::analysis_dispersions_test
