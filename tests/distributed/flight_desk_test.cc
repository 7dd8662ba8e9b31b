// A worker's rules with made-up time and messages.
#include "services/worker/flight_desk.h"

#include "tests/test.h"

namespace dispersa::flight_desk_test {

const std::string kFlight(64, 'f');

class FlightDeskTest : public testing::Test {
 protected:
  FlightDesk desk_{{.worker = "w", .engine_version = "e", .slots = 1}, 0.0};
  std::map<std::uint64_t, std::uint64_t> numbers_;  ///< of reports, and the coordinator that they are for

  Orders Say(std::vector<FlyOrder> assignments, std::uint64_t epoch = 7) {
    return {"w", epoch, std::move(assignments), {}, {}, false, ""};
  }
  void Load(double now_s = 0.0) {
    ASSERT_THAT(desk_.Tick(now_s).text_requests, SizeIs(1));
    desk_.On(TextPart{"w", kFlight, "name", "e", 4, 0, "te"}, now_s);
    EXPECT_FALSE(desk_.TakeText());
    desk_.On(TextPart{"w", kFlight, "name", "e", 4, 0, "te"}, now_s);  // again
    desk_.On(TextPart{"w", kFlight, "name", "e", 4, 2, "xt"}, now_s);
    EXPECT_EQ(desk_.TakeText().value().text, "text");
    EXPECT_FALSE(desk_.TakeText());
    desk_.Loaded(kFlight, nullptr, "");
  }
};

TEST_F(FlightDeskTest, TheStartIsReportedBeforeTheCaseIsFlown) {
  desk_.On(Say({{kFlight, 3, {10, 11}}}), 0.0);
  EXPECT_FALSE(desk_.Next(0.0)) << "no text yet";
  Load();
  const auto first = desk_.Next(0.0);
  ASSERT_TRUE(first);
  auto reports = desk_.TakeReports(0.0);
  ASSERT_THAT(reports, SizeIs(1));
  EXPECT_THAT(reports[0].started, ElementsAre(StartedCase{10, 3}));
  EXPECT_THAT(desk_.Status(WorkerState::kFlying).started, ElementsAre(StartedCase{10, 3}));
  desk_.Done(*first, {}, 1.0);
  // The result travels with the start of the next.
  ASSERT_TRUE(desk_.Next(1.0));
  reports = desk_.TakeReports(1.0);
  ASSERT_THAT(reports, SizeIs(1));
  EXPECT_THAT(reports[0].flown, SizeIs(1));
  EXPECT_THAT(reports[0].started, ElementsAre(StartedCase{11, 3}));
}

TEST_F(FlightDeskTest, CasesThatTakeNoTimeAreAnnouncedTogether) {
  std::vector<std::uint64_t> cases(40);
  for (std::size_t i = 0; i < cases.size(); ++i) cases[i] = i;
  desk_.On(Say({{kFlight, 3, cases}}), 0.0);
  Load();
  std::size_t messages = 0;
  double now_s = 0.0;
  while (const auto job = desk_.Next(now_s)) {
    messages += desk_.TakeReports(now_s).size();
    now_s += 0.0005;
    desk_.Done(*job, {}, now_s);
  }
  messages += desk_.TakeReports(now_s).size();
  EXPECT_LE(messages, 7u);  // the first alone, then ten together
}

TEST_F(FlightDeskTest, RepeatsAReportUntilItIsAcknowledged) {
  desk_.On(Say({{kFlight, 3, {10}}}), 0.0);
  Load();
  desk_.Done(*desk_.Next(0.0), {}, 0.1);
  EXPECT_FALSE(desk_.Next(0.1));
  const auto reports = desk_.TakeReports(0.1);
  ASSERT_THAT(reports, SizeIs(2));  // the start, the result, which has no next start to travel with
  const std::uint64_t number = reports.back().number;
  EXPECT_THAT(desk_.Tick(1.0).reports, IsEmpty());
  desk_.On(Say({}), 2.0);
  EXPECT_THAT(desk_.Tick(2.2).reports, SizeIs(1));
  EXPECT_THAT(desk_.Tick(2.3).reports, IsEmpty());
  EXPECT_THAT(desk_.Status(WorkerState::kReady).held, ElementsAre(3));
  desk_.On(Say({{kFlight, 3, {10}}}), 2.5);  // the same order again
  EXPECT_FALSE(desk_.Next(2.5));
  Orders acknowledges = Say({});
  acknowledges.acknowledged = {number};
  desk_.On(acknowledges, 3.0);
  EXPECT_THAT(desk_.Status(WorkerState::kReady).held, IsEmpty());
  EXPECT_TRUE(desk_.IsIdle());
  desk_.On(Say({}), 9.0);
  EXPECT_THAT(desk_.Tick(9.0).reports, IsEmpty());
}

// A host whose place another one took, and that comes back: two coordinators never pull at one worker.
TEST_F(FlightDeskTest, AnOlderCoordinatorIsFollowedOnlyWhenTheYoungerOneIsSilent) {
  desk_.On(Say({{kFlight, 3, {10}}}, 8), 0.0);
  Load();
  desk_.Done(*desk_.Next(0.0), {}, 0.1);
  EXPECT_FALSE(desk_.Next(0.1));
  const std::uint64_t number = desk_.TakeReports(0.1).back().number;
  Orders old = Say({{kFlight, 3, {20}}}, 7);
  old.acknowledged = {number};
  old.leave = true;
  old.refusal = "another engine";
  desk_.On(old, 4.9);
  EXPECT_FALSE(desk_.Next(4.9));
  EXPECT_FALSE(desk_.left());
  EXPECT_EQ(desk_.refusal(), "");
  EXPECT_THAT(desk_.Status(WorkerState::kReady).held, ElementsAre(3)) << "the younger one has not stored it";
  EXPECT_EQ(desk_.Status(WorkerState::kReady).coordinator_epoch, 8u);
  EXPECT_FALSE(desk_.IsHeard(5.1)) << "the older one's words are no sign of life";
  desk_.On(Say({{kFlight, 3, {20}}}, 7), 5.1);
  ASSERT_TRUE(desk_.Next(5.1));
  EXPECT_EQ(desk_.Status(WorkerState::kReady).coordinator_epoch, 7u);
}

TEST_F(FlightDeskTest, AnotherCoordinatorsOrdersReplaceTheLastOnes) {
  desk_.On(Say({{kFlight, 3, {10, 11}}}), 0.0);
  Load();
  const auto old = desk_.Next(0.0);
  desk_.On(Say({{kFlight, 3, {20}}}, 8), 0.5);
  EXPECT_THAT(desk_.Status(WorkerState::kReady).started, IsEmpty());
  const auto job = desk_.Next(0.5);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->case_index, 20u);
  EXPECT_EQ(job->coordinator_epoch, 8u);
  EXPECT_FALSE(desk_.Next(0.5)) << "case 11 is nobody's wish any more";
  // Results flown for the last coordinator count, under its name.
  desk_.Done(*old, {}, 0.6);
  for (const Report& report : desk_.TakeReports(0.6)) {
    if (!report.flown.empty()) {
      EXPECT_EQ(report.coordinator_epoch, 7u);
    }
  }
  EXPECT_THAT(desk_.Status(WorkerState::kReady).held, ElementsAre(3));
}

