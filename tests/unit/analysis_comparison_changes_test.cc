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
