#include "core/analysis/injection_summary.h"
#include "core/pages/report_sections.h"

#include "core/random/draws.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_injection_test {
namespace {

CaseColumns Injections(int count) {
  CaseColumns cases;
  cases.metrics.assign(MetricCount(kUsualStages),
                       CaseColumn(std::vector<double>(static_cast<std::size_t>(count), report_test::kNaN)));
  for (int i = 0; i < count; ++i) {
    Stream stream(9, static_cast<std::uint64_t>(i), "injection");
    const double x = stream.Normal(), y = stream.Normal(), z = stream.Normal();
    cases.index.push_back(static_cast<std::uint64_t>(i));
    cases.outcome.push_back(Outcome::kCompleted);
    cases.metrics[MetricColumn("injection_altitude_km")][cases.index.size() - 1] = 500.0 + 5.0 * x;
    cases.metrics[MetricColumn("injection_velocity_m_s")][cases.index.size() - 1] =
        7612.0 - 8.0 * x + 6.0 * y;
    cases.metrics[MetricColumn("injection_flight_path_angle_deg")][cases.index.size() - 1] = 0.05 * z;
  }
  return cases;
}

TEST(InjectionSummary, CovarianceAndContainment) {
  CaseColumns cases = Injections(4000);
  cases.outcome[7] = Outcome::kLostControl;  // what it measured counts for nothing
  const auto injection = SummarizeInjection(cases);
  ASSERT_TRUE(injection);
  EXPECT_EQ(injection->scatter.n, 3999u);
  // Four standard errors of variances from 4000 normal values: 9 %.
  EXPECT_NEAR(injection->scatter.covariance[0][0], 25.0, 0.09 * 25.0);
  EXPECT_NEAR(injection->scatter.covariance[0][1], -40.0, 0.09 * 50.0);
  EXPECT_NEAR(injection->scatter.covariance[1][1], 100.0, 0.09 * 100.0);
  ASSERT_EQ(injection->containment.size(), 4u);
  for (const Containment& one : injection->containment)
    EXPECT_NEAR(one.empirical, one.stated, 4.0 * std::sqrt(one.stated * (1.0 - one.stated) / 4000.0));
  const std::string html = InjectionSection(*injection);
  EXPECT_THAT(html, testing::HasSubstr("Joint scatter of 3999 completed flights"));
  EXPECT_THAT(html, testing::ContainsRegex(">-0\\.(79|80)"));  // altitude and velocity: -40 / (5 x 10)
}

TEST(InjectionSummary, OfTooFewFlights) {
  EXPECT_FALSE(SummarizeInjection(Injections(1)));
  const auto few = SummarizeInjection(Injections(4));
  ASSERT_TRUE(few);
  EXPECT_TRUE(few->containment.empty());
  EXPECT_THAT(InjectionSection(*few), testing::HasSubstr("Too few flights"));
}

}  // namespace
}  // namespace dispersa::analysis_injection_test
