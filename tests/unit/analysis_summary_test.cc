// The numbers of summary.json against numbers worked out by hand.
#include "core/analysis/campaign_summary.h"

#include "core/analysis/junit.h"
#include "core/analysis/load_check.h"
#include "core/analysis/stopping_rule.h"
#include "core/flight/engine_version.h"
#include "tests/json_holds.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_summary_test {

using namespace report_test;

/// n completed cases whose peak is 0.1, but for the first `failures`, whose peak is 0.9.
CaseColumns Columns(std::size_t n, std::size_t failures) {
  CaseColumns cases;
  cases.inputs.resize(InputCount(kUsualStages));
  cases.metrics.resize(MetricCount(kUsualStages));
  for (std::size_t i = 0; i < n; ++i) {
    cases.index.push_back(i);
    cases.outcome.push_back(Outcome::kCompleted);
    cases.metrics[MetricColumn(kPeak)].push_back(i < failures ? 0.9 : 0.1);
  }
  return cases;
}

Requirement Peak(std::optional<double> above, std::optional<std::array<double, 2>> within,
                 double probability) {
  Requirement requirement = PeakBelow(0.0, probability, 0.1);
  requirement.below.reset();
  requirement.above = above;
  requirement.within = within;
  return requirement;
}

/// Of independent cases.
RequirementSummary Judged(const Requirement& requirement, const CaseColumns& cases,
                          std::int64_t missing = 0) {
  return Judge(requirement, SamplingMethod::kMonteCarlo, cases, missing);
}

TEST(Judge, NeedsTheCasesOfTheExactBinomial) {
  // 99.73 % at 10 % consumer risk: 852 cases without a failure, 1440 with one (0.9973^852 = 0.0999).
  const Requirement requirement = PeakBelow(0.5, 0.9973, 0.10);
  const RequirementSummary enough = Judged(requirement, Columns(852, 0));
  EXPECT_EQ(enough.verdict, "pass");
  EXPECT_FALSE(enough.cases_needed.has_value());
  EXPECT_NEAR(*enough.success_lower, std::pow(0.10, 1.0 / 852), 1e-12);  // Clopper-Pearson without a failure
  EXPECT_EQ(enough.sentence,
            "0 of 852 flights broke the limit. With 90 % confidence at least 99.7301 % of flights meet it; "
            "99.73 % required.");

  const RequirementSummary one_less = Judged(requirement, Columns(851, 0));
  EXPECT_EQ(one_less.verdict, "inconclusive");
  EXPECT_EQ(one_less.cases_needed, 852);

  const RequirementSummary one_failure = Judged(requirement, Columns(852, 1));
  EXPECT_EQ(one_failure.verdict, "inconclusive");
  EXPECT_EQ(one_failure.failures, 1);
  EXPECT_EQ(one_failure.cases_needed, 1440);

  // Ten failures in 200 cases: a design with 99.73 % would show so many with a probability below 1e-9.
  const RequirementSummary failed = Judged(requirement, Columns(200, 10));
  EXPECT_EQ(failed.verdict, "fail");
}

TEST(Judge, SaysWhyNothingIsDecided) {
  // 200 cases without a failure: 0.1^(1/200) = 0.98855.
  const RequirementSummary open = Judged(PeakBelow(0.5, 0.9973, 0.10), Columns(200, 0));
  EXPECT_EQ(open.sentence,
            "0 of 200 flights broke the limit. Between 98.85 % and 100 % of flights meet it, each bound with "
            "90 % confidence; 99.73 % required.");
  EXPECT_EQ(
      AdviceSentence(open),
      " A new campaign can pass with 852 flights or more. By what was seen here, a campaign of 6816 flights "
      "passes with a probability of 61 %. This one, extended, needs 1104 flights in all with no "
      "further failure (any-time rule).");
  // One flight says next to nothing, and so does the advice.
  EXPECT_THAT(AdviceSentence(Judged(PeakBelow(0.5, 0.9973, 0.10), Columns(1, 0))),
              HasSubstr("passes with a probability of 5.51 %"));
}

TEST(Judge, SaysInOneSentenceWhatTheBoundMeans) {
  CaseColumns cases = Columns(2000, 0);
  for (std::size_t i = 0; i < 2000; ++i)
    cases.metrics[MetricColumn(kPeak)][i] = 0.1 + 1e-4 * static_cast<double>(i);  // bound 0.2997
  const auto sentence = [&](double limit) {
    return BoundSentence(Judged(PeakBelow(limit, 0.9973, 0.10), cases), "°");
  };
  EXPECT_EQ(sentence(0.5), "With 90 % confidence 99.73 % of flights stay below 0.3 ° (limit 0.5 °).");
  // Rounded up so that it holds, but never over the limit that it keeps to.
  EXPECT_EQ(sentence(0.3), "With 90 % confidence 99.73 % of flights stay below 0.2997 ° (limit 0.3 °).");
  EXPECT_EQ(BoundSentence(Judged(PeakBelow(0.5, 0.9973, 0.10), Columns(9, 0)), "°"), "");
}

TEST(Judge, BoundsTheMetricByTheOrderStatisticThatDecides) {
  // 2000 cases allow 2 failures: the third largest value is the bound.
  CaseColumns cases = Columns(2000, 0);
  for (std::size_t i = 0; i < 2000; ++i)
    cases.metrics[MetricColumn(kPeak)][i] = 0.1 + 1e-4 * static_cast<double>(i);
  const Requirement requirement = PeakBelow(0.5, 0.9973, 0.10);
  const RequirementSummary summary = Judged(requirement, cases);
  EXPECT_DOUBLE_EQ(*summary.bound, 0.1 + 1e-4 * 1997);
  EXPECT_DOUBLE_EQ(*summary.margin, 0.5 - (0.1 + 1e-4 * 1997));
  EXPECT_EQ(summary.verdict, "pass");
  // The requirement passes exactly when the bound keeps to the limit.
  EXPECT_EQ(Judged(PeakBelow(*summary.bound, 0.9973, 0.10), cases).verdict, "inconclusive");
  // Two lost flights are worse than any value; a third leaves no bound.
  cases.outcome[0] = cases.outcome[1] = Outcome::kLostControl;
  EXPECT_DOUBLE_EQ(*Judged(requirement, cases).bound, 0.1 + 1e-4 * 1999);
  cases.outcome[2] = Outcome::kImpact;
  EXPECT_FALSE(Judged(requirement, cases).bound.has_value());
  EXPECT_FALSE(Judged(requirement, Columns(851, 0)).bound.has_value());
  // From below, and from both sides.
  CaseColumns ascending = Columns(852, 0);
  for (std::size_t i = 0; i < 852; ++i)
    ascending.metrics[MetricColumn(kPeak)][i] = 1.0 + static_cast<double>(i);
  EXPECT_EQ(Judged(Peak(0.0, {}, 0.9973), ascending).bound, 1.0);
  const RequirementSummary inside = Judged(Peak({}, {{-10.0, 900.0}}, 0.9973), ascending);
  EXPECT_EQ(inside.bound, 1.0);  // 11 from -10, nearer than 852 to 900
  EXPECT_EQ(inside.margin, 11.0);
  EXPECT_EQ(inside.failures, 0);
  EXPECT_EQ(LimitWords(inside, "km"), "between -10 and 900 km");
}

