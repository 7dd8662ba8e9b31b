// Pairing of cases, and the statements about two campaigns.
#include "core/analysis/comparison.h"

#include <nlohmann/json.hpp>

#include "core/analysis/load_check.h"
#include "core/analysis/requirement_summary.h"
#include "tests/test.h"
#include "tests/unit/comparison_sample.h"

namespace dispersa::analysis_comparison_test {
namespace {

using namespace comparison_sample;
using report_test::MakeCampaign;

constexpr char kMetric[] = "pitch_error_rms_deg";

TEST(ReportComparison, PairsCasesOfEqualIndex) {
  const Comparison comparison = CompareColumns(Columns({0, 1, 2, 3}, {0.1, 0.2, 0.3, 0.4}, {1, 1, 1, 1}),
                                               Columns({0, 2, 3, 5}, {0.1, 0.3, 0.4, 0.6}, {2, 4, 9, 1}));
  EXPECT_TRUE(comparison.pairing.paired);
  EXPECT_EQ(comparison.pairing.shared, 3);
  EXPECT_EQ(comparison.pairing.only_a, 1);
  EXPECT_EQ(comparison.pairing.only_b, 1);
  ASSERT_EQ(comparison.metrics.size(), 1);           // no flight defines another one
  EXPECT_EQ(comparison.metrics[0].difference, 3.0);  // of 1, 3 and 8
  EXPECT_EQ(comparison.metrics[0].ratio, 4.0);
  EXPECT_EQ(comparison.metrics[0].a_better, 3);
  EXPECT_EQ(comparison.pairing.sentence,
            "Paired: every input has the same value in both campaigns in all of 3 cases shared. 1 case of A "
            "and 1 case of B have no partner "
            "and are left out.");
}

TEST(ReportComparison, OtherDrawsAreUnpaired) {
  const Comparison comparison = CompareColumns(Columns({0, 1, 2}, {0.1, 0.2, 0.3}, {1, 2, 3}),
                                               Columns({0, 1, 2}, {0.4, 0.5, 0.6}, {2, 4, 6}));
  EXPECT_FALSE(comparison.pairing.paired);
  EXPECT_THAT(comparison.pairing.sentence, StartsWith("Unpaired: no input that varies has the same value"));
  EXPECT_EQ(comparison.metrics[0].difference, 2.0);  // of the medians
  EXPECT_EQ(comparison.metrics[0].n_a, 3);
  EXPECT_THAT(comparison.harmed, IsEmpty());
  const auto json = nlohmann::json::parse(ComparisonJson(comparison));
  EXPECT_EQ(json["metrics"][0]["pairing"], "unpaired");
  EXPECT_TRUE(json["metrics"][0]["pairs"].is_null());
}

TEST(ReportComparison, AChangedInputIsListedAndTheOthersStillPair) {
  CaseColumns a = Columns({0, 1, 2}, {0.1, 0.2, 0.3}, {1, 2, 3});
  CaseColumns b = Columns({0, 1, 2}, {0.1, 0.2, 0.3}, {1, 2, 3});
  a.inputs[1] = std::vector<double>{1, 2, 3};
  b.inputs[1] = std::vector<double>{1, 4, 6};
  const Pairing pairing = CompareColumns(a, b).pairing;
  EXPECT_TRUE(pairing.paired);
  ASSERT_EQ(pairing.changed.size(), 1);
  EXPECT_EQ(pairing.changed[0].input, InputColumns()[1].name);
  EXPECT_EQ(pairing.changed[0].cases, 2);
  EXPECT_THAT(pairing.same, ElementsAre(InputColumns()[0].name));
  // A constant is equal without any draw.
  a.inputs[0] = b.inputs[0] = std::vector<double>{5, 5, 5};
  EXPECT_FALSE(CompareColumns(a, b).pairing.paired);
}

TEST(ReportComparison, LostFlightsAreWorseThanAnyAndTheLargestChangesComeFirst) {
  CaseColumns a = Columns({0, 1, 2, 3, 4}, {1, 2, 3, 4, 5}, {1.0, 1.0, 1.0, 1.0, 1.0});
  CaseColumns b = Columns({0, 1, 2, 3, 4}, {1, 2, 3, 4, 5}, {0.9, 1.1, 0.5, 0.7, 0.1});
  a.outcome[3] = Outcome::kLostControl;  // infinitely bad: b gains most there
  b.outcome[4] = Outcome::kLostControl;  // what it measured before it was lost counts for nothing
  const Comparison comparison = CompareColumns(a, b);
  const MetricComparison& metric = comparison.metrics[0];
  std::vector<std::uint64_t> gains, losses;
  for (const auto& pair : metric.gains) gains.push_back(pair.case_index);
  for (const auto& pair : metric.losses) losses.push_back(pair.case_index);
  EXPECT_THAT(gains, ElementsAre(3, 2, 0));
  EXPECT_THAT(losses, ElementsAre(4, 1));
  EXPECT_EQ(metric.lost_a, 1);
  EXPECT_EQ(metric.lost_b, 1);
  ASSERT_EQ(comparison.harmed.size(), 1);
  EXPECT_EQ(comparison.harmed[0].case_index, 4);
  EXPECT_EQ(comparison.harmed[0].reasons[0].requirement, "flight completed");
  ASSERT_EQ(comparison.rescued.size(), 1);
  EXPECT_EQ(comparison.rescued[0].case_index, 3);
}

TEST(ReportComparison, TheBadSideIsThatOfTheMetric) {
  // Of the perigee less is worse; b loses a flight, which is as if its perigee were below all.
  CaseColumns a = Columns({0, 1, 2}, {1, 2, 3}, {480, 490, 500}, "perigee_km");
  CaseColumns b = Columns({0, 1, 2}, {1, 2, 3}, {485, 495, 505}, "perigee_km");
  EXPECT_EQ(CompareColumns(a, b).metrics[0].b_better, 3);
  EXPECT_EQ(CompareColumns(a, b).metrics[0].difference, 5.0);
  EXPECT_EQ(CompareColumns(a, b).metrics[0].tails[0].name, "p05");
  b.outcome[2] = Outcome::kImpact;
  EXPECT_EQ(CompareColumns(a, b).metrics[0].a_better, 1);
  EXPECT_EQ(CompareColumns(a, b).metrics[0].losses[0].case_index, 2);
  // Of an error's sign nothing is said.
  const Comparison errors = CompareColumns(Columns({0, 1}, {1, 2}, {-3, 1}, "injection_altitude_error_km"),
                                           Columns({0, 1}, {1, 2}, {2, 0}, "injection_altitude_error_km"));
  EXPECT_EQ(errors.metrics[0].b_better, 2);
  // Of the altitude neither is good, and a lost flight has none.
  const Comparison neither = CompareColumns(Columns({0, 1}, {1, 2}, {500, 501}, "injection_altitude_km"),
                                            Columns({0, 1}, {1, 2}, {502, 503}, "injection_altitude_km"));
  EXPECT_EQ(neither.metrics[0].difference, 2.0);
  EXPECT_NE(neither.metrics[0].finding, "worse");
}

TEST(ReportComparison, RequirementsAreCountedPairByPair) {
  // Limit 1: fails in a: cases 0, 1, 2; in b: cases 2, 3 and the lost 4.
  CaseColumns a = Columns({0, 1, 2, 3, 4, 5}, {1, 2, 3, 4, 5, 6}, {2, 2, 2, 0, 0, 0});
  CaseColumns b = Columns({0, 1, 2, 3, 4, 5}, {1, 2, 3, 4, 5, 6}, {0, 0, 3, 4, 0, 0});
  b.outcome[4] = Outcome::kTimeout;
  Requirement requirement;
  requirement.metric = kMetric;
  requirement.below = 1.0;
  requirement.probability = 0.9;
  requirement.consumer_risk = 0.1;
  const Comparison comparison = CompareColumns(a, b, {requirement});
  ASSERT_EQ(comparison.requirements.size(), 1);
  const RequirementComparison& counted = comparison.requirements[0];
  EXPECT_EQ(counted.words, "pitch_error_rms_deg below 1");
  EXPECT_TRUE(counted.in_a);
  EXPECT_FALSE(counted.in_b);
  EXPECT_EQ(counted.both_fail, 1);
  EXPECT_EQ(counted.only_a_fails, 2);
  EXPECT_EQ(counted.only_b_fails, 2);
  EXPECT_EQ(counted.both_meet, 1);
  EXPECT_EQ(counted.p, 1.0);
  const auto json = nlohmann::json::parse(ComparisonJson(comparison));
  EXPECT_EQ(json["schema"], "dispersa/compare/1");
  EXPECT_EQ(json["requirements"][0]["mcnemar"]["only_b_fails"], 2);
  std::vector<int> harmed, rescued;
  for (const auto& one : json["harmed"]) harmed.push_back(one["case_index"]);
  for (const auto& one : json["rescued"]) rescued.push_back(one["case_index"]);
  EXPECT_THAT(harmed, ElementsAre(3, 4));
  EXPECT_THAT(rescued, ElementsAre(0, 1));
  EXPECT_EQ(json["harmed"][1]["requirements"].size(), 2);  // the flight, and what it required
  EXPECT_EQ(json["harmed"][0]["replay_b"], "dispersa replay B --case 3");
  const std::string page = ComparisonPage(comparison, a, b);
  EXPECT_THAT(page, AllOf(HasSubstr("dispersa replay A --case 4"), HasSubstr("timeout"),
                          Not(HasSubstr("nan")), Not(HasSubstr("src="))));
}

/// 60 pairs of which B breaks the limit in all and A in none.
Comparison Worse(CaseColumns& a, CaseColumns& b) {
  std::vector<std::uint64_t> index;
  std::vector<double> input, low, high;
  for (std::uint64_t i = 0; i < 60; ++i) {
    index.push_back(i);
    input.push_back(0.1 * static_cast<double>(i));
    low.push_back(0.5 + 0.001 * static_cast<double>(i));
    high.push_back(2.0 + 0.002 * static_cast<double>(i));
  }
  a = Columns(index, input, low);
  b = Columns(index, input, high);
  for (const char* name :
       {"injection_altitude_km", "injection_altitude_error_km", "pitch_error_rms_stage1_deg"}) {
    a.metrics[MetricColumn(name)] = low;
    b.metrics[MetricColumn(name)] = high;
  }
  Requirement requirement;
  requirement.metric = kMetric;
  requirement.below = 1.0;
  requirement.probability = 0.9;
  requirement.consumer_risk = 0.1;
  return CompareColumns(a, b, {requirement});
}

TEST(ReportComparison, SaysTheResultByRequirementAndCountsEachMetricOnce) {
  CaseColumns a, b;
  const Comparison comparison = Worse(a, b);
  EXPECT_EQ(comparison.finding, "worse");
  EXPECT_EQ(comparison.requirements[0].finding, "worse");
  // Four metrics differ: one is a stage's part of another, and one is the value of which the error is
  // compared.
  EXPECT_EQ(
      comparison.sentence,
      "B is worse in 1 of 1 requirement, pitch_error_rms_deg below 1: broken in 60 of 60 flights of B, in 0 "
      "of 60 of A. The largest change for the worse: injection_altitude_error_km, median 0.53 km in A, 2.06 "
      "km in B: a change by 28.8 times the spread of A. Of 2 metrics, each counted once, B is better in 0, "
      "worse in 2, and differs in "
      "0 that are neither good nor bad. 60 cases harmed by the change from A to B, 0 rescued.");
  const auto json = nlohmann::json::parse(ComparisonJson(comparison));
  EXPECT_EQ(json["finding"], "worse");
  EXPECT_EQ(json["requirements"][0]["finding"], "worse");
}

TEST(ReportComparison, ThePageShowsTheResultBeforeTheDetails) {
  CaseColumns a, b;
  const Comparison comparison = Worse(a, b);
  const std::string page = ComparisonPage(comparison, a, b);
  const std::size_t badge = page.find("<span class=\"badge fail\">B worse</span>");
  const std::size_t row = page.find(
      "Only B breaks it in 60 pairs, only A in 0, both in 0. If A and B were alike, "
      "chance would split the pairs so unevenly with a probability below 1e-15 "
      "(McNemar’s test).");
  const std::size_t cases = page.find("id=\"cases\""), metrics = page.find("id=\"metrics\""),
                    compared = page.find("id=\"compared\"");
  ASSERT_NE(compared, std::string::npos);
  EXPECT_LT(badge, row);
  EXPECT_LT(row, cases);
  EXPECT_LT(cases, metrics);
  EXPECT_LT(metrics, compared) << "ids of the campaigns come last";
  EXPECT_THAT(page, AllOf(HasSubstr("&lt; 1e-15"), Not(HasSubstr("0e+00")), HasSubstr("<main>"),
                          HasSubstr("<dfn>harmed</dfn>"), HasSubstr("40 more rows")));
}

TEST(ReportComparison, ChosenPointsHaveNoLimits) {
  const CaseColumns cases = Columns({0, 1, 2}, {0.1, 0.2, 0.3}, {1, 2, 3});
  const CaseColumns others = Columns({0, 1, 2}, {0.1, 0.2, 0.3}, {2, 4, 6});
  Campaign campaign = MakeCampaign(3);
  campaign.sampling.method = SamplingMethod::kCorners;
  const Comparison comparison =
      Compare({"A", "", campaign, cases}, {"B", "", campaign, others}, {kMetric}, {});
  EXPECT_FALSE(comparison.independent);
  EXPECT_EQ(comparison.metrics[0].difference, 2.0);
  EXPECT_TRUE(std::isnan(comparison.metrics[0].p));
  EXPECT_TRUE(std::isnan(comparison.metrics[0].interval.lower));
  EXPECT_EQ(comparison.metrics[0].finding, "not shown");
}

TEST(ReportComparison, ReplayCommandsSurviveAShell) {
  EXPECT_EQ(ReplayCommand("results/a-1", 3), "dispersa replay results/a-1 --case 3");
  EXPECT_EQ(ReplayCommand("my results/it's", 3), "dispersa replay 'my results/it'\\''s' --case 3");
}

// A metric that one of the laws does not measure is neither better nor worse, and no flight fails it.
TEST(ReportComparison, OfTwoLawsHasTheMetricsOfBoth) {
  const std::vector<double> inputs = {1.0, 2.0, 3.0};
  CaseColumns a = Columns({0, 1, 2}, inputs, {0.1, 0.2, 0.3});
  a.metrics[MetricColumn("rules_fired")] = std::vector{7.0, 8.0, 9.0};
  CaseColumns b = Columns({0, 1, 2}, inputs, {0.2, 0.3, 0.4});
  a.outcome[1] = b.outcome[1] = Outcome::kLostControl;
  Campaign of_a = report_test::MakeCampaign(3), of_b = of_a;
  of_a.requirements = {
      {.metric = "rules_fired", .below = 8.5, .above = {}, .probability = 0.9, .consumer_risk = 0.1}};
  of_b.autopilot.pitch.law = ControlLaw::kPd;
  const Comparison comparison = Compare({"A", "engine", of_a, a}, {"B", "engine", of_b, b}, {}, {});
  for (const MetricComparison& metric : comparison.metrics) EXPECT_NE(metric.metric, "rules_fired");
  ASSERT_EQ(comparison.requirements.size(), 1u);
  EXPECT_EQ(comparison.requirements[0].n_a, 3u);
  EXPECT_EQ(comparison.requirements[0].failures_a, 2u);
  EXPECT_EQ(comparison.requirements[0].n_b, 0u);
  EXPECT_TRUE(std::isnan(comparison.requirements[0].p));
  EXPECT_TRUE(comparison.harmed.empty());
}

std::vector<std::uint64_t> Indices(std::size_t n, std::uint64_t first = 0) {
  std::vector<std::uint64_t> list;
  for (std::size_t i = 0; i < n; ++i) list.push_back(first + i);
  return list;
}
std::vector<double> Ramp(std::size_t n, double from, double step) {
  std::vector<double> list;
  for (std::size_t i = 0; i < n; ++i) list.push_back(from + step * static_cast<double>(i));
  return list;
}

// The median of A is that of a lost flight. A lost flight is worse than any, of which more or less is worse.
TEST(ReportComparison, WhoLosesMostFlightsIsNotTheBetterOne) {
  for (const char* metric : {"pitch_error_rms_deg", "perigee_km"}) {
    SCOPED_TRACE(metric);
    CaseColumns a = Columns(Indices(60), Ramp(60, 0.0, 1.0), Ramp(60, 100.0, 0.5), metric);
    const CaseColumns b = Columns(Indices(60), Ramp(60, 1000.0, 1.0), Ramp(60, 100.2, 0.5), metric);
    for (std::size_t i = 0; i < 58; ++i) a.outcome[i] = Outcome::kLostControl;
    const Comparison comparison = CompareColumns(a, b, {}, {metric});
    ASSERT_FALSE(comparison.pairing.paired);
    EXPECT_TRUE(std::isnan(comparison.metrics[0].median_a));
    EXPECT_EQ(comparison.metrics[0].finding, "better");
    EXPECT_EQ(CompareColumns(b, a, {}, {metric}).metrics[0].finding, "worse");
  }
}

// What the summary counts: the loads of each flight, lost or not, and not the losses.
TEST(ReportComparison, LimitsOfTheVehicleAreCountedAsInTheSummary) {
  constexpr char kLoad[] = "axial_load_max_g";
  // B has not flown A's seventh case, which is beyond the limit, too.
  CaseColumns a = Columns(Indices(7), Ramp(7, 0.0, 1.0), {9.5, 9.5, 8, 8, 8, 8, 9.5}, kLoad);
  CaseColumns b = Columns(Indices(6), Ramp(6, 0.0, 1.0), {8, 8, 8, 8, 8, 9.5}, kLoad);
  a.outcome[1] = a.outcome[2] = a.outcome[3] = Outcome::kLostControl;
  b.outcome[0] = b.outcome[5] = Outcome::kLostControl;
  Campaign campaign = report_test::MakeCampaign(6);
  campaign.vehicle.limits.axial_load_g = 9.0;
  const auto compare = [&] {
    return Compare({"A", "engine", campaign, a}, {"B", "engine", campaign, b}, {kLoad}, {});
  };
  const Comparison comparison = compare();
  EXPECT_THAT(comparison.requirements, IsEmpty());
  ASSERT_EQ(comparison.load_checks.size(), 1u);
  EXPECT_EQ(comparison.load_checks[0].failures_a, 2u);
  EXPECT_EQ(comparison.load_checks[0].failures_b, 1u);
  EXPECT_EQ(CheckLoads(campaign, a)[0].failures, 3);
  EXPECT_EQ(CheckLoads(campaign, b)[0].failures, 1);
  const auto json = nlohmann::json::parse(ComparisonJson(comparison));
  EXPECT_EQ(json["load_checks"],
            nlohmann::json::parse(
                R"([{"metric": "structural_limit_exceeded", "failures_a": 2, "failures_b": 1}])"));
  // Stated by a campaign it is a requirement, which a lost flight fails.
  campaign.requirements = {
      {.metric = kLoad, .below = 9.0, .above = {}, .probability = 0.9973, .consumer_risk = 0.1}};
  const Comparison stated = compare();
  EXPECT_THAT(stated.load_checks, IsEmpty());
  EXPECT_EQ(stated.requirements[0].failures_a, 4u);
  EXPECT_EQ(stated.requirements[0].failures_b, 2u);
}

Requirement RmsBelow(double limit) {
  return {.metric = kMetric, .below = limit, .above = {}, .probability = 0.9, .consumer_risk = 0.1};
}

// Such a metric would come before all others if any change of it were infinitely large.
TEST(ReportComparison, AMetricThatDoesNotSpreadInAIsMeasuredByTheRangeOfBoth) {
  const std::vector<double> zeros(100, 0.0);
  std::vector<double> sometimes = zeros;
  for (std::size_t i = 90; i < 100; ++i) sometimes[i] = 1.0 + static_cast<double>(i - 90);
  const CaseColumns a = Columns(Indices(100), Ramp(100, 0.0, 1.0), zeros);
  const CaseColumns b = Columns(Indices(100), Ramp(100, 0.0, 1.0), sometimes);
  const Campaign campaign = MakeCampaign(100);
  for (const bool turned : {false, true}) {
    const Comparison comparison = Compare({"A", "engine", campaign, turned ? b : a},
                                          {"B", "engine", campaign, turned ? a : b}, {kMetric}, {}, 0.01);
    const MetricComparison& metric = comparison.metrics[0];
    EXPECT_EQ(metric.finding, turned ? "better" : "worse");
    EXPECT_EQ(metric.scale_of, turned ? "spread" : "range");
    if (turned) continue;
    EXPECT_EQ(metric.scale, 10.0);
    EXPECT_GT(metric.effect, 0.4);
    EXPECT_LE(metric.effect, 1.0);
  }
}

// Certain, since all pairs agree; whether it matters is another question.
TEST(ReportComparison, ADifferenceCanBeTooSmallToMatter) {
  const CaseColumns a = Columns(Indices(100), Ramp(100, 0.0, 1.0), Ramp(100, 0.2, 0.001));
  struct Case {
    double shift;
    std::vector<Requirement> requirements;
    double share;
    const char* finding;
    double least;
  };
  // The spread from 5 to 95 % of 0.200 to 0.299 is 0.0891.
  const Case cases[] = {{0.0008, {}, 0.01, kTooSmall, 0.000891},
                        {-0.0008, {}, 0.01, kTooSmall, 0.000891},
                        {0.0009, {}, 0.01, "worse", 0.000891},
                        {-0.0009, {}, 0.01, "better", 0.000891},
                        {0.004, {RmsBelow(0.5)}, 0.01, kTooSmall, 0.005},
                        {0.006, {RmsBelow(0.5)}, 0.01, "worse", 0.005},
                        {0.006, {RmsBelow(0.5)}, 0.02, kTooSmall, 0.01},
                        {0.0008, {}, 0.0, "worse", 0.0}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.shift);
    const CaseColumns b = Columns(Indices(100), Ramp(100, 0.0, 1.0), Ramp(100, 0.2 + one.shift, 0.001));
    Campaign of_a = MakeCampaign(100);
    const Campaign of_b = MakeCampaign(100);
    of_a.requirements = one.requirements;
    const Comparison comparison =
        Compare({"A", "engine", of_a, a}, {"B", "engine", of_b, b}, {kMetric}, {}, one.share);
    EXPECT_EQ(comparison.metrics[0].finding, one.finding);
    EXPECT_NEAR(comparison.practical_share * comparison.metrics[0].scale, one.least, 1e-12);
    EXPECT_EQ(comparison.metrics[0].scale_of, one.requirements.empty() ? "spread" : "limit");
    EXPECT_EQ(nlohmann::json::parse(ComparisonJson(comparison))["practical_share"], one.share);
    const bool small = one.finding == std::string(kTooSmall);
    EXPECT_EQ(comparison.sentence.find("In 1 the difference is certain but too small to matter: less than") !=
                  std::string::npos,
              small);
    const std::string page = ComparisonPage(comparison, a, b);
    EXPECT_EQ(page.find(">certain but too small to matter<") != std::string::npos, small);
  }
  // Equal medians and percentiles say nothing of the flights that B loses: the six of the largest values in
  // A.
  CaseColumns lost = a;
  for (std::size_t i = 94; i < 100; ++i) lost.outcome[i] = Outcome::kTimeout;
  EXPECT_EQ(CompareColumns(a, lost).metrics[0].finding, "worse");
}

TEST(ReportComparison, OfEqualNamesTheFoldersAndWhatDiffersAreNamed) {
  const CaseColumns cases = Columns({0, 1, 2}, {0.1, 0.2, 0.3}, {1, 2, 3});
  Campaign alpha = MakeCampaign(3);
  alpha.name = "alpha";
  const std::vector<CampaignChange> changes = {{"vehicle.stages[0].thrust_n", "1", "2"},
                                               {"vehicle.name", "x", "y"},
                                               {"dispersions.wind.max_speed_m_s", "3", "4"},
                                               {"requirements[0].below", "5", "6"}};
  const Comparison same =
      Compare({"old", "engine", alpha, cases}, {"new", "engine", alpha, cases}, {kMetric}, changes);
  const std::string page = ComparisonPage(same, cases, cases);
  EXPECT_LT(page.find(">requirements[0].<wbr>below"), page.find(">vehicle.<wbr>stages[0]"));
  EXPECT_THAT(page, HasSubstr("<h1>new against old</h1>"));
  EXPECT_THAT(page, HasSubstr("The campaign files differ in vehicle (2 values), dispersions (1 value) and "
                              "requirements (1 value).<br>"));
  Campaign beta = alpha;
  beta.name = "beta";
  const Comparison other =
      Compare({"old", "engine", alpha, cases}, {"new", "engine", beta, cases}, {kMetric}, {});
  EXPECT_THAT(ComparisonPage(other, cases, cases),
              AllOf(HasSubstr("<h1>new against old</h1>"), HasSubstr("B: <b>new</b>, campaign beta")));
  // The last part of a path is enough, unless both have the same.
  const auto title = [&](const char* a, const char* b) {
    const Comparison of = Compare({a, "", alpha, cases}, {b, "", alpha, cases}, {kMetric}, {});
    return SideTitle(of, of.b);
  };
  EXPECT_EQ(title("x/old", "x/new/"), "new");
  EXPECT_EQ(title("x/run", "y/run"), "y/run");
  EXPECT_EQ(title("old", "."), ".");
}

// Before all tables, and each side its own.
TEST(ReportComparison, ALostNominalFlightIsSaidOfItsSide) {
  const CaseColumns cases = Columns({0, 1, 2}, {0.1, 0.2, 0.3}, {1, 2, 3});
  for (const bool of_a : {true, false}) {
    Comparison lost = CompareColumns(cases, cases, {}, {kMetric});
    (of_a ? lost.a : lost.b).nominal_loss = "The nominal flight itself is lost: impact at 9.37 s in stage 1.";
    const std::string page = ComparisonPage(lost, cases, cases), letter = of_a ? "A" : "B";
    EXPECT_LT(page.find("<li>" + letter + ": The nominal flight itself is lost"), page.find("<table"));
    const auto json = nlohmann::json::parse(ComparisonJson(lost));
    EXPECT_EQ(json[of_a ? "a" : "b"]["nominal_loss"], (of_a ? lost.a : lost.b).nominal_loss);
    EXPECT_TRUE(json[of_a ? "b" : "a"]["nominal_loss"].is_null());
  }
}

// B minus A is the short way around the circle, from either side.
TEST(ReportComparison, LongitudesAreComparedAcrossTheCut) {
  constexpr char kLongitude[] = "impact_longitude_deg";
  for (const double sign : {1.0, -1.0}) {
    SCOPED_TRACE(sign);
    std::vector<double> of_a, of_b;
    for (int i = 0; i < 40; ++i) {
      of_a.push_back(NearTo(0.0, sign * (179.98 + 0.002 * i), kCutAt180Deg));
      of_b.push_back(NearTo(0.0, sign * (180.02 + 0.002 * i), kCutAt180Deg));
    }
    const CaseColumns a = Columns(Indices(40), Ramp(40, 0.0, 1.0), of_a, kLongitude);
    const CaseColumns b = Columns(Indices(40), Ramp(40, 0.0, 1.0), of_b, kLongitude);
    const CaseColumns other = Columns(Indices(40), Ramp(40, 99.0, 1.0), of_b, kLongitude);
    for (const CaseColumns* against : {&b, &other}) {
      const Requirement above{
          .metric = kLongitude, .below = {}, .above = sign * 179.9, .probability = 0.9, .consumer_risk = 0.1};
      const Comparison comparison = CompareColumns(a, *against, {above}, {kLongitude});
      EXPECT_EQ(comparison.metrics[0].finding, "differs") << "1 % of 179.9 degrees is no small difference";
      EXPECT_EQ(comparison.pairing.paired, against == &b);
      EXPECT_NEAR(comparison.metrics[0].difference, sign * 0.04, 1e-9);
      for (const PercentileComparison& tail : comparison.metrics[0].tails)
        EXPECT_TRUE(std::isnan(tail.difference) || std::fabs(tail.difference - sign * 0.04) < 1e-9);
    }
  }
}

// The values that stand beside an axis or a name of magnitudes are magnitudes.
TEST(ReportComparison, MagnitudesAreShownAsSuch) {
  constexpr char kError[] = "injection_altitude_error_km";
  const CaseColumns a = Columns(Indices(4), Ramp(4, 0.0, 1.0), {-3, 2, -1, 4}, kError);
  const CaseColumns b = Columns(Indices(4), Ramp(4, 0.0, 1.0), {1, -2.5, 2, -5}, kError);
  const ComparedValues values = ValuesToCompare(a, b, kError);
  EXPECT_THAT(values.a, ElementsAre(3, 2, 1, 4));
  EXPECT_THAT(values.b, ElementsAre(1, 2.5, 2, 5));
  const std::string page = ComparisonPage(CompareColumns(a, b, {}, {kError}), a, b);
  const std::size_t chart = page.find("aria-label=\"B against A, pair by pair");
  ASSERT_NE(chart, std::string::npos);
  EXPECT_THAT(page.substr(chart, page.find("</figure>", chart) - chart),
              AllOf(HasSubstr(", magnitude, km"), Not(HasSubstr(">-"))));
}

}  // namespace
}  // namespace dispersa::analysis_comparison_test
