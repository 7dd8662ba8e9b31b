// The ledger with made-up time and workers that die, hang, return false results and repeat themselves.
#include "services/ledger/ledger.h"

#include "core/campaign/case_range.h"
#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "core/results/attempt_ledger.h"
#include "services/ledger/audit.h"
#include "services/ledger/campaign_attempt.h"
#include "services/ledger/running_tally.h"
#include "tests/distributed/memory_store.h"
#include "tests/nominal_inputs.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::coordinator_ledger_test {
namespace {

const WorkerHello kHello{.engine_version = "1", .slots = 1, .credits = 2};

// Results that differ exactly where their cases differ.
Digest ResultOf(std::uint64_t case_index) { return {case_index, ~case_index}; }

TEST(Ledger, RefusesAnotherEngineVersionWithAReason) {
  Ledger ledger("0.1.0+aa", 10);
  EXPECT_EQ(ledger.Join("w", {.engine_version = "0.1.0+bb"}, 0.0),
            "engine version 0.1.0+bb of the worker differs from the coordinator's 0.1.0+aa");
  EXPECT_EQ(ledger.WorkerCount(), 0u);
  EXPECT_THAT(ledger.Assign(0.0), IsEmpty());
}

// 24 bytes for each of them would be 100 GB.
TEST(Ledger, HoldsAsManyCasesAsACampaignMayHave) {
  constexpr std::uint64_t kCases = 4294967295;
  Ledger ledger("1", kCases, {.side_by_side = 1});
  ledger.MarkDone(kCases - 1, ResultOf(kCases - 1));
  ledger.Join("w", kHello, 0.0);
  const auto given = ledger.Assign(0.0);
  ASSERT_THAT(given, SizeIs(2));
  EXPECT_EQ(ledger.Finished("w", 0, given[0].attempt, ResultOf(0), 1.0), Acceptance::kAccepted);
  EXPECT_EQ(ledger.Finished("w", kCases - 1, 0, ResultOf(7), 1.0), Acceptance::kConflict);
  EXPECT_EQ(ledger.Finished("w", kCases - 2, 0, ResultOf(kCases - 2), 1.0), Acceptance::kAccepted);
  EXPECT_EQ(ledger.Finished("w", kCases, 0, ResultOf(kCases), 1.0), Acceptance::kUnknown);
  EXPECT_EQ(ledger.Progress().done, 3u);
  EXPECT_EQ(ledger.Progress().waiting, kCases - 4) << "one is assigned";
  EXPECT_EQ(ledger.FingerprintOf(kCases - 2), ResultOf(kCases - 2));
}

TEST(Ledger, OfAShareGivesItsCasesAlone) {
  Ledger ledger("1", 12, {.first_case = 9, .side_by_side = 1});
  ledger.MarkDone(10, ResultOf(10));
  ledger.Join("w", kHello, 0.0);
  EXPECT_EQ(ledger.Progress().total, 3u);
  EXPECT_THAT(ledger.Assign(0.0), ElementsAre(Assignment{"w", 1, {9}}, Assignment{"w", 2, {11}}));
  EXPECT_EQ(ledger.Finished("w", 8, 1, ResultOf(8), 1.0), Acceptance::kUnknown) << "another share's";
  EXPECT_EQ(ledger.Finished("w", 9, 1, ResultOf(9), 1.0), Acceptance::kAccepted);
  EXPECT_FALSE(ledger.Complete());
  EXPECT_EQ(ledger.Finished("w", 11, 2, ResultOf(11), 1.0), Acceptance::kAccepted);
  EXPECT_TRUE(ledger.Complete());
  EXPECT_FALSE(ledger.IsResult(8, ResultOf(8)));
  ledger.Extend(14);
  EXPECT_EQ(ledger.Progress().total, 5u);
}

TEST(CaseRange, BlocksOfARangeFollowOneAnotherAndDifferByOneAtMost) {
  for (const std::uint64_t count : {1u, 3u, 7u, 40u}) {
    const CaseRange all{100, 117};
    std::uint64_t next = all.first, least = 17, most = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const CaseRange block = BlockOf(all, i, count);
      EXPECT_EQ(block.first, next) << i << " of " << count;
      next = block.end;
      least = std::min(least, block.size());
      most = std::max(most, block.size());
    }
    EXPECT_EQ(next, all.end) << count;
    EXPECT_LE(most - least, 1u) << count;
  }
  constexpr std::uint64_t kMost = 4294967295;
  EXPECT_EQ(BlockOf({0, kMost}, kMost - 1, kMost), (CaseRange{kMost - 1, kMost})) << "nothing overflows";
}

TEST(Ledger, GivesAsManyAssignmentsAsAWorkerGrantsCredits) {
  Ledger ledger("1", 10, {.side_by_side = 1});
  EXPECT_EQ(ledger.Join("w", kHello, 0.0), std::nullopt);
  const auto given = ledger.Assign(0.0);
  // Durations are not known yet: single cases.
  EXPECT_THAT(given, ElementsAre(Assignment{"w", 1, {0}}, Assignment{"w", 2, {1}}));
  EXPECT_THAT(ledger.Assign(0.0), IsEmpty());
  ledger.Started("w", 0, 1, 0.0);
  EXPECT_EQ(ledger.Finished("w", 0, 1, ResultOf(0), 1.0), Acceptance::kAccepted);
  EXPECT_THAT(ledger.Assign(1.0), ElementsAre(Assignment{"w", 3, {2}}));
  const LedgerProgress progress = ledger.Progress();
  EXPECT_EQ(progress.done, 1u);
  EXPECT_EQ(progress.assigned, 2u);
  EXPECT_EQ(progress.waiting, 7u);
}

TEST(Ledger, SpreadsFewCasesOverAllWorkers) {
  Ledger ledger("1", 2);
  ledger.Join("a", kHello, 0.0);
  ledger.Join("b", kHello, 0.0);
  EXPECT_THAT(ledger.Assign(0.0), ElementsAre(Assignment{"a", 1, {0}}, Assignment{"b", 2, {1}}));
}

// The sizes of the assignments of 200 cases of 1/128 s each to one worker that flies one after the other.
std::vector<std::size_t> SizesOf(const LedgerOptions& options) {
  Ledger ledger("1", 200, options);
  ledger.Join("w", {.engine_version = "1", .slots = 1, .credits = 1}, 0.0);
  std::vector<std::size_t> sizes;
  std::uint64_t next = 0;
  double now = 0.0;
  while (!ledger.Complete()) {
    const auto given = ledger.Assign(now);
    if (given.size() != 1) {
      ADD_FAILURE() << given.size() << " assignments";
      return sizes;
    }
    sizes.push_back(given[0].cases.size());
    for (const std::uint64_t case_index : given[0].cases) {
      EXPECT_EQ(case_index, next++);
      ledger.Started("w", case_index, given[0].attempt, now);
      now += 1.0 / 128;
      ledger.Finished("w", case_index, given[0].attempt, ResultOf(case_index), now);
    }
  }
  return sizes;
}

