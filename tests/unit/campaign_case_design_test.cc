// The inputs of a case, by every sampling method.
#include "core/campaign/case_design.h"

#include "core/random/draws.h"
#include "core/random/normal.h"
#include "tests/test.h"
#include "tests/unit/distributions.h"

namespace dispersa::campaign_case_design_test {

using namespace made_up;

Campaign With(SamplingMethod method, std::vector<Dispersion> dispersions, std::uint64_t cases = 64) {
  Campaign campaign;
  campaign.sampling = {method, cases, 42};
  campaign.dispersions = std::move(dispersions);
  return campaign;
}

TEST(CaseDesign, WithoutDispersionsEveryCaseIsNominal) {
  for (const SamplingMethod method :
       {SamplingMethod::kMonteCarlo, SamplingMethod::kLatinHypercube, SamplingMethod::kSobol,
        SamplingMethod::kCorners, SamplingMethod::kList})
    EXPECT_EQ(InputValues(CaseDesign(With(method, {})).Draw(7)), InputValues(FlightInputs{}));
}

TEST(CaseDesign, MonteCarloDrawsByNameAndCase) {
  const CaseDesign design(With(SamplingMethod::kMonteCarlo, {Of("drag", Normal(1.0, 0.02), "drag_factor")}));
  for (const std::uint64_t k : {0, 5, 1000000}) {
    const double u = Stream(42, k, "drag").Uniform();
    EXPECT_EQ(design.Draw(k).drag_factor, 1.0 + 0.02 * InverseNormal(u));
  }
}

TEST(CaseDesign, MonteCarloParametersDoNotDisturbOneAnother) {
  const Dispersion drag = Of("drag", Normal(1.0, 0.02), "drag_factor");
  const Dispersion cg = Of("cg", Uniform(0.8, 1.2), "cg_factor");
  const CaseDesign alone(With(SamplingMethod::kMonteCarlo, {drag}));
  const CaseDesign after(With(SamplingMethod::kMonteCarlo, {cg, drag}));
  const CaseDesign before(With(SamplingMethod::kMonteCarlo, {drag, cg}));
  for (std::uint64_t k = 0; k < 100; ++k) {
    EXPECT_EQ(alone.Draw(k).drag_factor, after.Draw(k).drag_factor);
    EXPECT_EQ(alone.Draw(k).drag_factor, before.Draw(k).drag_factor);
    EXPECT_EQ(before.Draw(k).cg_factor, after.Draw(k).cg_factor);
  }
}

TEST(CaseDesign, DrawingIsPure) {
  const CaseDesign design(With(SamplingMethod::kSobol, {Of("drag", Uniform(0.0, 1.0), "drag_factor"),
                                                        Of("cg", Uniform(0.0, 1.0), "cg_factor")}));
  const auto first = InputValues(design.Draw(9));
  design.Draw(3);
  design.Draw(60);
  EXPECT_EQ(InputValues(design.Draw(9)), first);
}

TEST(CaseDesign, FactorsMultiplyOthersAreSet) {
  Dispersion all = Of("thrust/all", Values({1.1}), "thrust_factor_stage1");
  all.inputs.push_back(FindInput("thrust_factor_stage2"));
  const CaseDesign design(
      With(SamplingMethod::kMonteCarlo, {all, Of("thrust/stage1", Values({0.5}), "thrust_factor_stage1"),
                                         Of("wind", Values({30.0}), "wind_max_speed_m_s"),
                                         Of("wind again", Values({20.0}), "wind_max_speed_m_s")}));
  const FlightInputs in = design.Draw(0);
  EXPECT_DOUBLE_EQ(in.stages[0].thrust_factor, 1.1 * 0.5);
  EXPECT_DOUBLE_EQ(in.stages[1].thrust_factor, 1.1);
  EXPECT_EQ(in.stages[2].thrust_factor, 1.0);
  EXPECT_EQ(in.air.wind_max_speed_m_s, 20.0);
}

TEST(CaseDesign, AbsoluteTakesTheMagnitude) {
  Dispersion tilt = Of("tilt", Normal(0.0, 0.01), "thrust_misalignment_stage1_deg");
  const CaseDesign with_sign(With(SamplingMethod::kMonteCarlo, {tilt}));
  tilt.absolute = true;
  const CaseDesign magnitude(With(SamplingMethod::kMonteCarlo, {tilt}));
  int negative = 0;
  for (std::uint64_t k = 0; k < 50; ++k) {
    const double value = with_sign.Draw(k).stages[0].thrust.misalignment_rad.magnitude;
    negative += value < 0.0;
    EXPECT_EQ(magnitude.Draw(k).stages[0].thrust.misalignment_rad.magnitude, std::fabs(value));
  }
  EXPECT_GT(negative, 10);
}

TEST(CaseDesign, UniformTwoPointAndValuesKeepToTheirRange) {
  const CaseDesign design(With(SamplingMethod::kMonteCarlo, {Of("a", Uniform(0.8, 1.2), "drag_factor"),
                                                             Of("b", TwoPoint(1.0, 0.9, 1.1), "cg_factor"),
                                                             Of("c", Values({0.5, 1.0, 2.0}), "cp_factor")}));
  double low = 2.0, high = 0.0;
  std::set<double> two, three;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const FlightInputs in = design.Draw(k);
    low = std::min(low, in.drag_factor);
    high = std::max(high, in.drag_factor);
    two.insert(in.cg_factor);
    three.insert(in.cp_factor);
  }
  EXPECT_GE(low, 0.8);
  EXPECT_LE(high, 1.2);
  EXPECT_LT(low, 0.82);
  EXPECT_GT(high, 1.18);
  EXPECT_EQ(two, (std::set<double>{0.9, 1.1}));
  EXPECT_EQ(three, (std::set<double>{0.5, 1.0, 2.0}));
}

