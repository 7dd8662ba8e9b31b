// Which change a comparison names, and the values that it shows with it.
#include "tests/test.h"
#include "tests/unit/comparison_sample.h"

namespace dispersa::analysis_comparison_changes_test {
namespace {

using namespace comparison_sample;
using report_test::PeakBelow;

constexpr char kRms[] = "pitch_error_rms_deg";

Requirement Below(double limit) {
  Requirement requirement = PeakBelow(limit, 0.9, 0.1);
  requirement.metric = kRms;
  return requirement;
}

/// 60 pairs. Of `low` no flight is beyond any limit; of `high` all break 1, and 40 break 3.
Comparison Compared(bool is_b_worse, const std::vector<Requirement>& requirements) {
  std::vector<std::uint64_t> index;
  std::vector<double> input, low, high;
  for (std::uint64_t i = 0; i < 60; ++i) {
    index.push_back(i);
    input.push_back(0.1 * static_cast<double>(i));
    low.push_back(0.5);
    high.push_back(i < 40 ? 4.0 : 2.0);
  }
  return CompareColumns(Columns(index, input, is_b_worse ? low : high),
                        Columns(index, input, is_b_worse ? high : low), requirements);
}

// In either direction and in whatever order the requirements stand.
TEST(ComparisonSentence, NamesTheLargestChange) {
  for (const std::vector<Requirement>& requirements :
       std::vector<std::vector<Requirement>>{{Below(1.0), Below(3.0)}, {Below(3.0), Below(1.0)}}) {
    EXPECT_THAT(Compared(true, requirements).sentence,
                HasSubstr("B is worse in 2 of 2 requirements, most in pitch_error_rms_deg below 1: broken in "
                          "60 of 60 flights of B, in 0 of 60 of A."));
    EXPECT_THAT(Compared(false, requirements).sentence,
                HasSubstr("B is better in 2 of 2 requirements, most in pitch_error_rms_deg below 1: broken "
                          "in 0 of 60 flights of B, in 60 of 60 of A."));
  }
}

std::vector<double> Scaled(double factor, double scatter = 0.001, std::size_t n = 400) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i)
    values.push_back(factor * (0.01 + scatter * static_cast<double>(i % 40)));
  return values;
}

Comparison OfFourHundred(const std::vector<double>& of_a, const std::vector<double>& of_b, bool paired,
                         const std::vector<Requirement>& requirements = {}) {
  std::vector<std::uint64_t> index;
  std::vector<double> input, other;
  for (std::uint64_t i = 0; i < 400; ++i) {
    index.push_back(i);
    input.push_back(0.1 * static_cast<double>(i));
    other.push_back(0.1 * static_cast<double>(i) + (paired ? 0.0 : 0.05));
  }
  return CompareColumns(Columns(index, input, of_a), Columns(index, other, of_b), requirements);
}

// Far from its limit a value can become five times worse, and no flight breaks anything.
TEST(ComparisonFinding, FollowsTheLargestEffectWithAndWithoutRequirements) {
  for (const bool paired : {true, false}) {
    for (const std::vector<Requirement>& requirements :
         std::vector<std::vector<Requirement>>{{}, {Below(1.0)}}) {
      const Comparison worse = OfFourHundred(Scaled(1.0), Scaled(5.0), paired, requirements);
      EXPECT_EQ(worse.pairing.paired, paired);
      EXPECT_EQ(worse.finding, "worse") << worse.sentence;
      EXPECT_THAT(worse.sentence, HasSubstr("The largest change for the worse: pitch_error_rms_deg, "));
      EXPECT_EQ(OfFourHundred(Scaled(5.0), Scaled(1.0), paired, requirements).finding, "better");
      EXPECT_EQ(OfFourHundred(Scaled(1.0), Scaled(1.0 + 1e-8), paired, requirements).finding,
                "no relevant difference");
    }
  }
}