// 2000 cases allow 2 failures. Each case without a result may be one, so that the bound moves towards the
// worst value.
TEST(Judge, AMissingCaseIsWorseThanTheBound) {
  const Requirement requirement = PeakBelow(0.5, 0.9973, 0.10);
  const std::vector<double> bounds = {1997.0, 1998.0, 1999.0};
  for (std::size_t missing = 0; missing < 4; ++missing) {
    CaseColumns cases = Columns(2000 - missing, 0);
    for (std::size_t i = 0; i < cases.rows(); ++i)
      cases.metrics[MetricColumn(kPeak)][i] = 1e-4 * static_cast<double>(i + missing);
    const RequirementSummary summary = Judged(requirement, cases, static_cast<std::int64_t>(missing));
    ASSERT_EQ(summary.bound.has_value(), missing < 3) << missing;
    if (missing == 3) continue;  // as many as a third failure: no value is a bound
    EXPECT_DOUBLE_EQ(*summary.bound, 1e-4 * bounds[missing]);
    EXPECT_DOUBLE_EQ(*summary.margin, 0.5 - 1e-4 * bounds[missing]);
  }
}

TEST(Judge, CountsALostFlightWhateverItMeasured) {
  CaseColumns cases = Columns(100, 0);
  cases.outcome[3] = Outcome::kLostControl;
  cases.outcome[4] = Outcome::kImpact;
  cases.metrics[MetricColumn(kPeak)][7] = kNaN;
  const RequirementSummary summary = Judged(PeakBelow(0.5, 0.9, 0.10), cases);
  EXPECT_EQ(summary.n, 100);
  EXPECT_EQ(summary.failures, 3);
  EXPECT_EQ(summary.lost_flights, 2);
}

TEST(Judge, SaysWhatAPlanDecidedWithoutWiderBounds) {
  Requirement requirement = PeakBelow(0.5, 0.9973, 0.10);
  requirement.plan = {PlanKind::kGroupSequential, 5, Spending::kOBrienFleming};
  const RequirementSummary met = Judged(requirement, Columns(5000, 8));
  // The first 8 cases failed: too few to fail early, few enough to pass at the end.
  EXPECT_EQ(met.sentence,
            "8 of 5000 flights broke the limit. That is few enough by its plan (judged 5 times up to 5000 "
            "flights) at a risk of 10 %; 99.73 % required.");
  EXPECT_EQ(met.looks[0].verdict, Verdict::kInconclusive);
  CaseColumns late = Columns(5000, 0);
  for (std::size_t i = 4000; i < 4008; ++i) late.metrics[MetricColumn(kPeak)][i] = 0.9;
  const RequirementSummary early = Judged(requirement, late);
  EXPECT_EQ(early.verdict, "pass");
  EXPECT_EQ(early.accepts, 8);
  EXPECT_EQ(early.looks[1].verdict, Verdict::kPass);
  EXPECT_EQ(
      early.sentence,
      "8 of 5000 flights broke the limit. That is few enough by its plan (judged 5 times up to 5000 flights) "
      "at a risk of 10 %; 99.73 % required. The look after 2000 flights decided, with 0 failures.");
}

TEST(Judge, TakesRowsOfWhateverNumbers) {
  CaseColumns some = Columns(852, 0);
  for (std::size_t i = 0; i < 852; ++i) some.index[i] = 7 * i + 3;
  EXPECT_EQ(Judged(PeakBelow(0.5, 0.9973, 0.10), some).verdict, "pass");
}

TEST(Judge, TheLimitItselfFails) { EXPECT_EQ(Judged(PeakBelow(0.1, 0.9, 0.1), Columns(10, 0)).failures, 10); }

TEST(Judge, LooksAboveToo) {
  const RequirementSummary summary = Judged(Peak(0.5, {}, 0.5), Columns(10, 4));
  EXPECT_FALSE(summary.below);
  EXPECT_EQ(summary.failures, 6);  // those at 0.1
}

TEST(Judge, MissingCasesCountAgainstEitherVerdict) {
  // 852 successes pass, but not beside 100 cases of which nothing is known.
  EXPECT_EQ(Judged(PeakBelow(0.5, 0.9973, 0.10), Columns(852, 0), 100).verdict, "inconclusive");
  // 3 failures of 20 fail 99 %, but not if 2000 more might all have been successes.
  EXPECT_EQ(Judged(PeakBelow(0.5, 0.99, 0.10), Columns(20, 3)).verdict, "fail");
  EXPECT_EQ(Judged(PeakBelow(0.5, 0.99, 0.10), Columns(20, 3), 2000).verdict, "inconclusive");
}