TEST(CaseDesign, CornersAreAllCombinationsFirstFactorFastest) {
  const Campaign campaign = With(SamplingMethod::kCorners, {Of("a", TwoPoint(1.0, 0.8, 1.2), "drag_factor"),
                                                            Of("b", TwoPoint(1.0, 0.9, 1.1), "cg_factor")});
  EXPECT_EQ(DesignSize(campaign), 4u);
  const CaseDesign design(campaign);
  const std::vector<std::pair<double, double>> expected = {{0.8, 0.9}, {1.2, 0.9}, {0.8, 1.1}, {1.2, 1.1}};
  for (std::uint64_t k = 0; k < 8; ++k) {
    const FlightInputs in = design.Draw(k);
    EXPECT_EQ(std::make_pair(in.drag_factor, in.cg_factor), expected[k % 4]) << k;
  }
}

TEST(CaseDesign, WhatIsNoFactorStaysRandomAndRepeatsWithOtherDraws) {
  const CaseDesign design(With(SamplingMethod::kCorners, {Of("a", TwoPoint(1.0, 0.8, 1.2), "drag_factor"),
                                                          Of("r", Normal(0.0, 1.0), "gyro_bias_yaw_deg_s")}));
  EXPECT_EQ(design.Draw(0).drag_factor, design.Draw(2).drag_factor);
  EXPECT_NE(design.Draw(0).sensors.gyro_bias_yaw_rad_s, design.Draw(2).sensors.gyro_bias_yaw_rad_s);
}

TEST(CaseDesign, OneAtATimeMovesOneFactorAndHoldsTheOthersAtNominal) {
  const Campaign campaign =
      With(SamplingMethod::kOneAtATime,
           {Of("a", TwoPoint(1.0, 0.8, 1.2), "drag_factor"), Of("b", TwoPoint(1.0, 0.9, 1.1), "cg_factor")});
  EXPECT_EQ(DesignSize(campaign), 4u);
  const CaseDesign design(campaign);
  const std::vector<std::pair<double, double>> expected = {{0.8, 1.0}, {1.2, 1.0}, {1.0, 0.9}, {1.0, 1.1}};
  for (std::uint64_t k = 0; k < 4; ++k)
    EXPECT_EQ(std::make_pair(design.Draw(k).drag_factor, design.Draw(k).cg_factor), expected[k]) << k;
}

TEST(CaseDesign, GridVariesTheFirstAxisSlowest) {
  const Campaign campaign = With(SamplingMethod::kGrid, {Of("a", Values({1.0, 2.0}), "drag_factor"),
                                                         Of("b", Values({10.0, 20.0, 30.0}), "cg_factor")});
  EXPECT_EQ(DesignSize(campaign), 6u);
  const CaseDesign design(campaign);
  const std::vector<std::pair<double, double>> expected = {{1, 10}, {1, 20}, {1, 30},
                                                           {2, 10}, {2, 20}, {2, 30}};
  for (std::uint64_t k = 0; k < 6; ++k)
    EXPECT_EQ(std::make_pair(design.Draw(k).drag_factor, design.Draw(k).cg_factor), expected[k]) << k;
}

