// What a coordinator of many campaigns decides by rules of each owner, each campaign and each limit: who is
// deleted, who may launch, who flies next, how long it takes. Every rule is tested with members that differ.
#include "services/coordinator/catalogue.h"
#include "services/coordinator/outcomes.h"
#include "services/coordinator/pace.h"
#include "services/coordinator/queue.h"
#include "services/coordinator/quota.h"
#include "services/coordinator/retention.h"
#include "tests/test.h"

namespace dispersa::coordinator_policies_test {
namespace {

constexpr std::int64_t kDay = 86400;

// Ended on different days, and of different size; one flies and one is read.
std::vector<Stored> SomeCampaigns() {
  return {{"flies", 0, 700, false},
          {"third", 30 * kDay, 10, true},
          {"first", 10 * kDay, 50, true},
          {"second", 20 * kDay, 200, true},
          {"is read", 5 * kDay, 40, false}};
}

/// Those that are removed 40 days after the start, each with "old" or "size". Of `stuck` nothing is freed.
std::vector<std::string> RemovedBy(const Retention& retention, const std::string& stuck = "",
                                   std::vector<Stored> campaigns = SomeCampaigns()) {
  std::vector<std::string> removed;
  DeleteBeyond(retention, std::move(campaigns), 40 * kDay, [&](const std::string& id, bool is_old) {
    removed.push_back(id + (is_old ? ": old" : ": size"));
    return id != stuck;
  });
  return removed;
}

TEST(Retention, WithoutALimitEverythingStays) { EXPECT_THAT(RemovedBy({}), IsEmpty()); }

// All take 1000.
TEST(Retention, DeletesTheOldestUntilTheOthersFit) {
  EXPECT_THAT(RemovedBy({.bytes = 1000}), IsEmpty()) << "as many as are allowed";
  EXPECT_THAT(RemovedBy({.bytes = 999}), ElementsAre("first: size"));
  EXPECT_THAT(RemovedBy({.bytes = 950}), ElementsAre("first: size"));
  EXPECT_THAT(RemovedBy({.bytes = 949}), ElementsAre("first: size", "second: size"));
  EXPECT_THAT(RemovedBy({.bytes = 749}), ElementsAre("first: size", "second: size", "third: size"));
  EXPECT_THAT(RemovedBy({.bytes = 1}), ElementsAre("first: size", "second: size", "third: size"))
      << "and never what flies or is read";
}

TEST(Retention, DeletesWhatEndedLongerAgoThanItsDays) {
  EXPECT_THAT(RemovedBy({.days = 30.0}), IsEmpty()) << "30 days and no longer";
  EXPECT_THAT(RemovedBy({.days = 29.5}), ElementsAre("first: old"));
  EXPECT_THAT(RemovedBy({.days = 19.5}), ElementsAre("first: old", "second: old"));
}

TEST(Retention, BothLimitsHoldAndWhatIsOldFreesSpaceToo) {
  EXPECT_THAT(RemovedBy({.days = 29.5, .bytes = 950}), ElementsAre("first: old"));
  EXPECT_THAT(RemovedBy({.days = 29.5, .bytes = 800}), ElementsAre("first: old", "second: size"));
}

TEST(Retention, WhatCannotBeDeletedFreesNothing) {
  EXPECT_THAT(RemovedBy({.bytes = 960}, "first"), ElementsAre("first: size", "second: size"));
}

TEST(Retention, OfThoseThatEndedAtOneMomentTheOrderIsKept) {
  EXPECT_THAT(RemovedBy({.bytes = 7}, "", {{"b", 1, 4, true}, {"a", 1, 4, true}}), ElementsAre("b: size"));
}

// Two owners with limits of their own and one without.
TEST(Quotas, EachOwnerHasItsOwnLimitsAndForTheRestThoseOfAll) {
  Quotas quotas;
  EXPECT_EQ(quotas.Add("cases=100,campaigns=10,places=4,disk=2GB"), "");
  EXPECT_EQ(quotas.Add("ann:cases=500,places=6"), "");
  EXPECT_EQ(quotas.Add("bob:campaigns=3,disk=none"), "");
  const auto limits = [&](const std::string& owner) {
    const Quota quota = quotas.Of(owner);
    return std::vector{quota.cases.value_or(0), quota.campaigns.value_or(0), quota.places.value_or(0),
                       quota.disk.value_or(0)};
  };
  EXPECT_THAT(limits("ann"), ElementsAre(500, 10, 6, 2'000'000'000));
  EXPECT_THAT(limits("bob"), ElementsAre(100, 3, 4, Quota::kNoLimit));
  EXPECT_THAT(limits("carol"), ElementsAre(100, 10, 4, 2'000'000'000));
  EXPECT_EQ(quotas.Add("places=5,disk=0.5TB"), "");
  EXPECT_THAT(limits("carol"), ElementsAre(100, 10, 5, 500'000'000'000)) << "the last word counts";
}

TEST(Quotas, OnesOwnLimitMayBeTheOnlyOne) {
  Quotas quotas;
  EXPECT_EQ(quotas.Add("ann:cases=5,campaigns=6,places=7,disk=8MB"), "");
  EXPECT_EQ(quotas.Of("ann").cases, 5u);
  EXPECT_EQ(quotas.Of("ann").campaigns, 6u);
  EXPECT_EQ(quotas.Of("ann").places, 7u);
  EXPECT_EQ(quotas.Of("ann").disk, 8'000'000u);
  EXPECT_FALSE(quotas.Of("bob").cases || quotas.Of("bob").campaigns || quotas.Of("bob").places ||
               quotas.Of("bob").disk);
}

TEST(Pace, IsWhatCameInTheLastMeasurements) {
  Pace pace;
  EXPECT_EQ(pace.PerSecond(), 0.0);
  pace.Measure(1.0, 50);
  EXPECT_EQ(pace.PerSecond(), 0.0) << "what was there before is no result of this second";
  pace.Measure(3.0, 56);
  EXPECT_EQ(pace.PerSecond(), 3.0);
  for (int i = 1; i <= 9; ++i) pace.Measure(3.0 + i, 56 + 10 * static_cast<std::uint64_t>(i));
  EXPECT_EQ(pace.PerSecond(), 10.0) << "ten measurements";
}

// The difference of the counts would be 2^64 less a few.
TEST(Pace, ResultsThatAreRemovedAreNoResults) {
  Pace pace;
  pace.Measure(1.0, 100);
  pace.Measure(2.0, 30);
  EXPECT_EQ(pace.PerSecond(), 0.0);
  EXPECT_EQ(TimeLeft({.total = 100, .done = 30, .waiting = 70}, pace.PerSecond()), std::nullopt);
  pace.Measure(3.0, 40);
  EXPECT_EQ(pace.PerSecond(), 5.0);
}

TEST(Pace, TimeLeftIsOfWhatWaitsAndOfWhatFlies) {
  const LedgerProgress progress{.total = 100, .done = 40, .quarantined = 5, .waiting = 35, .assigned = 20};
  EXPECT_EQ(TimeLeft(progress, 2.0), 27.5);
  EXPECT_EQ(TimeLeft({.total = 3, .done = 1, .assigned = 2}, 4.0), 0.5);
  EXPECT_EQ(TimeLeft({.total = 3, .done = 3}, 4.0), 0.0);
  EXPECT_EQ(TimeLeft(progress, 0.0), std::nullopt);
}

TEST(Labels, TheLastGivenIsTheLastAndNoneStandsTwice) {
  CatalogueEntry entry;
  AddLabels(&entry, {"commit=a", "branch=main"});
  AddLabels(&entry, {"commit=b"});
  EXPECT_THAT(entry.labels, ElementsAre("commit=a", "branch=main", "commit=b"));
  AddLabels(&entry, {"commit=a"});
  EXPECT_THAT(entry.labels, ElementsAre("branch=main", "commit=b", "commit=a"));
  AddLabels(&entry, {});
  EXPECT_THAT(entry.labels, ElementsAre("branch=main", "commit=b", "commit=a"));
}

TEST(Labels, OfTooManyTheFirstGo) {
  CatalogueEntry entry;
  std::vector<std::string> many;
  for (int i = 0; i < 33; ++i) many.push_back("n=" + std::to_string(i));
  AddLabels(&entry, many);
  EXPECT_EQ(entry.labels.size(), 32u);
  EXPECT_EQ(entry.labels.front(), "n=1");
  EXPECT_EQ(entry.labels.back(), "n=32");
}

// What was launched, by whom and when stays; what became of it is open again.
TEST(Queue, ACampaignThatGoesOnHasNoEnd) {
  CatalogueEntry entry;
  entry.id = "id";
  entry.name = "name";
  entry.owner = "ann";
  entry.labels = {"commit=a"};
  entry.distrusted = {"node1"};
  entry.priority = 3;
  entry.order = 7;
  entry.cases = 100;
  entry.done = 90;
  entry.conflicts = 2;
  entry.bytes = 1234;
  entry.launched_unix_s = 5;
  entry.state = CampaignState::kDone;
  entry.code = 3;
  entry.quarantined = 10;
  entry.ended_unix_s = 9;
  entry.attempts = 4;
  entry.problem = "the disk";
  entry.verdict = "pass";
  entry.engine = "1";
  entry.requirements = {{"q_max_pa", "words", 0.9, 90, 1, {}, {}, "pass"}};
  CatalogueEntry again = entry;
  QueueAgain(&again);
  entry.state = CampaignState::kWaiting;
  entry.code = 0;
  entry.quarantined = 0;
  entry.ended_unix_s = 0;
  entry.attempts = 0;
  entry.problem = entry.verdict = "";
  entry.requirements = {};
  EXPECT_TRUE(again == entry) << "conflicts stay: whoever repairs it forgets them";
}

TEST(Queue, GoesByPriorityAndThenByAge) {
  const auto entry = [](int priority, std::uint64_t order) {
    CatalogueEntry made;
    made.priority = priority;
    made.order = order;
    return made;
  };
  EXPECT_TRUE(ComesBefore(entry(1, 9), entry(0, 1)));
  EXPECT_FALSE(ComesBefore(entry(0, 1), entry(1, 9)));
  EXPECT_TRUE(ComesBefore(entry(-1, 2), entry(-1, 3)));
  EXPECT_FALSE(ComesBefore(entry(2, 3), entry(2, 2)));
  EXPECT_FALSE(ComesBefore(entry(2, 2), entry(2, 2)));
}

// A queue as a test writes it.
class Queued {
 public:
  CatalogueEntry& Add(const std::string& id, CampaignState state, const std::string& owner = "ann",
                      int priority = 0) {
    CatalogueEntry& entry = entries_.emplace_back();
    entry.id = entry.flight_id = id;
    entry.state = state;
    entry.owner = owner;
    entry.priority = priority;
    entry.order = entries_.size();
    entry.cases = 100;
    return entry;
  }
  /// The id of the one that is opened next; `delayed` waits for the disk.
  std::string Next(const Quotas& quotas = {}, const std::string& delayed = "") const {
    const CatalogueEntry* next = NextOf(All(), quotas, [&](const std::string& id) { return id == delayed; });
    return next == nullptr ? "none" : next->id;
  }
  std::string GivesWayTo(int priority) const {
    CatalogueEntry entry;
    entry.priority = priority;
    const CatalogueEntry* last = WhoGivesWayTo(entry, All());
    return last == nullptr ? "none" : last->id;
  }

 private:
  std::vector<const CatalogueEntry*> All() const {
    std::vector<const CatalogueEntry*> all;
    for (const CatalogueEntry& entry : entries_) all.push_back(&entry);
    return all;
  }
  std::deque<CatalogueEntry> entries_;
};

constexpr CampaignState kWaiting = CampaignState::kWaiting, kFlying = CampaignState::kFlying,
                        kReporting = CampaignState::kReporting;

TEST(Queue, OpensWhatHasTheHighestPriorityAndWaitsLongest) {
  Queued queue;
  EXPECT_EQ(queue.Next(), "none");
  queue.Add("flies", kFlying, "ann", 9);
  queue.Add("reports", kReporting, "ann", 9);
  queue.Add("low", kWaiting, "ann", -1);
  queue.Add("older", kWaiting, "ann", 2);
  queue.Add("younger", kWaiting, "ann", 2);
  EXPECT_EQ(queue.Next(), "older");
  EXPECT_EQ(queue.Next({}, "older"), "younger") << "the disk was full a moment ago";
}

TEST(Queue, WhatLacksItsReportAloneComesLast) {
  Queued queue;
  CatalogueEntry& flown = queue.Add("flown", kWaiting, "ann", 5);
  queue.Add("not flown", kWaiting);
  flown.done = 97;
  flown.quarantined = 3;
  EXPECT_EQ(queue.Next(), "not flown");
  flown.done = 96;
  EXPECT_EQ(queue.Next(), "flown");
  Queued both;
  both.Add("older", kWaiting).done = 100;
  both.Add("higher", kWaiting, "ann", 1).done = 100;
  EXPECT_EQ(both.Next(), "higher");
}

TEST(Queue, OfTheSameFlightsOneAfterTheOther) {
  for (const CampaignState busy : {kFlying, kReporting}) {
    Queued queue;
    queue.Add("first", busy).flight_id = "same";
    queue.Add("second", kWaiting).flight_id = "same";
    EXPECT_EQ(queue.Next(), "none");
    queue.Add("other", kWaiting);
    EXPECT_EQ(queue.Next(), "other");
  }
}

// Ann has two places and both are taken, bob has three of his own.
TEST(Queue, EachOwnerHasSoManyPlaces) {
  Quotas quotas;
  quotas.Add("places=2");
  quotas.Add("bob:places=3");
  Queued queue;
  queue.Add("a1", kFlying);
  queue.Add("a2", kFlying);
  queue.Add("a3", kWaiting, "ann", 9);
  queue.Add("b1", kFlying, "bob");
  queue.Add("b2", kFlying, "bob");
  queue.Add("b3", kWaiting, "bob");
  queue.Add("c1", kReporting, "carol");
  queue.Add("c2", kReporting, "carol");
  EXPECT_EQ(queue.Next(quotas), "b3");
  EXPECT_EQ(queue.Next(quotas, "b3"), "none");
  queue.Add("c3", kWaiting, "carol");
  EXPECT_EQ(queue.Next(quotas, "b3"), "c3") << "reports take no place, nor does what waits";
  queue.Add("c4", kWaiting, "carol", 1);
  EXPECT_EQ(queue.Next(quotas, "b3"), "c4");
  EXPECT_EQ(queue.Next(), "a3") << "without quotas";
}

TEST(Queue, TheLastGivesWayToAHigherPriority) {
  Queued queue;
  EXPECT_EQ(queue.GivesWayTo(5), "none");
  queue.Add("high", kFlying, "ann", 3);
  queue.Add("older", kFlying, "ann", 1);
  queue.Add("younger", kFlying, "ann", 1);
  queue.Add("middle", kFlying, "ann", 2);
  EXPECT_EQ(queue.GivesWayTo(2), "younger");
  EXPECT_EQ(queue.GivesWayTo(1), "none") << "an equal priority takes nobody's place";
}

// Of 21 requirements the first 20, each with the verdict that stands; load checks come behind them.
TEST(Outcomes, HaveTheVerdictThatStandsAndTheLoadChecksThatFailed) {
  CampaignSummary summary;
  for (int i = 0; i < 21; ++i) {
    RequirementSummary one;
    one.metric = "m" + std::to_string(i);
    one.n = 100 + i;
    one.failures = i;
    one.verdict = "pass";
    summary.requirements.push_back(one);
    if (i < 2) {
      summary.standing.requirements.emplace_back();
      summary.standing.requirements.back().verdict = i == 0 ? "fail" : "inconclusive";
    }
  }
  summary.load_checks = {{"structural_limit_exceeded", 50, 0, 0}, {"bending_moment_n_m", 60, 4, 0}};
  const std::vector<RequirementOutcome> outcomes = OutcomesOf(summary);
  ASSERT_EQ(outcomes.size(), 21u);
  EXPECT_EQ(outcomes[0].verdict, "fail");
  EXPECT_EQ(outcomes[1].verdict, "inconclusive");
  EXPECT_EQ(outcomes[2].verdict, "pass");
  EXPECT_EQ(outcomes[19].metric, "m19");
  EXPECT_EQ(outcomes[19].n, 119);
  EXPECT_EQ(outcomes[19].failures, 19);
  EXPECT_EQ(outcomes[20].metric, "bending_moment_n_m");
  EXPECT_EQ(outcomes[20].failures, 4);
  EXPECT_EQ(outcomes[20].verdict, "fail");
}

}  // namespace
}  // namespace dispersa::coordinator_policies_test
