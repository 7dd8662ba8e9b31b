// Moments and words of each distribution in a report: moments in closed form, and full texts.
#include "core/analysis/dispersion_summary.h"
#include "tests/test.h"
#include "tests/unit/distributions.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_dispersion_laws_test {
namespace {

using made_up::Empirical;
using made_up::LogNormal;
using made_up::Normal;
using made_up::Rayleigh;
using made_up::Triangular;
using made_up::TruncatedNormal;
using made_up::TwoPoint;
using made_up::Uniform;
using made_up::Values;
using std::numbers::pi;

struct Law {
  const char* name;
  ScalarDistribution distribution;
  double mean, std;  ///< in closed form
  std::string words;
  double tolerance = 1e-12;
};
void PrintTo(const Law& law, std::ostream* out) { *out << law.name; }

double Density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * pi); }
double Below(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

std::vector<Law> Laws() {
  const double e = std::exp(0.04);  // of a logarithm's variance
  const double kept = 2.0 * Below(1.5) - 1.0;
  // Of |x|, x normal about 1 with a deviation of 2.
  const double folded = 4.0 * Density(0.5) + 1.0 - 2.0 * Below(-0.5);
  constexpr double kIntegrated = 1e-3;  // over 20,000 quantiles: what its tails' last one leaves out
  return {
      {"TwoPoint", TwoPoint(1.0, 0.9, 1.3), 1.1, 0.2, "0.9 or 1.3"},
      {"Uniform", Uniform(2.0, 5.0), 3.5, 3.0 / std::sqrt(12.0), "uniform, 2 to 5"},
      {"FoldedNormal", Normal(1.0, 2.0), folded, std::sqrt(5.0 - folded * folded),
       "magnitude of normal, mean 1, 3σ 6"},
      {"LogNormal", LogNormal(3.0, 0.2), 3.0 * std::sqrt(e), 3.0 * std::sqrt(e * (e - 1.0)),
       "lognormal, median 3, σ of the logarithm 0.2", kIntegrated},
      {"Rayleigh", Rayleigh(2.0), 2.0 * std::sqrt(0.5 * pi), 2.0 * std::sqrt(2.0 - 0.5 * pi), "Rayleigh, σ 2",
       kIntegrated},
      {"Triangular", Triangular(1.0, 2.0, 6.0), 3.0, std::sqrt((1.0 + 36.0 + 4.0 - 6.0 - 2.0 - 12.0) / 18.0),
       "triangular, 1 to 6, mode 2", kIntegrated},
      {"TruncatedNormal", TruncatedNormal(4.0, 2.0, 1.0, 7.0), 4.0,
       2.0 * std::sqrt(1.0 - 3.0 * Density(1.5) / kept), "normal, mean 4, 3σ 6, truncated to 1 to 7",
       kIntegrated},
      {"TruncatedOnOneSide", TruncatedNormal(0.0, 1.0, 0.0, 20.0), std::sqrt(2.0 / pi),
       std::sqrt(1.0 - 2.0 / pi), "normal, mean 0, 3σ 3, truncated to 0 to 20", kIntegrated},
      {"Empirical", Empirical({1.0, 3.0}), 2.0, 2.0 / std::sqrt(12.0), "as a sample of 2, 1 to 3",
       kIntegrated},
      {"Values", Values({1.0, 2.0, 6.0}), 3.0, std::sqrt(14.0 / 3.0), "one of 1 2 6"},
      {"WeightedValues", Values({-1.0, 3.0}, {3.0, 1.0}), 0.0, std::sqrt(3.0),
       "one of -1 3 with weights 3 1"},
      {"MagnitudesOfWeightedValues", Values({-1.0, 3.0}, {3.0, 1.0}), 1.5, std::sqrt(0.75),
       "magnitude of one of -1 3 with weights 3 1"},
  };
}

DispersionSummary Summarized(const Law& law, const char* input, double unit) {
  Campaign campaign = report_test::MakeCampaign(2);
  Dispersion dispersion;
  dispersion.name = input;
  dispersion.distribution = law.distribution;
  dispersion.absolute = law.words.starts_with("magnitude");
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