TEST(CaseDesign, ListTakesRowsTogether) {
  const Campaign campaign = With(SamplingMethod::kList, {Of("a", Values({1.0, 2.0, 3.0}), "drag_factor"),
                                                         Of("b", Values({10.0, 20.0, 30.0}), "cg_factor")});
  EXPECT_EQ(DesignSize(campaign), 3u);
  const CaseDesign design(campaign);
  for (std::uint64_t k = 0; k < 6; ++k) {
    EXPECT_EQ(design.Draw(k).drag_factor, 1.0 + static_cast<double>(k % 3));
    EXPECT_EQ(design.Draw(k).cg_factor, 10.0 * (1.0 + static_cast<double>(k % 3)));
  }
}

// Of n cases, one falls into each of n equal cells of every parameter.
void ExpectStratified(SamplingMethod method, std::size_t cases) {
  const CaseDesign design(
      With(method,
           {Of("a", Uniform(0.0, 1.0), "wind_max_speed_m_s"), Of("b", Uniform(0.0, 1.0), "wind_altitude_m")},
           cases));
  std::set<std::size_t> cells_a, cells_b;
  for (std::uint64_t k = 0; k < cases; ++k) {
    const FlightInputs in = design.Draw(k);
    cells_a.insert(static_cast<std::size_t>(in.air.wind_max_speed_m_s * static_cast<double>(cases)));
    cells_b.insert(static_cast<std::size_t>(in.air.wind_altitude_m * static_cast<double>(cases)));
  }
  EXPECT_EQ(cells_a.size(), cases);
  EXPECT_EQ(cells_b.size(), cases);
}

TEST(CaseDesign, LatinHypercubeIsStratified) { ExpectStratified(SamplingMethod::kLatinHypercube, 50); }
TEST(CaseDesign, SobolIsStratifiedInPowersOfTwo) { ExpectStratified(SamplingMethod::kSobol, 64); }

TEST(CaseDesign, SeedAndMethodChangeTheDraws) {
  Campaign campaign = With(SamplingMethod::kMonteCarlo, {Of("a", Uniform(0.0, 1.0), "wind_altitude_m")});
  const double one = CaseDesign(campaign).Draw(3).air.wind_altitude_m;
  campaign.sampling.seed = 43;
  EXPECT_NE(CaseDesign(campaign).Draw(3).air.wind_altitude_m, one);
  campaign.sampling = {SamplingMethod::kLatinHypercube, 64, 42};
  EXPECT_NE(CaseDesign(campaign).Draw(3).air.wind_altitude_m, one);
}

/// The share of draws at most x against the distribution function, over 4000 cases: within 4 standard errors
/// of at most sqrt(0.25 / 4000) = 0.0079.
void ExpectLaw(const ScalarDistribution& distribution, const std::vector<std::pair<double, double>>& law) {
  const CaseDesign design(With(SamplingMethod::kMonteCarlo, {Of("w", distribution, "wind_altitude_m")}));
  for (const auto& [x, probability] : law) {
    int below = 0;
    for (std::uint64_t k = 0; k < 4000; ++k) below += design.Draw(k).air.wind_altitude_m <= x;
    EXPECT_NEAR(below / 4000.0, probability, 0.032) << x;
  }
}

TEST(CaseDesign, DrawsFollowTheirLaws) {
  const auto phi = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  const double from = phi(-1.0), to = phi(0.5);
  ExpectLaw(TruncatedNormal(3.0, 2.0, 1.0, 4.0), {{0.999, 0.0},
                                                  {2.0, (phi(-0.5) - from) / (to - from)},
                                                  {3.5, (phi(0.25) - from) / (to - from)},
                                                  {4.0, 1.0}});
  ExpectLaw(Triangular(0.0, 1.0, 4.0), {{0.5, 0.0625}, {1.0, 0.25}, {2.0, 1.0 - 4.0 / 12.0}});
  ExpectLaw(LogNormal(2.0, 0.5),
            {{2.0, 0.5}, {2.0 * std::exp(0.5), phi(1.0)}, {2.0 * std::exp(-0.25), phi(-0.5)}});
  ExpectLaw(Rayleigh(3.0), {{3.0, 1.0 - std::exp(-0.5)}, {6.0, 1.0 - std::exp(-2.0)}});
  ExpectLaw(Values({1.0, 2.0, 3.0}, {1.0, 5.0, 2.0}), {{1.0, 0.125}, {2.0, 0.75}, {3.0, 1.0}});
  ExpectLaw(Empirical({0.0, 1.0, 11.0}), {{0.5, 0.25}, {1.0, 0.5}, {6.0, 0.75}});
}

