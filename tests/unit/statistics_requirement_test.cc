#include "core/statistics/requirement.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/random/draws.h"
#include "core/statistics/order_statistics.h"

namespace dispersa {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr ProbabilityRequirement kPitch = {
    .side = Side::kBelow, .limit = 0.5, .probability = 0.9973, .consumer_risk = 0.10};

TEST(CountFailures, CountsLimitsAndLostFlights) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> values = {0.1, 0.5, 0.7, kNaN, infinity, -infinity, -1.0};
  EXPECT_EQ(CountFailures(kPitch, values), 5);  // the limit itself is not below it
  ProbabilityRequirement above = kPitch;
  above.side = Side::kAbove;
  EXPECT_EQ(CountFailures(above, values), 6);
}

TEST(Evaluate, PassesFromTheTablesNumberOn) {
  const std::int64_t needed[] = {852, 1440, 1970, 2473};
  for (std::int64_t failures = 0; failures < 4; ++failures) {
    const RequirementResult one_less = Evaluate(kPitch, needed[failures] - 1, failures);
    EXPECT_EQ(one_less.verdict, Verdict::kInconclusive);
    EXPECT_EQ(one_less.cases_needed, needed[failures]);
    EXPECT_LT(one_less.success_lower, kPitch.probability);
    const RequirementResult enough = Evaluate(kPitch, needed[failures], failures);
    EXPECT_EQ(enough.verdict, Verdict::kPass);
    EXPECT_EQ(enough.cases_needed, std::nullopt);
    EXPECT_GE(enough.success_lower, kPitch.probability);
  }
}

TEST(Evaluate, FailsWhenTheUpperLimitFallsShort) {
  // 2000 cases at 99.73 % have 5.4 failures on average; P(at least 9) = 0.0971, P(at least 8) = 0.178.
  const RequirementResult eight = Evaluate(kPitch, 2000, 8);
  EXPECT_EQ(eight.verdict, Verdict::kInconclusive);
  EXPECT_GT(eight.success_upper, kPitch.probability);
  EXPECT_EQ(eight.cases_needed, CasesNeeded(0.9973, 0.10, 8));
  const RequirementResult nine = Evaluate(kPitch, 2000, 9);
  EXPECT_EQ(nine.verdict, Verdict::kFail);
  EXPECT_LE(nine.success_upper, kPitch.probability);
  EXPECT_EQ(nine.cases_needed, std::nullopt);
}

TEST(Evaluate, NoCasesAreInconclusive) {
  const RequirementResult none = Evaluate(kPitch, 0, 0);
  EXPECT_EQ(none.verdict, Verdict::kInconclusive);
  EXPECT_EQ(none.cases_needed, 852);
  EXPECT_EQ(none.success_lower, 0.0);
  EXPECT_EQ(none.success_upper, 1.0);
}

TEST(Evaluate, CountsLostFlightsInValues) {
  std::vector<double> values(1439, 0.2);
  values.push_back(kNaN);
  const RequirementResult one_lost = Evaluate(kPitch, values);
  EXPECT_EQ(one_lost.n, 1440);
  EXPECT_EQ(one_lost.failures, 1);
  EXPECT_EQ(one_lost.verdict, Verdict::kPass);
  values.push_back(kNaN);
  EXPECT_EQ(Evaluate(kPitch, values).verdict, Verdict::kInconclusive);
}

// A case without a result could have gone either way: it can open a verdict, never decide one.
TEST(Evaluate, MissingCasesAreBounded) {
  EXPECT_EQ(Evaluate(kPitch, 1000, 0).verdict, Verdict::kPass);
  const RequirementResult open = Evaluate(kPitch, 1000, 0, 1);
  EXPECT_EQ(open.verdict, Verdict::kInconclusive);
  EXPECT_EQ(open.missing, 1);
  EXPECT_EQ(open.cases_needed, 1440);
  EXPECT_EQ(Evaluate(kPitch, 1439, 0, 1).verdict, Verdict::kPass);
  EXPECT_EQ(Evaluate(kPitch, 2000, 9).verdict, Verdict::kFail);
  EXPECT_EQ(Evaluate(kPitch, 2000, 9, 500).verdict, Verdict::kInconclusive);
}

// The two risks are what they are called: a design exactly at the requirement passes, and fails, at most
// 10 % of the time.
TEST(Evaluate, ErrsNoMoreOftenThanItsRisk) {
  constexpr int kCampaigns = 2000;
  constexpr int kCases = 400;
  const ProbabilityRequirement requirement = {
      .side = Side::kBelow, .limit = 0.97, .probability = 0.97, .consumer_risk = 0.10};
  int passed = 0;
  int failed = 0;
  for (int campaign = 0; campaign < kCampaigns; ++campaign) {
    Stream stream(20260101, static_cast<std::uint64_t>(campaign), "metric");
    std::vector<double> values;
    for (int i = 0; i < kCases; ++i) values.push_back(stream.Uniform());
    const Verdict verdict = Evaluate(requirement, values).verdict;
    passed += verdict == Verdict::kPass;
    failed += verdict == Verdict::kFail;
  }
  // Exactly: P(at most 7 of 400 failures) and P(at least 17); four standard errors (fixed seeds).
  const std::int64_t most = MaxFailures(0.97, 0.10, kCases).value();
  const double pass_rate = ConsumerRisk(0.97, kCases, most);
  std::int64_t least = most;
  while (ProducerRisk(0.97, kCases, least) > 0.10) ++least;
  const double fail_rate = ProducerRisk(0.97, kCases, least);
  EXPECT_LE(pass_rate, 0.10);
  EXPECT_LE(fail_rate, 0.10);
  EXPECT_NEAR(passed / double{kCampaigns}, pass_rate, 0.027);
  EXPECT_NEAR(failed / double{kCampaigns}, fail_rate, 0.027);
}

}  // namespace
}  // namespace dispersa
