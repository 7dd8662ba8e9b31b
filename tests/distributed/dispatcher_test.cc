// The coordinator's rules with made-up time and messages: trust in workers, repeated assignments, and blames.
#include "services/coordinator/dispatcher.h"

#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/results/fingerprint.h"
#include "memory_store.h"
#include "services/log/log.h"
#include "tests/test.h"

namespace dispersa::dispatcher_test {

const std::string kFlight(64, 'f');

Campaign MadeUp(const std::string& flight_id, std::uint64_t cases) {
  Campaign campaign;
  campaign.flight_id = flight_id;
  campaign.sampling.cases = cases;
  campaign.canonical_yaml = "0123456789";
  ScalarDistribution one;
  one.values = {one.nominal = 1.0};
  campaign.dispersions = {{"drag_coefficient", one, {FindInput("drag_factor")}}};
  return campaign;
}

CaseResult ResultOf(std::uint64_t case_index) {
  CaseResult result;
  result.case_index = case_index;
  SetInputs(RowInputs(MadeUp("", 1)), InputValues({}), result);
  result.metrics.resize(MetricCount(kUsualStages));
  return result;
}

class DispatcherTest : public testing::Test {
 protected:
  void Open(std::uint64_t cases, LedgerOptions options = {}) {
    auto store = std::make_unique<MemoryStore>();
    store_ = store.get();
    book_ = std::make_unique<CampaignBook>(MadeUp(kFlight, cases), std::move(store), options);
    dispatcher_.BeginCampaign(*book_);
  }
  WorkerStatus Status(const std::string& worker = "w") {
    return {worker, "host", 1, EngineVersion(), 1, 2, WorkerState::kReady, 0, kEpoch, {}, {}};
  }
  /// The message to the worker now.
  Orders Tick(double now_s, const std::string& worker = "w") {
    for (const Orders& orders : dispatcher_.Tick(now_s))
      if (orders.worker == worker) return orders;
    return {};
  }
  LedgerProgress Progress() const { return book_->ledger().Progress(); }
  /// The worker, as a child of this process.
  void JoinSupervised() {
    dispatcher_.Supervise("w");
    dispatcher_.On("s", Status(), 0.0);
  }
  void Fly(std::uint64_t attempt, std::uint64_t case_index, double now_s, std::uint64_t number = 1) {
    dispatcher_.On("s", Report{"w", kEpoch, number, kFlight, {{attempt, ResultOf(case_index)}}, {}}, now_s);
  }

  /// Flies what the audit asks for; returns how many.
  std::size_t FlyClaims(Dispatcher& dispatcher) {
    std::vector<Claim> all;
    dispatcher.TakeClaims([&](const Campaign&, std::vector<Claim> claims) {
      all.insert(all.end(), claims.begin(), claims.end());
    });
    for (const Claim& claim : all)
      dispatcher.Audited(kFlight, claim, Fingerprint(ResultOf(claim.case_index)));
    return all.size();
  }

