// Messages over real sockets: every field arrives, doubles to the last bit, and a departure is noticed.
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <list>

#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "services/transport/complaints.h"
#include "services/transport/coordinator_link.h"
#include "services/transport/doors.h"
#include "services/transport/private_domain.h"
#include "services/transport/worker_link.h"
#include "tests/test.h"

namespace dispersa::transport_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Ample for what takes milliseconds on an idle machine.
constexpr seconds kPatience(20);

// The first event of a type; none if it does not come.
template <typename Event>
std::optional<Event> Await(WorkerLink& link, milliseconds patience = kPatience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < deadline) {
    for (auto& event : link.Wait(milliseconds(100)))
      if (auto* wanted = std::get_if<Event>(&event)) return std::move(*wanted);
  }
  return std::nullopt;
}
/// `say` is called again and again: what is said before the two know each other is lost.
template <typename Event>
std::optional<Event> AwaitFrom(
    CoordinatorLink& link, const std::function<void()>& say = [] {}) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < deadline) {
    say();
    for (auto& event : link.Wait(milliseconds(100)))
      if (auto* wanted = std::get_if<Event>(&event.what)) return std::move(*wanted);
  }
  return std::nullopt;
}

class Transport : public testing::Test {
 protected:
  NetworkOptions Network() const { return {domain_.domain(), "127.0.0.1"}; }
  Peer CoordinatorPeer() const { return {"127.0.0.1", CoordinatorPort(domain_.domain())}; }
  std::unique_ptr<WorkerLink> MakeWorker(const std::string& uuid) {
    return std::make_unique<WorkerLink>(Network(), std::vector{CoordinatorPeer()}, uuid);
  }

  PrivateDomain domain_;
};

const std::string kFlight(64, 'f');

WorkerStatus StatusOf(const std::string& uuid) {
  return {uuid, "host", 42, "0.1.0+abc", 3, 4, WorkerState::kFlying, 17, 99, {5, 6}, {{7, 5}}};
}

CaseResult ResultOf(std::uint64_t case_index) {
  CaseResult result;
  result.case_index = case_index;
  result.outcome = Outcome::kLostControl;
  result.end_time_s = 123.456;
  result.end_stage = 3;
  result.reason = "attitude error";
  result.inputs.assign(20, 1.0 / 3.0);
  result.inputs_digest = {3, 0xbeefull << 40};
  result.metrics.assign(MetricCount(kUsualStages), -0.0);
  result.digest = {0xfeedull << 48, 1};
  result.events = {{"lift_off", 0.0, 1.0, 2.0, 3.0, 4.0}, {"stage_1_burnout", 5.0 / 3.0, 6.0, 7.0, 8.0, 9.0}};
  return result;
}

std::uint64_t Bits(double value) { return std::bit_cast<std::uint64_t>(value); }

TEST_F(Transport, CarriesWhatAWorkerSaysToTheLastBit) {
  CoordinatorLink coordinator(Network());
  const auto worker = MakeWorker("u1");
  const auto status = AwaitFrom<WorkerStatus>(coordinator, [&] { worker->Send(StatusOf("u1")); });
  ASSERT_TRUE(status);
  EXPECT_THAT(*status, FieldsAre("u1", "host", 42, "0.1.0+abc", 3, 4, WorkerState::kFlying, 17, 99,
                                 ElementsAre(5, 6), ElementsAre(StartedCase{7, 5})));

  Report report{"u1", 99, 3, kFlight, {{2, ResultOf(7)}}, {{8, 3}, {9, 3}}};
  const double odd_nan = std::bit_cast<double>(0x7ff8000000c0ffeeull);
  report.flown[0].result.metrics[1] = odd_nan;
  report.flown[0].result.metrics[2] = std::numeric_limits<double>::denorm_min();
  const auto received = AwaitFrom<Report>(coordinator, [&] { worker->Send(report); });
  ASSERT_TRUE(received);
  EXPECT_THAT(*received, FieldsAre("u1", 99, 3, kFlight, ElementsAre(FieldsAre(2, testing::_, false)),
                                   ElementsAre(StartedCase{8, 3}, StartedCase{9, 3})));
  const CaseResult &result = received->flown.at(0).result, &sent = report.flown[0].result;
  EXPECT_THAT(result, FieldsAre(7, Outcome::kLostControl, 123.456, 3, "attitude error", sent.inputs,
                                sent.inputs_digest, SizeIs(sent.metrics.size()), sent.digest, sent.events));
  for (std::size_t i = 0; i < sent.metrics.size(); ++i)
    EXPECT_EQ(Bits(result.metrics[i]), Bits(sent.metrics[i])) << i;

  const auto request = AwaitFrom<TextRequest>(coordinator, [&] {
    worker->Send(TextRequest{"u1", kFlight, 17});
  });
  ASSERT_TRUE(request);
  EXPECT_THAT(*request, FieldsAre("u1", kFlight, 17));

  const auto refusal = AwaitFrom<CampaignRefusal>(coordinator, [&] {
    worker->Send(CampaignRefusal{"u1", 99, kFlight, "cannot", true});
  });
  ASSERT_TRUE(refusal);
  EXPECT_THAT(*refusal, FieldsAre("u1", 99, kFlight, "cannot", true));
}