TEST(Judge, GivesAChosenDesignNoVerdict) {
  for (const std::size_t violated : {0, 1, 500}) {
    for (const SamplingMethod method :
         {SamplingMethod::kCorners, SamplingMethod::kOneAtATime, SamplingMethod::kGrid, SamplingMethod::kList,
          SamplingMethod::kSobol, SamplingMethod::kLatinHypercube}) {
      const RequirementSummary study = Judge(PeakBelow(0.5, 0.95, 0.10), method, Columns(1000, violated), 0);
      EXPECT_EQ(study.verdict, "study");
      EXPECT_FALSE(study.success_lower.has_value());
      EXPECT_FALSE(study.cases_needed.has_value());
      EXPECT_FALSE(study.bound.has_value());
      EXPECT_TRUE(study.looks.empty());
    }
  }
  EXPECT_EQ(Judge(PeakBelow(0.5, 0.95, 0.10), SamplingMethod::kCorners, Columns(16, 1), 0).sentence,
            "Design study: 15 of 16 points meet the limit. The points are chosen, not drawn independently: "
            "this says nothing about the probability in flight.");
}

TEST(Judge, ReplicatesOfADesignGiveBounds) {
  JudgingContext context;
  context.method = SamplingMethod::kLatinHypercube;
  context.cases = 1000;
  context.planned = 1000;
  context.replicates = 10;
  const RequirementSummary study = JudgeAll({PeakBelow(0.5, 0.95, 0.10)}, context, Columns(1000, 20))[0];
  EXPECT_EQ(study.verdict, "study");
  // Shares 0.2 and nine times 0: mean 0.02, standard error 0.02, t of 9 degrees at 10 % 1.3830.
  EXPECT_NEAR(*study.success_lower, 1.0 - (0.02 + 1.38303 * 0.02), 1e-6);
  EXPECT_NEAR(*study.success_upper, 1.0, 1e-6);
}

/// Five cases, peaks 1 2 3 4 of the completed ones; case 2 is lost.
class FiveCases : public testing::Test {
 protected:
  FiveCases() : campaign_(MakeCampaign(5)), folder_(ResultFolder::Create(temporary_ / "out", campaign_)) {
    const double peaks[] = {2.0, 4.0, 0.5, 1.0, 3.0};
    std::vector<CaseResult> results;
    for (std::uint64_t k = 0; k < 5; ++k) {
      CaseResult result = MakeCase(k);
      result.metrics[MetricColumn(kPeak)] = peaks[k];
      if (k == 2) {
        result.outcome = Outcome::kLostControl;
        result.reason = "gone";
        result.end_time_s = 60.0;
        result.end_stage = 2;
        result.metrics[MetricColumn("apogee_km")] = kNaN;
      }
      results.push_back(result);
    }
    folder_.Append(results);
  }

  TemporaryFolder temporary_;
  Campaign campaign_;
  ResultFolder folder_;
};

/// Case indices of a metric's worst cases.
std::vector<std::uint64_t> WorstIn(const CampaignSummary& summary, std::size_t metric) {
  std::vector<std::uint64_t> order;
  for (const WorstCase& worst : summary.worst_cases[metric].cases) order.push_back(worst.case_index);
  return order;
}

TEST_F(FiveCases, StatisticsAreThoseWorkedOutByHand) {
  const CampaignSummary summary = BuildSummary(folder_, campaign_);
  EXPECT_EQ(summary.flown, 5u);
  EXPECT_EQ(summary.outcomes[static_cast<std::size_t>(Outcome::kCompleted)], 4u);
  EXPECT_EQ(summary.outcomes[static_cast<std::size_t>(Outcome::kLostControl)], 1u);
  const Summary& peak = summary.metrics[MetricColumn(kPeak)].statistics;
  EXPECT_EQ(peak.n, 4u);  // the lost flight is not among them
  EXPECT_EQ(peak.undefined, 1u);
  EXPECT_DOUBLE_EQ(peak.mean, 2.5);
  // Deviations -1.5 -0.5 0.5 1.5: squares 2.25 0.25 0.25 2.25, sum 5.
  EXPECT_NEAR(peak.std, std::sqrt(5.0 / 3.0), 1e-15);
  EXPECT_EQ(peak.p50, 2.5);
  EXPECT_EQ(peak.max, 4.0);
  EXPECT_THAT(Warnings(summary),
              ElementsAre("1 of 5 flights were lost: statistics and percentiles cover the 4 that were "
                          "completed, and every lost flight fails every requirement."));
}

TEST_F(FiveCases, WorstCasesBeginWithALostOne) {
  const CampaignSummary summary = BuildSummary(folder_, campaign_);
  ASSERT_EQ(summary.worst_cases.size(), 8u) << "those of every report, in the order of their columns";
  EXPECT_EQ(summary.worst_cases[1].metric, kPeak);
  EXPECT_THAT(WorstIn(summary, 1), ElementsAre(2, 1, 4, 0, 3));
  EXPECT_EQ(summary.worst_cases[1].cases[1].value, 4.0);
  ASSERT_EQ(summary.lost_flights.size(), 1u);
  EXPECT_EQ(summary.lost_flights[0].end_stage, 2);
}

TEST_F(FiveCases, RanksByTheSideOfTheRequirement) {
  campaign_.requirements = {Peak(0.1, {}, 0.5)};
  EXPECT_THAT(WorstIn(BuildSummary(folder_, campaign_), 0), ElementsAre(2, 3, 0, 4, 1));
}

// Peaks 2 4 lost 1 3 of cases 0 to 4. Within 1.8 and 10 case 3 is outside, and 0 comes nearest of the others.
TEST_F(FiveCases, OfTwoLimitsTheWorstIsFarthestOutsideOrNearestToOne) {
  campaign_.requirements = {Peak({}, {{1.8, 10.0}}, 0.5)};
  CampaignSummary summary = BuildSummary(folder_, campaign_);
  EXPECT_THAT(WorstIn(summary, 0), ElementsAre(2, 3, 0, 4, 1));
  EXPECT_EQ(summary.requirements[0].worst_completed->case_index, 3u);
  EXPECT_EQ(summary.requirements[0].worst_completed->value, 1.0);
  const auto json = nlohmann::json::parse(SummaryJson(summary))["requirements"][0]["worst_completed"];
  EXPECT_EQ(json, (nlohmann::json{{"case_index", 3}, {"value", 1.0}}));

  campaign_.requirements[0].within = {{0.0, 4.5}};  // all inside: 4 comes nearest, then 1 and 3, 2 is best
  summary = BuildSummary(folder_, campaign_);
  EXPECT_THAT(WorstIn(summary, 0), ElementsAre(2, 1, 3, 4, 0));
  EXPECT_EQ(summary.requirements[0].worst_completed->case_index, 1u);

  // The same limits as two requirements: each has its own worst, and the list holds what both mean.
  campaign_.requirements = {PeakBelow(4.5, 0.5, 0.1), Peak(0.0, {}, 0.5)};
  summary = BuildSummary(folder_, campaign_);
  EXPECT_THAT(WorstIn(summary, 0), ElementsAre(2, 1, 3, 4, 0));
  EXPECT_EQ(summary.requirements[0].worst_completed->case_index, 1u);
  EXPECT_EQ(summary.requirements[1].worst_completed->case_index, 3u);

  // Of values whose margins to a limit far away are equal numbers, the larger one is worse all the same.
  campaign_.requirements = {PeakBelow(1e30, 0.5, 0.1)};
  summary = BuildSummary(folder_, campaign_);
  EXPECT_THAT(WorstIn(summary, 0), ElementsAre(2, 1, 4, 0, 3));
  EXPECT_EQ(summary.requirements[0].worst_completed->case_index, 1u);
}

