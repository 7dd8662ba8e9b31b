// Keys over real sockets: a signed participant is heard under its own name, and unprotected messages are not
// believed.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "services/transport/admission.h"
#include "services/transport/authority.h"
#include "services/transport/complaints.h"
#include "services/transport/convert.h"
#include "services/transport/coordinator_link.h"
#include "services/transport/fast_dds.h"
#include "services/transport/private_domain.h"
#include "services/transport/topics.h"
#include "services/transport/worker_link.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::keys_test {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

// Ample for what takes a second on an idle machine.
constexpr seconds kPatience(30);

class Keys : public testing::Test {
 protected:
  Keys() {
    MakeAuthority(authority_.path(), ValidFor(2));
    coordinator_ = std::make_unique<CoordinatorLink>(NetworkOf(Role::kCoordinator));
  }

  NetworkOptions NetworkOf(Role role) {
    NetworkOptions network{domain_.domain(), "127.0.0.1"};
    network.keys = OpenKeyFolder(IssueKeys(authority_.path(), role, "one", ValidFor(1)), {role});
    return network;
  }
  Peer Coordinator() const { return {"127.0.0.1", CoordinatorPort(domain_.domain())}; }

  /// The statuses that come; `say` is called again and again until `enough`.
  template <typename Say, typename Enough>
  bool Hear(Say say, Enough enough) {
    for (const auto deadline = Clock::now() + kPatience; Clock::now() < deadline;) {
      if (enough()) return true;
      say();
      for (const CoordinatorEvent& event : coordinator_->Wait(milliseconds(100))) {
        const auto* status = std::get_if<WorkerStatus>(&event.what);
        if (status == nullptr) continue;
        sender_ = event.sender;
        heard_.push_back(*status);
      }
    }
    return false;
  }

  PrivateDomain domain_;
  TemporaryFolder authority_;
  std::unique_ptr<CoordinatorLink> coordinator_;
  std::string sender_;
  std::vector<WorkerStatus> heard_;
};

WorkerStatus StatusOf(const std::string& worker, std::uint64_t flown) {
  WorkerStatus status;
  status.worker = worker;
  status.host = "host";
  status.engine_version = "1";
  status.slots = 1;
  status.flown = flown;
  return status;
}

TEST_F(Keys, AWorkerIsHeardUnderItsOwnNameAlone) {
  const NetworkOptions network = NetworkOf(Role::kWorker);
  const std::string name = NameOnNetwork(network, "a");
  EXPECT_EQ(name, "one_a");
  WorkerLink link(network, {Coordinator()}, name);
  ASSERT_TRUE(Hear([&] { link.Send(StatusOf(name, 1)); }, [&] { return !heard_.empty(); }));
  // Another's name, and another incarnation of the same keys: both are not this writer's partition.
  for (const char* other : {"two_a", "one_b"}) {
    const std::uint64_t before = Complaints();
    EXPECT_TRUE(Hear([&] { link.Send(StatusOf(other, 2)); }, [&] { return Complaints() > before; }));
  }
  for (const WorkerStatus& status : heard_) EXPECT_EQ(status.worker, name);
}

TEST_F(Keys, ATopicOfAnotherRoleCannotBeOpened) {
  EXPECT_THROW(WorkerLink(NetworkOf(Role::kObserver), {Coordinator()}, "one_a"), NetworkError);
}

/// A DATA message in plain, in the name of a writer of `participant`, as whoever has seen a packet can make.
Bytes Forge(const std::string& participant, std::uint8_t writer, std::uint32_t number,
            const WorkerStatus& status) {
  CodedType<idl::WorkerStatusV2PubSubType> type;
  idl::WorkerStatusV2 sample = ToIdl(status);
  rtps::SerializedPayload_t payload(4096);
  type.Encode(&sample, payload);
  Bytes bytes = {'R', 'T', 'P', 'S', 2, 3, 1, 15};
  for (std::size_t i = 0; i < participant.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(participant.substr(i, 2), nullptr, 16)));
  const std::uint32_t size = 20 + payload.length;
  bytes.insert(bytes.end(),
               {0x15, 0x05, static_cast<std::uint8_t>(size), static_cast<std::uint8_t>(size >> 8)});
  bytes.insert(bytes.end(), {0, 0, 16, 0, 0, 0, 0, 0, 0, 0, writer, 3, 0, 0, 0, 0});
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> 8 * i));
  bytes.insert(bytes.end(), payload.data, payload.data + payload.length);
  return bytes;
}

TEST_F(Keys, AMessageInPlainIsNotBelieved) {
  const NetworkOptions network = NetworkOf(Role::kWorker);
  const std::string name = NameOnNetwork(network, "a");
  WorkerLink link(network, {Coordinator()}, name);
  std::uint32_t said = 0;
  const auto say = [&] { link.Send(StatusOf(name, ++said)); };
  ASSERT_TRUE(Hear(say, [&] { return !heard_.empty(); }));

  // The numbers that this writer will use next, whichever of the participant's it is.
  const int socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(StatusPort(domain_.domain()));
  where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const std::uint64_t before = Complaints();
  for (std::uint8_t writer = 1; writer <= 16; ++writer) {
    for (std::uint32_t number = 1; number <= said + 3; ++number) {
      const Bytes forged = Forge(sender_, writer, number, StatusOf(name, 1'000'000));
      EXPECT_EQ(sendto(socket_, forged.data(), forged.size(), 0, reinterpret_cast<const sockaddr*>(&where),
                       sizeof where),
                static_cast<ssize_t>(forged.size()));
    }
  }
  close(socket_);
  const std::uint32_t then = said;
  EXPECT_TRUE(Hear(say, [&] { return Complaints() > before && heard_.back().flown > then; }));
  for (const WorkerStatus& status : heard_) EXPECT_LT(status.flown, 1'000'000u) << "a forged one";
}

}  // namespace dispersa::keys_test
