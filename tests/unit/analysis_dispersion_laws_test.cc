// Moments and words of each distribution in a report: moments in closed form, and full texts.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "core/analysis/dispersion_summary.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_dispersion_laws_test {
namespace {

using std::numbers::pi;

struct Law {
  const char* name;
  ScalarDistribution distribution;
  bool absolute;
  double mean, std;  ///< in closed form
  const char* words;
  double tolerance =
      1e-12;  ///< of a law that is integrated over 20,000 quantiles: what its tails' last one leaves out
};
void PrintTo(const Law& law, std::ostream* out) { *out << law.name; }

double Density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * pi); }
double Below(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

std::vector<Law> Laws() {
  const double e = std::exp(0.04);  // of a logarithm's variance
  const double kept = 2.0 * Below(1.5) - 1.0;
  // Of |x|, x normal about 1 with a deviation of 2.
  const double folded = 4.0 * Density(0.5) + 1.0 - 2.0 * Below(-0.5);
  return {
      {"TwoPoint",
       {.kind = Distribution::kTwoPoint, .nominal = 1.0, .low = 0.9, .high = 1.3, .values = {}},
       false,
       1.1,
       0.2,
       "0.9 or 1.3"},
      {"Uniform",
       {.kind = Distribution::kUniform, .low = 2.0, .high = 5.0, .values = {}},
       false,
       3.5,
       3.0 / std::sqrt(12.0),
       "uniform, 2 to 5"},
      {"FoldedNormal",
       {.kind = Distribution::kNormal, .nominal = 1.0, .sigma = 2.0, .values = {}},
       true,
       folded,
       std::sqrt(5.0 - folded * folded),
       "magnitude of normal, mean 1, 3σ 6"},
      {"LogNormal",
       {.kind = Distribution::kLogNormal, .nominal = 3.0, .sigma = 0.2, .values = {}},
       false,
       3.0 * std::sqrt(e),
       3.0 * std::sqrt(e * (e - 1.0)),
       "lognormal, median 3, σ of the logarithm 0.2",
       1e-3},
      {"Rayleigh",
       {.kind = Distribution::kRayleigh, .sigma = 2.0, .values = {}},
       false,
       2.0 * std::sqrt(0.5 * pi),
       2.0 * std::sqrt(2.0 - 0.5 * pi),
       "Rayleigh, σ 2",
       1e-3},
      {"Triangular",
       {.kind = Distribution::kTriangular, .nominal = 2.0, .low = 1.0, .high = 6.0, .values = {}},
       false,
       3.0,
       std::sqrt((1.0 + 36.0 + 4.0 - 6.0 - 2.0 - 12.0) / 18.0),
       "triangular, 1 to 6, mode 2",
       1e-3},
      {"TruncatedNormal",
       {.kind = Distribution::kTruncatedNormal,
        .nominal = 4.0,
        .sigma = 2.0,
        .low = 1.0,
        .high = 7.0,
        .values = {}},
       false,
       4.0,
       2.0 * std::sqrt(1.0 - 3.0 * Density(1.5) / kept),
       "normal, mean 4, 3σ 6, truncated to 1 to 7",
       1e-3},
      {"TruncatedOnOneSide",
       {.kind = Distribution::kTruncatedNormal,
        .nominal = 0.0,
        .sigma = 1.0,
        .low = 0.0,
        .high = 20.0,
        .values = {}},
       false,
       std::sqrt(2.0 / pi),
       std::sqrt(1.0 - 2.0 / pi),
       "normal, mean 0, 3σ 3, truncated to 0 to 20",
       1e-3},
      {"Empirical",
       {.kind = Distribution::kEmpirical, .values = {1.0, 3.0}},
       false,
       2.0,
       2.0 / std::sqrt(12.0),
       "as a sample of 2, 1 to 3",
       1e-3},
      {"Values",
       {.kind = Distribution::kValues, .values = {1.0, 2.0, 6.0}},
       false,
       3.0,
       std::sqrt(14.0 / 3.0),
       "one of 1 2 6"},
      {"WeightedValues",
       {.kind = Distribution::kValues, .values = {-1.0, 3.0}, .weights = {3.0, 1.0}},
       false,
       0.0,
       std::sqrt(3.0),
       "one of -1 3 with weights 3 1"},
      {"MagnitudesOfWeightedValues",
       {.kind = Distribution::kValues, .values = {-1.0, 3.0}, .weights = {3.0, 1.0}},
       true,
       1.5,
       std::sqrt(0.75),
       "magnitude of one of -1 3 with weights 3 1"},
  };
}

DispersionSummary Summarized(const Law& law, const char* input, double unit) {
  Campaign campaign = report_test::MakeCampaign(2);
  Dispersion dispersion;
  dispersion.name = input;
  dispersion.distribution = law.distribution;
  dispersion.absolute = law.absolute;
  dispersion.inputs = {FindInput(input)};
  ScalarDistribution& d = dispersion.distribution;
  // The spread of a logarithm has no unit.
  for (double* value : {&d.nominal, &d.low, &d.high}) *value *= unit;
  if (d.kind != Distribution::kLogNormal) d.sigma *= unit;
  for (double& value : d.values) value *= unit;
  campaign.dispersions = {dispersion};
  CaseColumns cases;
  cases.inputs.resize(InputCount(kUsualStages));
  cases.inputs[static_cast<std::size_t>(dispersion.inputs[0])] = std::vector<double>{1.0, 1.0};
  return SummarizeDispersions(campaign, cases).at(0);
}

class DispersionLaws : public testing::TestWithParam<Law> {};

TEST_P(DispersionLaws, HaveTheirMomentsAndWords) {
  const Law& law = GetParam();
  const DispersionSummary factor = Summarized(law, "drag_factor", 1.0);
  ASSERT_TRUE(factor.expected_mean && factor.expected_std);
  EXPECT_NEAR(*factor.expected_mean, law.mean, law.tolerance * (std::fabs(law.mean) + law.std));
  EXPECT_NEAR(*factor.expected_std, law.std, law.tolerance * law.std + 1e-15);
  EXPECT_EQ(factor.declared, law.words);
  // An angle is drawn in radians and told in degrees.
  const DispersionSummary angle = Summarized(law, "wind_azimuth_deg", pi / 180.0);
  EXPECT_NEAR(*angle.expected_mean, law.mean, law.tolerance * (std::fabs(law.mean) + law.std) + 1e-12);
  EXPECT_NEAR(*angle.expected_std, law.std, law.tolerance * law.std + 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Each, DispersionLaws, testing::ValuesIn(Laws()),
                         [](const auto& law) { return std::string(law.param.name); });

}  // namespace
}  // namespace dispersa::analysis_dispersion_laws_test