TEST_F(FlightDeskTest, WhatIsRevokedIsNotBegun) {
  desk_.On(Say({{kFlight, 3, {10}}, {kFlight, 4, {11}}}), 0.0);
  Load();
  Orders revokes = Say({});
  revokes.revoked = {3, 99};
  desk_.On(revokes, 0.1);
  EXPECT_EQ(desk_.Next(0.1).value().case_index, 11u);
  EXPECT_FALSE(desk_.Next(0.1));
}

TEST_F(FlightDeskTest, ACampaignThatDoesNotLoadIsRefusedEachTime) {
  desk_.On(Say({{kFlight, 3, {10}}}), 0.0);
  desk_.Tick(0.0);
  desk_.On(TextPart{"w", kFlight, "name", "e", 1, 0, "x"}, 0.0);
  desk_.TakeText();
  desk_.Loaded(kFlight, nullptr, "line 1: bad");
  auto refusals = desk_.Tick(0.1).refusals;
  ASSERT_THAT(refusals, SizeIs(1));
  EXPECT_EQ(refusals[0].reason, "line 1: bad");
  EXPECT_THAT(desk_.Status(WorkerState::kReady).held, IsEmpty());
  EXPECT_THAT(desk_.Tick(0.2).refusals, IsEmpty());
  desk_.On(Say({{kFlight, 3, {10}}}), 2.0);  // the refusal got lost
  EXPECT_THAT(desk_.Tick(2.1).refusals, SizeIs(1));
}