TEST(Judge, NoFlightIsTheWorstOfNone) {
  CaseColumns cases = Columns(2, 0);
  cases.outcome[0] = Outcome::kImpact;
  cases.metrics[MetricColumn(kPeak)][1] = kNaN;
  EXPECT_FALSE(Judged(PeakBelow(0.5, 0.9, 0.1), cases).worst_completed.has_value());
}

TEST_F(FiveCases, TheVerdict) {
  EXPECT_EQ(BuildSummary(folder_, campaign_).verdict, CampaignVerdict::kNothingJudged);
  EXPECT_EQ(BuildSummary(folder_, campaign_).standing.verdict, StandingVerdict::kNothingJudged);
  campaign_.requirements = {PeakBelow(10.0, 0.5, 0.40)};  // 1 failure of 5: P(X <= 1 | 0.5) = 6/32 < 0.4
  EXPECT_EQ(BuildSummary(folder_, campaign_).verdict, CampaignVerdict::kPass);
  campaign_.requirements.push_back(PeakBelow(10.0, 0.99, 0.10));  // P(X >= 1 | 0.99) = 0.049 <= 0.1
  campaign_.requirements.push_back(PeakBelow(10.0, 0.9, 0.10));
  CampaignSummary summary = BuildSummary(folder_, campaign_);
  EXPECT_EQ(summary.requirements[1].verdict, "fail");
  EXPECT_EQ(summary.requirements[2].verdict, "inconclusive");
  EXPECT_EQ(summary.verdict, CampaignVerdict::kFail);
  campaign_.requirements.erase(campaign_.requirements.begin() + 1);
  EXPECT_EQ(BuildSummary(folder_, campaign_).verdict, CampaignVerdict::kInconclusive);
  campaign_.sampling.cases = 6;
  EXPECT_EQ(BuildSummary(folder_, campaign_).verdict, CampaignVerdict::kIncomplete);

  // A failure that no missing case can undo is said beside the incompleteness.
  campaign_.requirements = {PeakBelow(0.1, 0.99, 0.10)};
  summary = BuildSummary(folder_, campaign_);
  EXPECT_EQ(summary.verdict, CampaignVerdict::kIncomplete);
  EXPECT_EQ(summary.requirements[0].verdict, "fail");
  EXPECT_EQ(Warnings(summary)[1],
            "Not met whatever the missing cases bring: pitch_error_peak_deg below 0.1 for 99 % of flights at "
            "10 % risk.");
}

TEST_F(FiveCases, JsonHoldsTheContract) {
  campaign_.sampling.cases = 6;
  campaign_.requirements = {PeakBelow(4.5, 0.9, 0.10)};
  folder_.Quarantine({5, "killed 3 workers"});
  const std::string text = SummaryJson(BuildSummary(folder_, campaign_));
  const nlohmann::json json = nlohmann::json::parse(text);
  EXPECT_TRUE(Holds(json, R"({
      "schema": "dispersa/summary/1", "verdict": "incomplete", "joint": {"method": "each"},
      "campaign": {"name": "made_up", "seed": 7, "cases": 6, "design": "monte_carlo"},
      "metrics": {"pitch_error_peak_deg": {"group": "Attitude", "label": "Pitch error, peak", "unit": "°",
                                           "n": 4, "p50": 2.5, "min": 1.0},
                  "bending_moment_max_n_m": {"unit": "N m", "group": "Loads"}},
      "quarantined": [{"case_index": 5, "reason": "killed 3 workers"}]})"));
  EXPECT_EQ(json["campaign"]["id"], std::string(64, '1'));
  EXPECT_EQ(json["campaign"]["flight_id"], std::string(64, '2'));
  EXPECT_EQ(json["engine"], EngineVersion());
  EXPECT_EQ(json["outcomes"],
            nlohmann::json::parse(R"({"completed": 4, "lost_control": 1, "structural_limit": 0, "impact": 0,
                                      "numerical_failure": 0, "timeout": 0})"));
  FlightKind kind = AnyUnder(campaign_.autopilot.pitch.law);
  kind.has_limits = false;
  EXPECT_EQ(json["metrics"].size(), MetricsUnder(kUsualStages, kind).size());
  const nlohmann::json& requirement = json["requirements"][0];
  // Planned as if the campaign were the first in the folder, which was made without requirements.
  EXPECT_TRUE(Holds(requirement, R"({
      "metric": "pitch_error_peak_deg", "limit": 4.5, "probability": 0.9, "consumer_risk": 0.1, "n": 5,
      "failures": 1, "verdict": "inconclusive", "plan": {"kind": "fixed", "cases": 6}, "post_hoc": true})"));
  EXPECT_TRUE(requirement["cases_needed"].is_number_integer());
  EXPECT_NEAR(requirement["attained_risk"], 0.98415, 1e-6);  // one failure, one case missing, of 6 at 10 %
  EXPECT_TRUE(Holds(json["worst_cases"][0], R"({"case_index": 2, "replay": "dispersa replay . --case 2"})"));
  EXPECT_EQ(json["nominal"], nullptr);
  EXPECT_EQ(text.back(), '\n');
}