TEST_F(Transport, OrdersReachOnlyTheWorkerTheyAreMeantFor) {
  CoordinatorLink coordinator(Network());
  const auto first = MakeWorker("u1");
  const auto second = MakeWorker("u2");
  const Orders orders{"u1", 7, {{kFlight, 3, {1, 2}}, {kFlight, 4, {}}}, {5}, {6, 7}, true, "because"};
  std::optional<Orders> received;
  for (int i = 0; i < 100 && !received; ++i) {  // what is said before they know each other is lost
    coordinator.Send(orders);
    received = Await<Orders>(*first, milliseconds(100));
  }
  ASSERT_TRUE(received);
  EXPECT_THAT(*received,
              FieldsAre("u1", 7, orders.assignments, ElementsAre(5), ElementsAre(6, 7), true, "because"));

  const std::string bytes(256 << 10, '\xfe');  // more than one datagram
  std::optional<TextPart> part;
  for (int i = 0; i < 100 && !part; ++i) {
    coordinator.Send(TextPart{"u1", kFlight, "name", "engine", 1 << 20, 5, bytes});
    part = Await<TextPart>(*first, milliseconds(100));
  }
  ASSERT_TRUE(part);
  EXPECT_THAT(*part, FieldsAre("u1", kFlight, "name", "engine", 1 << 20, 5, SizeIs(bytes.size())));
  EXPECT_TRUE(part->bytes == bytes);
  EXPECT_FALSE(Await<Orders>(*second, milliseconds(200)));
}

TEST_F(Transport, NoticesThatAWorkerLeaves) {
  CoordinatorLink coordinator(Network());
  auto worker = MakeWorker("u1");
  ASSERT_TRUE(AwaitFrom<WorkerStatus>(coordinator, [&] { worker->Send(StatusOf("u1")); }));
  worker.reset();
  EXPECT_TRUE(AwaitFrom<SenderGone>(coordinator));
}

TEST_F(Transport, TellsSendersApart) {
  CoordinatorLink coordinator(Network());
  const auto one = MakeWorker("u1");
  const auto other = MakeWorker("u1");  // in the name of the first
  std::set<std::string> senders;
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (senders.size() < 2 && std::chrono::steady_clock::now() < deadline) {
    one->Send(StatusOf("u1"));
    other->Send(StatusOf("u1"));
    for (const CoordinatorEvent& event : coordinator.Wait(milliseconds(100))) senders.insert(event.sender);
  }
  EXPECT_EQ(senders.size(), 2u);
}

TEST_F(Transport, RefusesWhatMakesNoSense) {
  CoordinatorLink coordinator(Network());
  const auto worker = MakeWorker("u1");
  const auto is_refused = [&](const auto& message) {
    const std::uint64_t before = Complaints();
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (Complaints() == before && std::chrono::steady_clock::now() < deadline) {
      worker->Send(message);
      EXPECT_TRUE(coordinator.Wait(milliseconds(100)).empty());
    }
    return Complaints() > before;
  };
  WorkerStatus status = StatusOf("u1");
  status.slots = 0;
  EXPECT_TRUE(is_refused(status));
  EXPECT_TRUE(is_refused(StatusOf("\x1b[31m")));
  Report report{"u1", 99, 3, kFlight, {{2, ResultOf(7)}}, {}};
  report.flown[0].result.metrics.pop_back();
  EXPECT_TRUE(is_refused(report));
  report.flown[0].result = ResultOf(7);
  report.flight_id = "short";
  EXPECT_TRUE(is_refused(report));
  EXPECT_TRUE(is_refused(TextRequest{"u1", "no", 0}));
  EXPECT_TRUE(is_refused(CampaignRefusal{"u1", 1, kFlight, std::string(5000, 'x')}));
  EXPECT_TRUE(AwaitFrom<WorkerStatus>(coordinator, [&] { worker->Send(StatusOf("u1")); }))
      << "it goes on listening";
}

/// Holds a UDP port of 127.0.0.1, as another program does.
class TakenPort {
 public:
  explicit TakenPort(std::uint16_t port) : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in where{};
    where.sin_family = AF_INET;
    where.sin_port = htons(port);
    where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&where), sizeof where), 0) << port;
  }
  ~TakenPort() { close(socket_); }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;

 private:
  int socket_;
};