// The median stays where it is, the tail does not: as if an uncertainty were doubled.
TEST(ComparisonFinding, ATailThatMovesAloneIsFound) {
  std::vector<double> narrow, wide;
  for (int i = 0; i < 400; ++i) {
    const double of = ((i * 37) % 400 - 199.5) / 200.0;
    narrow.push_back(0.5 + 0.1 * of);
    wide.push_back(0.5 + 0.2 * of);
  }
  const Comparison worse = OfFourHundred(narrow, wide, false), better = OfFourHundred(wide, narrow, false);
  EXPECT_EQ(worse.metrics[0].finding, "worse");
  EXPECT_EQ(better.metrics[0].finding, "better");
  EXPECT_NE(worse.metrics[0].effect_in, "median");
  EXPECT_EQ(worse.metrics[0].found_in, worse.metrics[0].effect_in);
  EXPECT_LE(worse.metrics[0].found_p, 0.05);
  EXPECT_GT(worse.metrics[0].p_holm, 0.05) << "the median is the same";
  EXPECT_THAT(EffectWords(worse.metrics[0]), HasSubstr(worse.metrics[0].effect_in + " 0."));
  const MetricComparison same = OfFourHundred(narrow, narrow, true).metrics[0];
  EXPECT_EQ(EffectWords(same), "");
  EXPECT_EQ(same.found_in, "median");
}

// The first row of the page is the largest effect; what does not matter is counted and folded.
TEST(ComparisonPage, BeginsWithTheLargestEffect) {
  CaseColumns a = Columns({}, {}, {}), b = a;
  std::vector<std::uint64_t> index;
  std::vector<double> input;
  for (std::uint64_t i = 0; i < 400; ++i) index.push_back(i), input.push_back(0.1 * static_cast<double>(i));
  a = Columns(index, input, Scaled(1.0));
  b = Columns(index, input, Scaled(1.2));
  for (const auto& [name, factor] : {std::pair{"deflection_peak_deg", 3.0}, std::pair{"q_max_pa", 1.0}}) {
    a.metrics[MetricColumn(name)] = Scaled(1.0);
    b.metrics[MetricColumn(name)] = Scaled(factor);
  }
  const Comparison comparison = CompareColumns(a, b);
  ASSERT_EQ(comparison.metrics.size(), 3u);
  EXPECT_EQ(ByEffect(comparison)[0]->metric, "deflection_peak_deg");
  EXPECT_EQ(ByEffect(comparison)[1]->metric, "pitch_error_rms_deg");
  EXPECT_THAT(
      ComparisonPage(comparison, a, b),
      HasSubstr("<details><summary>1 metrics without a change that matters: 1 not shown, 0 certain but too "
                "small</summary>"));
}

// The campaigns share cases 2, 3 and 5, which stand in other rows of A than of B.
TEST(ComparedCases, ShowTheValuesOfTheirOwnRows) {
  const Comparison comparison = CompareColumns(
      Columns({0, 2, 3, 5}, {0.1, 0.3, 0.4, 0.6}, {0.01, 0.12, 2.13, 0.15}),
      Columns({1, 2, 3, 4, 5}, {0.2, 0.3, 0.4, 0.5, 0.6}, {3.01, 2.22, 0.23, 3.04, 2.25}), {Below(1.0)});
  ASSERT_EQ(comparison.harmed.size(), 2u);
  EXPECT_EQ(comparison.harmed[0].case_index, 2u);
  EXPECT_EQ(comparison.harmed[0].reasons[0].a, 0.12);
  EXPECT_EQ(comparison.harmed[0].reasons[0].b, 2.22);
  EXPECT_EQ(comparison.harmed[1].case_index, 5u);
  EXPECT_EQ(comparison.harmed[1].reasons[0].a, 0.15);
  EXPECT_EQ(comparison.harmed[1].reasons[0].b, 2.25);
  ASSERT_EQ(comparison.rescued.size(), 1u);
  EXPECT_EQ(comparison.rescued[0].case_index, 3u);
  EXPECT_EQ(comparison.rescued[0].reasons[0].a, 2.13);
  EXPECT_EQ(comparison.rescued[0].reasons[0].b, 0.23);
}

}  // namespace
}  // namespace dispersa::analysis_comparison_changes_test