TEST_F(FlightDeskTest, AFaultOfTheProgramIsSaidAsSuch) {
  const std::string other(64, 'e');
  desk_.On(Say({{kFlight, 3, {10}}, {other, 4, {10}}}), 0.0);
  desk_.Loaded(kFlight, nullptr, "engine fault: core/a.cc:1: x does not hold", true);
  desk_.Loaded(other, nullptr, "line 1: bad");
  std::map<std::string, bool> faults;
  for (const CampaignRefusal& refusal : desk_.Tick(0.1).refusals)
    faults[refusal.flight_id] = refusal.engine_fault;
  EXPECT_EQ(faults, (std::map<std::string, bool>{{kFlight, true}, {other, false}}));
}

TEST_F(FlightDeskTest, WithoutAWordTheConnectionIsMadeAnewEverMoreSeldom) {
  std::vector<double> anew;
  for (double now_s = 0.0; now_s < 100.0; now_s += 0.5)
    if (desk_.Tick(now_s).new_connection) anew.push_back(now_s);
  EXPECT_THAT(anew, ElementsAre(5.5, 16.0, 36.5, 67.0, 97.5));
  desk_.On(Say({}), 100.0);
  EXPECT_FALSE(desk_.Tick(104.9).new_connection);
  EXPECT_TRUE(desk_.Tick(105.1).new_connection);
}

TEST_F(FlightDeskTest, SaysThatItLivesTwiceASecondWhateverHappens) {
  int said = 0;
  for (int i = 0; i < 1000; ++i) said += desk_.Tick(0.01 * i).status.has_value();
  EXPECT_GE(said, 19);
  EXPECT_LE(said, 21);
}

TEST_F(FlightDeskTest, FlyingWaitsWhileResultsAreNotStored) {
  FlightDesk desk({.worker = "w", .engine_version = "e", .slots = 1, .max_unstored = 2}, 0.0);
  desk.On(Say({{kFlight, 3, {1, 2, 3}}}), 0.0);
  desk.Tick(0.0);
  desk.On(TextPart{"w", kFlight, "name", "e", 1, 0, "x"}, 0.0);
  desk.TakeText();
  desk.Loaded(kFlight, nullptr, "");
  std::vector<std::uint64_t> numbers;
  for (int i = 0; i < 2; ++i) {
    desk.Done(*desk.Next(i), {}, i + 0.5);
  }
  EXPECT_FALSE(desk.Next(2.0));
  for (const Report& report : desk.TakeReports(2.0)) numbers.push_back(report.number);
  Orders acknowledges = Say({});
  acknowledges.acknowledged = numbers;
  desk.On(acknowledges, 2.1);
  EXPECT_TRUE(desk.Next(2.2));
}

TEST_F(FlightDeskTest, DrainedItHandsBackWhatItHasNotBegun) {
  desk_.On(Say({{kFlight, 3, {10, 11}}, {kFlight, 4, {12}}}), 0.0);
  Load();
  const auto job = desk_.Next(0.0);
  desk_.Drain();
  EXPECT_FALSE(desk_.Next(0.1));
  const auto status = desk_.Tick(0.1).status;
  ASSERT_TRUE(status);
  EXPECT_EQ(status->state, WorkerState::kDraining);
  EXPECT_THAT(status->held, ElementsAre(3));
  EXPECT_THAT(status->started, ElementsAre(StartedCase{10, 3}));
  desk_.On(Say({{kFlight, 5, {13}}}), 0.2);
  EXPECT_FALSE(desk_.Next(0.2));
  EXPECT_FALSE(desk_.IsIdle());
  desk_.Done(*job, {}, 1.0);
  EXPECT_FALSE(desk_.IsIdle()) << "its result is not stored yet";
}