TEST(Ledger, BatchesShortCasesAndShrinksTheBatchesTowardsTheEnd) {
  // 0.25 s of 1/128-s cases are 32; later half of what waits: 199-5*32 = 39/2 = 19, 20/2, 10/2, 5/2, ...
  EXPECT_THAT(SizesOf({.batch_duration_s = 0.25, .max_batch = 64, .side_by_side = 1}),
              ElementsAre(1, 32, 32, 32, 32, 32, 19, 10, 5, 2, 1, 1, 1));
}

TEST(Ledger, BatchesCasesThatFlySideBySideInWholePacks) {
  // Eight at once last as long as one; the largest batch and, later, half of what waits bound them.
  EXPECT_THAT(SizesOf({.batch_duration_s = 0.25, .max_batch = 60, .side_by_side = 8}),
              ElementsAre(8, 56, 56, 40, 16, 8, 8, 4, 2, 1, 1));
}

// One case in a hundred that ends at once, or that takes long, says little of the others.
TEST(Ledger, BatchesFollowTheMeanOfManyCasesAndNotTheLastOne) {
  const auto next_after = [](double last_s) {
    Ledger ledger("1", 4000, {.batch_duration_s = 1.0, .max_batch = 1000, .side_by_side = 1});
    ledger.Join("w", {.engine_version = "1", .slots = 1, .credits = 1}, 0.0);
    double now_s = 0.0;
    const auto fly = [&](double seconds) {
      const auto given = ledger.Assign(now_s);
      for (const std::uint64_t i : given.at(0).cases) {
        ledger.Started("w", i, given[0].attempt, now_s);
        now_s += seconds;
        ledger.Finished("w", i, given[0].attempt, ResultOf(i), now_s);
      }
    };
    for (int i = 0; i < 3; ++i) fly(1.0 / 64);
    const auto given = ledger.GiveTo("w", 0, now_s);
    ledger.Started("w", given->cases[0], given->attempt, now_s);
    now_s += last_s;
    ledger.Finished("w", given->cases[0], given->attempt, ResultOf(given->cases[0]), now_s);
    ledger.Join("v", {.engine_version = "1", .slots = 1, .credits = 1}, now_s);
    return ledger.GiveTo("v", 0, now_s)->cases.size();
  };
  EXPECT_EQ(next_after(1.0 / 64), 64u);
  // The newest one has a weight of a tenth: 0.9 + 0.1 * 0 and 0.9 + 0.1 * 11 of a 64th.
  EXPECT_EQ(next_after(0.0), 71u);
  EXPECT_EQ(next_after(11.0 / 64), 32u);
}

TEST(Ledger, AResultIsAcceptedOnceAndComparedEverAfter) {
  Ledger ledger("1", 3);
  ledger.Join("w", kHello, 0.0);
  const auto given = ledger.Assign(0.0);
  EXPECT_EQ(ledger.Finished("w", 0, given[0].attempt, ResultOf(0), 1.0), Acceptance::kAccepted);
  EXPECT_EQ(ledger.Finished("w", 0, given[0].attempt, ResultOf(0), 1.0), Acceptance::kDuplicate);
  EXPECT_EQ(ledger.Finished("stranger", 0, 77, ResultOf(0), 1.0), Acceptance::kDuplicate);
  EXPECT_EQ(ledger.Finished("w", 0, given[0].attempt, ResultOf(1), 1.0), Acceptance::kConflict);
  EXPECT_EQ(ledger.Finished("w", 3, given[0].attempt, ResultOf(3), 1.0), Acceptance::kUnknown);
  EXPECT_EQ(ledger.Progress().done, 1u);
  EXPECT_EQ(ledger.Progress().duplicates, 2u);
  EXPECT_EQ(ledger.Progress().conflicts, 1u);
  // A case that was never assigned is accepted too, and not flown again.
  EXPECT_EQ(ledger.Finished("stranger", 2, 77, ResultOf(2), 1.0), Acceptance::kAccepted);
  ledger.Finished("w", 1, given[1].attempt, ResultOf(1), 1.0);
  EXPECT_TRUE(ledger.Complete());
  EXPECT_THAT(ledger.Assign(1.0), IsEmpty());
}

TEST(Ledger, ResumesWithTheMissingCases) {
  Ledger ledger("1", 4);
  for (const std::uint64_t case_index : {0u, 2u, 2u}) ledger.MarkDone(case_index, ResultOf(case_index));
  EXPECT_EQ(ledger.Progress().done, 2u);
  ledger.Join("w", kHello, 0.0);
  EXPECT_THAT(ledger.Assign(0.0), ElementsAre(Assignment{"w", 1, {1}}, Assignment{"w", 2, {3}}));
  // The stored fingerprint is what repetitions must equal.
  EXPECT_EQ(ledger.Finished("w", 0, 9, ResultOf(0), 0.0), Acceptance::kDuplicate);
  EXPECT_EQ(ledger.Finished("w", 0, 9, ResultOf(1), 0.0), Acceptance::kConflict);
}

TEST(Ledger, ADeathReturnsTheCasesAndBlamesByItsCause) {
  struct Row {
    WorkerEnd end;
    bool blames;
  };
  for (const Row row : {Row{WorkerEnd::kKilled, false}, Row{WorkerEnd::kLeft, false},
                        Row{WorkerEnd::kCrashed, true}, Row{WorkerEnd::kSilent, true}}) {
    Ledger ledger("1", 3, {.blames_to_quarantine = 1});
    ledger.Join("w", kHello, 0.0);
    const auto given = ledger.Assign(0.0);
    ASSERT_THAT(given, SizeIs(2));
    ledger.Started("w", 0, given[0].attempt, 0.0);  // case 1 is assigned but not started: never blamed
    ledger.Lost("w", row.end, "reason");
    EXPECT_EQ(ledger.Progress().waiting, row.blames ? 2u : 3u);
    if (row.blames) {
      EXPECT_THAT(ledger.Quarantined(), ElementsAre(CaseBlames{0, {"reason"}}));
    } else {
      EXPECT_THAT(ledger.Quarantined(), IsEmpty());
    }
    ledger.Lost("w", row.end, "again");  // told twice: by its exit status and by its heartbeat
    EXPECT_EQ(ledger.Progress().quarantined, row.blames ? 1u : 0u);
  }
}

