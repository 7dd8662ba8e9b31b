// The verdict that stands: earlier attempts in a table with what they come to, what the ledger counts, and
// what the standing makes of looks and advice.
#include "core/analysis/standing.h"

#include "core/analysis/campaign_summary.h"
#include "core/analysis/stopping_rule.h"
#include "tests/test.h"
#include "tests/unit/made_up_results.h"

namespace dispersa::analysis_standing_test {

using namespace report_test;

constexpr std::uint64_t kSeed = 7;  // of MakeCampaign()
constexpr char kId[] = "own";

CaseResult Flight(std::uint64_t index, bool fails) {
  CaseResult result = MakeCase(index);
  result.metrics[MetricColumn(kPeak)] = fails ? 0.9 : 0.1;
  return result;
}

/// An attempt in the ledger, at a requirement that was "pitch_error_peak_deg below <limit>".
struct Earlier {
  std::uint64_t seed;
  std::int64_t planned, cases, failures;
  std::string verdict;
  double limit = 0.5, probability = 0.9, risk = 0.1;
};

/// The campaign: 40 flights with seed 7, of which `failures` break "below 0.5 for 90 % at 10 % risk". One
/// look at 40 cases passes with at most one failure.
struct Row {
  std::string name;
  std::vector<Earlier> earlier;
  std::int64_t failures;
  std::set<std::uint64_t> missing;  ///< quarantined cases
  StandingVerdict standing;
  std::int64_t pool_cases, pool_failures;
  bool is_post_hoc = false;
  std::string reason = "";  ///< of a pass: what decided, if not the campaign's own flights
};

constexpr auto kPass = StandingVerdict::kPass;
constexpr auto kNotEvidence = StandingVerdict::kNotEvidence;
constexpr auto kIncomplete = StandingVerdict::kIncomplete;

class StandingOfAttempts : public testing::TestWithParam<Row> {};

TEST_P(StandingOfAttempts, IsAsExpected) {
  const Row& row = GetParam();
  const TemporaryFolder temporary;
  Campaign campaign = MakeCampaign(40);
  campaign.id = kId;
  campaign.design_id = "design";
  campaign.requirements = {PeakBelow(0.5, 0.9, 0.1)};
  ResultFolder folder = ResultFolder::Create(temporary / "out", campaign);
  std::vector<CaseResult> results;
  for (std::uint64_t k = 0; k < 40; ++k)
    if (!row.missing.contains(k)) results.push_back(Flight(k, std::cmp_less(k, row.failures)));
  folder.Append(results);
  for (const std::uint64_t index : row.missing) folder.Quarantine({index, "it killed 3 workers"});
  const AttemptLedger ledger(folder.directory() / kFolderLedgerName);
  for (std::size_t i = 0; i < row.earlier.size(); ++i) {
    const Earlier& one = row.earlier[i];
    Campaign flown = campaign;
    flown.id = "earlier" + std::to_string(i);
    flown.sampling.seed = one.seed;
    flown.sampling.cases = static_cast<std::uint64_t>(one.planned);
    flown.requirements = {PeakBelow(one.limit, one.probability, one.risk)};
    AttemptRecord record = RecordOf(flown);
    record.cases = one.cases;
    record.verdict = record.requirements[0].verdict = one.verdict;
    record.requirements[0].failures = one.failures;
    ledger.Write(record);
  }
  ledger.Write(RecordOf(campaign));
  const Standing standing = BuildSummary(folder, campaign).standing;
  EXPECT_STREQ(StandingVerdictName(standing.verdict), StandingVerdictName(row.standing));
  EXPECT_EQ(standing.is_post_hoc, row.is_post_hoc);
  ASSERT_EQ(standing.requirements.size(), 1u);
  EXPECT_EQ(standing.requirements[0].pool_cases, row.pool_cases);
  EXPECT_EQ(standing.requirements[0].pool_failures, row.pool_failures);
  if (row.standing == kPass) {
    EXPECT_EQ(standing.requirements[0].reason, row.reason);
  }
}

constexpr char kEarlier[] = "An earlier attempt at this design passed, and that stands.";

// An earlier pass lets a later pass stand only if what it passed was at least as strict. Its four failures
// keep the pool of all flights from passing, so that the pass itself decides.
INSTANTIATE_TEST_SUITE_P(
    Strictness, StandingOfAttempts,
    testing::Values(
        Row{"NoneBefore", {}, 0, {}, kPass, 40, 0},
        Row{"AsStrict", {{8, 40, 40, 4, "pass"}}, 0, {}, kPass, 80, 4, false, kEarlier},
        Row{"StricterInBoth",
            {{8, 40, 40, 4, "pass", 0.5, 0.95, 0.05}},
            0,
            {},
            kPass,
            80,
            4,
            false,
            kEarlier},
        // The plan's risk is spent: the pool decides, and says so.
        Row{"SpentThenTogether",
            {{8, 40, 40, 0, "inconclusive"}},
            0,
            {},
            kPass,
            80,
            0,
            false,
            "All attempts together decide: 80 flights show 0 failures."},
        Row{"LaxerProbability", {{8, 40, 40, 4, "pass", 0.5, 0.8, 0.1}}, 0, {}, kNotEvidence, 80, 4},
        Row{"LaxerRisk", {{8, 40, 40, 4, "pass", 0.5, 0.9, 0.5}}, 0, {}, kNotEvidence, 80, 4},
        Row{"StricterProbabilityLaxerRisk",
            {{8, 40, 40, 4, "pass", 0.5, 0.95, 0.2}},
            0,
            {},
            kNotEvidence,
            80,
            4},
        Row{"AsStrictButOpen", {{8, 40, 40, 4, "inconclusive"}}, 0, {}, kNotEvidence, 80, 4}),
    [](const auto& row) { return row.param.name; });

// A case without a result may have failed, so it counts as a failure among all attempts.
INSTANTIATE_TEST_SUITE_P(
    MissingCases, StandingOfAttempts,
    testing::Values(Row{"OneInTheMiddle", {}, 0, {20}, kIncomplete, 40, 1},
                    Row{"ThreeBesideTwoFailures", {}, 2, {10, 25, 39}, kIncomplete, 40, 5},
                    Row{"AfterAnEarlierOne", {{8, 40, 40, 9, "fail"}}, 0, {3, 30}, kIncomplete, 80, 11}),
    [](const auto& row) { return row.param.name; });

// What was required when cases of this seed were first flown binds. Nothing was seen without cases, or with
// another seed.
INSTANTIATE_TEST_SUITE_P(
    Binding, StandingOfAttempts,
    testing::Values(Row{"NoCases", {{kSeed, 60, 0, 0, "", 0.05}}, 0, {}, kPass, 40, 0},
                    Row{"OneCase", {{kSeed, 60, 1, 1, "fail", 0.05}}, 0, {}, kNotEvidence, 40, 0, true},
                    Row{"OtherSeed", {{8, 60, 60, 60, "fail", 0.05}}, 0, {}, kPass, 40, 0},
                    // The first with cases binds, not the first of all.
                    Row{"NoCasesThenTheSame",
                        {{kSeed, 60, 0, 0, "", 0.05}, {kSeed, 50, 5, 0, "inconclusive"}},
                        0,
                        {},
                        kPass,  // by the any-time rule
                        40,
                        0}),
    [](const auto& row) { return row.param.name; });

// Flying the same cases again adds none and takes no failure back.
INSTANTIATE_TEST_SUITE_P(
    Again, StandingOfAttempts,
    testing::Values(Row{"AsMany", {{kSeed, 60, 40, 5, "fail"}}, 0, {}, kNotEvidence, 40, 5},
                    Row{"MoreThanBefore", {{kSeed, 30, 30, 6, "fail"}}, 0, {}, kNotEvidence, 40, 6},
                    Row{"FewerThanBefore", {{kSeed, 90, 80, 7, "fail"}}, 0, {}, kNotEvidence, 80, 7},
                    Row{"MoreFailuresNow", {{kSeed, 60, 40, 5, "fail"}}, 1, {}, kNotEvidence, 40, 5},
                    Row{"TwoSeeds",
                        {{kSeed, 60, 40, 5, "fail"}, {8, 30, 30, 2, "inconclusive"}},
                        0,
                        {},
                        kNotEvidence,
                        70,
                        7}),
    [](const auto& row) { return row.param.name; });

TEST(AttemptOf, CountsCasesWithoutAResultUpToTheLastAsFailures) {
  const TemporaryFolder temporary;
  Campaign campaign = MakeCampaign(40);
  campaign.requirements = {PeakBelow(0.5, 0.9, 0.1), PeakBelow(0.95, 0.9, 0.1)};
  ResultFolder folder = ResultFolder::Create(temporary / "out", campaign);
  folder.Append(std::vector{Flight(0, true), Flight(1, false), Flight(4, true), Flight(6, false)});
  const AttemptRecord record = AttemptOf(campaign, BuildSummary(folder, campaign), {});
  EXPECT_EQ(record.cases, 7);  // 33 that nobody assigned are no part of it
  ASSERT_EQ(record.requirements.size(), 2u);
  EXPECT_EQ(record.requirements[0].failures, 5);  // two that fail, three that are missing
  EXPECT_EQ(record.requirements[1].failures, 3);
}

// Designs, not attempts: two attempts at one and three at another are two designs.
TEST(BeginAttempt, CountsEachEarlierDesignOnce) {
  const TemporaryFolder temporary;
  const std::filesystem::path root = temporary / "results";
  std::filesystem::create_directories(root / "own");
  Campaign campaign = MakeCampaign(40);
  const auto write = [&](const char* id, const char* design, std::uint64_t seed) {
    campaign.id = id;
    campaign.design_id = design;
    campaign.sampling.seed = seed;
    AttemptLedger(root / kLedgerName).Write(RecordOf(campaign));
  };
  write("a1", "first", kSeed);
  write("b1", "second", 8);
  write("a2", "first", kSeed);
  write("b2", "second", 9);
  write("b3", "second", 8);
  write("c1", "own", 8);
  campaign.id = kId;
  campaign.design_id = "own";
  campaign.sampling.seed = kSeed;
  ASSERT_FALSE(BeginAttempt(root, root / "own", campaign, "2026-01-01T00:00:00Z").has_value());
  const std::vector<AttemptRecord> kept = AttemptLedger(root / "own" / kFolderLedgerName).Read();
  ASSERT_EQ(kept.size(), 2u);  // at this design
  EXPECT_EQ(kept[0].id, "c1");
  EXPECT_EQ(kept[1].id, kId);
  EXPECT_EQ(kept[1].earlier_designs, 2);
  EXPECT_EQ(kept[1].earlier_designs_of_seed, 1);
}

RequirementSummary WithAdvice(std::int64_t least, std::int64_t likely, double probability,
                              std::int64_t extended) {
  RequirementSummary requirement;
  requirement.advice.emplace();
  requirement.advice->least = least;
  requirement.advice->likely.cases = likely;
  requirement.advice->likely.probability = probability;
  requirement.advice->extended = extended;
  return requirement;
}

// Whatever their order: flights that decide all of them decide the one that needs most, and the least
// probable one limits the probability.
TEST(AdviceTogether, NamesTheGreatestNumbers) {
  const std::vector<RequirementSummary> requirements = {
      WithAdvice(22, 38, 0.9, 300), WithAdvice(76, 129, 0.5, 100), WithAdvice(45, 400, 0.75, 200)};
  for (const std::vector<std::size_t>& order :
       std::vector<std::vector<std::size_t>>{{0, 1, 2}, {2, 0, 1}, {1, 2, 0}}) {
    CampaignSummary summary;
    for (const std::size_t i : order) {
      summary.requirements.push_back(requirements[i]);
      summary.standing.requirements.emplace_back().verdict = "inconclusive";
    }
    EXPECT_EQ(
        AdviceTogether(summary),
        "To decide all 3 inconclusive requirements: a new campaign needs 76 flights or more. By what "
        "was seen here, a campaign of 400 flights passes each of them with a probability of at least 50 %. "
        "This campaign, extended, needs 300 flights in all with no further failure (any-time rule).");
  }
}

/// Where a campaign of 200 cases with looks at 100 and 200 stops, if `failures` flights from case 75 on fail.
std::uint64_t StopsAt(std::uint64_t failures, const std::vector<std::int64_t>& past_looks) {
  Campaign campaign = MakeCampaign(200);
  campaign.verdicts.stop_when_decided = true;
  campaign.requirements = {PeakBelow(0.5, 0.9, 0.1)};
  campaign.requirements[0].plan.kind = PlanKind::kGroupSequential;
  campaign.requirements[0].plan.looks = 2;
  StoppingRule rule(campaign, 200, past_looks);
  for (std::uint64_t k = 0; k < 100; ++k) rule.Add(Flight(k, k >= 75 && k < 75 + failures));
  rule.Advance({});
  return rule.target();
}

// The verdict that was read at 75 cases without failure was a pass. It decides with 4 failures of 100, which
// alone are too many to pass. 18 of 100 fail by themselves, and contradict it, so that nothing is decided.
TEST(StoppingRule, RemembersVerdictsThatWereRead) {
  EXPECT_EQ(StopsAt(4, {}), 200u);
  EXPECT_EQ(StopsAt(4, {75}), 100u);
  EXPECT_EQ(StopsAt(18, {}), 100u);
  EXPECT_EQ(StopsAt(18, {75}), 200u);
}

}  // namespace dispersa::analysis_standing_test