TEST(CaseDesign, CorrelatedNormalsAreAndOthersStay) {
  Dispersion a = Of("a", Normal(0.0, 1.0), "wind_altitude_m");
  Dispersion b = Of("b", Normal(0.0, 2.0), "wind_width_m");
  const CaseDesign apart(With(SamplingMethod::kMonteCarlo, {a, b}));
  b.mix = {{0, 0.6}, {1, 0.8}};
  const CaseDesign together(With(SamplingMethod::kMonteCarlo, {a, b}));
  double ab = 0.0, bb = 0.0;
  constexpr int kCases = 4000;
  for (std::uint64_t k = 0; k < kCases; ++k) {
    const FlightInputs in = together.Draw(k);
    EXPECT_EQ(in.air.wind_altitude_m, apart.Draw(k).air.wind_altitude_m);
    ab += in.air.wind_altitude_m * in.air.wind_width_m / kCases;
    bb += in.air.wind_width_m * in.air.wind_width_m / kCases;
  }
  // Standard errors: of the covariance 2 sqrt((1 + 0.36) / 4000) = 0.037, of the variance 4 sqrt(2 / 4000) =
  // 0.09.
  EXPECT_NEAR(ab, 1.2, 0.15);
  EXPECT_NEAR(bb, 4.0, 0.36);
}

TEST(CaseDesign, SobolColumnsBelongToTheirNames) {
  const Dispersion drag = Of("drag", Uniform(0.0, 1.0), "drag_factor");
  const Dispersion wind = Of("wind/altitude", Uniform(0.0, 1.0), "wind_altitude_m");
  const Dispersion thrust = Of("thrust", Uniform(0.5, 1.5), "thrust_factor_stage1");
  const CaseDesign few(With(SamplingMethod::kSobol, {drag, wind}));
  const CaseDesign more(With(SamplingMethod::kSobol, {thrust, drag, wind}));
  for (std::uint64_t k = 0; k < 64; ++k) {
    EXPECT_EQ(few.Draw(k).drag_factor, more.Draw(k).drag_factor);
    EXPECT_EQ(few.Draw(k).air.wind_altitude_m, more.Draw(k).air.wind_altitude_m);
  }
}

// Of two that feed one input the first by name has its column, wherever they stand; the other is always 1
// here.
TEST(CaseDesign, OfOneInputTheFirstNameHasTheSobolColumn) {
  const Dispersion one = Of("b", Uniform(0.5, 1.5), "drag_factor");
  const auto beside = [](const std::string& name) { return Of(name, Normal(1.0, 0.0), "drag_factor"); };
  const CaseDesign alone(With(SamplingMethod::kSobol, {one}));
  const CaseDesign before(With(SamplingMethod::kSobol, {beside("c"), one})),
      after(With(SamplingMethod::kSobol, {one, beside("c")}));
  const CaseDesign second(With(SamplingMethod::kSobol, {one, beside("a")}));
  int same = 0;
  for (std::uint64_t k = 0; k < 64; ++k) {
    EXPECT_EQ(before.Draw(k).drag_factor, alone.Draw(k).drag_factor);
    EXPECT_EQ(after.Draw(k).drag_factor, alone.Draw(k).drag_factor);
    same += second.Draw(k).drag_factor == alone.Draw(k).drag_factor;
  }
  EXPECT_LT(same, 16) << "the first points of all columns are alike";
}

TEST(CaseDesign, ReplicatesAreDesignsOfTheirOwn) {
  for (const SamplingMethod method : {SamplingMethod::kLatinHypercube, SamplingMethod::kSobol}) {
    Campaign campaign = With(method, {Of("a", Uniform(0.0, 1.0), "wind_altitude_m")}, 64);
    campaign.sampling.replicates = 4;
    const CaseDesign design(campaign);
    campaign.sampling.cases = 16;
    campaign.sampling.replicates = 1;
    const CaseDesign one(campaign);
    std::set<double> all;
    for (std::uint64_t replicate = 0; replicate < 4; ++replicate) {
      std::set<int> strata;
      for (std::uint64_t k = 0; k < 16; ++k) {
        const double value = design.Draw(16 * replicate + k).air.wind_altitude_m;
        if (replicate == 0) {
          EXPECT_EQ(value, one.Draw(k).air.wind_altitude_m);
        }
        strata.insert(static_cast<int>(16.0 * value));
        all.insert(value);
      }
      EXPECT_EQ(strata.size(), 16u);
    }
    EXPECT_EQ(all.size(), 64u);
  }
}

}  // namespace dispersa::campaign_case_design_test
