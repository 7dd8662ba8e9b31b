// A campaign's book over a real result folder: its end, its counts, and the stored results.
#include "services/ledger/campaign_book.h"

#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "memory_store.h"
#include "tests/nominal_inputs.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::campaign_book_test {

constexpr char kPeak[] = "pitch_error_peak_deg";

class BookTest : public testing::Test {
 protected:
  BookTest() {
    campaign_.requirements = {{kPeak, 0.5, {}, 0.97, 0.1}};
    campaign_.requirements[0].plan = {PlanKind::kGroupSequential, 4, Spending::kPocock};
    campaign_.name = "made up";
    campaign_.canonical_yaml = "made up";
    campaign_.id = std::string(64, 'a');
    campaign_.flight_id = std::string(64, 'f');
  }
  /// Looks at 10, 20, 30 and 40 cases.
  void OpenSequential() {
    campaign_.sampling.cases = 40;
    campaign_.verdicts.stop_when_decided = true;
    book_.emplace(campaign_, ResultFolder::Create(folder_ / "out", campaign_));
  }
  static CaseResult ResultOf(std::uint64_t case_index, double peak = 0.1) {
    CaseResult result;
    result.case_index = case_index;
    result.outcome = Outcome::kCompleted;
    ApplyNominal(result);
    result.metrics.resize(MetricCount(kUsualStages));
    result.metrics[MetricColumn(kPeak)] = peak;
    return result;
  }
  void Return(const std::string& worker, std::uint64_t first, std::uint64_t end, double peak = 0.1) {
    for (std::uint64_t i = first; i < end; ++i) book_->Accept(worker, "host", 0, ResultOf(i, peak), 1.0);
  }
  /// It ends every process, as its worker has seen alone.
  void Quarantine(std::uint64_t case_index) {
    book_->ledger().Join("w", {EngineVersion(), 1, 100}, 0.0);
    for (const Assignment& assignment : book_->ledger().Assign(0.0)) {
      for (const std::uint64_t i : assignment.cases)
        if (i == case_index) book_->Quarantine("w", i, assignment.attempt, "signal 11", 0.5);
    }
  }
  std::uint64_t Target() const { return book_->ledger().Progress().total; }

  TemporaryFolder folder_;
  Campaign campaign_;
  std::optional<CampaignBook> book_;
};

class FullDiskTest : public BookTest {
 protected:
  FullDiskTest() {
    campaign_.sampling.cases = 4;
    auto store = std::make_unique<FullStore>();
    store_ = store.get();
    book_.emplace(campaign_, std::move(store));
    book_->PauseOnDiskErrors();
    store_->problem = ResultError::Kind::kDiskFull;
  }
  FullStore* store_;
};

TEST_F(FullDiskTest, KeepsWhatItHasAndStoresItWhenThereIsSpace) {
  Return("w", 0, 3);
  EXPECT_FALSE(book_->FlushIfDue(10.0));
  EXPECT_EQ(book_->pause(), "the disk is what it is");
  EXPECT_EQ(book_->breakdown(), "");
  EXPECT_EQ(book_->unstored(), 3u);
  store_->problem.reset();
  EXPECT_FALSE(book_->FlushIfDue(14.9)) << "it is tried again after 5 s";
  EXPECT_TRUE(book_->FlushIfDue(15.0));
  EXPECT_EQ(book_->pause(), "");
  EXPECT_EQ(book_->unstored(), 0u);
  EXPECT_EQ(store_->rows.size(), 3u);
}

TEST_F(FullDiskTest, AFaultOfTheProgramKeepsWhatWasAccepted) {
  store_->problem.reset();
  Return("w", 0, 3);
  book_->Break("engine fault: core/a.cc:1: x does not hold");
  EXPECT_EQ(store_->rows.size(), 3u);
  EXPECT_EQ(book_->breakdown(), "engine fault: core/a.cc:1: x does not hold");
  Return("w", 3, 4);
  EXPECT_FALSE(book_->FlushIfDue(99.0)) << "nothing follows";
  book_->Break("engine fault: another");
  EXPECT_EQ(book_->breakdown(), "engine fault: core/a.cc:1: x does not hold") << "the first one";
}

TEST_F(FullDiskTest, AnyOtherErrorBreaksTheBookForEver) {
  store_->problem = ResultError::Kind::kFile;
  Return("w", 0, 3);
  EXPECT_FALSE(book_->FlushIfDue(10.0));
  EXPECT_EQ(book_->breakdown(), "the disk is what it is");
  EXPECT_EQ(book_->pause(), "");
  store_->problem.reset();
  EXPECT_FALSE(book_->FlushIfDue(99.0));
}

TEST_F(FullDiskTest, ABookThatIsNotPatientThrows) {
  auto store = std::make_unique<FullStore>();
  store->problem = ResultError::Kind::kDiskFull;
  book_.emplace(campaign_, std::move(store));
  Return("w", 0, 3);
  EXPECT_THROW(book_->FlushIfDue(10.0), ResultError);
}