/// A campaign of made-up cases, of which `failing` have a large peak, reported on as `run` does.
class Misuse : public testing::Test {
 protected:
  Misuse() { campaign_.requirements_id = "original"; }

  void Fly(std::uint64_t cases, std::uint64_t failing) {
    campaign_.sampling.cases = cases;
    const std::filesystem::path folder = temporary_ / "out";
    ResultFolder opened = std::filesystem::exists(folder) ? ResultFolder::Resume(folder, campaign_)
                                                          : ResultFolder::Create(folder, campaign_);
    std::vector<CaseResult> results;
    for (std::uint64_t k = flown_; k < cases; ++k) {
      results.push_back(MakeCase(k, opened.inputs()));
      results.back().metrics[MetricColumn(kPeak)] = k < failing ? 0.9 : 0.1;
    }
    flown_ = cases;
    opened.Append(results);
    summary_ = BuildSummary(opened, campaign_);
    RecordLooks(opened, campaign_, summary_);
  }

  TemporaryFolder temporary_;
  Campaign campaign_ = MakeCampaign(0);
  CampaignSummary summary_;
  std::uint64_t flown_ = 0;
};

TEST_F(Misuse, ExtendingUntilItPassesDoesNotPassAndShows) {
  campaign_.requirements = {PeakBelow(0.5, 0.97, 0.10)};  // 76 cases without a failure, 129 with one
  Fly(76, 1);
  EXPECT_EQ(summary_.requirements[0].verdict, "inconclusive");
  EXPECT_EQ(summary_.requirements[0].cases_needed, 129);
  EXPECT_TRUE(Warnings(summary_).empty());
  Fly(129, 1);
  // By itself the larger campaign passes, and its summary is that of one flown at once.
  EXPECT_EQ(summary_.requirements[0].verdict, "pass");
  EXPECT_EQ(summary_.requirements[0].planned, 129);
  EXPECT_FALSE(summary_.requirements[0].beyond_plan);
  EXPECT_TRUE(Warnings(summary_).empty());
  // What stands is another matter: 76 cases could have passed, and spent the risk.
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kNotEvidence);
  EXPECT_EQ(summary_.standing.requirements[0].verdict, "not_evidence");
  EXPECT_EQ(StandingBadge(summary_.standing), "not evidence");
  EXPECT_THAT(StandingNotes(summary_.standing, summary_), IsEmpty());
  EXPECT_THAT(JudgedSentence(summary_.requirements[0], summary_.standing.requirements[0]),
              StartsWith("Earlier campaigns of this design have used up the risk of 10 %. All 129 flights "
                         "together show 1 failure; under the any-time rule "));
  // Reading it again is no further look.
  const std::string before = SummaryJson(summary_);
  Fly(129, 1);
  EXPECT_EQ(SummaryJson(summary_), before);
}

TEST_F(Misuse, ALimitThatWasChangedAfterTheFirstCaseShows) {
  campaign_.requirements = {PeakBelow(0.05, 0.9, 0.10)};
  Fly(40, 0);
  EXPECT_FALSE(summary_.requirements[0].post_hoc);
  EXPECT_EQ(summary_.requirements[0].verdict, "fail");
  campaign_.requirements = {PeakBelow(0.5, 0.9, 0.10)};
  campaign_.requirements_id = "changed";
  Fly(40, 0);
  EXPECT_EQ(summary_.requirements[0].verdict, "pass");
  EXPECT_TRUE(summary_.requirements[0].post_hoc);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kNotEvidence);
  EXPECT_EQ(StandingBadge(summary_.standing), "post hoc");
  EXPECT_THAT(
      StandingNotes(summary_.standing, summary_),
      ElementsAre("Post hoc: pitch_error_peak_deg below 0.5 for 90 % of flights at 10 % risk was not "
                  "required before the first case was flown.",
                  "Post hoc: pitch_error_peak_deg below 0.05 for 90 % of flights at 10 % risk was required, "
                  "and was changed or left out after the first case was flown. Its last verdict: fail."));
  EXPECT_THAT(JUnitXml(summary_), HasSubstr("errors=\"2\""));
  EXPECT_THAT(JUnitXml(summary_), HasSubstr("name=\"pitch_error_peak_deg below 0.05 for 90 % of flights at "
                                            "10 % risk\" time=\"0\">\n      <error "
                                            "type=\"post_hoc\" message=\"Changed or left out after its "
                                            "flights were flown. Its last verdict: fail.\"/>"));
  campaign_.requirements.clear();
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kNotEvidence) << "dropped";
  EXPECT_EQ(StandingNotes(summary_.standing, summary_).size(), 1u);
  // A requirement that fails goes before: it is known, whenever it was stated.
  campaign_.requirements = {PeakBelow(0.04, 0.9, 0.10)};
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kFail);
  // As it was: it counts again.
  campaign_.requirements = {PeakBelow(0.05, 0.9, 0.10)};
  campaign_.requirements_id = "original";
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kFail);
  EXPECT_FALSE(summary_.standing.is_post_hoc);
}

TEST_F(Misuse, ATightenedLimitIsNoEvidenceAndKeepsTheOldVerdict) {
  campaign_.requirements = {PeakBelow(0.5, 0.9, 0.10)};
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kPass);
  campaign_.requirements = {PeakBelow(0.3, 0.9, 0.10)};
  campaign_.requirements_id = "changed";
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kNotEvidence);
  ASSERT_EQ(summary_.standing.dropped.size(), 1u);
  EXPECT_EQ(summary_.standing.dropped[0].verdict, "pass");
}

TEST_F(Misuse, WordsAndOrderOfRequirementsAreNoChange) {
  campaign_.requirements = {PeakBelow(0.5, 0.9, 0.10), PeakBelow(0.6, 0.9, 0.10)};
  Fly(40, 0);
  std::swap(campaign_.requirements[0], campaign_.requirements[1]);
  campaign_.requirements[0].id = "REQ-7";
  campaign_.requirements[0].rationale = "fairing";
  campaign_.requirements[0].source = "spec 4.2";
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kPass);
  const auto json = nlohmann::json::parse(SummaryJson(summary_))["requirements"][0];
  EXPECT_TRUE(Holds(json, R"({"id": "REQ-7", "rationale": "fairing", "source": "spec 4.2"})"));
  EXPECT_NEAR(json["attained_risk"], std::pow(0.9, 40), 1e-12);
}