TEST(Ledger, ABlamedCaseFliesAloneAfterTheOthersAndTheThirdBlameQuarantinesIt) {
  Ledger ledger("1", 4);
  ledger.Join("a", kHello, 0.0);
  auto given = ledger.Assign(0.0);
  ledger.Started("a", 0, given[0].attempt, 0.0);
  ledger.Lost("a", WorkerEnd::kCrashed, "signal 11");
  ledger.Join("b", kHello, 1.0);
  given = ledger.Assign(1.0);
  EXPECT_THAT(given, ElementsAre(Assignment{"b", 3, {1}}, Assignment{"b", 4, {2}}));
  EXPECT_EQ(ledger.Finished("b", 1, 3, ResultOf(1), 1.5), Acceptance::kAccepted);
  EXPECT_THAT(ledger.Assign(1.5), ElementsAre(Assignment{"b", 5, {3}}));
  EXPECT_EQ(ledger.Finished("b", 2, 4, ResultOf(2), 2.0), Acceptance::kAccepted);
  EXPECT_THAT(ledger.Assign(2.0), IsEmpty());  // b still holds case 3: the suspect would not be alone
  EXPECT_EQ(ledger.Finished("b", 3, 5, ResultOf(3), 2.5), Acceptance::kAccepted);
  EXPECT_THAT(ledger.Assign(2.5), ElementsAre(Assignment{"b", 6, {0}}));
  ledger.Started("b", 0, 6, 2.5);
  ledger.Lost("b", WorkerEnd::kKilled, "someone killed it");  // not the case's fault
  ledger.Join("c", kHello, 3.0);
  EXPECT_THAT(ledger.Assign(3.0), ElementsAre(Assignment{"c", 7, {0}}));
  ledger.Started("c", 0, 7, 3.0);
  ledger.Lost("c", WorkerEnd::kCrashed, "signal 6");
  EXPECT_FALSE(ledger.Complete());
  ledger.Join("d", kHello, 4.0);
  EXPECT_THAT(ledger.Assign(4.0), ElementsAre(Assignment{"d", 8, {0}}));
  ledger.Started("d", 0, 8, 4.0);
  ledger.Lost("d", WorkerEnd::kSilent, "silent");
  EXPECT_TRUE(ledger.Complete());
  EXPECT_THAT(ledger.Quarantined(), ElementsAre(CaseBlames{0, {"signal 11", "signal 6", "silent"}}));
  // Better late than never.
  EXPECT_EQ(ledger.Finished("d", 0, 8, ResultOf(0), 9.0), Acceptance::kAccepted);
  EXPECT_THAT(ledger.Quarantined(), IsEmpty());
  EXPECT_EQ(ledger.Progress().done, 4u);
  EXPECT_TRUE(ledger.Complete());
}

TEST(Ledger, NothingJoinsASuspectOnItsWorker) {
  Ledger ledger("1", 3, {.lease_s = 10.0});
  ledger.Join("a", kHello, 0.0);
  ledger.Join("b", kHello, 0.0);
  auto given = ledger.Assign(0.0);
  EXPECT_THAT(given, ElementsAre(Assignment{"a", 1, {0}}, Assignment{"b", 2, {1}}, Assignment{"a", 3, {2}}));
  ledger.Started("a", 0, 1, 0.0);
  ledger.Lost("a", WorkerEnd::kCrashed, "signal 11");
  EXPECT_THAT(ledger.Assign(1.0), ElementsAre(Assignment{"b", 4, {2}}));
  ledger.Finished("b", 1, 2, ResultOf(1), 2.0);
  ledger.Finished("b", 2, 4, ResultOf(2), 2.0);
  EXPECT_THAT(ledger.Assign(2.0), ElementsAre(Assignment{"b", 5, {0}}));
  ledger.Join("c", kHello, 2.0);
  ledger.Join("b", kHello, 2.0);  // a repeated announcement changes nothing
  EXPECT_THAT(ledger.Assign(2.0), IsEmpty());
  // Cases that wait again, or are new, are for others until the suspect has landed.
  ledger.Extend(7);
  for (const Assignment& assignment : ledger.Assign(2.0)) EXPECT_EQ(assignment.worker, "c");
  EXPECT_GT(ledger.Progress().waiting, 0u);
  EXPECT_TRUE(ledger.IsAlone("b"));
  ledger.Finished("b", 0, 5, ResultOf(0), 3.0);
  EXPECT_FALSE(ledger.IsAlone("b"));
  EXPECT_THAT(ledger.Assign(3.0), Not(IsEmpty()));
}

TEST(Ledger, AStuckWorkerLosesItsCasesAndOnlyTheOneThatHangsIsBlamed) {
  Ledger ledger("1", 3, {.lease_s = 10.0, .blames_to_quarantine = 1});
  ledger.Join("a", kHello, 0.0);
  ledger.Assign(0.0);
  ledger.Started("a", 0, 1, 5.0);
  EXPECT_THAT(ledger.Expire(15.0), IsEmpty());
  EXPECT_THAT(ledger.Expire(15.1), ElementsAre("a"));
  EXPECT_THAT(ledger.Quarantined(), ElementsAre(CaseBlames{0, {"no result within its lease"}}));
  EXPECT_EQ(ledger.Progress().waiting, 2u);
  EXPECT_THAT(ledger.Assign(15.1), IsEmpty());  // it must report something first
  EXPECT_THAT(ledger.Expire(99.0), IsEmpty());
  EXPECT_EQ(ledger.Finished("a", 0, 1, ResultOf(0), 99.0), Acceptance::kAccepted);
  EXPECT_THAT(ledger.Assign(99.0), SizeIs(2));
}

TEST(Ledger, AnAssignmentThatNobodyStartsExpiresWithoutBlame) {
  Ledger ledger("1", 1, {.lease_s = 10.0, .blames_to_quarantine = 1});
  ledger.Join("a", kHello, 0.0);
  ledger.Assign(100.0);  // idle time before the assignment does not count
  EXPECT_THAT(ledger.Expire(110.0), IsEmpty());
  EXPECT_THAT(ledger.Expire(110.1), ElementsAre("a"));
  EXPECT_EQ(ledger.Progress().waiting, 1u);
  ledger.Started("a", 0, 1, 111.0);  // of the expired attempt: unsticks the worker, holds nothing
  EXPECT_EQ(ledger.Progress().waiting, 1u);
  EXPECT_THAT(ledger.Assign(111.0), ElementsAre(Assignment{"a", 2, {0}}));
  ledger.Started("a", 0, 1, 112.0);  // the old attempt again: not the one to be blamed
  ledger.Lost("a", WorkerEnd::kCrashed, "signal 11");
  EXPECT_THAT(ledger.Quarantined(), IsEmpty());
}

TEST(Ledger, AnAssignmentThatGotLostIsGivenAgainToTheWorkerThatIsIdle) {
  Ledger ledger("1", 1, {.lease_s = 10.0});
  ledger.Join("a", kHello, 0.0);
  ledger.Assign(0.0);
  ledger.Idle("a");  // it may still be on its way
  EXPECT_THAT(ledger.Assign(5.0), IsEmpty());
  EXPECT_THAT(ledger.Expire(10.1), ElementsAre("a"));
  EXPECT_THAT(ledger.Assign(10.1), IsEmpty());
  ledger.Idle("a");
  EXPECT_THAT(ledger.Assign(10.2), ElementsAre(Assignment{"a", 2, {0}}));
  ledger.Idle("nobody");
}

TEST(Ledger, TheLeaseGrowsWithTheLongestCase) {
  Ledger ledger("1", 2, {.lease_s = 10.0});
  ledger.Join("a", kHello, 0.0);
  ledger.Assign(0.0);
  ledger.Started("a", 0, 1, 0.0);
  ledger.Finished("a", 0, 1, ResultOf(0), 5.0);  // so 100 s from now on
  ledger.Started("a", 1, 2, 5.0);
  EXPECT_THAT(ledger.Expire(105.0), IsEmpty());
  EXPECT_THAT(ledger.Expire(105.1), ElementsAre("a"));
}

