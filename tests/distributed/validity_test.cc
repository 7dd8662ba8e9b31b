// Every bound of a message that arrives: the last that is taken, the first that is refused, and what is said of it.
#include "services/transport/validity.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"

namespace dispersa::validity_test {
namespace {

const std::string kFlight = std::string(60, 'a') + "09f7";
const char kBadWorker[] = "the worker's name is no identifier";
const char kBadFlight[] = "the flight id is not 64 hexadecimal digits";
const char kBadClient[] = "the client's name is no identifier";
const char kTooLong[] = "a text is too long";
const char kForeign[] = "a result has not the inputs and metrics of this engine";
const char kImpossible[] = "a result has an impossible stage or reason";

/// One change of a sound message, and what is then said of it: nothing where it is still sound.
template <typename Message>
struct Change {
  const char* name;
  std::function<void(Message&)> make;
  std::string problem = "";
};

template <typename Message>
void ExpectProblems(const Message& sound, const std::vector<Change<Message>>& changes) {
  EXPECT_EQ(Problem(sound), "");
  for (const Change<Message>& change : changes) {
    Message message = sound;
    change.make(message);
    EXPECT_EQ(Problem(message), change.problem) << change.name;
  }
}

/// What a name may be, of a worker, a client or a method.
template <typename Message>
std::vector<Change<Message>> NameChanges(std::string Message::* name, const std::string& problem) {
  std::vector<Change<Message>> changes = {
      {"longest", [=](Message& m) { m.*name = std::string(64, 'z'); }},
      {"each kind of character", [=](Message& m) { m.*name = "AZaz09-_"; }},
      {"none", [=](Message& m) { (m.*name).clear(); }, problem},
      {"too long", [=](Message& m) { m.*name = std::string(65, 'z'); }, problem}};
  // Neighbours of what is allowed, and what a partition or a shell would take for something else.
  for (const char c : std::string("/:@[`{ *.\n\x7f\xe9") + '\0')
    changes.push_back({"a character of no name", [=](Message& m) { m.*name = std::string("w") + c; }, problem});
  return changes;
}
template <typename Message>
std::vector<Change<Message>> FlightChanges() {
  return {{"short flight id", [](Message& m) { m.flight_id.pop_back(); }, kBadFlight},
          {"long flight id", [](Message& m) { m.flight_id += '0'; }, kBadFlight},
          {"capital", [](Message& m) { m.flight_id[0] = 'A'; }, kBadFlight},
          {"no digit", [](Message& m) { m.flight_id[63] = 'g'; }, kBadFlight}};
}

TEST(Validity, OfAWorkersStatus) {
  WorkerStatus sound;
  sound.worker = "worker-1";
  sound.slots = 1;
  ExpectProblems<WorkerStatus>(sound, NameChanges(&WorkerStatus::worker, kBadWorker));
  ExpectProblems<WorkerStatus>(
      sound, {{"longest host", [](auto& m) { m.host = std::string(256, 'h'); }},
              {"host", [](auto& m) { m.host = std::string(257, 'h'); }, kTooLong},
              {"longest engine", [](auto& m) { m.engine_version = std::string(256, 'e'); }},
              {"engine", [](auto& m) { m.engine_version = std::string(257, 'e'); }, kTooLong},
              {"no slot", [](auto& m) { m.slots = 0; }, "slots are not from 1 to 1024"},
              {"most slots", [](auto& m) { m.slots = 1024; }},
              {"slots", [](auto& m) { m.slots = 1025; }, "slots are not from 1 to 1024"},
              {"most credits", [](auto& m) { m.credits = 65536; }},
              {"credits", [](auto& m) { m.credits = 65537; }, "too many credits"},
              {"most held", [](auto& m) { m.held.resize(65536); }},
              {"held", [](auto& m) { m.held.resize(65537); }, "too long a list"},
              {"most started", [](auto& m) { m.started.resize(65536); }},
              {"started", [](auto& m) { m.started.resize(65537); }, "too long a list"}});
}

TEST(Validity, OfOrders) {
  Orders sound;
  sound.worker = "worker-1";
  sound.coordinator_epoch = 1;
  sound.assignments = {{kFlight, 1, {3, 4}}, {kFlight, 2, {}}};
  ExpectProblems<Orders>(sound, NameChanges(&Orders::worker, kBadWorker));
  ExpectProblems<Orders>(
      sound, {{"no epoch", [](auto& m) { m.coordinator_epoch = 0; }, "the epoch is 0"},
              {"no orders", [](auto& m) { m.assignments.clear(); }},
              {"a later order's flight", [](auto& m) { m.assignments[1].flight_id = "f"; }, kBadFlight},
              {"longest refusal", [](auto& m) { m.refusal = std::string(4096, 'r'); }},
              {"refusal", [](auto& m) { m.refusal = std::string(4097, 'r'); }, kTooLong}});
}

Report SoundReport() {
  Report report;
  report.worker = "worker-1";
  report.flight_id = kFlight;
  FlownCase flown;
  flown.result.inputs.resize(InputCount(kUsualStages));
  flown.result.metrics.resize(MetricCount(kUsualStages));
  report.flown = {flown, flown};
  return report;
}

TEST(Validity, OfAReport) {
  const Report sound = SoundReport();
  ExpectProblems<Report>(sound, NameChanges(&Report::worker, kBadWorker));
  ExpectProblems<Report>(sound, FlightChanges<Report>());
  const auto wide = [](CaseResult& result) {
    result.inputs.resize(InputCount(64));
    result.metrics.resize(MetricCount(64));
  };
  ExpectProblems<Report>(
      sound, {{"nothing flown", [](auto& m) { m.flown.clear(); }},
              {"most cases", [](auto& m) { m.flown.resize(4096, m.flown[0]); }},
              {"cases", [](auto& m) { m.flown.resize(4097, m.flown[0]); }, "too many cases"},
              {"most started", [](auto& m) { m.started.resize(4096); }},
              {"started", [](auto& m) { m.started.resize(4097); }, "too many cases"},
              {"many stages", [&](auto& m) { wide(m.flown[1].result); }},
              {"one input more", [](auto& m) { m.flown[1].result.inputs.push_back(0.0); }, kForeign},
              {"one input less", [](auto& m) { m.flown[1].result.inputs.pop_back(); }, kForeign},
              {"one metric more", [](auto& m) { m.flown[1].result.metrics.push_back(0.0); }, kForeign},
              {"inputs of many stages with metrics of few",
               [](auto& m) { m.flown[1].result.inputs.resize(InputCount(64)); }, kForeign},
              {"nothing", [](auto& m) { m.flown[1].result = {}; }, kForeign},
              {"last stage", [](auto& m) { m.flown[1].result.end_stage = 64; }},
              {"stage", [](auto& m) { m.flown[1].result.end_stage = 65; }, kImpossible},
              {"stage below 0", [](auto& m) { m.flown[1].result.end_stage = -1; }, kImpossible},
              {"longest reason", [](auto& m) { m.flown[1].result.reason = std::string(4096, 'r'); }},
              {"reason", [](auto& m) { m.flown[1].result.reason = std::string(4097, 'r'); }, kImpossible}});
}

// A case that was given up has a reason and nothing else.
TEST(Validity, OfAReportOfACaseGivenUp) {
  Report sound = SoundReport();
  sound.flown[0] = {1, {}, true};
  sound.flown[0].result.reason = "ends the process that flies it";
  ExpectProblems<Report>(sound,
                         {{"no reason", [](auto& m) { m.flown[0].result.reason.clear(); }, kForeign},
                          {"inputs", [](auto& m) { m.flown[0].result.inputs = {1.0}; }, kForeign},
                          {"metrics", [](auto& m) { m.flown[0].result.metrics = {1.0}; }, kForeign},
                          {"the numbers of a flight", [](auto& m) { m.flown[1].given_up = true; }, kForeign}});
}

TEST(Validity, OfACampaignsText) {
  ExpectProblems<TextRequest>({"w", kFlight, 3}, NameChanges(&TextRequest::worker, kBadWorker));
  ExpectProblems<TextRequest>({"w", kFlight, 3}, FlightChanges<TextRequest>());
  const TextPart sound{"w", kFlight, "name", "engine", 10, 4, "sixsix"};
  const char beyond[] = "a part beyond the text";
  ExpectProblems<TextPart>(sound, NameChanges(&TextPart::worker, kBadWorker));
  ExpectProblems<TextPart>(sound, FlightChanges<TextPart>());
  ExpectProblems<TextPart>(
      sound, {{"longest name", [](auto& m) { m.name = std::string(256, 'n'); }},
              {"name", [](auto& m) { m.name = std::string(257, 'n'); }, kTooLong},
              {"engine", [](auto& m) { m.engine_version = std::string(257, 'e'); }, kTooLong},
              {"largest", [](auto& m) { m.size = std::uint64_t{64} << 20; }},
              {"size", [](auto& m) { m.size = (std::uint64_t{64} << 20) + 1; }, "the campaign's text is larger than 64 MiB"},
              {"one byte too many", [](auto& m) { m.bytes += '7'; }, beyond},
              {"the end", [](auto& m) { m.offset = 10, m.bytes.clear(); }},
              {"behind the end", [](auto& m) { m.offset = 11, m.bytes.clear(); }, beyond},
              {"so far that a sum would be small again", [](auto& m) { m.offset = ~std::uint64_t{2}; }, beyond}});
}

TEST(Validity, OfARefusal) {
  const CampaignRefusal sound{"w", 1, kFlight, "why"};
  const char reason[] = "no reason, or too long a one";
  ExpectProblems<CampaignRefusal>(sound, NameChanges(&CampaignRefusal::worker, kBadWorker));
  ExpectProblems<CampaignRefusal>(sound, FlightChanges<CampaignRefusal>());
  ExpectProblems<CampaignRefusal>(sound, {{"none", [](auto& m) { m.reason.clear(); }, reason},
                                          {"longest", [](auto& m) { m.reason = std::string(4096, 'r'); }},
                                          {"too long", [](auto& m) { m.reason = std::string(4097, 'r'); }, reason}});
}

TEST(Validity, OfProgressRequestsAndReplies) {
  CampaignProgress progress;
  progress.flight_id = kFlight;
  ExpectProblems<CampaignProgress>(progress, FlightChanges<CampaignProgress>());
  const Request request{"client", 1, "list", "{}", "data"};
  ExpectProblems<Request>(request, NameChanges(&Request::client, kBadClient));
  ExpectProblems<Request>(request, NameChanges(&Request::method, "the method is no identifier"));
  ExpectProblems<Request>(request,
                          {{"longest arguments", [](auto& m) { m.arguments = std::string(4096, ' '); }},
                           {"arguments", [](auto& m) { m.arguments = std::string(4097, ' '); }, "too long arguments"},
                           {"any data", [](auto& m) { m.data = std::string(1 << 20, '\0'); }}});
  Reply reply;
  reply.client = "client";
  ExpectProblems<Reply>(reply, NameChanges(&Reply::client, kBadClient));
}

}  // namespace
}  // namespace dispersa::validity_test
