// Columns of results: what counts as a value.
#include "core/report/case_columns.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dispersa {
namespace {

TEST(ReportCaseColumns, OnlyCompletedFlightsHaveValues) {
  CaseColumns cases;
  cases.index = {0, 1, 2};
  cases.outcome = {Outcome::kCompleted, Outcome::kLostControl, Outcome::kImpact};
  cases.metrics.resize(MetricNames().size());
  cases.metrics[MetricColumn("pitch_error_rms_deg")] = {0.1, 0.2, 0.3};
  const std::vector<double> values = CompletedValues(cases, "pitch_error_rms_deg");
  EXPECT_EQ(values[0], 0.1);
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_TRUE(std::isnan(values[2]));
  EXPECT_EQ(LostCount(cases), 2u);
}

}  // namespace
}  // namespace dispersa
