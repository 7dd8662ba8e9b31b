// A stranger on the network: tries to publish or to subscribe one topic, with the keys of a folder or
// without, and stays until its standard input ends. It checks no keys, as a stranger's program would not.
//
// usage: security_probe publish|subscribe TOPIC PARTITION DOMAIN [--keys FOLDER] [--as-coordinator] [--named
// NAME] [--hours-ago N]
//        security_probe issue AUTHORITY ROLE NAME FROM TO     keys valid between so many hours from now
// --hours-ago N: with a clock that goes so many hours behind.
// Prints one JSON object: whether its own middleware made the writer or reader, with how many others it was
// matched at most, and how many samples came.
#include <poll.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/flight/engine_version.h"
#include "services/transport/authority.h"
#include "services/transport/endpoints.h"
#include "services/transport/participant.h"
#include "services/transport/topics.h"

namespace {
std::time_t clock_behind_s = 0;
}

// In the place of the C library's, for OpenSSL and Fast DDS too.
extern "C" __attribute__((visibility("default"))) std::time_t time(std::time_t* out) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  const std::time_t shown = now.tv_sec - clock_behind_s;
  if (out != nullptr) *out = shown;
  return shown;
}

namespace dispersa {
namespace {

struct Options {
  bool publish = false;
  std::string topic, partition, name = "stranger";
  int domain = 0;
  std::string keys;
  bool as_coordinator = false;
};

struct Outcome {
  bool created = false;
  int matched = 0;
  int samples = 0;

  void SeeMatched(int now) {
    if (matched == 0 && now > 0) {
      std::puts("matched");
      std::fflush(stdout);
    }
    matched = std::max(matched, now);
  }
};

/// Waits for 100 ms; false when nobody holds our standard input any more.
bool GoOn() {
  pollfd in{0, POLLIN, 0};
  char byte = 0;
  return poll(&in, 1, 100) == 0 || std::fread(&byte, 1, 1, stdin) == 1;
}

template <typename PubSubType>
void Publish(Participant& participant, const Options& options, Outcome& outcome,
             const typename PubSubType::type& message) {
  Writer<PubSubType> writer(participant, participant.MakePublisher(options.partition), options.topic);
  outcome.created = true;
  do {
    outcome.SeeMatched(writer.matched());
    writer.Write(message);
  } while (GoOn());
}

template <typename PubSubType>
void Subscribe(Participant& participant, const Options& options, Outcome& outcome) {
  auto* reader =
      participant.MakeSubscriber({options.partition})
          ->create_datareader(participant.TopicOf<PubSubType>(options.topic), MakeReaderQos("", 0));
  if (reader == nullptr) throw NetworkError("cannot create a reader");
  outcome.created = true;
  do {
    dds::SubscriptionMatchedStatus status;
    reader->get_subscription_matched_status(status);
    outcome.SeeMatched(status.current_count);
    typename PubSubType::type message;
    dds::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == kDdsOk) ++outcome.samples;
  } while (GoOn());
}

template <typename PubSubType>
void Try(const std::string& topic, const Options& options, Outcome& outcome, Participant& participant,
         const typename PubSubType::type& message = {}) {
  if (topic != options.topic) return;
  if (options.publish) {
    Publish<PubSubType>(participant, options, outcome, message);
  } else {
    Subscribe<PubSubType>(participant, options, outcome);
  }
}

int Main(const std::vector<std::string>& words) {
  constexpr int kHour_s = 3600;
  if (words.at(0) == "issue") {
    const std::time_t now = time(nullptr);
    IssueKeys(words.at(1), *ParseRole(words.at(2)), words.at(3),
              {now + std::stoi(words.at(4)) * kHour_s, now + std::stoi(words.at(5)) * kHour_s});
    return 0;
  }
  Options options;
  options.publish = words.at(0) == "publish";
  options.topic = words.at(1);
  options.partition = words.at(2);
  options.domain = std::stoi(words.at(3));
  for (std::size_t i = 4; i < words.size(); ++i) {
    if (words[i] == "--keys") options.keys = words.at(++i);
    if (words[i] == "--named") options.name = words.at(++i);
    if (words[i] == "--hours-ago") clock_behind_s = std::stoi(words.at(++i)) * kHour_s;
    if (words[i] == "--as-coordinator") options.as_coordinator = true;
  }
  ParticipantOptions how;
  how.network = {options.domain, "127.0.0.1"};
  if (!options.keys.empty()) how.network.keys = KeyFolder{options.keys, Role::kObserver, options.name};
  how.name = "probe";
  if (options.as_coordinator) {
    how.name = kCoordinatorParticipant;  // workers do not even hear another's greeting
    how.discovery_port = CoordinatorPort(options.domain);
    how.door.doors = std::make_shared<Doors>("127.0.0.1");
    how.door.doors->Open(*how.discovery_port);
  } else {
    how.peers = {{"127.0.0.1", CoordinatorPort(options.domain)}};
  }

  Outcome outcome;
  std::string problem;
  try {
    Participant participant(how);
    // What would do harm if it came: a worker that is ready, orders to leave.
    idl::WorkerStatusV2 status;
    status.worker(options.name);
    status.host("stranger");
    status.engine_version(EngineVersion());
    status.slots(1);
    idl::OrdersV1 orders;
    orders.worker(options.name);
    orders.coordinator_epoch(1);
    orders.leave(true);
    Try<idl::WorkerStatusV2PubSubType>(kStatusTopic, options, outcome, participant, status);
    Try<idl::OrdersV1PubSubType>(kOrdersTopic, options, outcome, participant, orders);
    Try<idl::ReportV3PubSubType>(kReportTopic, options, outcome, participant);
    Try<idl::RequestV1PubSubType>(kRequestTopic, options, outcome, participant);
    Try<idl::ResultV2PubSubType>(kResultTopic, options, outcome, participant);
    Try<idl::ProgressV1PubSubType>(kProgressTopic, options, outcome, participant);
  } catch (const std::exception& error) {
    problem = error.what();
    while (GoOn()) {
    }
  }
  std::printf("{\"created\": %s, \"matched\": %d, \"samples\": %d, \"problem\": \"%s\"}\n",
              outcome.created ? "true" : "false", outcome.matched, outcome.samples, problem.c_str());
  return 0;
}

}  // namespace
}  // namespace dispersa

int main(int argc, char** argv) { return dispersa::Main({argv + 1, argv + argc}); }