TEST(Ledger, AStartThatIsSaidAgainIsNoLater) {
  Ledger ledger("1", 1, {.lease_s = 10.0, .blames_to_quarantine = 1});
  ledger.Join("a", kHello, 0.0);
  ledger.Assign(0.0);
  for (const double now_s : {0.0, 4.0, 8.0}) ledger.Started("a", 0, 1, now_s);  // as every status says
  EXPECT_THAT(ledger.Expire(10.0), IsEmpty());
  EXPECT_THAT(ledger.Expire(10.1), ElementsAre("a"));
  EXPECT_EQ(ledger.Progress().quarantined, 1u);
}

TEST(Ledger, AWorkerWhoseSuspectHungGetsOthersWhenItSpeaksAgain) {
  Ledger ledger("1", 1, {.lease_s = 10.0});
  ledger.Join("doomed", kHello, 0.0);
  ledger.Assign(0.0);
  ledger.Started("doomed", 0, 1, 0.0);
  ledger.Lost("doomed", WorkerEnd::kCrashed, "signal 11");
  ledger.Join("a", kHello, 1.0);
  EXPECT_THAT(ledger.Assign(1.0), ElementsAre(Assignment{"a", 2, {0}}));
  ledger.Started("a", 0, 2, 1.0);
  EXPECT_THAT(ledger.Expire(11.1), ElementsAre("a"));
  EXPECT_FALSE(ledger.IsAlone("a"));
  ledger.Idle("a");
  ledger.Extend(2);
  EXPECT_EQ(ledger.GiveTo("a", 0, 12.0)->cases, std::vector<std::uint64_t>{1});
}

TEST(Ledger, ACaseThatWasFlownIsNoSuspectAnyMore) {
  Ledger ledger("1", 1, {.blames_to_quarantine = 2});
  const auto crash = [&](const std::string& worker) {
    ledger.Join(worker, kHello, 0.0);
    const auto given = ledger.Assign(0.0);
    ASSERT_THAT(given, SizeIs(1));
    ledger.Started(worker, 0, given[0].attempt, 0.0);
    ledger.Lost(worker, WorkerEnd::kCrashed, "signal 11");
  };
  crash("a");
  EXPECT_EQ(ledger.Finished("late", 0, 1, ResultOf(0), 1.0), Acceptance::kAccepted);
  ledger.Reopen({0});  // its worker was expelled
  crash("b");
  EXPECT_EQ(ledger.Progress().quarantined, 0u) << "the first blame of a new life";
  crash("c");
  EXPECT_EQ(ledger.Progress().quarantined, 1u);
}

// The result of one worker came late, when another one flew the case already. Then the first one is expelled.
TEST(Ledger, ACaseThatSomebodyFliesIsNotWaitingWhenItsResultIsRemoved) {
  Ledger ledger("1", 1);
  ledger.Join("late", kHello, 0.0);
  const auto first = ledger.Assign(0.0);
  ASSERT_THAT(first, SizeIs(1));
  ledger.Expire(100.0);
  ledger.Join("b", kHello, 100.0);
  const auto second = ledger.Assign(100.0);
  ASSERT_THAT(second, SizeIs(1));
  EXPECT_EQ(second[0].worker, "b");
  EXPECT_EQ(ledger.Finished("late", 0, first[0].attempt, ResultOf(0), 101.0), Acceptance::kAccepted);
  ledger.Lost("late", WorkerEnd::kKilled, "expelled");
  ledger.Reopen({0});
  EXPECT_EQ(ledger.Progress().waiting, 0u);
  EXPECT_EQ(ledger.Progress().assigned, 1u);
  EXPECT_THAT(ledger.Assign(102.0), testing::IsEmpty());
  EXPECT_EQ(ledger.Batches("b"), 1u);
  ledger.Lost("b", WorkerEnd::kLeft, "it left");
  EXPECT_EQ(ledger.Progress().waiting, 1u) << "nobody flies it any more";
}

TEST(Ledger, AssignmentsOfOtherCampaignsCountAsCredits) {
  Ledger ledger("1", 3, {.side_by_side = 1});
  ledger.Join("w", kHello, 0.0);  // two credits
  EXPECT_FALSE(ledger.GiveTo("w", 2, 0.0));
  EXPECT_TRUE(ledger.GiveTo("w", 1, 0.0));
  EXPECT_FALSE(ledger.GiveTo("w", 1, 0.0));
}

TEST(Ledger, ASuspectIsGivenToOneWhoHoldsNothingOfOtherCampaigns) {
  Ledger ledger("1", 1);
  ledger.Join("doomed", kHello, 0.0);
  ledger.Assign(0.0);
  ledger.Started("doomed", 0, 1, 0.0);
  ledger.Lost("doomed", WorkerEnd::kCrashed, "signal 11");
  ledger.Join("w", kHello, 0.0);
  EXPECT_FALSE(ledger.GiveTo("w", 1, 0.0));
  EXPECT_TRUE(ledger.GiveTo("w", 0, 0.0));
  EXPECT_TRUE(ledger.IsAlone("w"));
}

TEST(Ledger, AQuarantinedCaseSaysNothingOfHowLongOthersTake) {
  Ledger ledger("1", 2, {.lease_s = 10.0, .side_by_side = 1});
  ledger.Join("a", kHello, 0.0);
  ledger.Assign(0.0);
  ledger.Started("a", 0, 1, 0.0);
  EXPECT_FALSE(ledger.Quarantine("a", 0, 99, "of another attempt", 5.0));
  EXPECT_EQ(ledger.Progress().quarantined, 0u) << "somebody else may fly it";
  EXPECT_FALSE(ledger.Quarantine("a", 0, 1, "it hung", 9.0));
  EXPECT_EQ(ledger.Progress().quarantined, 1u);
  ledger.Started("a", 1, 2, 9.0);
  EXPECT_THAT(ledger.Expire(19.1), ElementsAre("a"));
}

// Cases of the second assignment of a worker with one slot, of 99 that are left and take 1 ms; before it,
// something happens.
template <typename Event>
std::size_t NextBatch(Event event) {
  Ledger ledger("1", 100, {.side_by_side = 1});
  ledger.Join("w", {.engine_version = "1", .slots = 1, .credits = 1}, 0.0);
  ledger.Assign(0.0);
  ledger.Started("w", 0, 1, 0.0);
  ledger.Finished("w", 0, 1, ResultOf(0), 0.001);
  event(ledger);
  return ledger.GiveTo("w", 0, 1.0)->cases.size();
}

TEST(Ledger, SlotsAreThoseOfWorkersThatAreHere) {
  const WorkerHello large{.engine_version = "1", .slots = 10, .credits = 20};
  // At least two rounds for every slot.
  EXPECT_EQ(NextBatch([](Ledger&) {}), 99u / 2);
  EXPECT_EQ(NextBatch([&](Ledger& ledger) { ledger.Join("v", large, 0.5); }), 99u / 22);
  EXPECT_EQ(NextBatch([&](Ledger& ledger) {
              for (int i = 0; i < 5; ++i) ledger.Join("v", large, 0.5);
            }),
            99u / 22)
      << "a worker is counted once";
  EXPECT_EQ(NextBatch([&](Ledger& ledger) {
              ledger.Join("v", large, 0.5);
              ledger.Lost("v", WorkerEnd::kLeft, "it left");
            }),
            99u / 2);
}