TEST_F(Transport, MorePeersThanOneParticipantServesAreHeardAndAnswered) {
  // A crowd of programs on the coordinator's host takes even these.
  std::list<TakenPort> taken;
  for (int port = kFirstDoorPort; port <= kLastDoorPort; ++port)
    taken.emplace_back(PortOf(domain_.domain(), port));
  CoordinatorLink coordinator(Network());
  const auto pulse = coordinator.StartPulse();
  std::map<std::string, std::unique_ptr<WorkerLink>> workers;
  for (std::size_t i = 0; i < Doors::kPlaces + 4; ++i) {
    const std::string name = "u" + std::to_string(i);
    workers[name] = MakeWorker(name);
  }
  std::set<std::string> heard, answered;
  long beats = 0;
  const auto deadline = std::chrono::steady_clock::now() + 2 * kPatience;
  // Beats that follow the answers were answered by all participants.
  while (std::chrono::steady_clock::now() < deadline && pulse->beats() < beats + 2) {
    for (auto& [name, worker] : workers) {
      if (!heard.contains(name)) worker->Send(StatusOf(name));
      if (!worker->Wait(milliseconds(0)).empty()) answered.insert(name);
    }
    for (const auto& event : coordinator.Wait(milliseconds(100))) {
      ASSERT_FALSE(std::holds_alternative<Request>(event.what)) << "its question to itself is nobody else's";
      if (const auto* status = std::get_if<WorkerStatus>(&event.what)) heard.insert(status->worker);
    }
    for (const std::string& name : heard)
      if (!answered.contains(name)) coordinator.Send(Orders{name, 1, {}, {}, {}, false, ""});
    if (answered.size() < workers.size()) beats = pulse->beats();
  }
  EXPECT_EQ(answered.size(), workers.size());
  EXPECT_GE(pulse->beats(), 2);
  const long last = pulse->beats();
  std::this_thread::sleep_for(seconds(3));
  EXPECT_LE(pulse->beats(), last + 1) << "it beats although nobody answers";
}

TEST_F(Transport, ASecondCoordinatorInTheDomainIsRefused) {
  const CoordinatorLink coordinator(Network());
  EXPECT_EQ(ErrorOf<NetworkError>([&] { const CoordinatorLink second(Network()); }),
            "UDP port " + std::to_string(CoordinatorPort(domain_.domain())) +
                " of 127.0.0.1 is not free: is there a coordinator in domain " +
                std::to_string(domain_.domain()) + " already?");
}

TEST(PrivateDomainTest, TwoNeverShareOne) {
  const PrivateDomain first;
  const PrivateDomain second;
  EXPECT_NE(first.domain(), second.domain());
  for (const int domain : {first.domain(), second.domain()}) {
    EXPECT_GE(domain, 40);
    EXPECT_LE(domain, 99);
  }
}

TEST(ParsePeerTest, TakesTheCoordinatorsPortIfThereIsNone) {
  EXPECT_EQ(ParsePeer("host", 2).host, "host");
  EXPECT_EQ(ParsePeer("host", 2).port, 7905);
  EXPECT_EQ(ParsePeer("10.0.0.1:123", 2).host, "10.0.0.1");
  EXPECT_EQ(ParsePeer("10.0.0.1:123", 2).port, 123);
}

TEST(ParsePeerTest, TakesSeveralWithCommasBetween) {
  const std::vector<Peer> peers = ParsePeers("main,10.0.0.2:123", 2);
  ASSERT_EQ(peers.size(), 2u);
  EXPECT_EQ(peers[0].host, "main");
  EXPECT_EQ(peers[0].port, 7905);
  EXPECT_EQ(peers[1].port, 123);
  EXPECT_THROW(ParsePeers("main,", 2), NetworkError);
  EXPECT_THROW(ParsePeers("", 2), NetworkError);
}

TEST(ParsePeerTest, RefusesWhatIsNoPeer) {
  const auto message = [](const std::string& text) {
    return ErrorOf<NetworkError>([&] { ParsePeer(text, 0); });
  };
  EXPECT_EQ(message("host:0"), "peer 'host:0': not HOST:PORT with a port from 1 to 65535");
  EXPECT_EQ(message("host:65536"), "peer 'host:65536': not HOST:PORT with a port from 1 to 65535");
  EXPECT_EQ(message("host:"), "peer 'host:': not HOST:PORT with a port from 1 to 65535");
  EXPECT_EQ(message("host:1x"), "peer 'host:1x': not HOST:PORT with a port from 1 to 65535");
  EXPECT_EQ(message(":123"), "peer ':123': the host is missing");
  for (const std::string text : {"::1", "[::1]:7405", "fe80::1"}) {
    EXPECT_EQ(message(text), "peer '" + text +
                                 "' is an IPv6 address, allowed: an IPv4 address or a host name, with :PORT "
                                 "if the port is not the usual one");
  }
}

TEST(SharedMemory, IsNotUsed) {
  // Segments of other programs may lie there: what counts is that ours add none.
  const auto segments = [] {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/shm"))
      count += entry.path().filename().string().starts_with("fast");  // fastrtps, fastdds
    return count;
  };
  const std::size_t before = segments();
  const PrivateDomain domain;
  const NetworkOptions network{domain.domain(), "127.0.0.1"};
  CoordinatorLink coordinator(network);
  WorkerLink worker(network, {{"127.0.0.1", CoordinatorPort(domain.domain())}}, "u1");
  ASSERT_TRUE(AwaitFrom<WorkerStatus>(coordinator, [&] { worker.Send(StatusOf("u1")); }));
  EXPECT_EQ(segments(), before);
}

}  // namespace dispersa::transport_test