  static constexpr std::uint64_t kEpoch = 7;
  Dispatcher dispatcher_{kEpoch, EngineVersion()};
  MemoryStore* store_ = nullptr;
  std::unique_ptr<CampaignBook> book_;
};

TEST_F(DispatcherTest, RepeatsAnAssignmentUntilTheWorkerHoldsIt) {
  Open(1);
  dispatcher_.On("s", Status(), 0.0);
  const Orders first = Tick(0.0);
  ASSERT_EQ(first.assignments.size(), 1u);
  EXPECT_EQ(first.coordinator_epoch, kEpoch);
  dispatcher_.On("s", Status(), 1.9);
  EXPECT_THAT(Tick(1.9).assignments, IsEmpty()) << "it may be on its way";
  dispatcher_.On("s", Status(), 2.0);
  EXPECT_EQ(Tick(2.0).assignments, first.assignments);
  WorkerStatus holds = Status();
  holds.held = {first.assignments[0].attempt};
  for (double now_s = 3.0; now_s < 20.0; now_s += 1.0) {
    dispatcher_.On("s", holds, now_s);
    EXPECT_THAT(Tick(now_s).assignments, IsEmpty());
  }
  holds.coordinator_epoch = kEpoch - 1;  // what it holds is another coordinator's
  dispatcher_.On("s", holds, 20.0);
  EXPECT_EQ(Tick(20.0).assignments, first.assignments);
}

// Another host took over while this one was frozen: it wakes, hears the same workers and leaves them alone.
TEST_F(DispatcherTest, LeavesWorkersToAYoungerCoordinatorWhileTheyFollowIt) {
  Open(1);
  dispatcher_.On("s", Status(), 0.0);
  const Orders first = Tick(0.0);
  ASSERT_EQ(first.assignments.size(), 1u);
  WorkerStatus led = Status();
  led.coordinator_epoch = kEpoch + 1;
  dispatcher_.On("s", led, 0.5);
  EXPECT_EQ(dispatcher_.joined(), 0u);
  EXPECT_EQ(Progress().waiting, 1u) << "nobody is blamed for it";
  const Orders empty = Tick(0.5);
  EXPECT_EQ(empty.worker, "w") << "it hears that somebody is here";
  EXPECT_THAT(empty.assignments, IsEmpty());
  EXPECT_EQ(empty.refusal, "");
  dispatcher_.On("s", Report{"w", kEpoch + 1, 1, kFlight, {{7, ResultOf(0)}}, {}}, 0.6);
  EXPECT_EQ(Progress().done, 0u) << "its results are the other one's";
  EXPECT_TRUE(dispatcher_.ReceivesReports(3.0))
      << "no reason to start again, which would make it the youngest";
  EXPECT_FALSE(dispatcher_.ReceivesReports(4.0)) << "now it hears nobody";
  dispatcher_.On("s", Status(), 6.0);  // the younger one is silent, and it follows this one again
  EXPECT_EQ(Tick(6.0).assignments.size(), 1u);
}

TEST_F(DispatcherTest, RevokesWhatItDidNotGiveOrHasTakenBack) {
  Open(1);
  WorkerStatus holds = Status();
  holds.held = {99};
  dispatcher_.On("s", holds, 0.0);
  EXPECT_THAT(Tick(0.0).revoked, ElementsAre(99));
}

TEST_F(DispatcherTest, KnowsThatNothingButStatusesGetsHere) {
  Open(100);
  EXPECT_FALSE(dispatcher_.ReceivesReports(0.0)) << "nobody";
  dispatcher_.On("s", Status(), 0.0);
  const std::uint64_t attempt = Tick(0.0).assignments.at(0).attempt;
  WorkerStatus flies = Status();
  flies.held = {attempt};
  flies.started = {{attempt, 1}};
  flies.flown = 1;
  Fly(attempt, 0, 1.0);
  double now_s = 1.5;
  // One long flight has nothing to tell.
  for (; now_s < 100.0; now_s += 0.5) {
    dispatcher_.On("s", flies, now_s);
    EXPECT_TRUE(dispatcher_.ReceivesReports(now_s));
  }
  // It has flown and nothing is heard of it; whoever else is there and has nothing to tell is heard.
  flies.flown = 2;
  const double deaf_s = now_s;
  Fly(attempt, 2, now_s, 2);
  for (; now_s < deaf_s + 10.0; now_s += 0.5) {
    flies.flown += 1;
    dispatcher_.On("s", flies, now_s);
    EXPECT_EQ(dispatcher_.ReceivesReports(now_s), now_s <= deaf_s + 5.0) << now_s;
  }
  dispatcher_.On("t", Status("v"), now_s);
  EXPECT_TRUE(dispatcher_.ReceivesReports(now_s));
  dispatcher_.Gone("t");
  Fly(attempt, 3, now_s, 3);
  EXPECT_TRUE(dispatcher_.ReceivesReports(now_s)) << "it is heard again";
}

TEST_F(DispatcherTest, KnowsThatNoTextIsAskedFor) {
  Open(1);
  dispatcher_.On("s", Status(), 0.0);
  WorkerStatus waits = Status();
  waits.held = {Tick(0.0).assignments.at(0).attempt};
  for (double now_s = 0.5; now_s < 70.0; now_s += 0.5) {
    dispatcher_.On("s", waits, now_s);
    EXPECT_EQ(dispatcher_.ReceivesReports(now_s), now_s <= 60.0) << now_s;
  }
  EXPECT_TRUE(dispatcher_.On(TextRequest{"w", kFlight, 0}, 4, 70.0));
  EXPECT_TRUE(dispatcher_.ReceivesReports(70.0));
}

TEST_F(DispatcherTest, SaysSomethingEverySecond) {
  Open(0);
  dispatcher_.On("s", Status(), 0.0);
  int said = 0;
  for (int i = 0; i < 100; ++i) {
    dispatcher_.On("s", Status(), 0.1 * i);
    said += Tick(0.1 * i).worker == "w";
  }
  EXPECT_GE(said, 9);
  EXPECT_LE(said, 11);
}

TEST_F(DispatcherTest, AcknowledgesWhatIsStoredAndOnlyThat) {
  Open(2);
  dispatcher_.On("s", Status(), 0.0);
  const std::uint64_t attempt = Tick(0.0).assignments.at(0).attempt;
  Fly(attempt, 0, 0.1, 41);
  EXPECT_THAT(Tick(0.1).acknowledged, IsEmpty());
  EXPECT_EQ(store_->stored, 0u);
  EXPECT_THAT(Tick(1.0).acknowledged, ElementsAre(41));
  EXPECT_EQ(store_->stored, 1u);
  Fly(attempt, 0, 1.1, 41);  // the acknowledgement got lost
  EXPECT_THAT(Tick(2.0).acknowledged, ElementsAre(41));
}

TEST_F(DispatcherTest, AcknowledgesResultsOfAClosedCampaignSoThatTheyAreDropped) {
  Open(2);
  dispatcher_.On("s", Status(), 0.0);
  Tick(0.0);
  dispatcher_.EndCampaign(kFlight);
  Fly(1, 0, 0.1, 41);
  EXPECT_THAT(Tick(0.2).acknowledged, ElementsAre(41));
}

TEST_F(DispatcherTest, ReportsOfAnotherEpochBringResultsAndBlameNobody) {
  Open(2, {.blames_to_quarantine = 1});
  dispatcher_.On("s", Status(), 0.0);
  const Orders orders = Tick(0.0);
  const std::uint64_t attempt = orders.assignments.at(0).attempt;
  // The same attempt number of another start of the coordinator: not this one.
  dispatcher_.On("s", Report{"w", kEpoch + 1, 1, kFlight, {{attempt, ResultOf(1)}}, {{0, attempt}}}, 0.1);
  EXPECT_EQ(Progress().done, 1u);
  EXPECT_EQ(book_->ledger().Owed("w", attempt).size(), orders.assignments[0].cases.size());
  WorkerStatus old = Status();
  old.coordinator_epoch = kEpoch - 1;
  old.started = {{0, attempt}};
  dispatcher_.On("s", old, 0.2);
  Tick(5.0);  // it fell silent
  EXPECT_EQ(dispatcher_.joined(), 0u);
  EXPECT_EQ(Progress().quarantined, 0u);
  EXPECT_EQ(Progress().waiting, 1u);
}

TEST_F(DispatcherTest, SilenceBlamesWhatTheStatusSaysIsFlown) {
  Open(2, {.blames_to_quarantine = 1});
  dispatcher_.On("s", Status(), 0.0);
  const std::uint64_t attempt = Tick(0.0).assignments.at(0).attempt;
  WorkerStatus flies = Status();
  flies.held = {attempt};
  flies.started = {{0, attempt}};  // the report of the start got lost
  dispatcher_.On("s", flies, 0.5);
  Tick(5.0);
  EXPECT_EQ(Progress().quarantined, 1u);
  EXPECT_EQ(Progress().waiting, 1u);
}

TEST_F(DispatcherTest, ARefusedWorkerIsToldSoEachTimeAndNeverJoins) {
  Open(1);
  WorkerStatus stranger = Status();
  stranger.engine_version = "other";
  for (double now_s = 0.0; now_s < 5.0; now_s += 1.0) {
    dispatcher_.On("s", stranger, now_s);
    const Orders orders = Tick(now_s);
    EXPECT_EQ(orders.refusal,
              "engine version other of the worker differs from the coordinator's " + EngineVersion());
    EXPECT_THAT(orders.assignments, IsEmpty());
    EXPECT_EQ(dispatcher_.joined(), 0u);
  }
  stranger.engine_version = EngineVersion();  // the same incarnation with another story
  dispatcher_.On("s", stranger, 5.0);
  EXPECT_EQ(dispatcher_.joined(), 0u);
}

TEST_F(DispatcherTest, AnEndedWorkerDoesNotComeBackByALateMessage) {
  Open(1);
  JoinSupervised();
  Tick(0.0);
  dispatcher_.WorkerEnded("w", WorkerEnd::kKilled, "signal 9", 0.1);
  Tick(1.0);
  EXPECT_EQ(dispatcher_.joined(), 0u);
  dispatcher_.On("s", Status(), 1.1);
  EXPECT_EQ(dispatcher_.joined(), 0u);
  Fly(1, 0, 1.2);
  EXPECT_EQ(Progress().done, 0u);
}

TEST_F(DispatcherTest, TheLastMessagesOfADeadWorkerAreAwaited) {
  Open(2, {.blames_to_quarantine = 1});
  JoinSupervised();
  const std::uint64_t attempt = Tick(0.0).assignments.at(0).attempt;
  dispatcher_.WorkerEnded("w", WorkerEnd::kCrashed, "signal 11", 1.0);
  Tick(1.1);
  // On its way when the process ended: case 0 is done, case 1 is what it died of.
  dispatcher_.On("s", Report{"w", kEpoch, 1, kFlight, {{attempt, ResultOf(0)}}, {}}, 1.15);
  Tick(1.3);
  EXPECT_EQ(Progress().done, 1u);
  EXPECT_EQ(dispatcher_.joined(), 0u);
}

TEST_F(DispatcherTest, OnlyItsOwnParticipantSpeaksForAWorker) {
  Open(2);
  dispatcher_.On("s", Status(), 0.0);
  const std::uint64_t attempt = Tick(0.0).assignments.at(0).attempt;
  WorkerStatus left = Status();
  left.state = WorkerState::kLeft;
  dispatcher_.On("forger", left, 0.1);
  dispatcher_.On("forger", Report{"w", kEpoch, 1, kFlight, {{attempt, ResultOf(0)}}, {}}, 0.2);
  dispatcher_.On("forger", CampaignRefusal{"w", kEpoch, kFlight, "no"}, 0.3);
  EXPECT_EQ(dispatcher_.joined(), 1u);
  EXPECT_EQ(Progress().done, 0u);
  EXPECT_EQ(dispatcher_.refused_messages(), 3u);
  // Until it is gone, or silent for long: then the worker has made its connection anew.
  dispatcher_.Gone("s");
  dispatcher_.On("s2", Status(), 0.4);
  dispatcher_.On("s2", Report{"w", kEpoch, 1, kFlight, {{attempt, ResultOf(0)}}, {}}, 0.5);
  EXPECT_EQ(Progress().done, 1u);
}

TEST_F(DispatcherTest, AWorkersNewConnectionIsItsOwnAlone) {
  Open(2);
  dispatcher_.On("s", Status(), 0.0);
  dispatcher_.Gone("somebody else's");
  dispatcher_.On("forger", Status(), 0.1);
  EXPECT_EQ(dispatcher_.refused_messages(), 1u) << "its connection is as it was";
  dispatcher_.Gone("s");
  dispatcher_.On("s2", Status(), 0.2);
  EXPECT_EQ(dispatcher_.refused_messages(), 1u);
  dispatcher_.On("forger", Status(), 0.3);
  EXPECT_EQ(dispatcher_.refused_messages(), 2u) << "the worker has a new connection already";
  ASSERT_EQ(Tick(0.3).assignments.at(0).cases.at(0), 0u);
  dispatcher_.On("forger", Report{"w", kEpoch, 1, kFlight, {{1, ResultOf(0)}}, {}}, 0.4);
  EXPECT_EQ(Progress().done, 0u);
  dispatcher_.On("s2", Report{"w", kEpoch, 1, kFlight, {{1, ResultOf(0)}}, {}}, 0.5);
  EXPECT_EQ(Progress().done, 1u);
}

TEST_F(DispatcherTest, SoManyWorkersAndNoMore) {
  Dispatcher dispatcher(kEpoch, EngineVersion(), {.max_workers = 2, .audit = {}});
  for (const char* worker : {"a", "b", "c"}) dispatcher.On(worker, Status(worker), 0.0);
  EXPECT_EQ(dispatcher.joined(), 2u);
  EXPECT_EQ(dispatcher.refused_messages(), 1u);
  WorkerStatus left = Status("a");
  left.state = WorkerState::kLeft;
  dispatcher.On("a", left, 0.1);
  for (const char* worker : {"c", "b"}) dispatcher.On(worker, Status(worker), 0.2);
  EXPECT_EQ(dispatcher.joined(), 2u);
  EXPECT_EQ(dispatcher.refused_messages(), 1u) << "the place of one that left";
}

TEST_F(DispatcherTest, AReportIsASignOfLife) {
  Open(100);
  dispatcher_.On("s", Status(), 0.0);
  for (std::uint64_t i = 0; i < 10; ++i) {
    Fly(1, i, static_cast<double>(i), i + 1);
    Tick(static_cast<double>(i));
  }
  EXPECT_EQ(dispatcher_.joined(), 1u);
}

TEST_F(DispatcherTest, AssignmentsOfAClosedCampaignAreNotRepeated) {
  Open(1);
  dispatcher_.On("s", Status(), 0.0);
  ASSERT_THAT(Tick(0.0).assignments, SizeIs(1));
  dispatcher_.On("s", Status(), 2.0);  // it got lost: to be said again
  dispatcher_.EndCampaign(kFlight);
  EXPECT_THAT(Tick(2.0).assignments, IsEmpty());
}

TEST_F(DispatcherTest, AResultOfAnotherVehicleIsNone) {
  Open(2);
  dispatcher_.On("s", Status(), 0.0);
  ASSERT_EQ(Tick(0.0).assignments.at(0).cases.at(0), 0u);
  CaseResult result = ResultOf(0);
  result.inputs.resize(2);
  dispatcher_.On("s", Report{"w", kEpoch, 1, kFlight, {{1, result}}, {}}, 0.1);
  EXPECT_EQ(Progress().done, 0u);
  EXPECT_EQ(dispatcher_.refused_messages(), 1u);
  EXPECT_EQ(dispatcher_.joined(), 0u);
}

// A worker that speaks well and lies.
class ForgerTest : public DispatcherTest {
 protected:
  void Come(const std::string& worker, double now_s = 0.0) { dispatcher_.On(worker, Status(worker), now_s); }
  std::vector<FlyOrder> Given(const std::string& worker, double now_s = 0.0) {
    return Tick(now_s, worker).assignments;
  }
  void Return(const std::string& worker, CaseResult result, double now_s = 0.1, std::uint64_t epoch = kEpoch,
              std::uint64_t attempt = 0) {
    dispatcher_.On(worker, Report{worker, epoch, ++number_, kFlight, {{attempt, std::move(result)}}, {}},
                   now_s);
  }