// Two workers with one case each, of two; "quick" has returned its own after a second.
class Overdue : public testing::Test {
 protected:
  Overdue() {
    Come("a");
    Come("quick");
    given_ = ledger_.Assign(0.0);
    ledger_.Started("quick", 1, given_.at(1).attempt, 0.0);
    ledger_.Finished("quick", 1, given_.at(1).attempt, ResultOf(1), longest_s_);
  }
  void Come(const std::string& worker, double now_s = 0.0) {
    ledger_.Join(worker, {.engine_version = "1", .slots = 1, .credits = 1}, now_s);
  }
  bool IsTakenFrom(const std::string& worker, double now_s) {
    ledger_.Expire(now_s);
    return ledger_.Batches(worker) == 0;
  }
  /// The worker that gets the case that waits; empty: nobody.
  std::string WhoGetsIt(double now_s) {
    const auto given = ledger_.Assign(now_s);
    return given.empty() ? "" : given[0].worker;
  }

  const double longest_s_ = 1.0;
  Ledger ledger_{"1", 2, {.lease_s = 1000.0, .overdue_s = 30.0, .side_by_side = 1}};
  std::vector<Assignment> given_;
};

TEST_F(Overdue, ACaseIsTakenFromOneThatReturnsNothingForAnIdleOne) {
  EXPECT_FALSE(IsTakenFrom("a", 30.0));
  EXPECT_TRUE(IsTakenFrom("a", 30.1)) << "more than 20 times the longest case";
  EXPECT_EQ(WhoGetsIt(30.1), "quick") << "although a comes first";
  EXPECT_TRUE(ledger_.WasGiven("a", 0)) << "its result is still welcome";
}

TEST_F(Overdue, NotBeforeTwentyTimesTheLongestCase) {
  ledger_.Extend(3);
  ledger_.Assign(1.0);
  ledger_.Started("quick", 2, 3, 1.0);
  ledger_.Finished("quick", 2, 3, ResultOf(2), 4.0);
  EXPECT_FALSE(IsTakenFrom("a", 59.0)) << "the longest took 3 s";
  EXPECT_TRUE(IsTakenFrom("a", 61.0));
}

TEST_F(Overdue, NotWhileAnotherCaseWaits) {
  ledger_.Extend(3);
  EXPECT_FALSE(IsTakenFrom("a", 40.0));
}

TEST_F(Overdue, ACaseIsTakenOnceAndThenLeftToItsSecondWorker) {
  ASSERT_TRUE(IsTakenFrom("a", 31.0));
  ASSERT_EQ(WhoGetsIt(31.0), "quick");
  Come("c", 32.0);
  EXPECT_FALSE(IsTakenFrom("quick", 100.0));
}

TEST_F(Overdue, ASlowWorkerGetsCasesWhenNoQuickOneIsHere) {
  ASSERT_TRUE(IsTakenFrom("a", 31.0));
  ledger_.Withdraw("quick", {});
  EXPECT_EQ(WhoGetsIt(32.0), "a") << "the other one leaves";
}

TEST_F(Overdue, ASlowWorkerThatReturnsItsCaseIsQuickAgain) {
  ASSERT_TRUE(IsTakenFrom("a", 31.0));
  ledger_.Finished("a", 0, given_[0].attempt, ResultOf(0), 32.0);
  ledger_.Extend(3);
  EXPECT_EQ(WhoGetsIt(32.0), "a");
}

TEST(Ledger, RemembersTheLastFourWorkersThatHeldACase) {
  Ledger ledger("1", 1);
  for (const char* worker : {"a", "b", "c", "d", "e"}) {
    ledger.Join(worker, kHello, 0.0);
    ASSERT_THAT(ledger.Assign(0.0), SizeIs(1));
    ledger.Lost(worker, WorkerEnd::kLeft, "it left");
  }
  EXPECT_FALSE(ledger.WasGiven("a", 0));
  for (const char* worker : {"b", "c", "d", "e"}) EXPECT_TRUE(ledger.WasGiven(worker, 0)) << worker;
}

TEST(Ledger, AWorkerHoldsFewUntilItHasReturnedSome) {
  Ledger ledger("1", 100, {.first_assignments = 2, .side_by_side = 1});
  ledger.Join("w", {.engine_version = "1", .slots = 1, .credits = 5}, 0.0);
  EXPECT_THAT(ledger.Assign(0.0), SizeIs(2));
  ledger.Finished("w", 0, 1, ResultOf(0), 1.0);
  EXPECT_THAT(ledger.Assign(1.0), SizeIs(2)) << "it holds one, and may hold three";
  for (const std::uint64_t i : {1, 2, 3}) ledger.Finished("w", i, i + 1, ResultOf(i), 2.0);
  EXPECT_THAT(ledger.Assign(2.0), SizeIs(5)) << "its credits";
}

TEST(Ledger, OfTheCasesOfAStuckWorkerOnlyThoseThatFlewTooLongAreBlamed) {
  Ledger ledger("1", 3, {.lease_s = 10.0, .blames_to_quarantine = 1, .side_by_side = 1});
  ledger.Join("w", {.engine_version = "1", .slots = 3, .credits = 3}, 0.0);
  ASSERT_THAT(ledger.Assign(0.0), SizeIs(3));
  ledger.Started("w", 0, 1, 0.0);
  ledger.Started("w", 1, 2, 8.0);
  EXPECT_THAT(ledger.Expire(10.5), ElementsAre("w"));
  EXPECT_THAT(ledger.Quarantined(), ElementsAre(CaseBlames{0, {"no result within its lease"}, false}));
  EXPECT_EQ(ledger.Progress().waiting, 2u);
}

// Of two workers, the first result of each and the share of all.
std::vector<std::uint64_t> AuditedOf(double share) {
  Audit audit({share, 5});
  for (std::uint64_t i = 0; i < 1000; ++i)
    audit.Consider({i % 2 == 0 ? "node1_a" : "node2_b", i, ResultOf(i)});
  std::vector<std::uint64_t> cases;
  for (const Claim& claim : audit.Take()) cases.push_back(claim.case_index);
  return cases;
}

TEST(Audit, TakesTheFirstOfEachWorkerAndAShareOfAll) {
  EXPECT_THAT(AuditedOf(0.0), ElementsAre(0, 1));
  const std::vector<std::uint64_t> tenth = AuditedOf(0.1);
  EXPECT_THAT(tenth, ::testing::IsSupersetOf({0u, 1u}));
  EXPECT_THAT(tenth.size(), ::testing::AllOf(::testing::Gt(70u), ::testing::Lt(130u)));
  EXPECT_EQ(AuditedOf(1.0).size(), 1000u);
}

TEST(Audit, ForgetsTheResultsOfOneWorkerAlone) {
  Audit audit({1.0, 5});
  for (const char* worker : {"node1_a", "node2_b", "node1_c", "node10_d"}) audit.Consider({worker, 0, {}});
  audit.Drop("node1");
  std::vector<std::string> left;
  for (const Claim& claim : audit.Take()) left.push_back(claim.worker);
  EXPECT_THAT(left, ElementsAre("node2_b", "node10_d"));
  EXPECT_FALSE(audit.IsSettled());
  audit.Settle();
  EXPECT_FALSE(audit.IsSettled()) << "one of two";
  audit.Settle();
  EXPECT_TRUE(audit.IsSettled());
}

