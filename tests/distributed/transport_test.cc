// Messages over real sockets: every field arrives, doubles to the last bit, and departure is noticed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <thread>

#include "services/transport/coordinator_link.h"
#include "services/transport/private_domain.h"
#include "services/transport/worker_link.h"

namespace dispersa {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;

// Ample for what takes milliseconds on an idle machine.
constexpr seconds kPatience(20);

// The first event of a type; none if it does not come.
template <typename Event, typename Link>
std::optional<Event> Await(Link& link, seconds patience = kPatience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < deadline) {
    std::optional<Event> found;
    for (auto& event : link.Wait(milliseconds(100))) {
      if (auto* wanted = std::get_if<Event>(&event); wanted != nullptr && !found) found = std::move(*wanted);
    }
    if (found) return found;
  }
  return std::nullopt;
}

class Transport : public testing::Test {
 protected:
  NetworkOptions Network() const { return {domain_.domain(), "127.0.0.1"}; }
  Peer CoordinatorPeer() const { return {"127.0.0.1", CoordinatorPort(domain_.domain())}; }
  std::unique_ptr<WorkerLink> MakeWorker(const std::string& uuid) {
    return std::make_unique<WorkerLink>(Network(), CoordinatorPeer(), uuid);
  }

  PrivateDomain domain_;
};

WorkerStatus StatusOf(const std::string& uuid) {
  return {uuid, "host", 42, "0.1.0+abc", 3, 4, WorkerState::kFlying, 17, {5, 6}};
}

std::uint64_t Bits(double value) { return std::bit_cast<std::uint64_t>(value); }

TEST_F(Transport, CarriesWhatAWorkerSaysToTheLastBit) {
  CoordinatorLink coordinator(Network());
  const auto worker = MakeWorker("u1");
  worker->Send(StatusOf("u1"));
  const auto status = Await<WorkerStatus>(coordinator);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->worker, "u1");
  EXPECT_EQ(status->host, "host");
  EXPECT_EQ(status->pid, 42u);
  EXPECT_EQ(status->engine_version, "0.1.0+abc");
  EXPECT_EQ(status->slots, 3u);
  EXPECT_EQ(status->credits, 4u);
  EXPECT_EQ(status->state, WorkerState::kFlying);
  EXPECT_EQ(status->flown, 17u);
  EXPECT_THAT(status->started_cases, ElementsAre(5, 6));

  const double odd_nan = std::bit_cast<double>(0x7ff8000000c0ffeeull);
  const std::vector<double> values = {1.0 / 3.0, -0.0, odd_nan, std::numeric_limits<double>::denorm_min()};
  Report report{"u1", 99, "flight", {}, {{8, 3}, {9, 3}}};
  FlownCase flown;
  flown.attempt = 2;
  flown.result = {7,      Outcome::kLostControl, 123.456, 3, "attitude error", values,
                  values, {0xfeedull << 48, 1}};
  report.flown = {flown};
  worker->Send(report);
  const auto received = Await<Report>(coordinator);
  ASSERT_TRUE(received);
  EXPECT_EQ(received->worker, "u1");
  EXPECT_EQ(received->coordinator_epoch, 99u);
  EXPECT_EQ(received->flight_id, "flight");
  ASSERT_EQ(received->started.size(), 2u);
  EXPECT_EQ(received->started[1].case_index, 9u);
  EXPECT_EQ(received->started[1].attempt, 3u);
  ASSERT_EQ(received->flown.size(), 1u);
  EXPECT_EQ(received->flown[0].attempt, 2u);
  const CaseResult& result = received->flown[0].result;
  EXPECT_EQ(result.case_index, 7u);
  EXPECT_EQ(result.outcome, Outcome::kLostControl);
  EXPECT_EQ(result.end_time_s, 123.456);
  EXPECT_EQ(result.end_stage, 3);
  EXPECT_EQ(result.reason, "attitude error");
  EXPECT_EQ(result.digest, flown.result.digest);
  ASSERT_EQ(result.inputs.size(), values.size());
  ASSERT_EQ(result.metrics.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(Bits(result.inputs[i]), Bits(values[i])) << i;
    EXPECT_EQ(Bits(result.metrics[i]), Bits(values[i])) << i;
  }

  worker->Send(CampaignRefusal{"u1", 99, "flight", "cannot"});
  const auto refusal = Await<CampaignRefusal>(coordinator);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->worker, "u1");
  EXPECT_EQ(refusal->coordinator_epoch, 99u);
  EXPECT_EQ(refusal->flight_id, "flight");
  EXPECT_EQ(refusal->reason, "cannot");
}

TEST_F(Transport, GivesALateWorkerTheOpenCampaignAndTellsWhenItCloses) {
  CoordinatorLink coordinator(Network());
  // More than one datagram, and more than a socket's default buffer.
  const std::string text(3'000'000, 'x');
  coordinator.OpenCampaign({1, "closed", "flight 1", "e", "old", "text"});
  coordinator.CloseCampaign("flight 1");
  coordinator.OpenCampaign({1, "id", "flight 2", "engine", "name", text});
  const auto worker = MakeWorker("u1");
  const auto campaign = Await<CampaignDefinition>(*worker);
  ASSERT_TRUE(campaign);
  EXPECT_EQ(campaign->coordinator_epoch, 1u);
  EXPECT_EQ(campaign->campaign_id, "id");
  EXPECT_EQ(campaign->flight_id, "flight 2");
  EXPECT_EQ(campaign->engine_version, "engine");
  EXPECT_EQ(campaign->name, "name");
  EXPECT_TRUE(campaign->canonical_yaml == text);
  coordinator.CloseCampaign("flight 2");
  const auto closed = Await<CampaignClosed>(*worker);
  ASSERT_TRUE(closed);
  EXPECT_EQ(closed->flight_id, "flight 2");
  EXPECT_EQ(closed->coordinator_epoch, 1u);
}