 private:
  std::uint64_t number_ = 0;
};

TEST_F(ForgerTest, ACaseThatItWasNotGivenIsNotItsToReturn) {
  Open(3000);
  Come("forger");
  Come("honest");
  const std::set<std::uint64_t> given = [&] {
    std::set<std::uint64_t> cases;
    for (const FlyOrder& order : Given("forger")) cases.insert(order.cases.begin(), order.cases.end());
    return cases;
  }();
  ASSERT_GT(given.size(), 0u);
  SetLogLevel(LogLevel::kNothing);
  for (std::uint64_t i = 0; i < 3000; ++i)
    if (!given.contains(i)) Return("forger", ResultOf(i));
  SetLogLevel(LogLevel::kInfo);
  EXPECT_EQ(Progress().done, 0u);
  EXPECT_EQ(dispatcher_.refused_messages(), 3000u - given.size());
  Return("forger", ResultOf(*given.begin()));
  EXPECT_EQ(Progress().done, 1u);
  CaseResult other = ResultOf(*given.begin());
  other.metrics[0] = 1.0;
  Return("honest", other);
  EXPECT_EQ(dispatcher_.refused_messages(), 3001u - given.size());
  EXPECT_EQ(Progress().conflicts, 0u);
  // For another epoch it is no better.
  Return("forger", ResultOf(2999), 0.1, kEpoch + 1);
  EXPECT_EQ(Progress().done, 1u);
}

TEST_F(ForgerTest, WhatWasTakenFromAWorkerIsStillItsToReturn) {
  Open(2);
  Come("w");
  ASSERT_THAT(Given("w"), SizeIs(2));
  Tick(5.0);  // it fell silent
  EXPECT_EQ(Progress().waiting, 2u);
  Come("w", 5.1);
  Return("w", ResultOf(1), 5.2);
  EXPECT_EQ(Progress().done, 1u);
  const std::uint64_t refused = dispatcher_.refused_messages();
  Return("w", ResultOf(1), 5.3);  // its acknowledgement got lost
  EXPECT_EQ(dispatcher_.refused_messages(), refused);
}

TEST_F(ForgerTest, MetricsThatTheCampaignHasNotExpelTheProcess) {
  Open(50);
  Come("node1_aa");
  const std::vector<Orders> all = dispatcher_.Tick(0.0);
  CaseResult forged = ResultOf(all.at(0).assignments.at(0).cases.at(0));
  forged.metrics.push_back(1.0);
  Return("node1_aa", forged);
  EXPECT_EQ(Progress().done, 0u);
  EXPECT_THAT(
      dispatcher_.expelled(),
      ElementsAre(Pair("node1_aa", Expulsion{"case " + std::to_string(forged.case_index) +
                                                 " of campaign : its metrics are not those of the campaign",
                                             "host"})));
}

TEST_F(ForgerTest, InputsThatTheCampaignDoesNotDrawExpelTheProcessAndAllThatItReturned) {
  Open(50);
  for (const char* worker : {"node1_aa", "node1_bb", "node2_cc"}) Come(worker);
  const std::vector<Orders> all = dispatcher_.Tick(0.0);
  std::map<std::string, std::uint64_t> first, second;
  for (const Orders& orders : all) {
    if (orders.assignments.empty()) continue;
    first[orders.worker] = orders.assignments.at(0).cases.at(0);
    second[orders.worker] = orders.assignments.back().cases.back();
  }
  for (const auto& [worker, case_index] : first) Return(worker, ResultOf(case_index));
  EXPECT_EQ(Progress().done, 3u);
  CaseResult forged = ResultOf(second.at("node1_bb"));
  forged.inputs[0] += 1e-12;
  Return("node1_bb", forged);
  EXPECT_EQ(Progress().done, 2u) << "of node2 and of node1's honest process";
  EXPECT_EQ(dispatcher_.joined(), 2u);
  EXPECT_THAT(dispatcher_.expelled(),
              ElementsAre(Pair(
                  "node1_bb", Expulsion{"case " + std::to_string(forged.case_index) +
                                            " of campaign : its inputs are not those that the campaign draws",
                                        "host"})));
  Come("node1_bb", 0.5);
  EXPECT_EQ(dispatcher_.joined(), 2u);
  EXPECT_THAT(Tick(0.5, "node1_bb").refusal, HasSubstr("its inputs are not those"));
  Come("node1_dd", 0.6);
  EXPECT_EQ(dispatcher_.joined(), 3u) << "another process of the same keys";
}

// Each host has two workers with the same keys. Of one host after the other a process lies.
TEST_F(ForgerTest, AProcessThenItsHostThenItsKeysAreExpelled) {
  Open(100);
  const auto come = [&](const std::string& worker, const std::string& host) {
    WorkerStatus status = Status(worker);
    status.host = host;
    dispatcher_.On(worker, status, 0.0);
  };
  const std::map<std::string, std::string> host_of = {{"node1_a", "rack1"}, {"node1_b", "rack1"},
                                                      {"node1_c", "rack1"}, {"node1_d", "rack2"},
                                                      {"node1_e", "rack2"}, {"node10_f", "rack1"}};
  for (const auto& [worker, host] : host_of) come(worker, host);
  std::map<std::string, std::vector<std::uint64_t>> given;
  for (const Orders& orders : dispatcher_.Tick(0.0)) {
    for (const FlyOrder& order : orders.assignments)
      given[orders.worker].insert(given[orders.worker].end(), order.cases.begin(), order.cases.end());
  }
  for (const auto& [worker, host] : host_of) Return(worker, ResultOf(given.at(worker).at(0)));
  EXPECT_EQ(Progress().done, 6u);
  const auto lie = [&](const std::string& worker) {
    CaseResult forged = ResultOf(given.at(worker).at(1));
    forged.inputs_digest.low ^= 1;  // a constant that it did not apply
    Return(worker, forged);
  };
  const auto names = [&] {
    std::vector<std::string> all;
    for (const auto& [name, expulsion] : dispatcher_.expelled()) all.push_back(name);
    return all;
  };
  lie("node1_a");
  EXPECT_THAT(names(), ElementsAre("node1_a"));
  EXPECT_EQ(Progress().done, 5u);
  EXPECT_EQ(dispatcher_.joined(), 5u);
  lie("node1_b");
  EXPECT_THAT(names(), ElementsAre("node1@rack1", "node1_a", "node1_b"));
  EXPECT_EQ(Progress().done, 3u) << "of rack2, and of other keys on rack1";
  EXPECT_EQ(dispatcher_.joined(), 3u);
  come("node1_g", "rack1");
  EXPECT_EQ(dispatcher_.joined(), 3u);
  EXPECT_THAT(Tick(0.0, "node1_g").refusal,
              StartsWith("2 of its processes there returned false results, the last one: case "));
  lie("node1_d");
  EXPECT_THAT(names(), ElementsAre("node1", "node1@rack1", "node1_a", "node1_b", "node1_d"));
  EXPECT_EQ(Progress().done, 1u) << "of other keys";
  EXPECT_EQ(dispatcher_.joined(), 1u);
  // Whoever is readmitted begins anew; those that lied stay outside.
  EXPECT_EQ(dispatcher_.Readmit("node2").size(), 0u);
  EXPECT_THAT(dispatcher_.Readmit("node1"),
              ElementsAre("node1", "node1@rack1", "node1_a", "node1_b", "node1_d"));
  EXPECT_EQ(CountExpelled(dispatcher_.expelled()), 0u);
  for (const auto& [worker, host] : host_of) come(worker, host);
  EXPECT_EQ(dispatcher_.joined(), 3u) << "node1_c, node1_e, node10_f";
  lie("node1_e");
  EXPECT_EQ(CountExpelled(dispatcher_.expelled()), 1u) << "its first lie";
}

TEST_F(ForgerTest, KeysThatWereExpelledBeforeStayOutside) {
  Open(2);
  Come("node1_aa");
  dispatcher_.Expel({{"node1", {"its keys are revoked"}}});
  EXPECT_EQ(dispatcher_.joined(), 0u);
  EXPECT_EQ(Progress().waiting, 2u);
  EXPECT_EQ(Tick(0.1, "node1_aa").refusal, "its keys are revoked");
  for (const char* again : {"node1_aa", "node1_bb"}) {
    Come(again, 0.5);
    EXPECT_EQ(Tick(0.5, again).refusal, "its keys are revoked");
  }
  EXPECT_EQ(dispatcher_.joined(), 0u);
}

TEST_F(ForgerTest, TwentyThatTakeCasesAndReturnNoneHoldNobodyUp) {
  constexpr std::uint64_t kCases = 400;
  Open(kCases);
  std::vector<std::string> sybils;
  for (int i = 0; i < 20; ++i) sybils.push_back("a" + std::to_string(i));
  std::map<std::string, std::vector<StartedCase>> started;
  double now_s = 0.0, done_s = 0.0;
  std::vector<StartedCase> owed;  // by the honest one, which needs 20 ms a case
  for (; now_s < 60.0 && done_s == 0.0; now_s += 0.02) {
    for (const std::string& sybil : sybils) {
      WorkerStatus status = Status(sybil);
      status.slots = 1024;
      status.credits = 32768;
      status.started = started[sybil];
      for (const StartedCase& each : status.started) status.held.push_back(each.attempt);
      dispatcher_.On(sybil, status, now_s);
    }
    dispatcher_.On("honest", Status("honest"), now_s);
    if (!owed.empty()) {
      Return("honest", ResultOf(owed.back().case_index), now_s, kEpoch, owed.back().attempt);
      owed.pop_back();
    }
    for (const Orders& orders : dispatcher_.Tick(now_s)) {
      for (const FlyOrder& order : orders.assignments) {
        for (const std::uint64_t case_index : order.cases)
          (orders.worker == "honest" ? owed : started[orders.worker]).push_back({case_index, order.attempt});
      }
    }
    if (book_->Complete()) done_s = now_s;
  }
  EXPECT_EQ(Progress().done, kCases);
  EXPECT_EQ(Progress().quarantined, 0u);
  EXPECT_LT(done_s, 20.0) << "8 s of flying and 10 s of patience";
}

TEST_F(DispatcherTest, ARefusalForAnEarlierCoordinatorMeansNothing) {
  Open(2);
  dispatcher_.On("s", Status(), 0.0);
  dispatcher_.On("s", CampaignRefusal{"w", kEpoch - 1, kFlight, "no"}, 0.1);
  EXPECT_EQ(dispatcher_.RefusalByAll(kFlight), std::nullopt);
  EXPECT_THAT(Tick(0.2).assignments, SizeIs(2));
}

const std::string kFault = "engine fault: core/a.cc:1: x does not hold";

TEST_F(DispatcherTest, AfterAnEngineFaultOfOneWorkerAnotherGetsItsCases) {
  Open(2);
  dispatcher_.On("s", Status(), 0.0);
  EXPECT_THAT(Tick(0.0).assignments, SizeIs(2));
  for (const double now_s : {0.1, 0.2})  // it says so at each case that it is given
    dispatcher_.On("s", CampaignRefusal{"w", kEpoch, kFlight, kFault, true}, now_s);
  EXPECT_EQ(book_->breakdown(), "");
  EXPECT_EQ(dispatcher_.RefusalByAll(kFlight), std::nullopt) << "others may come";
  EXPECT_EQ(dispatcher_.refusal(), std::nullopt);
  EXPECT_EQ(Progress().waiting, 2u);
  dispatcher_.On("s", Status(), 0.3);
  EXPECT_THAT(Tick(0.3).assignments, IsEmpty()) << "it is leaving";
  dispatcher_.On("other", Status("other"), 0.4);
  EXPECT_THAT(Tick(0.4, "other").assignments, SizeIs(2));
}

TEST_F(DispatcherTest, AnEngineFaultOfASecondWorkerEndsTheCampaign) {
  Open(2);
  for (const char* worker : {"a", "b", "c"}) {
    dispatcher_.On(worker, Status(worker), 0.0);
    dispatcher_.Tick(0.0);
  }
  dispatcher_.On("a", CampaignRefusal{"a", kEpoch, kFlight, "engine fault: another", true}, 0.1);
  EXPECT_EQ(book_->breakdown(), "");
  dispatcher_.On("b", CampaignRefusal{"b", kEpoch, kFlight, kFault, true}, 0.2);
  EXPECT_EQ(book_->breakdown(), kFault);
  EXPECT_EQ(Progress().waiting, 2u);
  EXPECT_EQ(Progress().quarantined, 0u);
  EXPECT_THAT(Tick(0.5, "c").assignments, IsEmpty()) << "no other worker gets them";
}

TEST_F(DispatcherTest, OnlyAWorkerThatSaysSoHasAFault) {
  Open(2);
  for (const char* worker : {"a", "b", "c"}) dispatcher_.On(worker, Status(worker), 0.0);
  dispatcher_.On("c", CampaignRefusal{"c", kEpoch, kFlight, "engine fault: another", true}, 0.1);
  for (const char* worker : {"a", "b"})
    dispatcher_.On(worker, CampaignRefusal{worker, kEpoch, kFlight, kFault, false}, 0.1);
  EXPECT_EQ(book_->breakdown(), "") << "whatever its words are";
  EXPECT_EQ(dispatcher_.RefusalByAll(kFlight), kFault) << "of those that stay";
}

// A process that ends with a fault of its own is a crash to its parent. It flies for two campaigns.
TEST_F(DispatcherTest, AnEngineFaultBlamesNoCaseOfAnyCampaign) {
  const std::string other_flight(64, 'e');
  auto store = std::make_unique<MemoryStore>();
  CampaignBook other(MadeUp(other_flight, 1), std::move(store), {.attempt_base = 1000});
  Open(1);
  dispatcher_.BeginCampaign(other);
  JoinSupervised();
  std::vector<StartedCase> started;
  for (const FlyOrder& order : Tick(0.0).assignments) {
    dispatcher_.On("s", Report{"w", kEpoch, 0, order.flight_id, {}, {{0, order.attempt}}}, 0.1);
    started.push_back({0, order.attempt});
  }
  ASSERT_THAT(started, SizeIs(2));
  dispatcher_.On("s", CampaignRefusal{"w", kEpoch, kFlight, kFault, true}, 0.2);
  dispatcher_.WorkerEnded("w", WorkerEnd::kCrashed, "exit code 1", 0.3);
  dispatcher_.Tick(1.0);
  EXPECT_EQ(dispatcher_.joined(), 0u);
  dispatcher_.On("n", Status("n"), 1.1);
  EXPECT_THAT(Tick(1.1, "n").assignments, SizeIs(2)) << "suspects would fly alone, one after the other";
  EXPECT_EQ(other.breakdown(), "");
  dispatcher_.EndCampaign(other_flight);
}

TEST_F(DispatcherTest, ARuleThatBreaksInOneBookEndsItsCampaignAlone) {
  const std::string other_flight(64, 'e');
  CampaignBook other(MadeUp(other_flight, 1), std::make_unique<MemoryStore>(), {.attempt_base = 1000});
  Open(1);
  dispatcher_.BeginCampaign(other);
  dispatcher_.On("s", Status(), 5.0);
  for (const FlyOrder& order : Tick(5.0).assignments)
    dispatcher_.On("s", Report{"w", kEpoch, 0, order.flight_id, {}, {{0, order.attempt}}}, 5.0);
  Fly(1, 0, 4.0);  // before it was begun
  EXPECT_THAT(book_->breakdown(), StartsWith("engine fault: services/ledger/ledger.cc:"));
  EXPECT_THAT(book_->breakdown(), EndsWith("duration_s >= 0.0 does not hold, duration_s: -1"));
  EXPECT_EQ(other.breakdown(), "");
  dispatcher_.On("s", Report{"w", kEpoch, 2, other_flight, {{1001, ResultOf(0)}}, {}}, 6.0);
  EXPECT_TRUE(other.Complete());
  dispatcher_.EndCampaign(other_flight);
}

TEST_F(DispatcherTest, AWorkerThatRefusedACampaignGetsNoCaseOfIt) {
  Open(2);
  dispatcher_.On("s", Status(), 0.0);
  dispatcher_.On("s", CampaignRefusal{"w", kEpoch, kFlight, "no\x1b[31m"}, 0.1);
  EXPECT_EQ(dispatcher_.refusal(), "no\\x1b[31m") << "in letters that a terminal may be shown";
  dispatcher_.On("s", Status(), 0.5);
  EXPECT_THAT(Tick(0.5).assignments, IsEmpty());
  EXPECT_EQ(Progress().waiting, 2u);
}

TEST_F(DispatcherTest, AcknowledgementsThatDoNotFitComeNext) {
  dispatcher_.On("s", Status(), 0.0);
  std::set<std::uint64_t> acknowledged;
  for (std::uint64_t number = 1; number <= 5000; ++number)
    dispatcher_.On("s", Report{"w", kEpoch, number, kFlight, {{1, ResultOf(0)}}, {}}, 0.0);
  for (const double now_s : {0.1, 0.2, 0.3}) {
    const Orders orders = Tick(now_s);
    EXPECT_LE(orders.acknowledged.size(), 4096u);
    acknowledged.insert(orders.acknowledged.begin(), orders.acknowledged.end());
  }
  EXPECT_EQ(acknowledged.size(), 5000u);
}

TEST_F(DispatcherTest, ASupervisedWorkerThatIsSilentIsNamedUntilItsEndIsTold) {
  Open(1);
  JoinSupervised();
  Tick(3.0);
  EXPECT_THAT(dispatcher_.TakeUnresponsive(), IsEmpty());
  for (const double now_s : {3.1, 6.2}) {
    Tick(now_s);
    EXPECT_THAT(dispatcher_.TakeUnresponsive(), ElementsAre("w")) << now_s;
    Tick(now_s + 0.1);
    EXPECT_THAT(dispatcher_.TakeUnresponsive(), IsEmpty()) << now_s;
  }
  EXPECT_EQ(dispatcher_.joined(), 1u) << "its exit status says more";
}

TEST_F(DispatcherTest, ASupervisedWorkerThatHangsIsNamed) {
  Open(1, {.lease_s = 10.0});
  JoinSupervised();
  WorkerStatus flies = Status();
  flies.held = {Tick(0.0).assignments.at(0).attempt};
  flies.started = {{0, flies.held[0]}};
  std::vector<std::string> named;
  for (double now_s = 0.5; now_s < 12.0; now_s += 0.5) {
    dispatcher_.On("s", flies, now_s);  // it says all the time that it lives and flies
    Tick(now_s);
    const auto taken = dispatcher_.TakeUnresponsive();
    named.insert(named.end(), taken.begin(), taken.end());
    if (now_s <= 10.5) {
      EXPECT_THAT(named, IsEmpty()) << now_s;
    }
  }
  EXPECT_THAT(named, ElementsAre("w"));
}

TEST_F(DispatcherTest, ASupervisedWorkersEndIsToldByItsParent) {
  Open(2);
  JoinSupervised();
  Tick(0.0);
  WorkerStatus left = Status();
  left.state = WorkerState::kLeft;
  dispatcher_.On("s", left, 0.5);
  EXPECT_EQ(dispatcher_.joined(), 1u);
  EXPECT_EQ(Progress().assigned, 2u);
  dispatcher_.WorkerEnded("w", WorkerEnd::kLeft, "exit code 0", 0.6);
  Tick(1.0);
  EXPECT_EQ(dispatcher_.joined(), 0u);
  EXPECT_EQ(Progress().waiting, 2u);
}

TEST_F(DispatcherTest, ASuspectFliesBesideNoCaseOfAnotherCampaign) {
  Open(1);
  dispatcher_.On("s", Status("doomed"), 0.0);
  const std::uint64_t attempt = Tick(0.0, "doomed").assignments.at(0).attempt;
  dispatcher_.On("s", Report{"doomed", kEpoch, 1, kFlight, {}, {{0, attempt}}}, 0.1);
  Tick(5.0);  // it fell silent
  dispatcher_.On("s", Status(), 5.0);
  ASSERT_THAT(Tick(5.0).assignments, SizeIs(1)) << "the suspect";
  CampaignBook other(MadeUp(std::string(64, '1'), 5), std::make_unique<MemoryStore>(),
                     {.attempt_base = 1000});
  dispatcher_.BeginCampaign(other, 9);
  for (const double now_s : {5.1, 6.1}) {
    dispatcher_.On("s", Status(), now_s);
    EXPECT_THAT(Tick(now_s).assignments, IsEmpty()) << now_s;
  }
  EXPECT_EQ(other.ledger().Progress().waiting, 5u);
  // Nor does it join others.
  dispatcher_.On("s3", Status("v"), 6.2);
  EXPECT_THAT(Tick(6.2, "v").assignments, Not(IsEmpty()));
}

TEST_F(DispatcherTest, ANewPriorityCountsFromNowOn) {
  CampaignBook one(MadeUp(std::string(64, '1'), 50), std::make_unique<MemoryStore>(), {.attempt_base = 1000});
  CampaignBook other(MadeUp(std::string(64, '2'), 50), std::make_unique<MemoryStore>(),
                     {.attempt_base = 2000});
  dispatcher_.BeginCampaign(one, 3);
  dispatcher_.BeginCampaign(other, 2);
  dispatcher_.BeginCampaign(other, 4);
  dispatcher_.On("s", Status(), 0.0);
  Tick(0.0);
  EXPECT_EQ(one.ledger().Progress().assigned, 0u);
  EXPECT_GT(other.ledger().Progress().assigned, 0u);
}

TEST_F(DispatcherTest, DismissedWorkersAreToldAtOnceAndGetNoMoreCases) {
  Open(100);
  dispatcher_.On("s", Status(), 0.0);
  EXPECT_FALSE(Tick(0.0).leave);
  dispatcher_.Dismiss();
  dispatcher_.On("t", Status("v"), 0.1);
  const std::vector<Orders> told = dispatcher_.Tick(0.1);
  ASSERT_THAT(told, SizeIs(2));
  for (const Orders& orders : told) {
    EXPECT_TRUE(orders.leave) << orders.worker;
    EXPECT_THAT(orders.assignments, IsEmpty()) << orders.worker;
  }
}

TEST_F(DispatcherTest, AStrangersReportIsNotCounted) {
  Open(2);
  Fly(1, 0, 0.0);
  EXPECT_EQ(Progress().done, 0u);
  dispatcher_.On("s", Status(), 0.1);
  Fly(1, 77, 0.2);
  EXPECT_EQ(dispatcher_.refused_messages(), 1u) << "a case that does not exist";
  EXPECT_EQ(Progress().done, 0u);
}

TEST_F(DispatcherTest, NoWorkerTakesMoreThanCreditsOfABatch) {
  LedgerOptions options;
  options.first_assignments = 1000;
  Open(100000, options);
  WorkerStatus greedy = Status();
  greedy.credits = 60000;
  dispatcher_.On("s", greedy, 0.0);
  dispatcher_.On("s2", Status("other"), 0.0);
  EXPECT_EQ(Tick(0.0).assignments.size(), 32u) << "another worker that comes finds cases left";
}

TEST_F(DispatcherTest, ADrainingWorkerKeepsWhatItFliesAndGetsNoMore) {
  Open(4);
  dispatcher_.On("s", Status(), 0.0);
  const Orders orders = Tick(0.0);
  WorkerStatus drains = Status();
  drains.state = WorkerState::kDraining;
  drains.held = {orders.assignments.at(0).attempt};
  drains.started = {{orders.assignments[0].cases.at(0), orders.assignments[0].attempt}};
  dispatcher_.On("s", drains, 0.5);
  EXPECT_EQ(Progress().assigned, 1u);
  EXPECT_THAT(Tick(0.6).assignments, IsEmpty());
}

TEST_F(DispatcherTest, GivesOutATextInParts) {
  Open(1);
  EXPECT_FALSE(dispatcher_.On(TextRequest{"w", kFlight, 0}, 4, 0.0)) << "to no stranger";
  dispatcher_.On("s", Status(), 0.0);
  EXPECT_EQ(dispatcher_.On(TextRequest{"w", kFlight, 0}, 4, 0.0)->bytes, "0123");
  EXPECT_EQ(dispatcher_.On(TextRequest{"w", kFlight, 8}, 4, 0.0)->bytes, "89");
  EXPECT_EQ(dispatcher_.On(TextRequest{"w", kFlight, 8}, 4, 0.0)->size, 10u);
  EXPECT_FALSE(dispatcher_.On(TextRequest{"w", kFlight, 11}, 4, 0.0));
  EXPECT_FALSE(dispatcher_.On(TextRequest{"w", std::string(64, 'e'), 0}, 4, 0.0));
}

class AuditTest : public DispatcherTest {
 protected:
  void Audit(double share, std::uint64_t cases) {
    audited_ = std::make_unique<Dispatcher>(kEpoch, EngineVersion(), DispatcherOptions{.audit = {share, 1}});
    auto store = std::make_unique<MemoryStore>();
    store_ = store.get();
    book_ = std::make_unique<CampaignBook>(MadeUp(kFlight, cases), std::move(store));
    audited_->BeginCampaign(*book_);
    for (const char* worker : {"liar", "honest"}) audited_->On(worker, Status(worker), 0.0);
  }
  /// Of a worker that is there, whomever the case was given to.
  void Return(const std::string& worker, const CaseResult& result) {
    for (const Dispatcher::WorkerView& view : audited_->Workers())
      if (view.worker == worker) book_->Accept(worker, "host", 0, result, 0.0);
  }
  static CaseResult Lie(std::uint64_t case_index) {
    CaseResult lie = ResultOf(case_index);
    lie.digest.low = 1;
    return lie;
  }
  std::unique_ptr<Dispatcher> audited_;
};

TEST_F(AuditTest, TakesTheFirstResultOfEachWorkerAndTheShare) {
  Audit(0.25, 1000);
  for (std::uint64_t i = 0; i < 1000; ++i) Return(i % 2 == 0 ? "honest" : "liar", ResultOf(i));
  const std::size_t taken = FlyClaims(*audited_);
  EXPECT_NEAR(static_cast<double>(taken), 252.0, 60.0) << "four standard deviations";
  EXPECT_EQ(FlyClaims(*audited_), 0u) << "each once";
  EXPECT_EQ(book_->confirmed(), taken);
  EXPECT_EQ(audited_->expelled().size(), 0u);
  book_->Flush();
  EXPECT_EQ(store_->audited.size(), taken);
}

TEST_F(AuditTest, NothingIsCompleteBeforeItsAuditIs) {
  Audit(1e-9, 2);
  Return("honest", ResultOf(0));
  Return("liar", ResultOf(1));
  EXPECT_TRUE(book_->ledger().Complete());
  EXPECT_FALSE(book_->Complete());
  EXPECT_EQ(FlyClaims(*audited_), 2u) << "the first of each";
  EXPECT_TRUE(book_->Complete());
}

TEST_F(AuditTest, ALiarIsExpelledAndAllThatItReturnedIsFlownAgain) {
  Audit(1e-9, 8);
  for (std::uint64_t i = 0; i < 4; ++i) Return("honest", ResultOf(i));
  Return("liar", Lie(4));
  for (std::uint64_t i = 5; i < 8; ++i) Return("liar", ResultOf(i));
  ASSERT_TRUE(book_->ledger().Complete());
  FlyClaims(*audited_);
  EXPECT_EQ(audited_->expelled().size(), 1u);
  EXPECT_EQ(Progress().done, 4u) << "what it told the truth about too";
  EXPECT_EQ(store_->stored, 4u);
  // It is told why, whenever it speaks, and gets and gives nothing any more.
  audited_->On("liar", Status("liar"), 1.0);
  bool is_told = false;
  for (const Orders& orders : audited_->Tick(1.0)) {
    if (orders.worker != "liar") continue;
    is_told = true;
    EXPECT_THAT(orders.refusal, HasSubstr("case 4"));
    EXPECT_THAT(orders.assignments, IsEmpty());
  }
  EXPECT_TRUE(is_told);
  Return("liar", ResultOf(5));
  EXPECT_EQ(Progress().done, 4u);
  for (std::uint64_t i = 4; i < 8; ++i) Return("honest", ResultOf(i));
  EXPECT_TRUE(book_->Complete());
}

TEST_F(AuditTest, AnExpelledWorkerIsRememberedHoweverManyAreRefused) {
  Audit(1e-9, 2);
  SetLogLevel(LogLevel::kNothing);
  for (int i = 0; i < 1000; ++i) {
    WorkerStatus stranger = Status("stranger" + std::to_string(i));
    stranger.engine_version = "other";
    audited_->On("s", stranger, 0.0);
  }
  SetLogLevel(LogLevel::kInfo);
  Return("liar", Lie(0));
  FlyClaims(*audited_);
  EXPECT_EQ(audited_->expelled().size(), 1u);
  audited_->On("liar", Status("liar"), 1.0);
  EXPECT_EQ(audited_->joined(), 1u) << "the honest one";
}

TEST_F(AuditTest, ADisputedResultIsNotStoredAsAudited) {
  Audit(1e-9, 3);
  Return("honest", ResultOf(0));
  Return("liar", ResultOf(1));
  FlyClaims(*audited_);
  Return("liar", Lie(2));
  Return("honest", ResultOf(2));  // right, and not what is stored
  FlyClaims(*audited_);
  book_->Flush();
  EXPECT_THAT(store_->audited, ElementsAre(0, 1));
}

TEST_F(AuditTest, SettlesWhoIsWrongWhenTwoContradictEachOther) {
  for (const bool the_lie_comes_first : {true, false}) {
    Audit(1e-9, 3);
    Return("honest", ResultOf(0));
    Return("liar", ResultOf(1));
    FlyClaims(*audited_);  // the first of each; the others are not chosen
    if (the_lie_comes_first) Return("liar", Lie(2));
    Return("honest", ResultOf(2));
    if (!the_lie_comes_first) Return("liar", Lie(2));
    EXPECT_EQ(Progress().conflicts, 1u);
    EXPECT_EQ(FlyClaims(*audited_), 2u);
    EXPECT_EQ(audited_->expelled().size(), 1u);
    EXPECT_EQ(Progress().conflicts, 0u) << "it is known who was wrong";
    EXPECT_EQ(store_->WorkerOf(0), "honest");
    EXPECT_EQ(store_->WorkerOf(1), std::nullopt);
    EXPECT_EQ(book_->ledger().Complete(), false);
    Return("honest", ResultOf(1));
    if (the_lie_comes_first) Return("honest", ResultOf(2));
    EXPECT_TRUE(book_->Complete());
  }
}

// A campaign whose control law is a plug-in, and two workers.
class PluginTest : public DispatcherTest {
 protected:
  void Open(std::uint64_t cases, const MemoryStore& stored = {}) {
    Campaign campaign = MadeUp(kFlight, cases);
    campaign.autopilot.plugin.emplace().name = "law";
    auto store = std::make_unique<MemoryStore>(stored);
    store_ = store.get();
    dispatcher_.EndCampaign(kFlight);
    book_ = std::make_unique<CampaignBook>(campaign, std::move(store));
    dispatcher_.BeginCampaign(*book_);
  }
  void Come(const std::string& worker) { dispatcher_.On(worker, Status(worker), 0.0); }
  /// Whomever the case was given to.
  void Return(const std::string& worker, const CaseResult& result) {
    book_->Accept(worker, "host", 0, result, 0.0);
  }
  std::vector<std::uint64_t> Given(const std::string& worker) {
    std::vector<std::uint64_t> cases;
    for (const FlyOrder& order : Tick(0.0, worker).assignments)
      cases.insert(cases.end(), order.cases.begin(), order.cases.end());
    return cases;
  }
};

TEST_F(PluginTest, TheFirstTwoCasesAreFlownByTwoWorkers) {
  Open(3);
  for (const char* worker : {"a", "b"}) Come(worker);
  for (std::uint64_t i = 0; i < 3; ++i) Return("a", ResultOf(i));
  EXPECT_FALSE(book_->Complete());
  EXPECT_THAT(Given("b"), ElementsAre(0, 1));
  EXPECT_THAT(Given("a"), IsEmpty());
  for (std::uint64_t i = 0; i < 2; ++i) Return("b", ResultOf(i));
  EXPECT_TRUE(book_->Complete());
  EXPECT_EQ(book_->refusal(), std::nullopt);
  EXPECT_EQ(Progress().conflicts, 0u);
}

TEST_F(PluginTest, AnotherResultRefusesTheCampaignAndNamesTheFirstColumnThatDiffers) {
  Open(3);
  for (const char* worker : {"a", "b"}) Come(worker);
  CaseResult first = ResultOf(1), second = ResultOf(1);
  first.metrics.assign(MetricCount(kUsualStages), 0.25);
  second.metrics = first.metrics;
  second.metrics[1] = 0.5;
  second.metrics[2] = 0.75;
  second.digest.low = 1;
  Return("a", first);
  Return("b", second);
  EXPECT_EQ(book_->refusal(),
            "the control law law is not deterministic: of case 1, flown by worker a and again by b, metric_" +
                MetricNames()[1] + " is '0.25' once and '0.5' again");
}

TEST_F(PluginTest, ASecondFlightThatIsQuarantinedRefusesTheCampaign) {
  Open(1);
  for (const char* worker : {"a", "b"}) Come(worker);
  Return("a", ResultOf(0));
  dispatcher_.On("b", Status("b"), 0.0);
  const Orders orders = Tick(0.0, "b");
  ASSERT_EQ(orders.assignments.size(), 1u);
  CaseResult quarantined;
  quarantined.reason = "the control law ended by signal 11 (SIGSEGV)";
  FlownCase flown{orders.assignments[0].attempt, quarantined};
  flown.is_quarantined = true;
  dispatcher_.On("b", Report{"b", kEpoch, 1, kFlight, {flown}, {}}, 0.0);
  EXPECT_EQ(book_->refusal(),
            "the control law law is not deterministic: of case 0, flown by worker a and again by b, the "
            "flight ended well once, and again the control law ended by signal 11 (SIGSEGV)");
}

TEST_F(PluginTest, ACoordinatorThatIsStartedAgainStillWantsAnotherWorker) {
  Open(2);
  for (const char* worker : {"a", "b"}) Come(worker);
  CaseResult other = ResultOf(0);
  other.end_stage = 3;
  Return("a", other);
  Return("a", ResultOf(1));
  book_->Flush();
  Open(2, MemoryStore(*store_));
  EXPECT_FALSE(book_->Complete());
  EXPECT_THAT(Given("b"), ElementsAre(0, 1));
  Return("a", other);  // what was not acknowledged is said again
  Return("a", ResultOf(1));
  EXPECT_EQ(book_->refusal(), std::nullopt);
  EXPECT_FALSE(book_->Complete());
  Return("b", ResultOf(0));
  EXPECT_EQ(book_->refusal(),
            "the control law law is not deterministic: of case 0, flown by worker a and again by b, "
            "end_stage is '3' once and '0' again");
}

TEST_F(PluginTest, WhatWasFlownBeforeIsWhatEveryWorkerMustReturn) {
  Open(3);
  Come("a");
  CaseResult flown = ResultOf(0);
  flown.end_stage = 2;
  book_->Expect({flown});
  Return("a", ResultOf(1));
  EXPECT_EQ(book_->refusal(), std::nullopt);
  Return("a", ResultOf(0));
  EXPECT_EQ(book_->refusal(),
            "the control law law is not deterministic: of case 0, flown here before the campaign and again "
            "by a, end_stage is '2' once and '0' again");
}

TEST_F(PluginTest, WhatIsStoredMustBeWhatWasFlownBefore) {
  Open(3);
  Come("a");
  Return("a", ResultOf(0));
  book_->Flush();
  book_->Expect({ResultOf(0), ResultOf(1)});
  EXPECT_EQ(book_->refusal(), std::nullopt);
  CaseResult flown = ResultOf(0);
  flown.end_stage = 2;
  book_->Expect({flown});
  EXPECT_THAT(book_->refusal().value_or(""),
              HasSubstr("of case 0, flown here before the campaign and again by a"));
}

TEST_F(PluginTest, ACampaignIsRefusedByAllWhenNobodyIsLeft) {
  Open(3);
  EXPECT_EQ(dispatcher_.RefusalByAll(kFlight), std::nullopt);
  for (const char* worker : {"a", "b"}) Come(worker);
  dispatcher_.On("a", CampaignRefusal{"a", kEpoch, kFlight, "no"}, 0.0);
  EXPECT_EQ(dispatcher_.RefusalByAll(kFlight), std::nullopt);
  dispatcher_.On("b", CampaignRefusal{"b", kEpoch, kFlight, "neither"}, 0.0);
  EXPECT_EQ(dispatcher_.RefusalByAll(kFlight), "no");
}

TEST_F(PluginTest, AContradictionOfAnyCaseRefusesTheCampaign) {
  Open(9);
  for (const char* worker : {"a", "b"}) Come(worker);
  Return("a", ResultOf(8));
  CaseResult other = ResultOf(8);
  other.reason = "lost";
  Return("a", other);
  EXPECT_THAT(book_->refusal().value_or(""),
              HasSubstr("of case 8, flown by worker a and again by a, reason is '' once and 'lost' again"));
}

TEST_F(PluginTest, OnlyACaseThatAPluginCouldSpoilIsQuarantined) {
  for (const bool with_plugin : {true, false}) {
    if (with_plugin) {
      Open(1);
    } else {
      dispatcher_.EndCampaign(kFlight);
      DispatcherTest::Open(1);
    }
    Come("a");
    const Orders orders = Tick(with_plugin ? 0.0 : 0.5, "a");
    ASSERT_EQ(orders.assignments.size(), 1u);
    FlownCase flown{orders.assignments[0].attempt, {}};
    flown.result.reason = "it ended the process";
    flown.is_quarantined = true;
    dispatcher_.On("a", Report{"a", kEpoch, 1, kFlight, {flown}, {}}, 0.5);
    EXPECT_EQ(Progress().quarantined, with_plugin ? 1u : 0u);
    EXPECT_EQ(dispatcher_.refused_messages(), with_plugin ? 0u : 1u);
  }
}

TEST_F(PluginTest, ACaseThatIsQuarantinedForAnEarlierCoordinatorIsNot) {
  Open(1);
  Come("a");
  const std::uint64_t attempt = Tick(0.0, "a").assignments.at(0).attempt;
  FlownCase flown{attempt, {}, true};
  flown.result.reason = "it ended the process";
  dispatcher_.On("a", Report{"a", kEpoch - 1, 1, kFlight, {flown}, {}}, 0.5);
  EXPECT_EQ(Progress().quarantined, 0u);
}

TEST_F(PluginTest, CampaignsWithoutPluginAreFlownOnce) {
  DispatcherTest::Open(2);
  for (const char* worker : {"a", "b"}) Come(worker);
  for (std::uint64_t i = 0; i < 2; ++i) Return("a", ResultOf(i));
  EXPECT_TRUE(book_->Complete());
  EXPECT_THAT(Given("b"), IsEmpty());
}

}  // namespace dispersa::dispatcher_test