TEST_F(FlightDeskTest, HalvesOfTwoTextsAreNotJoined) {
  desk_.On(Say({{kFlight, 3, {10}}}), 0.0);
  desk_.Tick(0.0);
  desk_.On(TextPart{"w", kFlight, "name", "e", 4, 0, "te"}, 0.0);
  desk_.On(TextPart{"w", kFlight, "name", "e", 6, 2, "xten"}, 0.1);
  EXPECT_FALSE(desk_.TakeText()) << "the rest of a text of another size";
  // Another coordinator's text begins at its beginning.
  desk_.On(Say({{kFlight, 1, {10}}}, 8), 1.0);
  const auto requests = desk_.Tick(1.0).text_requests;
  ASSERT_THAT(requests, SizeIs(1));
  EXPECT_EQ(requests[0].offset, 0u);
  desk_.On(TextPart{"w", kFlight, "name", "e", 4, 2, "ab"}, 1.1);  // asked for by the last one
  desk_.On(TextPart{"w", kFlight, "name", "e", 4, 0, "ab"}, 1.2);
  desk_.On(TextPart{"w", kFlight, "name", "e", 4, 2, "cd"}, 1.3);
  EXPECT_EQ(desk_.TakeText().value().text, "abcd");
}

TEST_F(FlightDeskTest, AnAttemptIsOfOneCoordinator) {
  desk_.On(Say({{kFlight, 3, {10}}}), 0.0);
  Load();
  const auto old = desk_.Next(0.0);
  desk_.On(Say({{kFlight, 3, {20}}}, 8), 0.5);  // the same number by chance
  const auto job = desk_.Next(0.5);
  desk_.Done(*old, {}, 0.6);
  EXPECT_THAT(desk_.Status(WorkerState::kFlying).started, ElementsAre(StartedCase{20, 3}));
  desk_.Done(*job, {}, 0.7);
  EXPECT_FALSE(desk_.Next(0.7));
  const auto acknowledge = [&](std::uint64_t epoch) {
    Orders orders = Say({}, 8);
    for (const auto& [number, of] : numbers_)
      if (of == epoch) orders.acknowledged.push_back(number);
    desk_.On(orders, 0.9);
  };
  for (const Report& report : desk_.TakeReports(0.8))
    if (!report.flown.empty()) numbers_[report.number] = report.coordinator_epoch;
  ASSERT_THAT(numbers_, SizeIs(2));
  acknowledge(7);
  EXPECT_THAT(desk_.Status(WorkerState::kReady).held, ElementsAre(3)) << "its result is not stored yet";
  acknowledge(8);
  EXPECT_THAT(desk_.Status(WorkerState::kReady).held, IsEmpty());
}

TEST_F(FlightDeskTest, ACampaignWithCasesToFlyIsNotForgotten) {
  desk_.On(Say({{kFlight, 3, {10}}}), 0.0);
  for (std::uint64_t i = 0; i < 20; ++i) {
    Orders orders =
        Say({{std::string(63, 'f') + static_cast<char>('a' + i % 5) + std::to_string(i), 100 + i, {1}}});
    desk_.On(orders, 0.1);
    Orders revokes = Say({});
    revokes.revoked = {100 + i};
    desk_.On(revokes, 0.1);
  }
  Load(0.2);
  EXPECT_EQ(desk_.Next(0.2).value().case_index, 10u);
}

TEST_F(FlightDeskTest, AResultDoesNotWaitForALongCase) {
  desk_.On(Say({{kFlight, 3, {10, 11}}}), 0.0);
  Load();
  const auto first = desk_.Next(0.0);
  desk_.Next(0.0);  // flies for long
  desk_.TakeReports(0.0);
  desk_.Done(*first, {}, 1.0);
  EXPECT_THAT(desk_.Tick(1.05).reports, IsEmpty()) << "it may travel with the next start";
  const auto reports = desk_.Tick(1.2).reports;
  ASSERT_THAT(reports, SizeIs(1));
  EXPECT_THAT(reports[0].flown, SizeIs(1));
}

TEST_F(FlightDeskTest, AReportThatIsRepeatedStartsNothingAgain) {
  desk_.On(Say({{kFlight, 3, {10, 11}}}), 0.0);
  Load();
  desk_.Done(*desk_.Next(0.0), {}, 1.0);
  desk_.Next(1.0);
  const auto reports = desk_.TakeReports(1.0);
  EXPECT_THAT(reports.back().started, ElementsAre(StartedCase{11, 3}));
  desk_.On(Say({}), 3.0);
  const auto repeated = desk_.Tick(3.1).reports;
  ASSERT_THAT(repeated, SizeIs(1));
  EXPECT_THAT(repeated[0].flown, SizeIs(1));
  EXPECT_THAT(repeated[0].started, IsEmpty()) << "the status says what is flown now";
}

