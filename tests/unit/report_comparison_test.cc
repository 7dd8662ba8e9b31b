// Pairing of cases, and what is said of a pair.
#include "core/report/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/report/case_columns.h"
#include "tests/unit/report_test_support.h"

namespace dispersa {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kMetric[] = "pitch_error_rms_deg";

/// One input (all the others unread) and one metric a case.
CaseColumns Columns(const std::vector<std::uint64_t>& index, const std::vector<double>& input,
                    const std::vector<double>& metric) {
  CaseColumns cases;
  cases.index = index;
  cases.outcome.assign(index.size(), Outcome::kCompleted);
  cases.inputs = {input};
  cases.metrics.resize(MetricNames().size());
  cases.metrics[MetricColumn(kMetric)] = metric;
  return cases;
}

TEST(ReportComparison, PairsCasesOfEqualIndexAndEqualDraws) {
  // Case 1 is only in a, case 5 only in b, and case 3 was drawn otherwise: 1 + 1 + 2 cases without a pair.
  const Comparison comparison = Compare(Columns({0, 1, 2, 3}, {0.1, 0.2, 0.3, 0.4}, {1, 1, 1, 1}),
                                        Columns({0, 2, 3, 5}, {0.1, 0.3, 0.5, 0.6}, {2, 4, 1, 1}), {kMetric});
  EXPECT_EQ(comparison.pairs, 2);
  EXPECT_EQ(comparison.unpaired, 4);
  ASSERT_EQ(comparison.metrics.size(), 1);
  EXPECT_EQ(comparison.metrics[0].difference.worse, 2);
  EXPECT_EQ(comparison.metrics[0].difference.median_difference, 2.0);  // of 1 and 3
  // Of 2 and 4, between which ratios are interpolated by their logarithms.
  EXPECT_DOUBLE_EQ(comparison.metrics[0].difference.median_ratio, std::sqrt(8.0));
}

TEST(ReportComparison, ListsWhereTheSecondIsBetterWithTheLargestGainFirst) {
  CaseColumns a = Columns({0, 1, 2, 3, 4}, {0, 0, 0, 0, 0}, {1.0, 1.0, 1.0, 1.0, 1.0});
  CaseColumns b = Columns({0, 1, 2, 3, 4}, {0, 0, 0, 0, 0}, {0.9, 1.1, 0.5, 0.7, 0.1});
  a.outcome[3] = Outcome::kLostControl;  // infinitely bad: b gains most there
  b.outcome[4] = Outcome::kLostControl;  // what it measured before it was lost counts for nothing
  const Comparison comparison = Compare(a, b, {kMetric});
  std::vector<std::uint64_t> order;
  for (const auto& better : comparison.metrics[0].better) order.push_back(better.case_index);
  EXPECT_THAT(order, ElementsAre(3, 2, 0));
  EXPECT_EQ(comparison.metrics[0].difference.better, 3);
  EXPECT_EQ(comparison.metrics[0].difference.worse, 2);
  EXPECT_THAT(BetterCasesList(comparison.metrics[0], "ours", "theirs"),
              HasSubstr("cases in which theirs is better than ours in Pitch error, RMS: 3</summary><p class=\"soft\">3 "
                        "(0.7 against lost), 2 (0.5 against 1), 0 (0.9 against 1)"));
}

TEST(ReportComparison, NoBetterCaseIsSaidToo) {
  const Comparison comparison = Compare(Columns({0}, {0}, {1.0}), Columns({0}, {0}, {2.0}), {kMetric});
  EXPECT_EQ(BetterCasesList(comparison.metrics[0], "a", "b"),
            "<p class=\"soft\">cases in which b is better than a in Pitch error, RMS: 0</p>\n");
}

TEST(ReportComparison, TheUsualMetricsExist) {
  for (const std::string& metric : ComparedMetrics()) EXPECT_THAT(MetricNames(), testing::Contains(metric));
}

}  // namespace
}  // namespace dispersa