TEST_F(Misuse, AStudyIsJudgedByEveryCaseAndShowsNoProbability) {
  campaign_.sampling.method = SamplingMethod::kLatinHypercube;
  campaign_.requirements = {PeakBelow(0.5, 0.9, 0.10)};
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kNotEvidence);
  EXPECT_EQ(
      summary_.standing.requirements[0].reason,
      "The points of a design study are chosen, so they show no probability; require every_case: true.");
  campaign_.requirements[0].every_case = true;
  EXPECT_EQ(RequirementWords(BuildSummary(ResultFolder::Open(temporary_ / "out"), campaign_).requirements[0]),
            "pitch_error_peak_deg below 0.5 in every case");
}

TEST_F(Misuse, EveryCaseOfAStudyIsMetOrFails) {
  campaign_.sampling.method = SamplingMethod::kLatinHypercube;
  campaign_.requirements = {PeakBelow(0.5, 0.0, 0.0)};
  campaign_.requirements[0].every_case = true;
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kPass);
  EXPECT_THAT(JUnitXml(summary_), HasSubstr("failures=\"0\" errors=\"0\" skipped=\"0\""));
  const auto json = nlohmann::json::parse(SummaryJson(summary_))["requirements"][0];
  EXPECT_EQ(json["probability"], nullptr);
  EXPECT_EQ(json["every_case"], true);
  EXPECT_EQ(json["attained_risk"], nullptr);
}

TEST_F(Misuse, AttemptsInTheFoldersLedgerCount) {
  campaign_.requirements = {PeakBelow(0.5, 0.9, 0.10)};
  campaign_.design_id = "design";
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kPass);
  AttemptRecord earlier = RecordOf(campaign_);
  earlier.id = "earlier";
  earlier.seed = 8;
  earlier.cases = 40;
  earlier.requirements[0].failures = 9;
  earlier.requirements[0].verdict = "fail";
  earlier.verdict = "fail";
  const AttemptLedger ledger(temporary_ / "out" / kFolderLedgerName);
  ledger.Write(earlier);
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kNotEvidence);
  EXPECT_EQ(summary_.standing.requirements[0].pool_cases, 80);
  EXPECT_EQ(summary_.standing.requirements[0].pool_failures, 9);
  EXPECT_EQ(StandingNotes(summary_.standing, summary_).back(),
            "Attempt 2 at this design. Earlier ones here: seed 8, 40 flights: fail.");
  EXPECT_THAT(JUnitXml(summary_), HasSubstr("errors=\"1\""));
  // Another design is another matter.
  earlier.design_id = "other";
  ledger.Write(earlier);
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kPass);
  // Whoever says why he starts anew may be green; the reason and the earlier verdict are said.
  earlier.design_id = "design";
  ledger.Write(earlier);
  AttemptRecord own = RecordOf(campaign_);
  own.fresh = "the actuator was measured again";
  ledger.Write(own);
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kPass);
  const std::string junit = JUnitXml(summary_);
  EXPECT_THAT(junit, HasSubstr("the actuator was measured again"));
  EXPECT_THAT(junit, HasSubstr("seed 8, 40 flights: fail"));
}

TEST_F(Misuse, CasesThatWereFlownUnderAnotherLimitElsewhereShowNothing) {
  campaign_.requirements = {PeakBelow(0.05, 0.9, 0.10)};
  campaign_.design_id = "design";
  AttemptRecord earlier = RecordOf(campaign_);
  earlier.id = "earlier";
  earlier.cases = 40;
  earlier.requirements[0].verdict = "fail";
  campaign_.requirements = {PeakBelow(0.5, 0.9, 0.10)};
  Fly(40, 0);
  AttemptLedger(temporary_ / "out" / kFolderLedgerName).Write(earlier);
  Fly(40, 0);
  EXPECT_EQ(summary_.standing.verdict, StandingVerdict::kNotEvidence);
  EXPECT_TRUE(summary_.standing.is_post_hoc);
  ASSERT_EQ(summary_.standing.dropped.size(), 1u);
  EXPECT_EQ(summary_.standing.dropped[0].verdict, "fail");
}

TEST_F(Misuse, HalfADesignIsIncomplete) {
  campaign_.requirements = {PeakBelow(0.5, 0.9, 0.10)};
  campaign_.sampling.method = SamplingMethod::kCorners;
  for (const char* input : {"drag_factor", "lift_factor", "cg_factor", "cp_factor", "density_factor"})
    campaign_.dispersions.push_back(made_up::Of(input, made_up::TwoPoint(0.0, 0.0, 0.0), input));
  Fly(16, 0);
  EXPECT_EQ(summary_.verdict, CampaignVerdict::kIncomplete);
  EXPECT_EQ(Warnings(summary_)[0], "Incomplete design: 16 of its 32 points are in the campaign.");
  Fly(32, 0);
  EXPECT_EQ(summary_.verdict, CampaignVerdict::kStudy);
  EXPECT_EQ(summary_.requirements[0].verdict, "study");
}

TEST_F(Misuse, APointOfADesignThatViolatesARequirementIsSaid) {
  campaign_.requirements = {PeakBelow(0.5, 0.9, 0.10)};
  campaign_.sampling.method = SamplingMethod::kLatinHypercube;
  Fly(100, 1);
  EXPECT_EQ(summary_.verdict, CampaignVerdict::kStudyViolated);
  EXPECT_STREQ(CampaignVerdictName(summary_.verdict), "study");
}