TEST_F(FlightDeskTest, AReportThatIsNeverAcknowledgedMakesANewConnection) {
  desk_.On(Say({{kFlight, 3, {10}}}), 0.0);
  Load();
  desk_.Done(*desk_.Next(0.0), {}, 0.5);
  desk_.Next(0.5);
  std::vector<double> anew;
  for (double now_s = 1.0; now_s < 130.0; now_s += 1.0) {
    desk_.On(Say({}), now_s);  // it hears
    if (desk_.Tick(now_s).new_connection) anew.push_back(now_s);
  }
  EXPECT_THAT(anew, ElementsAre(61.0, 122.0)) << "60 s after the report, and again";
}

TEST_F(FlightDeskTest, ForEachSlotOneWaitsWhileItsLanesFly) {
  const FlightDesk desk({.worker = "w", .engine_version = "e", .slots = 2, .lanes = 4}, 0.0);
  EXPECT_EQ(desk.Status(WorkerState::kReady).credits, 10u);
}

TEST_F(FlightDeskTest, TheStatusNamesAllThatWereAnnouncedTogether) {
  std::vector<std::uint64_t> cases(40);
  for (std::size_t i = 0; i < cases.size(); ++i) cases[i] = i;
  desk_.On(Say({{kFlight, 3, cases}}), 0.0);
  Load();
  desk_.Done(*desk_.Next(0.0), {}, 0.0005);
  ASSERT_TRUE(desk_.Next(0.0005));
  EXPECT_THAT(desk_.Status(WorkerState::kFlying).started, SizeIs(10)) << "5 ms of 0.5 ms";
}

TEST_F(FlightDeskTest, AReportIsOfOneCampaign) {
  const std::string other(64, 'e');
  desk_.On(Say({{kFlight, 3, {10}}, {other, 4, {20}}}), 0.0);
  for (const TextRequest& request : desk_.Tick(0.0).text_requests) {
    desk_.On(TextPart{"w", request.flight_id, "name", "e", 1, 0, "x"}, 0.0);
    desk_.TakeText();
    desk_.Loaded(request.flight_id, nullptr, "");
  }
  const auto one = desk_.Next(0.0), two = desk_.Next(0.0);
  desk_.TakeReports(0.0);
  CaseResult result;
  result.case_index = one->case_index;
  desk_.Done(*one, result, 1.0);
  result.case_index = two->case_index;
  desk_.Done(*two, result, 1.0);
  EXPECT_FALSE(desk_.Next(1.0));
  const auto reports = desk_.TakeReports(1.0);
  ASSERT_THAT(reports, SizeIs(2));
  for (const Report& report : reports) {
    ASSERT_THAT(report.flown, SizeIs(1));
    EXPECT_EQ(report.flown[0].result.case_index, report.flight_id == kFlight ? 10u : 20u);
  }
}

TEST_F(FlightDeskTest, ARefusalIsForTheCoordinatorThatAssigned) {
  desk_.On(Say({{kFlight, 3, {10}}}), 0.0);
  desk_.Tick(0.0);
  desk_.On(TextPart{"w", kFlight, "name", "e", 1, 0, "x"}, 0.0);
  desk_.TakeText();
  desk_.Loaded(kFlight, nullptr, "line 1: bad");
  desk_.On(Say({}, 8), 0.1);
  EXPECT_THAT(desk_.Tick(0.1).refusals, IsEmpty());
  desk_.On(Say({{kFlight, 1, {10}}}, 8), 0.2);
  EXPECT_THAT(desk_.Tick(0.2).refusals, SizeIs(1));
}

TEST_F(FlightDeskTest, SoManyReportsAreRepeatedAtOnce) {
  std::vector<std::uint64_t> cases(70);
  for (std::size_t i = 0; i < cases.size(); ++i) cases[i] = i;
  desk_.On(Say({{kFlight, 3, cases}}), 0.0);
  Load();
  double now_s = 0.0;
  while (const auto job = desk_.Next(now_s)) desk_.Done(*job, {}, now_s += 0.01);
  EXPECT_THAT(desk_.TakeReports(now_s), SizeIs(71)) << "the first start, and 70 results";
  desk_.On(Say({}), now_s + 2.1);
  EXPECT_THAT(desk_.Tick(now_s + 2.1).reports, SizeIs(64));
  EXPECT_THAT(desk_.Tick(now_s + 2.2).reports, SizeIs(6));
}

}  // namespace dispersa::flight_desk_test