TEST_F(BookTest, AnUndecidedLookGoesOnToTheNext) {
  OpenSequential();
  EXPECT_EQ(Target(), 10u);
  Return("w", 0, 9);
  EXPECT_FALSE(book_->Complete());
  EXPECT_EQ(Target(), 10u);
  Return("w", 9, 10);
  EXPECT_FALSE(book_->Complete());
  EXPECT_EQ(Target(), 20u);
}

TEST_F(BookTest, AQuarantinedCaseDoesNotEndTheCampaignAtItsFirstLook) {
  OpenSequential();
  Quarantine(4);
  Return("w", 0, 4);
  Return("w", 5, 10);
  EXPECT_EQ(book_->ledger().Progress().quarantined, 1u);
  EXPECT_FALSE(book_->Complete()) << "nine good flights of ten decide nothing";
  EXPECT_EQ(Target(), 20u);
}

TEST_F(BookTest, ADecidedLookEndsIt) {
  OpenSequential();
  Return("w", 0, 10, 0.9);
  EXPECT_TRUE(book_->Complete());
  EXPECT_EQ(Target(), 10u);
}

TEST_F(BookTest, AnExpelledWorkersResultsCountForNothing) {
  OpenSequential();
  book_->KeepAudit({1e-9, 1});
  book_->KeepTally();
  Return("honest", 0, 5);
  Return("liar", 5, 10, 0.9);
  EXPECT_EQ(book_->tally().Standings().at(0).failures, 5);
  book_->Disown("liar");
  EXPECT_EQ(book_->tally().n(), 5);
  EXPECT_EQ(book_->tally().Standings().at(0).failures, 0);
  // Its claims need not be flown again.
  for (const Claim& claim : book_->TakeClaims()) {
    EXPECT_EQ(claim.worker, "honest");
    EXPECT_TRUE(book_->Settle(claim, claim.fingerprint));
  }
  EXPECT_FALSE(book_->Complete());
  EXPECT_EQ(Target(), 10u);
  Return("honest", 5, 10);
  EXPECT_EQ(book_->tally().n(), 10);
  EXPECT_FALSE(book_->Complete()) << "the lies would have failed it";
  EXPECT_EQ(Target(), 20u);
}

TEST_F(BookTest, ACampaignThatGoesOnCountsWhatIsStoredAndKeepsItsPlan) {
  OpenSequential();
  Return("w", 0, 7);
  book_->Flush();
  book_.reset();
  campaign_.sampling.cases = 80;
  book_.emplace(campaign_, ResultFolder::Resume(folder_ / "out", campaign_));
  book_->KeepTally();
  EXPECT_EQ(book_->tally().n(), 7);
  EXPECT_EQ(book_->ledger().Progress().done, 7u);
  EXPECT_EQ(Target(), 10u) << "the looks are those that were planned: of 40";
}

class StoringTest : public BookTest {
 protected:
  void Open(std::uint64_t cases) {
    campaign_.sampling.cases = cases;
    campaign_.autopilot.plugin.emplace().name = "law";
    auto store = std::make_unique<MemoryStore>();
    store_ = store.get();
    book_.emplace(campaign_, std::move(store), LedgerOptions{.blames_to_quarantine = 1});
  }
  MemoryStore* store_ = nullptr;
};

TEST_F(StoringTest, ADurationIsFromACasesStartToItsResult) {
  Open(2);
  book_->Start("w", 0, 1, 10.0);
  book_->Accept("w", "host", 1, ResultOf(0), 12.5);
  book_->Accept("w", "host", 1, ResultOf(1), 12.5);  // whose start got lost
  book_->Flush();
  EXPECT_EQ(store_->seconds.at(0), 2.5);
  EXPECT_TRUE(std::isnan(store_->seconds.at(1)));
}

TEST_F(StoringTest, WhyACaseWasQuarantinedIsStored) {
  Open(3);
  Quarantine(0);
  book_->ledger().Join("crashes", {EngineVersion(), 1, 9}, 0.0);
  book_->ledger().Lost("w", WorkerEnd::kLeft, "it left");
  for (const Assignment& assignment : book_->ledger().Assign(0.0))
    for (const std::uint64_t i : assignment.cases)
      if (i == 2) book_->Start("crashes", i, assignment.attempt, 1.0);
  book_->ledger().Lost("crashes", WorkerEnd::kCrashed, "signal 11 of process 42");
  book_->Flush();
  EXPECT_THAT(store_->quarantined,
              ElementsAre(Pair(0, "signal 11"), Pair(2, "every attempt to fly it ended or hung its worker")));
}

TEST_F(StoringTest, ManyResultsDoNotWaitForTheirTime) {
  Open(5000);
  EXPECT_TRUE(book_->FlushIfDue(1.0));
  Return("w", 0, 3999);
  EXPECT_FALSE(book_->FlushIfDue(1.4));
  EXPECT_EQ(store_->stored, 0u);
  Return("w", 3999, 4000);
  EXPECT_TRUE(book_->FlushIfDue(1.4));
  EXPECT_EQ(store_->stored, 4000u);
  EXPECT_FALSE(book_->FlushIfDue(1.8));
  EXPECT_TRUE(book_->FlushIfDue(1.9));
}

}  // namespace dispersa::campaign_book_test
