// Rules whose breach no campaign that goes well would show.
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "services/coordinator/watchdog.h"
#include "services/fleet/local_workers.h"
#include "services/ledger/campaign_book.h"
#include "services/ledger/prepare_run.h"
#include "tests/distributed/forgetful_store.h"
#include "tests/nominal_inputs.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::rules_test {

TEST(Rules, AConflictFailsTheCampaignWhateverItsVerdict) {
  Campaign campaign;
  campaign.sampling.cases = 2;
  CampaignBook book(campaign, std::make_unique<ForgetfulStore>());
  CaseResult result;
  book.Accept("w", "h", 1, result, 0.0);
  book.Accept("w", "h", 1, result, 0.0);
  const auto conflicts = [&] { return book.ledger().Progress().conflicts; };
  EXPECT_EQ(CampaignExitCode(StandingVerdict::kPass, conflicts()), 0);
  EXPECT_EQ(CampaignExitCode(StandingVerdict::kFail, conflicts()), 3);
  result.end_time_s = 1.0;
  book.Accept("other", "h", 1, result, 0.0);
  for (const auto verdict : {StandingVerdict::kPass, StandingVerdict::kFail, StandingVerdict::kInconclusive,
                             StandingVerdict::kIncomplete}) {
    EXPECT_EQ(CampaignExitCode(verdict, conflicts()), 1);
  }
}

TEST(Rules, AVerdictHasItsExitCode) {
  EXPECT_EQ(CampaignExitCode(StandingVerdict::kPass, 0), 0);
  EXPECT_EQ(CampaignExitCode(StandingVerdict::kNothingJudged, 0), 0);
  EXPECT_EQ(CampaignExitCode(StandingVerdict::kNothingJudged, 0, true), 7);
  EXPECT_EQ(CampaignExitCode(StandingVerdict::kPass, 0, true), 0);
  EXPECT_EQ(CampaignExitCode(StandingVerdict::kFail, 0), 3);
  EXPECT_EQ(CampaignExitCode(StandingVerdict::kInconclusive, 0), 4);
  EXPECT_EQ(CampaignExitCode(StandingVerdict::kNotEvidence, 0), 7);
  EXPECT_EQ(CampaignExitCode(StandingVerdict::kIncomplete, 0), 5);
}

TEST(Rules, OfTwoExitCodesTheWorseIsReported) {
  const std::vector<int> order = {130, 2, 1, 5, 6, 3, 7, 4, 0};
  ASSERT_EQ(ExitMeanings().size(), order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_EQ(ExitMeanings()[i].code, order[i]);
    for (std::size_t k = i; k < order.size(); ++k) {
      const auto worse = static_cast<ExitCode>(order[i]), other = static_cast<ExitCode>(order[k]);
      EXPECT_EQ(WorseOf(worse, other), worse);
      EXPECT_EQ(WorseOf(other, worse), worse);
    }
  }
}

// Statuses as waitpid gives them.
TEST(Rules, AWorkerThatIsEndedFromOutsideBlamesNothing) {
  std::string how;
  for (const int signal : {SIGKILL, SIGTERM, SIGINT, SIGHUP})
    EXPECT_EQ(ClassifyExit(signal, &how), WorkerEnd::kKilled);
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGBUS})
    EXPECT_EQ(ClassifyExit(signal, &how), WorkerEnd::kCrashed);
  EXPECT_EQ(ClassifyExit(7 << 8, &how), WorkerEnd::kCrashed);
  EXPECT_EQ(how, "exit code 7");
  EXPECT_EQ(ClassifyExit(0, &how), WorkerEnd::kLeft);
}

TEST(Rules, ResumingWithFewerCasesDropsNoRow) {
  const TemporaryFolder root;
  RunRequest request;
  request.campaign = DISPERSA_CAMPAIGNS "/smoke.yaml";
  request.out = (root / "out").string();
  request.overrides.cases = 10;
  {
    PreparedRun prepared = PrepareRun(request);
    CaseResult result;
    result.case_index = 7;
    ApplyEverywhere(prepared.folder.inputs(), 0.5, result);
    result.metrics.assign(MetricCount(kUsualStages), 0.5);
    prepared.folder.Append({{result}});
  }
  request.resume = true;
  request.overrides.cases = 3;
  {
    const PreparedRun prepared = PrepareRun(request);
    EXPECT_EQ(prepared.campaign.sampling.cases, 8u) << "extended to what is there";
    EXPECT_EQ(prepared.folder.PresentCases(), std::vector<std::uint64_t>{7});
    EXPECT_THROW(PrepareRun(request), InputError) << "two at once";
  }
}

TEST(RestartRule, WhoHeardSomebodyAndHasWorkDoesNotHearNobodyForLong) {
  RestartRule rule;
  long beats = 0;
  for (double t = 0.0; t < 100.0; t += 1.0)
    EXPECT_FALSE(rule.Check(t, false, true, ++beats)) << "nobody came yet";
  EXPECT_FALSE(rule.Check(100.0, true, true, ++beats));
  for (double t = 101.0; t < 200.0; t += 1.0)
    EXPECT_FALSE(rule.Check(t, false, false, ++beats)) << "nothing to do";
  for (double t = 200.0; t < 209.0; t += 1.0) EXPECT_FALSE(rule.Check(t, false, true, ++beats)) << t;
  EXPECT_TRUE(rule.Check(210.0, false, true, ++beats));
}

TEST(RestartRule, ACoordinatorThatDoesNotHearItselfStartsAgain) {
  for (const bool has_work : {true, false}) {
    RestartRule rule;
    EXPECT_FALSE(rule.Check(59.0, has_work, has_work, 0)) << "its middleware begins slowly";
    EXPECT_FALSE(rule.Check(60.0, has_work, has_work, 1));
    EXPECT_FALSE(rule.Check(80.0, has_work, has_work, 1));
    EXPECT_FALSE(rule.Check(80.5, has_work, has_work, 2)) << "it was slow";
    EXPECT_TRUE(rule.Check(101.0, has_work, has_work, 2)) << has_work;
  }
  EXPECT_TRUE(RestartRule().Check(61.0, false, false, 0)) << "it never heard itself";
}

}  // namespace dispersa::rules_test
