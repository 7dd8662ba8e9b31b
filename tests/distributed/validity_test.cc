// Each rule for a message: the last message that passes, the first that does not, and the text in the log.
#include "services/transport/validity.h"

#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "core/flight/own_metrics.h"
#include "services/transport/convert.h"
#include "tests/test.h"

namespace dispersa::validity_test {

const std::string kFlight(64, 'f');
const char kBadWorker[] = "the worker's name is no identifier";
const char kBadFlight[] = "the flight id is not 64 hexadecimal digits";
const char kTooLong[] = "a text is too long";

/// The problem of `message` after a change.
template <typename Message, typename Change>
std::string After(Message message, Change change) {
  change(message);
  return WhyInvalid(message);
}

WorkerStatus Status() {
  return {"w-1_a", "host", 42, "engine", 3, 4, WorkerState::kFlying, 17, 99, {5, 6}, {{7, 5}}};
}
Orders SomeOrders() { return {"w", 7, {{kFlight, 3, {1, 2}}}, {5}, {6}, false, ""}; }
Report SomeReport() {
  FlownCase flown{2, {}};
  flown.result.inputs.resize(InputCount(kUsualStages));
  flown.result.metrics.resize(MetricCount(kUsualStages));
  return {"w", 9, 3, kFlight, {flown}, {{8, 3}}};
}

// Names become partitions, in which * is everybody, and words of the log.
TEST(Validity, ANameIsAnIdentifierOfLimitedLength) {
  for (const std::string name : {"a", "Z-9_", "0123456789abcdef0123456789abcdef"}) {
    EXPECT_EQ(After(Status(), [&](auto& status) { status.worker = name; }), "") << name;
  }
  for (const std::string& name : {std::string(), std::string("*"), std::string("a*"), std::string("a b"),
                                  std::string("a/b"), std::string("\x1b[31m"), std::string("ä"),
                                  std::string("a."), std::string(1, '\0'), std::string(81, 'a')}) {
    const auto set = [&](auto& message) { message.worker = name; };
    EXPECT_EQ(After(Status(), set), kBadWorker) << name;
    EXPECT_EQ(After(SomeOrders(), set), kBadWorker) << name;
    EXPECT_EQ(After(SomeReport(), set), kBadWorker) << name;
    EXPECT_EQ(After(TextRequest{"w", kFlight, 0}, set), kBadWorker) << name;
    EXPECT_EQ(After(TextPart{"w", kFlight, "n", "e", 9, 2, "bytes"}, set), kBadWorker) << name;
    EXPECT_EQ(After(CampaignRefusal{"w", 1, kFlight, "why"}, set), kBadWorker) << name;
    const char no_client[] = "the client's name is no identifier";
    EXPECT_EQ(WhyInvalid(Request{name, 1, "list", "{}", ""}), no_client) << name;
    EXPECT_EQ(WhyInvalid(Reply{name, 1, 0, "{}", ""}), no_client) << name;
    EXPECT_EQ(WhyInvalid(Request{"c", 1, name, "{}", ""}), "the method is no identifier") << name;
  }
  const auto worker_of = [](std::size_t letters) {
    return After(Status(), [&](auto& status) { status.worker = std::string(letters, 'a'); });
  };
  EXPECT_EQ(worker_of(64), "");
  EXPECT_EQ(worker_of(65), kBadWorker);
  EXPECT_EQ(WhyInvalid(Request{"c", 1, std::string(65, 'a'), "{}", ""}), "the method is no identifier");
  // With a right before the name of its keys.
  EXPECT_EQ(WhyInvalid(Request{std::string(80, 'a'), 1, "list", "{}", ""}), "");
  EXPECT_EQ(WhyInvalid(Reply{std::string(80, 'a'), 1, 0, "{}", ""}), "");
}

TEST(Validity, AFlightIdIs64HexadecimalDigits) {
  for (const std::string& id : {std::string(), std::string(63, 'f'), std::string(65, 'f'),
                                std::string(64, 'F'), std::string(64, 'g'), std::string(63, '0') + "/"}) {
    const auto set = [&](auto& message) { message.flight_id = id; };
    EXPECT_EQ(After(SomeOrders(), [&](Orders& orders) { orders.assignments[0].flight_id = id; }), kBadFlight);
    EXPECT_EQ(After(SomeReport(), set), kBadFlight) << id;
    EXPECT_EQ(After(TextRequest{"w", kFlight, 0}, set), kBadFlight) << id;
    EXPECT_EQ(After(TextPart{"w", kFlight, "n", "e", 9, 2, "bytes"}, set), kBadFlight) << id;
    EXPECT_EQ(After(CampaignRefusal{"w", 1, kFlight, "why"}, set), kBadFlight) << id;
    EXPECT_EQ(After(CampaignProgress{}, set), kBadFlight) << id;
  }
  EXPECT_EQ(After(TextRequest{"w", kFlight, 0}, [](auto& text) { text.flight_id = std::string(64, '0'); }),
            "");
}

TEST(Validity, AStatusOfBoundedSize) {
  EXPECT_EQ(After(Status(), [](auto& s) { s.host.assign(256, 'h'), s.engine_version.assign(256, 'e'); }), "");
  EXPECT_EQ(After(Status(), [](auto& s) { s.host.assign(257, 'h'); }), kTooLong);
  EXPECT_EQ(After(Status(), [](auto& s) { s.engine_version.assign(257, 'h'); }), kTooLong);
  for (const std::uint32_t slots : {1u, 1024u})
    EXPECT_EQ(After(Status(), [&](auto& s) { s.slots = slots; }), "");
  for (const std::uint32_t slots : {0u, 1025u, std::numeric_limits<std::uint32_t>::max()})
    EXPECT_EQ(After(Status(), [&](auto& s) { s.slots = slots; }), "slots are not from 1 to 1024");
  EXPECT_EQ(After(Status(), [](auto& s) { s.credits = 65536; }), "");
  EXPECT_EQ(After(Status(), [](auto& s) { s.credits = 65537; }), "too many credits");
  EXPECT_EQ(After(Status(), [](auto& s) { s.held.resize(65536), s.started.resize(65536); }), "");
  EXPECT_EQ(After(Status(), [](auto& s) { s.held.resize(65537); }), "too long a list");
  EXPECT_EQ(After(Status(), [](auto& s) { s.started.resize(65537); }), "too long a list");
}

TEST(Validity, OrdersOfACoordinatorThatHasAnEpoch) {
  EXPECT_EQ(WhyInvalid(SomeOrders()), "");
  EXPECT_EQ(After(SomeOrders(), [](auto& orders) { orders.coordinator_epoch = 0; }), "the epoch is 0");
  EXPECT_EQ(After(SomeOrders(), [](auto& orders) { orders.refusal.assign(4096, 'x'); }), "");
  EXPECT_EQ(After(SomeOrders(), [](auto& orders) { orders.refusal.assign(4097, 'x'); }), kTooLong);
}

TEST(Validity, AResultHasTheInputsAndMetricsOfThisEngine) {
  const char wrong[] = "a result has not the inputs and metrics of this engine";
  const auto of = [](std::size_t inputs, std::size_t metrics) {
    return After(SomeReport(), [&](Report& report) {
      report.flown[0].result.inputs.resize(inputs);
      report.flown[0].result.metrics.resize(metrics);
    });
  };
  const std::size_t inputs = InputColumns().size(), metrics = MetricCount(kUsualStages);
  EXPECT_EQ(of(inputs, metrics), "");
  EXPECT_EQ(of(0, metrics), "") << "of a campaign that disperses nothing";
  EXPECT_EQ(of(inputs + 1, metrics), wrong);
  EXPECT_EQ(of(inputs, metrics + kMaxOwnMetrics), "") << "of a campaign with metrics of its own";
  const std::size_t most = MetricCount(kMaxStages + kFurtherNozzles) + kMaxOwnMetrics;
  EXPECT_EQ(of(inputs, most), "");
  for (const std::size_t wrong_metrics : {std::size_t{0}, metrics - 1, most + 1})
    EXPECT_EQ(of(inputs, wrong_metrics), wrong);
}

TEST(Validity, AQuarantinedCaseHasAReasonAndNothingElse) {
  const auto quarantined = [](auto change) {
    return After(SomeReport(), [&](Report& report) {
      report.flown[0] = {2, {}, true};
      report.flown[0].result.reason = "it ended the process";
      change(report.flown[0].result);
    });
  };
  const char wrong[] = "a result has not the inputs and metrics of this engine";
  EXPECT_EQ(quarantined([](CaseResult&) {}), "");
  EXPECT_EQ(quarantined([](CaseResult& result) { result.reason.clear(); }), wrong);
  EXPECT_EQ(quarantined([](CaseResult& result) { result.inputs = {1.0}; }), wrong);
  EXPECT_EQ(quarantined([](CaseResult& result) { result.metrics = {1.0}; }), wrong);
}

TEST(Validity, AResultEndsInAStageThatAVehicleCanHave) {
  const char wrong[] = "a result has an impossible stage or reason";
  for (const int stage : {0, 64})
    EXPECT_EQ(After(SomeReport(), [&](auto& r) { r.flown[0].result.end_stage = stage; }), "");
  for (const int stage : {-1, 65})
    EXPECT_EQ(After(SomeReport(), [&](auto& r) { r.flown[0].result.end_stage = stage; }), wrong);
  EXPECT_EQ(After(SomeReport(), [](auto& r) { r.flown[0].result.reason.assign(4097, 'x'); }), wrong);
}

TEST(Validity, AReportHasAtMost4096Cases) {
  EXPECT_EQ(After(SomeReport(), [](auto& report) { report.started.resize(4096); }), "");
  EXPECT_EQ(After(SomeReport(), [](auto& report) { report.started.resize(4097); }), "too many cases");
  EXPECT_EQ(After(SomeReport(), [](auto& report) { report.flown.assign(4096, report.flown[0]); }), "");
  EXPECT_EQ(After(SomeReport(), [](auto& report) { report.flown.assign(4097, report.flown[0]); }),
            "too many cases");
}

TEST(Validity, APartOfATextLiesWithinTheText) {
  const auto part = [](std::uint64_t size, std::uint64_t offset, std::size_t bytes) {
    return WhyInvalid(TextPart{"w", kFlight, "name", "engine", size, offset, std::string(bytes, 'x')});
  };
  const char beyond[] = "a part beyond the text";
  EXPECT_EQ(part(9, 0, 9), "");
  EXPECT_EQ(part(9, 9, 0), "");
  EXPECT_EQ(part(9, 5, 5), beyond);
  EXPECT_EQ(part(9, 10, 0), beyond);
  EXPECT_EQ(part(9, std::numeric_limits<std::uint64_t>::max(), 2), beyond) << "their sum is 1";
  EXPECT_EQ(part(std::uint64_t{64} << 20, 0, 9), "");
  EXPECT_EQ(part((std::uint64_t{64} << 20) + 1, 0, 9), "the campaign's text is larger than 64 MiB");
  EXPECT_EQ(WhyInvalid(TextPart{"w", kFlight, std::string(257, 'n'), "e", 9, 0, ""}), kTooLong);
  EXPECT_EQ(WhyInvalid(TextPart{"w", kFlight, "n", std::string(257, 'e'), 9, 0, ""}), kTooLong);
}

TEST(Validity, ARefusalSaysWhyInAFewWords) {
  const auto refusal = [](std::size_t letters) {
    return WhyInvalid(CampaignRefusal{"w", 1, kFlight, std::string(letters, 'x')});
  };
  EXPECT_EQ(refusal(4096), "");
  for (const std::size_t letters : {0, 4097}) EXPECT_EQ(refusal(letters), "no reason, or too long a one");
}

TEST(Validity, ARequestHasFewArgumentsAndAnyData) {
  EXPECT_EQ(WhyInvalid(Request{"c", 1, "upload", std::string(4096, ' '), std::string(300000, 'd')}), "");
  EXPECT_EQ(WhyInvalid(Request{"c", 1, "upload", std::string(4097, ' '), ""}), "too long arguments");
  EXPECT_EQ(WhyInvalid(Reply{"c", 1, 0, std::string(300000, 't'), std::string(300000, 'd')}), "");
}

// Each field with a value of its own: there and back again.
TEST(Conversion, KeepsWhatObserversAndClientsAreTold) {
  const CampaignProgress progress{1, "i", kFlight, "n", "s", 2, 3, 4, 5, 6};
  EXPECT_THAT(FromIdl(ToIdl(progress)), Optional(FieldsAre(1, "i", kFlight, "n", "s", 2, 3, 4, 5, 6)));
  // An observer of another vendor reads this.
  const idl::ProgressV1 message = ToIdl(progress);
  EXPECT_EQ(message.quarantined(), 4u);
  EXPECT_EQ(message.assigned(), 5u);

  const std::string bytes("\0\xff\n", 3);
  EXPECT_THAT(FromIdl(ToIdl(Reply{"c", 7, 5, "text", bytes})), Optional(FieldsAre("c", 7, 5, "text", bytes)));
  EXPECT_THAT(FromIdl(ToIdl(Request{"c", 7, "read", "{}", bytes})),
              Optional(FieldsAre("c", 7, "read", "{}", bytes)));
}

TEST(Conversion, AnEventWithoutTheFormOfANameIsNoMessage) {
  FlownCase flown{3, {}, false};
  for (const std::string name : {"max_q", "stage_12_burnout", "a234567890123456789012345678901234567890"}) {
    flown.result.events = {{"lift_off", 0, 0, 0, 0, 0}, {name, 1, 2, 3, 4, 5}};
    const auto report = FromIdl(ToIdl(Report{"w", 9, 3, kFlight, {flown}, {}}));
    ASSERT_TRUE(report) << name;
    EXPECT_EQ(report->flown[0].result.events, flown.result.events);
  }
  for (const std::string name : {"", "Max_q", "max q", "max-q", "<b>", "\x1b[1m", "max_q\n",
                                 "a2345678901234567890123456789012345678901"}) {
    flown.result.events = {{"lift_off", 0, 0, 0, 0, 0}, {name, 1, 2, 3, 4, 5}};
    EXPECT_FALSE(FromIdl(ToIdl(Report{"w", 9, 3, kFlight, {flown}, {}}))) << name;
  }
}

TEST(Conversion, AQuarantinedCaseArrivesAsSuch) {
  FlownCase flown{3, {}, true};
  flown.result.case_index = 8;
  flown.result.reason = "why";
  const Report sent{"w", 9, 3, kFlight, {flown}, {}};
  EXPECT_EQ(ToIdl(sent).flown()[0].outcome(), "given_up");
  const auto report = FromIdl(ToIdl(sent));
  ASSERT_TRUE(report);
  EXPECT_THAT(report->flown, ElementsAre(FieldsAre(3, testing::_, true)));
  EXPECT_EQ(report->flown[0].result.case_index, 8u);
  EXPECT_EQ(report->flown[0].result.reason, "why");
}

}  // namespace dispersa::validity_test