// Two requirements with other limits, probabilities and failures.
class TallyOfTwo : public testing::Test {
 protected:
  TallyOfTwo() {
    Requirement peak, pressure;
    peak.metric = "pitch_error_peak_deg";
    peak.below = 0.5;
    peak.probability = 0.9;
    peak.consumer_risk = 0.1;
    pressure.metric = "q_max_pa";
    pressure.above = 100.0;
    pressure.probability = 0.5;
    pressure.consumer_risk = 0.05;
    campaign_.name = "two";
    campaign_.id = std::string(64, 'a');
    campaign_.flight_id = std::string(64, 'f');
    campaign_.design_id = std::string(64, 'd');
    campaign_.requirements = {peak, pressure};
    campaign_.sampling.cases = 100;
  }
  static CaseResult Flown(std::uint64_t case_index, double peak_deg, double pressure_pa,
                          Outcome outcome = Outcome::kCompleted) {
    CaseResult result;
    result.case_index = case_index;
    result.outcome = outcome;
    ApplyNominal(result);
    result.metrics.resize(MetricCount(kUsualStages));
    result.metrics[MetricColumn("pitch_error_peak_deg")] = peak_deg;
    result.metrics[MetricColumn("q_max_pa")] = pressure_pa;
    return result;
  }
  static std::string Line(const RequirementStanding& one) {
    return one.metric + " " + std::to_string(one.failures) + "/" + std::to_string(one.n) + " " + one.so_far;
  }

  Campaign campaign_;
};

TEST_F(TallyOfTwo, EachIsJudgedByItsOwnMetricLimitProbabilityAndRisk) {
  RunningTally tally(campaign_);
  const auto standings = [&] {
    std::vector<std::string> lines;
    for (const RequirementStanding& one : tally.Standings()) lines.push_back(Line(one));
    return lines;
  };
  // 0.5^5 is the first power below its risk of 0.05; of 0.9 it is the 22nd, below 0.1.
  for (std::uint64_t i = 0; i < 4; ++i) tally.Add(Flown(i, 0.1, 200.0));
  EXPECT_THAT(standings(), ElementsAre("pitch_error_peak_deg 0/4 inconclusive", "q_max_pa 0/4 inconclusive"));
  tally.Add(Flown(4, 0.1, 200.0));
  EXPECT_THAT(standings(), ElementsAre("pitch_error_peak_deg 0/5 inconclusive", "q_max_pa 0/5 pass"));
  tally.Add(Flown(5, 0.6, 200.0));
  tally.Add(Flown(6, 0.6, 200.0));
  EXPECT_THAT(standings(), ElementsAre("pitch_error_peak_deg 2/7 inconclusive", "q_max_pa 0/7 pass"));
  tally.Add(Flown(7, 0.6, 50.0));
  EXPECT_THAT(standings(), ElementsAre("pitch_error_peak_deg 3/8 fail", "q_max_pa 1/8 pass"));
}

TEST_F(TallyOfTwo, ChosenPointsAreAStudyHoweverManyAreFlown) {
  campaign_.sampling.method = SamplingMethod::kSobol;
  RunningTally tally(campaign_);
  for (std::uint64_t i = 0; i < 30; ++i) tally.Add(Flown(i, 0.1, 50.0));
  EXPECT_EQ(Line(tally.Standings()[0]), "pitch_error_peak_deg 0/30 study");
  EXPECT_EQ(Line(tally.Standings()[1]), "q_max_pa 30/30 study");
}

TEST_F(TallyOfTwo, AHistogramHasTheLimitsOfItsOwnRequirement) {
  const RunningTally tally(campaign_);
  ASSERT_GE(tally.histograms().size(), 2u);
  EXPECT_EQ(tally.histograms()[0].limits.high, 0.5);
  EXPECT_EQ(tally.histograms()[1].metric, "q_max_pa");
  EXPECT_EQ(tally.histograms()[1].limits.low, 100.0);
}

// Of ten cases two wait, one flies, seven are flown, one of them is lost.
TEST_F(TallyOfTwo, OfACancelledAttemptCasesWithoutAResultAreFailuresOfEach) {
  campaign_.sampling.cases = 10;
  CampaignBook book(campaign_, std::make_unique<MemoryStore>(), {.side_by_side = 1});
  book.KeepTally();
  for (std::uint64_t i = 0; i < 7; ++i)
    book.Accept("w", "host", 0,
                Flown(i, i < 2 ? 0.7 : 0.1, i < 4 ? 50.0 : 200.0,
                      i == 6 ? Outcome::kLostControl : Outcome::kCompleted),
                1.0);
  book.ledger().Join("v", {EngineVersion(), 1, 1}, 1.0);
  ASSERT_THAT(book.ledger().Assign(1.0), SizeIs(1));
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "results");
  NoteCancelledIn(folder.path(), folder / "results", book);
  const std::vector<AttemptRecord> noted = AttemptLedger(folder / "results" / kFolderLedgerName).Read();
  ASSERT_THAT(noted, SizeIs(1));
  EXPECT_EQ(noted[0].cases, 8) << "up to the last that was assigned";
  ASSERT_THAT(noted[0].requirements, SizeIs(2));
  EXPECT_EQ(noted[0].requirements[0].failures, 2 + 1 + 1) << "beyond the limit, lost, without a result";
  EXPECT_EQ(noted[0].requirements[1].failures, 4 + 1 + 1);
}

// Cases that two workers shall fly.
class SecondFlights : public testing::Test {
 protected:
  SecondFlights() {
    for (std::uint64_t i = 0; i < 2; ++i) ledger_.RequireSecondFlight(i);
  }
  void Come(const std::string& worker) { ledger_.Join(worker, {"1", 1, 1}, now_s_); }
  Acceptance Fly(const Assignment& given, std::uint64_t case_index, Digest result) {
    ledger_.Started(given.worker, case_index, given.attempt, now_s_);
    return ledger_.Finished(given.worker, case_index, given.attempt, result, now_s_);
  }
  void FlyAllAlone() {
    Come("a");
    for (auto given = ledger_.Assign(now_s_); !given.empty(); given = ledger_.Assign(now_s_)) {
      for (const std::uint64_t i : given[0].cases) Fly(given[0], i, ResultOf(i));
    }
  }
  Ledger ledger_{"1", 4, {.lease_s = 10.0, .blames_to_quarantine = 2, .side_by_side = 1}};
  double now_s_ = 0.0;
};

TEST_F(SecondFlights, OneWorkerAloneBringsItToItsEnd) {
  FlyAllAlone();
  EXPECT_TRUE(ledger_.Complete());
  EXPECT_EQ(ledger_.Progress().duplicates, 0u);
}

TEST_F(SecondFlights, AnotherWorkerFliesThemBeforeAllElse) {
  Come("a");
  const Assignment first = ledger_.Assign(0.0)[0];
  EXPECT_EQ(first, (Assignment{"a", 1, {0}}));
  Fly(first, 0, ResultOf(0));
  Come("b");
  const auto given = ledger_.Assign(0.0);
  EXPECT_THAT(given, ElementsAre(Assignment{"a", 2, {1}}, Assignment{"b", 3, {0}}));
  Come("c");
  EXPECT_THAT(ledger_.Assign(0.0), ElementsAre(Assignment{"c", 4, {2}})) << "one of them is enough";
  EXPECT_EQ(Fly(given[1], 0, ResultOf(0)), Acceptance::kDuplicate);
  EXPECT_THAT(ledger_.Assign(0.0), ElementsAre(Assignment{"b", 5, {3}})) << "once again is enough";
}