TEST_F(Misuse, StopsWhereItIsDecidedInWhateverOrderTheCasesCame) {
  campaign_.requirements = {PeakBelow(0.5, 0.97, 0.10)};
  campaign_.requirements[0].plan = {PlanKind::kGroupSequential, 4, Spending::kPocock};
  campaign_.verdicts.stop_when_decided = true;
  campaign_.sampling.cases = 400;
  StoppingRule ascending(campaign_, 400, {});
  StoppingRule descending(campaign_, 400, {});
  EXPECT_EQ(ascending.target(), 100u);
  for (std::uint64_t k = 0; k < 100; ++k) {
    EXPECT_FALSE(ascending.Settled({}));
    EXPECT_FALSE(ascending.Advance({}));
    for (const bool up : {true, false}) {
      const std::uint64_t index = up ? k : 99 - k;
      CaseResult result = MakeCase(index);
      result.metrics[MetricColumn(kPeak)] = index == 7 ? 0.9 : 0.1;
      (up ? ascending : descending).Add(result);
    }
  }
  EXPECT_TRUE(ascending.Advance({}));  // one failure of 100 decides nothing
  EXPECT_TRUE(descending.Advance({}));
  EXPECT_EQ(ascending.target(), 200u);
  for (std::uint64_t k = 100; k < 199; ++k) {
    CaseResult result = MakeCase(k);
    result.metrics[MetricColumn(kPeak)] = 0.1;
    ascending.Add(result);
  }
  EXPECT_FALSE(ascending.Settled({}));
  EXPECT_TRUE(ascending.Settled({199}));  // quarantined
  CaseResult last = MakeCase(199);
  last.metrics[MetricColumn(kPeak)] = 0.1;
  ascending.Add(last);
  const auto looks = Boundaries(campaign_.requirements[0].plan, 0.97, 0.10, 400);
  EXPECT_EQ(ascending.Advance({}), looks[1].accept < 1);  // one failure of 200 is enough or not
}

TEST(SummaryJson, WritesUndefinedAsNull) {
  TemporaryFolder temporary;
  const Campaign campaign = MakeCampaign(2);
  const ResultFolder folder = ResultFolder::Create(temporary / "out", campaign);
  const nlohmann::json json = nlohmann::json::parse(SummaryJson(BuildSummary(folder, campaign)));
  EXPECT_EQ(json["metrics"][kPeak]["mean"], nullptr);
  EXPECT_EQ(json["metrics"][kPeak]["n"], 0);
  EXPECT_EQ(json["verdict"], "incomplete");
}

const Requirement kExceeded = {"structural_limit_exceeded", 1.0, {}, 0.9973, 0.10};

// A vehicle with limits, and a campaign whose one requirement every case meets.
struct LimitedCampaign {
  explicit LimitedCampaign(std::uint64_t cases) : campaign(MakeCampaign(cases)) {
    campaign.vehicle.limits.q_max_pa = 100e3;
    campaign.vehicle.limits.axial_load_g = 9.0;
    campaign.requirements = {PeakBelow(1e3, 0.5, 0.10)};
    for (std::uint64_t k = 0; k < cases; ++k) {
      results.push_back(MakeCase(k));
      Set(k, "q_max_pa", 80e3 + static_cast<double>(k));
      Set(k, "axial_load_max_g", 8.0);
      Set(k, "structural_limit_exceeded", 0.0);
    }
  }
  void Set(std::uint64_t case_index, const char* metric, double value) {
    results[case_index].metrics[MetricColumn(metric)] = value;
  }
  CampaignSummary Summary() const {
    const TemporaryFolder temporary;
    ResultFolder folder = ResultFolder::Create(temporary / "out", campaign);
    folder.Append(results);
    return BuildSummary(folder, campaign);
  }

  Campaign campaign;
  std::vector<CaseResult> results;
};

TEST(StructuralLimits, ThatAreKeptByTooFewFlightsHoldNothingUp) {
  const LimitedCampaign kept(20);
  const CampaignSummary summary = kept.Summary();
  ASSERT_EQ(summary.load_checks.size(), 1u);
  EXPECT_EQ(summary.load_checks[0].failures, 0);
  EXPECT_EQ(summary.verdict, CampaignVerdict::kPass);
  EXPECT_EQ(summary.beyond_limits, 0u);
  ASSERT_EQ(summary.limits.size(), 2u);
  EXPECT_EQ(summary.limits[0].metric, "q_max_pa");
  EXPECT_EQ(summary.limits[0].limit, 100e3);
  EXPECT_EQ(*summary.limits[0].largest, 80e3 + 19.0);
  EXPECT_EQ(summary.limits[0].largest_case, 19u);
  EXPECT_THAT(Warnings(summary), IsEmpty());
  // Stated by the campaign, a requirement takes the check's place and needs its cases.
  LimitedCampaign stated(20);
  stated.campaign.requirements.push_back(kExceeded);
  EXPECT_EQ(stated.Summary().verdict, CampaignVerdict::kInconclusive);
  EXPECT_THAT(stated.Summary().load_checks, IsEmpty());
}

TEST(StructuralLimits, CountFromTheFirstFlightBeyondThem) {
  LimitedCampaign one(100);
  one.Set(7, "axial_load_max_g", 9.5);
  one.Set(7, "structural_limit_exceeded", 1.0);
  const CampaignSummary summary = one.Summary();
  EXPECT_EQ(summary.load_checks[0].failures, 1);
  EXPECT_EQ(summary.verdict, CampaignVerdict::kFail);
  EXPECT_EQ(summary.beyond_limits, 1u);
  EXPECT_EQ(summary.limits[0].exceeded, 0u);
  EXPECT_EQ(summary.limits[1].exceeded, 1u);
  EXPECT_THAT(Warnings(summary),
              ElementsAre("Structural limits of the vehicle were exceeded in 1 of 100 flights: "
                          "axial_load_max_g above 9 g in 1, up to 9.5 g in case 7."));
  const auto json = nlohmann::json::parse(SummaryJson(summary));
  EXPECT_TRUE(Holds(json, R"({"limits": {"exceeded": 1}})"));
  EXPECT_EQ(json["limits"]["loads"][1]["largest_case"], 7);
  EXPECT_EQ(json["load_checks"][0]["failures"], 1);
}

TEST(StructuralLimits, ExceededByEveryFlightFailTheCampaign) {
  LimitedCampaign all(100);
  for (std::uint64_t k = 0; k < 100; ++k) {
    all.Set(k, "q_max_pa", 110e3);
    all.Set(k, "structural_limit_exceeded", 1.0);
  }
  EXPECT_EQ(all.Summary().verdict, CampaignVerdict::kFail);
  // Also of a campaign that states nothing, and at any point of a design study.
  all.campaign.requirements.erase(all.campaign.requirements.begin());
  EXPECT_EQ(all.Summary().verdict, CampaignVerdict::kFail);
  all.campaign.sampling.method = SamplingMethod::kSobol;
  EXPECT_EQ(all.Summary().verdict, CampaignVerdict::kStudyViolated);
}