TEST_F(Transport, OrdersReachOnlyTheWorkerTheyAreMeantForInOrder) {
  CoordinatorLink coordinator(Network());
  // Sent before the workers are there.
  constexpr std::uint64_t kOrders = 500;
  for (std::uint64_t i = 0; i < kOrders; ++i) {
    coordinator.Send("u1", FlyOrder{7, "flight", i, {i, i + 1}});
    coordinator.Send("u2", FlyOrder{7, "flight", 1000 + i, {}});
  }
  coordinator.Send("u1", LeaveOrder{7});
  coordinator.Refuse({"u2", "because"});
  const auto first = MakeWorker("u1");
  const auto second = MakeWorker("u2");
  std::uint64_t next = 0;
  bool left = false;
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!left && std::chrono::steady_clock::now() < deadline) {
    for (const WorkerEvent& event : first->Wait(milliseconds(100))) {
      if (const auto* order = std::get_if<FlyOrder>(&event)) {
        ASSERT_EQ(order->attempt, next);
        EXPECT_EQ(order->coordinator_epoch, 7u);
        EXPECT_EQ(order->flight_id, "flight");
        EXPECT_THAT(order->cases, ElementsAre(next, next + 1));
        ++next;
      } else {
        ASSERT_TRUE(std::holds_alternative<LeaveOrder>(event));
        left = true;
      }
    }
  }
  EXPECT_TRUE(left);
  EXPECT_EQ(next, kOrders);
  const auto refusal = Await<Refusal>(*second);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->worker, "u2");
  EXPECT_EQ(refusal->reason, "because");
}

TEST_F(Transport, NoticesThatAWorkerLeaves) {
  CoordinatorLink coordinator(Network());
  auto worker = MakeWorker("u1");
  worker->Send(StatusOf("u1"));
  ASSERT_TRUE(Await<WorkerStatus>(coordinator));
  worker.reset();
  const auto gone = Await<WorkerGone>(coordinator);
  ASSERT_TRUE(gone);
  EXPECT_EQ(gone->worker, "u1");
}

TEST_F(Transport, AWorkerWithNothingToSayIsNotSilent) {
  CoordinatorLink coordinator(Network());
  const auto worker = MakeWorker("u1");
  worker->Send(StatusOf("u1"));
  ASSERT_TRUE(Await<WorkerStatus>(coordinator));
  // Longer than the lease of 3 s.
  EXPECT_FALSE(Await<WorkerSilent>(coordinator, seconds(5)));
}

TEST_F(Transport, HistoriesDoNotGrowWithoutLimitAndLoseNothing) {
  CoordinatorLink coordinator(Network());
  const auto worker = MakeWorker("u1");
  // Twice past the point where a writer drops what was acknowledged.
  constexpr std::uint64_t kReports = 10'000;
  std::jthread sender([&] {
    for (std::uint64_t i = 0; i < kReports; ++i) worker->Send(Report{"u1", i, "flight", {}, {}});
  });
  std::uint64_t next = 0;
  const auto deadline = std::chrono::steady_clock::now() + 3 * kPatience;
  while (next < kReports && std::chrono::steady_clock::now() < deadline) {
    for (const CoordinatorEvent& event : coordinator.Wait(milliseconds(100))) {
      const auto* report = std::get_if<Report>(&event);
      if (report == nullptr) continue;
      ASSERT_EQ(report->coordinator_epoch, next++);
    }
  }
  EXPECT_EQ(next, kReports);
}

TEST_F(Transport, ASecondCoordinatorInTheDomainIsRefused) {
  const CoordinatorLink coordinator(Network());
  try {
    const CoordinatorLink second(Network());
    FAIL() << "no error";
  } catch (const NetworkError& error) {
    EXPECT_EQ(std::string(error.what()), "UDP port " + std::to_string(CoordinatorPort(domain_.domain())) +
                                             " of 127.0.0.1 is not free: is there a coordinator in domain " +
                                             std::to_string(domain_.domain()) + " already?");
  }
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

TEST(ParsePeerTest, RefusesWhatIsNoPeer) {
  const auto message = [](const std::string& text) {
    try {
      ParsePeer(text, 0);
    } catch (const NetworkError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message("host:0"), "peer 'host:0': not HOST:PORT with a port from 1 to 65535");
  EXPECT_EQ(message("host:65536"), "peer 'host:65536': not HOST:PORT with a port from 1 to 65535");
  EXPECT_EQ(message("host:"), "peer 'host:': not HOST:PORT with a port from 1 to 65535");
  EXPECT_EQ(message("host:1x"), "peer 'host:1x': not HOST:PORT with a port from 1 to 65535");
  EXPECT_EQ(message(":123"), "peer ':123': the host is missing");
}

TEST(SharedMemory, IsNotUsed) {
  // Segments of other programs may lie there: what counts is that ours add none.
  const auto segments = [] {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/shm")) {
      count += entry.path().filename().string().starts_with("fastrtps");
    }
    return count;
  };
  const std::size_t before = segments();
  const PrivateDomain domain;
  const NetworkOptions network{domain.domain(), "127.0.0.1"};
  CoordinatorLink coordinator(network);
  WorkerLink worker(network, {"127.0.0.1", CoordinatorPort(domain.domain())}, "u1");
  worker.Send(StatusOf("u1"));
  ASSERT_TRUE(Await<WorkerStatus>(coordinator));
  EXPECT_EQ(segments(), before);
}

}  // namespace
}  // namespace dispersa