TEST_F(SecondFlights, IsNotCompleteWhileAnotherWorkerCouldFlyThem) {
  FlyAllAlone();
  Come("b");
  EXPECT_FALSE(ledger_.Complete());
  const auto given = ledger_.Assign(0.0);
  ASSERT_THAT(given, ElementsAre(Assignment{"b", 5, {0, 1}}));
  EXPECT_EQ(ledger_.Owed("b", 5), given[0].cases);
  EXPECT_EQ(Fly(given[0], 0, ResultOf(0)), Acceptance::kDuplicate);
  EXPECT_FALSE(ledger_.Complete());
  EXPECT_EQ(Fly(given[0], 1, ResultOf(7)), Acceptance::kConflict);
  EXPECT_TRUE(ledger_.Complete());
  EXPECT_EQ(ledger_.Batches("b"), 0u);
  EXPECT_EQ(ledger_.Progress().done, 4u);
}

TEST_F(SecondFlights, AWorkerThatLeavesOwesNothing) {
  FlyAllAlone();
  Come("b");
  ledger_.Assign(0.0);
  ledger_.Withdraw("b", {0});
  EXPECT_FALSE(ledger_.Complete()) << "it ends what it flies";
  ledger_.Lost("b", WorkerEnd::kLeft, "left");
  EXPECT_TRUE(ledger_.Complete());
  Come("c");
  EXPECT_THAT(ledger_.Assign(0.0), ElementsAre(Assignment{"c", 6, {0, 1}}));
}

TEST_F(SecondFlights, ThoseThatEndOrHangTheirWorkersAreNotAskedForForEver) {
  FlyAllAlone();
  Come("b");
  ledger_.Started("b", 0, ledger_.Assign(0.0)[0].attempt, 0.0);
  ledger_.Lost("b", WorkerEnd::kCrashed, "signal 11");
  Come("c");
  ledger_.Started("c", 0, ledger_.Assign(0.0)[0].attempt, 0.0);
  EXPECT_THAT(ledger_.Expire(11.0), ElementsAre("c"));
  EXPECT_TRUE(ledger_.Complete()) << "a worker that hangs is not waited for";
  ledger_.Idle("c");
  EXPECT_THAT(ledger_.Assign(11.0), ElementsAre(Assignment{"c", 7, {1}}));
  EXPECT_EQ(ledger_.Progress().done, 4u) << "their results stay";
  EXPECT_THAT(ledger_.Quarantined(), IsEmpty());
}

TEST_F(SecondFlights, TheSameWorkersResultSaidAgainIsNoSecondFlight) {
  FlyAllAlone();
  Come("b");
  EXPECT_EQ(ledger_.Finished("a", 0, 1, ResultOf(0), 0.0), Acceptance::kDuplicate);
  EXPECT_FALSE(ledger_.Complete());
  EXPECT_THAT(ledger_.Assign(0.0)[0].cases, ElementsAre(0, 1));
}

TEST_F(SecondFlights, WhatIsNotBelievedAnyMoreIsWantedTwiceAnew) {
  FlyAllAlone();
  Come("b");
  const Assignment given = ledger_.Assign(0.0)[0];
  for (const std::uint64_t i : {0, 1}) Fly(given, i, ResultOf(i));
  ledger_.Reopen({0});
  ledger_.Lost("a", WorkerEnd::kKilled, "expelled");
  const Assignment again = ledger_.Assign(0.0)[0];
  EXPECT_EQ(again, (Assignment{"b", 6, {0}}));
  Fly(again, 0, ResultOf(0));
  Come("c");
  EXPECT_FALSE(ledger_.Complete());
  EXPECT_THAT(ledger_.Assign(0.0), ElementsAre(Assignment{"c", 7, {0}}));
}

TEST_F(SecondFlights, OneThatSurvivesWhatAnotherDoesNotSaysSo) {
  FlyAllAlone();
  Come("b");
  const Assignment given = ledger_.Assign(0.0)[0];
  EXPECT_TRUE(ledger_.Quarantine("b", 0, given.attempt, "signal 11", 0.0));
  EXPECT_FALSE(ledger_.Quarantine("b", 0, given.attempt, "signal 11", 0.0)) << "said again";
  EXPECT_EQ(ledger_.Progress().quarantined, 0u);
}

TEST_F(SecondFlights, ResumesWithWhoFlewThem) {
  Ledger resumed("1", 2);
  for (std::uint64_t i = 0; i < 2; ++i) resumed.MarkDone(i, ResultOf(i));
  resumed.RequireSecondFlight(0, "a");
  resumed.RequireSecondFlight(1);
  EXPECT_TRUE(resumed.Complete());
  resumed.Join("a", kHello, 0.0);
  EXPECT_THAT(resumed.Assign(0.0), ElementsAre(Assignment{"a", 1, {1}})) << "nobody knows who flew case 1";
  resumed.Join("b", kHello, 0.0);
  EXPECT_THAT(resumed.Assign(0.0), ElementsAre(Assignment{"b", 2, {0}}));
}

// A world with delayed, reordered and repeated messages. Workers are killed, stop their status messages and
// come back. Poison cases crash or hang their worker. For any order of events, every other case is accepted
// exactly once, exactly the poison cases are quarantined, and the world ends. In every other world two
// workers must fly the first cases.
class RandomWorld {
 public:
  RandomWorld(std::uint64_t seed, std::uint64_t cases)
      : random_(seed),
        cases_(cases),
        ledger_("1", cases, {.lease_s = 3.0}),
        second_flights_(seed % 2 == 1 ? 2 : 0) {
    for (std::uint64_t k = 0; k < cases; ++k) {
      if (k < second_flights_) ledger_.RequireSecondFlight(k);
      if (Chance(0.03)) (Chance(0.5) ? crashing_ : hanging_).insert(k);
    }
  }

  void Run() {
    int steps = 0;
    while (!ledger_.Complete()) {
      ASSERT_LT(++steps, 200000) << "does not come to rest";
      Step();
      const LedgerProgress progress = ledger_.Progress();
      ASSERT_EQ(progress.done, accepted_.size());
      ASSERT_EQ(progress.done + progress.quarantined + progress.waiting + progress.assigned, cases_);
    }
    std::set<std::uint64_t> poison = crashing_;
    poison.insert(hanging_.begin(), hanging_.end());
    std::set<std::uint64_t> quarantined;
    for (const CaseBlames& q : ledger_.Quarantined()) {
      quarantined.insert(q.case_index);
      EXPECT_THAT(q.reasons, SizeIs(3));
    }
    EXPECT_EQ(quarantined, poison);
    for (std::uint64_t k = 0; k < cases_; ++k) {
      EXPECT_EQ(accepted_.count(k), poison.contains(k) ? 0u : 1u) << k;
    }
    EXPECT_EQ(ledger_.Progress().conflicts, 0u);
  }