TEST(StructuralLimits, AreHeldAgainstWhatALostFlightBore) {
  LimitedCampaign lost(20);
  lost.results[3].outcome = Outcome::kLostControl;
  lost.results[4].outcome = Outcome::kLostControl;
  lost.Set(4, "q_max_pa", 110e3);
  const CampaignSummary summary = lost.Summary();
  EXPECT_EQ(summary.requirements[0].failures, 2);
  EXPECT_EQ(summary.requirements[0].lost_flights, 2);
  EXPECT_EQ(summary.load_checks[0].failures, 1);
}

TEST(StructuralLimits, OfAStudyThatAsksNothingLeaveItAsItWas) {
  LimitedCampaign study(10);
  study.campaign.requirements.erase(study.campaign.requirements.begin());
  study.campaign.sampling.method = SamplingMethod::kSobol;
  EXPECT_EQ(study.Summary().verdict, CampaignVerdict::kNothingJudged);
}

// A limit whose load no flight defines was not kept. Of a lost flight, what it bore until then counts.
TEST(StructuralLimits, AreNotKeptByLoadsThatWereNotMeasured) {
  LimitedCampaign open(20);
  open.Set(3, "q_max_pa", std::numeric_limits<double>::quiet_NaN());
  open.Set(4, "q_max_pa", std::numeric_limits<double>::quiet_NaN());
  open.results[4].outcome = Outcome::kLostControl;
  open.Set(5, "q_max_pa", 110e3);
  // One load is not measured, the other one is beyond its limit: it counts once, as what is known.
  open.Set(6, "q_max_pa", std::numeric_limits<double>::quiet_NaN());
  open.Set(6, "axial_load_max_g", 9.5);
  const CampaignSummary summary = open.Summary();
  EXPECT_EQ(summary.load_checks[0].failures, 3);
  EXPECT_EQ(summary.load_checks[0].not_measured, 1);
  EXPECT_EQ(LoadCheckSentence(summary.load_checks[0]),
            "Load check: 2 of 20 flights went beyond a limit of the vehicle, and in 1 completed its load is "
            "not measured. No flight may.");
}

TEST(StructuralLimits, DoNotKeepACampaignFromStopping) {
  LimitedCampaign kept(2000);
  kept.campaign.verdicts.stop_when_decided = true;
  kept.campaign.requirements[0].plan = {.kind = PlanKind::kGroupSequential, .looks = 10};
  const auto target_after = [&](std::uint64_t cases) {
    StoppingRule rule(kept.campaign, 2000, {});
    for (std::uint64_t k = 0; k < cases; ++k) rule.Add(kept.results[k]);
    while (rule.Advance({})) {
    }
    return rule.target();
  };
  EXPECT_EQ(target_after(200), 200u) << "half of the flights below a limit that none comes near";
  kept.Set(5, "q_max_pa", 110e3);
  EXPECT_EQ(target_after(200), 200u) << "and a flight beyond it has decided";
}

/// Impacts from 0.03 degrees west to 0.03 degrees east of a longitude.
CaseColumns ImpactsAbout(double site_deg) {
  CaseColumns cases = Columns(61, 0);
  for (std::size_t i = 0; i < 61; ++i) {
    cases.metrics[MetricColumn("impact_longitude_deg")].push_back(
        NearTo(0.0, site_deg + 0.001 * (static_cast<double>(i) - 30.0), kCutAt180Deg));
  }
  return cases;
}

// At the antimeridian as elsewhere, from either side: what is judged is the way to the limit.
TEST(Judge, OfALongitudeDoesNotSeeTheCut) {
  for (const double site_deg : {10.0, 179.98, -179.98}) {
    SCOPED_TRACE(site_deg);
    const CaseColumns cases = ImpactsAbout(site_deg);
    const auto judge = [&](std::optional<double> below, std::optional<double> above) {
      return Judged({"impact_longitude_deg", below, above, 0.9, 0.1}, cases);
    };
    const double east_deg = NearTo(0.0, site_deg + 0.0295, kCutAt180Deg);
    const double west_deg = NearTo(0.0, site_deg - 0.0295, kCutAt180Deg);
    for (const RequirementSummary& one : {judge(east_deg, {}), judge({}, west_deg)}) {
      EXPECT_EQ(one.failures, 1);
      ASSERT_TRUE(one.bound);
      EXPECT_GT(*one.margin, 0.0);
      EXPECT_LT(*one.margin, 0.06);
      EXPECT_NEAR(one.worst_completed->value, one.limit, 0.001);
    }
    const Requirement range{
        "impact_longitude_deg", {}, {}, 0.9, 0.1, {{site_deg - 0.0295, site_deg + 0.0295}}};
    EXPECT_EQ(Judged(range, cases).failures, 2);
  }
}

// The bound is 295.494 for a limit of 295: the words tell them apart.
TEST(Judge, SaysABoundWithTheDigitsOfItsMargin) {
  RequirementSummary summary;
  summary.probability = 0.9973;
  summary.consumer_risk = 0.1;
  struct Case {
    bool below;
    double limit;
    std::optional<double> low;
    double bound;
    const char* words;
  };
  for (const Case& one : {Case{false, 295.0, {}, 295.494, "above 295.49 km (limit 295 km)"},
                          Case{true, 295.0, {}, 294.506, "below 294.51 km (limit 295 km)"},
                          Case{true, 300.1234567, {}, 300.0, "below 300 km (limit 300.1234567 km)"},
                          Case{true, 305.0, 295.0, 295.494, "above 295.49 km (limits 295 and 305 km)"},
                          Case{true, 305.0, 295.0, 304.5, "below 304.5 km (limits 295 and 305 km)"}}) {
    summary.below = one.below;
    summary.limit = one.limit;
    summary.low_limit = one.low;
    summary.bound = one.bound;
    EXPECT_EQ(BoundSentence(summary, "km"),
              std::string("With 90 % confidence 99.73 % of flights stay ") + one.words + ".");
  }
}

}  // namespace dispersa::analysis_summary_test