 private:
  struct Message {
    enum { kStarted, kFinished } kind;
    std::uint64_t case_index;
    std::uint64_t attempt;
  };
  struct Machine {
    std::deque<std::pair<std::uint64_t, std::uint64_t>> queue;  ///< case, attempt
    std::vector<std::pair<std::uint64_t, std::uint64_t>> flying;
    std::deque<Message> outbox;  ///< in order, as of one reliable writer
    bool known = false;
  };

  bool Chance(double p) { return std::bernoulli_distribution(p)(random_); }

  void Step() {
    now_s_ += 0.05;
    if (machines_.size() < 4 && Chance(0.2)) machines_["w" + std::to_string(next_++)] = {};
    for (auto& [id, machine] : machines_) {
      if (!machine.known && Chance(0.3)) {
        ASSERT_EQ(ledger_.Join(id, {.engine_version = "1", .slots = 2, .credits = 3}, now_s_), std::nullopt);
        machine.known = true;
      }
    }
    for (const std::string& stuck : ledger_.Expire(now_s_)) {
      Deliver(stuck);
      machines_.erase(stuck);
      ledger_.Lost(stuck, WorkerEnd::kKilled, "stuck");
    }
    for (const Assignment& assignment : ledger_.Assign(now_s_)) {
      ASSERT_TRUE(machines_.contains(assignment.worker));
      for (std::size_t i = 1; i < assignment.cases.size(); ++i) {
        ASSERT_EQ(assignment.cases[i], assignment.cases[i - 1] + 1) << "not contiguous";
      }
      for (const std::uint64_t k : assignment.cases) {
        ASSERT_LT(k, cases_);
        if (accepted_.contains(k)) {
          ASSERT_LT(k, second_flights_) << "flown again";
          ASSERT_NE(accepted_.at(k), assignment.worker) << "flown again by the same worker";
        }
        machines_[assignment.worker].queue.emplace_back(k, assignment.attempt);
      }
    }
    std::vector<std::string> ids;
    for (const auto& [id, machine] : machines_) ids.push_back(id);
    for (const std::string& id : ids) Act(id);
  }

  void Act(const std::string& id) {
    Machine& machine = machines_[id];
    if (machine.flying.size() < 2 && !machine.queue.empty() && Chance(0.7)) {
      machine.flying.push_back(machine.queue.front());
      machine.queue.pop_front();
      const auto [k, attempt] = machine.flying.back();
      machine.outbox.push_back({Message::kStarted, k, attempt});
      if (crashing_.contains(k)) {
        // Some of its last messages arrive, some do not.
        if (Chance(0.9)) Deliver(id);
        machines_.erase(id);
        ledger_.Lost(id, Chance(0.5) ? WorkerEnd::kCrashed : WorkerEnd::kSilent, "crash");
        return;
      }
    }
    for (std::size_t i = 0; i < machine.flying.size(); ++i) {
      const auto [k, attempt] = machine.flying[i];
      if (hanging_.contains(k) || !Chance(0.5)) continue;
      machine.outbox.push_back({Message::kFinished, k, attempt});
      machine.flying.erase(machine.flying.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    if (Chance(0.5)) Deliver(id);
    if (Chance(0.004)) {
      if (Chance(0.5)) Deliver(id);
      // Killed; what it had sent may still arrive after the news of its death.
      ledger_.Lost(id, WorkerEnd::kKilled, "killed");
      Deliver(id);
      machines_.erase(id);
    } else if (Chance(0.005) && machine.flying.empty()) {
      // A partition of the network: it is declared lost, goes on, and is back later.
      ledger_.Lost(id, WorkerEnd::kSilent, "silent");
      machine.known = false;
    }
  }

  void Deliver(const std::string& id) {
    std::deque<Message>& outbox = machines_[id].outbox;
    for (const Message& message : outbox) {
      for (int repetition = Chance(0.05) ? 2 : 1; repetition > 0; --repetition) {
        if (message.kind == Message::kStarted) {
          ledger_.Started(id, message.case_index, message.attempt, now_s_);
          continue;
        }
        const Acceptance acceptance =
            ledger_.Finished(id, message.case_index, message.attempt, ResultOf(message.case_index), now_s_);
        if (acceptance == Acceptance::kAccepted) {
          EXPECT_TRUE(accepted_.emplace(message.case_index, id).second) << "accepted twice";
        } else {
          EXPECT_EQ(acceptance, Acceptance::kDuplicate);
        }
      }
    }
    outbox.clear();
  }

  std::mt19937_64 random_;
  std::uint64_t cases_;
  Ledger ledger_;
  std::set<std::uint64_t> crashing_;
  std::set<std::uint64_t> hanging_;
  std::uint64_t second_flights_;                   ///< so many of the first cases
  std::map<std::uint64_t, std::string> accepted_;  ///< by whom
  std::map<std::string, Machine> machines_;
  int next_ = 0;
  double now_s_ = 0.0;
};

TEST(Ledger, EveryInterleavingAcceptsEachCaseOnceAndQuarantinesExactlyThePoison) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE(seed);
    RandomWorld(seed, 60).Run();
    if (testing::Test::HasFailure()) break;
  }
}

TEST(IndexSet, BehavesLikeASetThatGivesItsLowestRun) {
  std::mt19937_64 random(1);
  IndexSet set;
  std::set<std::uint64_t> model;
  set.AddRange(10, 30);
  for (std::uint64_t k = 10; k < 30; ++k) model.insert(k);
  for (int step = 0; step < 20000; ++step) {
    const std::uint64_t k = random() % 64;
    switch (random() % 3) {
      case 0:
        if (model.insert(k).second) set.Add(k);
        break;
      case 1:
        ASSERT_EQ(set.Remove(k), model.erase(k) == 1);
        break;
      default: {
        const std::uint64_t limit = 1 + random() % 3;
        std::vector<std::uint64_t> expected;
        while (!model.empty() && expected.size() < limit &&
               (expected.empty() || *model.begin() == expected.back() + 1)) {
          expected.push_back(*model.begin());
          model.erase(model.begin());
        }
        ASSERT_EQ(set.TakeRun(limit), expected);
      }
    }
    ASSERT_EQ(set.Count(), model.size());
    ASSERT_EQ(set.Empty(), model.empty());
  }
}

TEST(Ledger, GoesOnWhenItIsExtended) {
  Ledger ledger("engine", 2);
  ASSERT_FALSE(ledger.Join("w", {"engine", 1, 2}, 0.0));
  for (const Assignment& assignment : ledger.Assign(0.0)) {
    for (const std::uint64_t index : assignment.cases)
      ledger.Finished("w", index, assignment.attempt, Digest{index, 1}, 1.0);
  }
  EXPECT_TRUE(ledger.Complete());
  ledger.Extend(2);
  EXPECT_TRUE(ledger.Complete());
  ledger.Extend(5);
  EXPECT_FALSE(ledger.Complete());
  EXPECT_EQ(ledger.Progress().total, 5u);
  EXPECT_EQ(ledger.Progress().waiting, 3u);
  EXPECT_EQ(ledger.Assign(2.0).front().cases.front(), 2u);
}

}  // namespace
}  // namespace dispersa::coordinator_ledger_test
