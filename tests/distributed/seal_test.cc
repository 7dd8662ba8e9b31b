// The secret of a run: a sender with the secret is believed. One without it, or one that repeats others'
// messages, is not.
#include "services/transport/seal.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "services/fleet/local_workers.h"
#include "services/transport/coordinator_link.h"
#include "services/transport/endpoints.h"
#include "services/transport/private_domain.h"
#include "services/transport/run_pass.h"
#include "services/transport/topics.h"
#include "services/transport/worker_link.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::seal_test {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;

constexpr seconds kPatience(30);   // ample for what takes a second on an idle machine
constexpr seconds kLongEnough(2);  // for what would come within tenths of a second

const Seal::Origin kOrigin{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}, 17};

Bytes Sealed(const Seal& seal, const std::string& topic, const std::string& content) {
  Bytes data(content.begin(), content.end());
  data.resize(content.size() + Seal::kSize);
  seal.Put(topic, kOrigin, data.data(), content.size());
  return data;
}

TEST(Seal, FitsWhatItWasPutOnAndTellsWhoseItIs) {
  const Seal seal(Secret{7}), same(Secret{7});
  for (const std::string content : {"", "x", "a longer content"}) {
    const Bytes data = Sealed(seal, "topic", content);
    Seal::Origin origin;
    EXPECT_TRUE(same.Fits("topic", data.data(), data.size(), &origin));
    EXPECT_EQ(origin, kOrigin);
  }
}

TEST(Seal, FitsNothingElse) {
  const Seal seal(Secret{7});
  const Bytes data = Sealed(seal, "topic", "content");
  Seal::Origin origin;
  for (std::size_t i = 0; i < data.size(); ++i) {
    Bytes changed = data;
    changed[i] ^= 1;
    EXPECT_FALSE(seal.Fits("topic", changed.data(), changed.size(), &origin)) << i;
    EXPECT_FALSE(seal.Fits("topic", data.data(), i, &origin)) << i;
  }
  EXPECT_FALSE(Seal(Secret{8}).Fits("topic", data.data(), data.size(), &origin));
  EXPECT_FALSE(seal.Fits("topi", data.data(), data.size(), &origin));
  Bytes shifted = Sealed(seal, "topi", "ccontent");
  shifted.erase(shifted.begin());
  EXPECT_FALSE(seal.Fits("topic", shifted.data(), shifted.size(), &origin)) << "a topic ends where it ends";
}

TEST(Seal, SecretsDifferAndNumbersGrow) {
  EXPECT_NE(DrawSecret(), DrawSecret());
  EXPECT_NE(DrawSecret(), Secret{});
  std::uint64_t number = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t next = NextSealNumber(number);
    ASSERT_GT(next, number);
    number = next;
  }
  EXPECT_GT(NextSealNumber(0), number) << "a writer that is made anew goes on above";
}

TEST(HeardSeals, CountOnceEachAndFromTheirWriterAlone) {
  rtps::GUID_t writer;
  std::memcpy(writer.guidPrefix.value, kOrigin.writer.data(), 12);
  std::memcpy(writer.entityId.value, kOrigin.writer.data() + 12, 4);
  rtps::GUID_t other = writer;
  other.entityId.value[3] ^= 1;
  HeardSeals heard;
  EXPECT_FALSE(heard.IsNew(rtps::InstanceHandle_t(other), kOrigin)) << "said again by another one";
  EXPECT_TRUE(heard.IsNew(rtps::InstanceHandle_t(writer), kOrigin));
  EXPECT_FALSE(heard.IsNew(rtps::InstanceHandle_t(writer), kOrigin)) << "said again in its name";
  EXPECT_FALSE(heard.IsNew(rtps::InstanceHandle_t(writer), {kOrigin.writer, 16}));
  EXPECT_TRUE(heard.IsNew(rtps::InstanceHandle_t(writer), {kOrigin.writer, 18}));
}

std::string RefusalOf(const std::string& text) {
  return ErrorOf<NetworkError>([&] { ParseRunPass(text); });
}

TEST(RunPass, ArrivesAsItWasAndNothingElseIsTaken) {
  const RunPass pass{DrawSecret(), {std::string(64, 'a'), std::string(64, '0')}};
  const RunPass parsed = ParseRunPass(ToText(pass));
  EXPECT_EQ(parsed.secret, pass.secret);
  EXPECT_EQ(parsed.plugins, pass.plugins);
  const std::string text = ToText(pass), refused = "--run-pass: the data is not from `dispersa run`";
  EXPECT_EQ(RefusalOf(text), "none");
  EXPECT_EQ(RefusalOf(""), refused);
  EXPECT_EQ(RefusalOf("dispersa-run/1\n"), refused);
  EXPECT_EQ(RefusalOf("dispersa-run/2" + text.substr(14)), refused);
  EXPECT_EQ(RefusalOf(text.substr(0, 70)), refused);
  EXPECT_EQ(RefusalOf(text + "abc\n"), refused);
  EXPECT_EQ(RefusalOf(std::string(100000, 'x')), refused);
}

TEST(RunPass, APipeIsReadToItsEndAndClosed) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  RunPass pass{DrawSecret(), {}};
  for (int i = 0; i < 100; ++i) pass.plugins.insert(std::string(62, 'a') + std::to_string(10 + i % 90));
  const std::string text = ToText(pass);
  ASSERT_EQ(write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  close(ends[1]);
  const RunPass taken = TakeRunPass(ends[0]);
  EXPECT_EQ(taken.secret, pass.secret);
  EXPECT_EQ(taken.plugins, pass.plugins);
  EXPECT_EQ(fcntl(ends[0], F_GETFD), -1);
}

/// The bytes of orders as they travel, sealed or not.
class RawOrders : public CodedType<idl::OrdersV1PubSubType> {
 public:
  bool Encode(const void* data, rtps::SerializedPayload_t& payload) override {
    const Bytes& bytes = *static_cast<const Bytes*>(data);
    std::copy(bytes.begin(), bytes.end(), payload.data);
    payload.length = static_cast<std::uint32_t>(bytes.size());
    payload.encapsulation = CDR_LE;
    return true;
  }
  bool Decode(rtps::SerializedPayload_t& payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload.data, payload.data + payload.length);
    return true;
  }
  std::uint32_t SizeOf(const void* data) override {
    return static_cast<std::uint32_t>(static_cast<const Bytes*>(data)->size());
  }
};

/// Repeats the orders to a worker.
class Echo {
 public:
  Echo(Participant& participant, const std::string& worker) {
    dds::Topic* there = participant.TopicOf<RawOrders>(kOrdersTopic);
    reader_ =
        participant.MakeSubscriber({PartitionOf(worker)})->create_datareader(there, MakeReaderQos("", 0));
    writer_ = participant.MakePublisher(PartitionOf(worker))->create_datawriter(there, MakeWriterQos(kDepth));
  }
  /// How many it has heard.
  int SayAgain() {
    Bytes bytes;
    dds::SampleInfo info;
    while (reader_->take_next_sample(&bytes, &info) == kDdsOk) {
      if (!info.valid_data) continue;
      if (info.publication_handle == rtps::InstanceHandle_t(writer_->guid())) continue;
      ++heard_;
      writer_->write(&bytes);
    }
    return heard_;
  }

 private:
  dds::DataReader* reader_;
  dds::DataWriter* writer_;
  int heard_ = 0;
};

WorkerStatus StatusOf(const std::string& worker) {
  WorkerStatus status;
  status.worker = worker;
  status.host = "host";
  status.engine_version = "1";
  return status;
}

class SecretTest : public testing::Test {
 protected:
  NetworkOptions Network(std::optional<Secret> secret) const {
    NetworkOptions network{domain_.domain(), "127.0.0.1"};
    network.secret = secret;
    return network;
  }
  Peer CoordinatorPeer() const { return {"127.0.0.1", CoordinatorPort(domain_.domain())}; }
  /// Whether a status reaches the one, and orders reach the other, within this time.
  static std::pair<bool, bool> HearEachOther(CoordinatorLink& coordinator, WorkerLink& worker,
                                             seconds patience) {
    bool up = false, down = false;
    for (const auto deadline = Clock::now() + patience; Clock::now() < deadline && !(up && down);) {
      worker.Send(StatusOf("w"));
      Orders orders;
      orders.worker = "w";
      orders.coordinator_epoch = 3;
      coordinator.Send(orders);
      for (const CoordinatorEvent& event : coordinator.Wait(milliseconds(50)))
        up = up || std::holds_alternative<WorkerStatus>(event.what);
      down = down || !worker.Wait(milliseconds(50)).empty();
    }
    return {up, down};
  }

  PrivateDomain domain_;
  const Secret secret_ = DrawSecret();
};

TEST_F(SecretTest, TwoWhoHaveItHearEachOther) {
  CoordinatorLink coordinator(Network(secret_));
  WorkerLink worker(Network(secret_), {CoordinatorPeer()}, "w");
  EXPECT_EQ(HearEachOther(coordinator, worker, kPatience), std::pair(true, true));
}

TEST_F(SecretTest, NeitherSideHearsWhoHasNoneOrAnother) {
  for (const std::optional<Secret>& other : {std::optional<Secret>(), std::optional(DrawSecret())}) {
    CoordinatorLink coordinator(Network(secret_));
    WorkerLink worker(Network(other), {CoordinatorPeer()}, "w");
    const auto [up, down] = HearEachOther(coordinator, worker, kLongEnough);
    EXPECT_FALSE(up) << "a worker that is a stranger";
    EXPECT_FALSE(down && other) << "a worker with another secret";
  }
  CoordinatorLink stranger(Network(std::nullopt));
  WorkerLink worker(Network(secret_), {CoordinatorPeer()}, "w");
  EXPECT_FALSE(HearEachOther(stranger, worker, kLongEnough).second) << "a coordinator that is a stranger";
}

// An eavesdropper has sealed messages of others.
TEST_F(SecretTest, WhatASiblingWasToldOrWasToldBeforeIsNotBelieved) {
  CoordinatorLink coordinator(Network(secret_));
  WorkerLink worker(Network(secret_), {CoordinatorPeer()}, "w");
  ASSERT_EQ(HearEachOther(coordinator, worker, kPatience), std::pair(true, true));
  // He finds the worker as somebody whom the coordinator knows: by its address.
  std::vector<Peer> everybody = {CoordinatorPeer()};
  std::ifstream sockets("/proc/self/net/udp");
  for (std::string line; std::getline(sockets, line);) {
    unsigned address = 0, port = 0;
    if (std::sscanf(line.c_str(), " %*d: %x:%x", &address, &port) == 2 && everybody.size() < 64)
      everybody.push_back({"127.0.0.1", static_cast<std::uint16_t>(port)});
  }
  Participant stranger({Network(std::nullopt), "stranger", std::nullopt, everybody});
  Echo echo(stranger, "w");
  Orders orders;
  orders.worker = "w";
  orders.coordinator_epoch = 3;
  std::uint64_t said = 0;
  std::map<std::uint64_t, int> heard;  // how often, by what it acknowledges
  const auto listen = [&](milliseconds patience) {
    for (const WorkerEvent& event : worker.Wait(patience))
      if (const auto* order = std::get_if<Orders>(&event); order != nullptr && !order->acknowledged.empty())
        ++heard[order->acknowledged.front()];
  };
  int overheard = 0;
  for (const auto deadline = Clock::now() + kPatience; Clock::now() < deadline && overheard < 20;) {
    std::this_thread::sleep_for(milliseconds(5));
    orders.acknowledged = {++said};
    coordinator.Send(orders);
    overheard = echo.SayAgain();
    listen(milliseconds(20));
  }
  ASSERT_GE(overheard, 20) << "the eavesdropper has not heard";
  std::this_thread::sleep_for(milliseconds(300));
  listen(milliseconds(0));
  EXPECT_FALSE(heard.empty());
  for (const auto& [order, times] : heard) EXPECT_EQ(times, 1) << "order " << order << " was believed again";
}

// Others would neither be listened to nor listen.
ParticipantOptions InACoordinatorsPlace(const NetworkOptions& network, std::optional<std::uint16_t> port,
                                        const std::vector<Peer>& peers) {
  ParticipantOptions options{network, kCoordinatorParticipant, port, peers};
  options.door.doors = std::make_shared<Doors>("127.0.0.1");
  options.door.doors->Open(port.value_or(0));
  return options;
}

TEST_F(SecretTest, AWorkerDoesNothingThatAnotherOneWasTold) {
  Participant parent(InACoordinatorsPlace(Network(secret_), CoordinatorPort(domain_.domain()), {}));
  Writer<idl::OrdersV1PubSubType> writer(parent, parent.MakePublisher(PartitionOf("w")), kOrdersTopic);
  WorkerLink worker(Network(secret_), {CoordinatorPeer()}, "w");
  Orders orders;
  orders.coordinator_epoch = 3;
  bool is_heard = false;
  for (const auto deadline = Clock::now() + kPatience; Clock::now() < deadline && !is_heard;) {
    for (const char* name : {"sibling", "w"}) {
      orders.worker = name;
      writer.Write(ToIdl(orders));
    }
    for (const WorkerEvent& event : worker.Wait(milliseconds(50))) {
      EXPECT_EQ(std::get<Orders>(event).worker, "w");
      is_heard = true;
    }
  }
  EXPECT_TRUE(is_heard);
}

std::string TextOfProcess(pid_t pid, const char* what) {
  return TextOfFile(fs::path("/proc") / std::to_string(pid) / what);
}

/// The word that follows a given word of a command line.
std::string After(const std::string& word, const std::string& command_line) {
  const std::string wanted = word + '\0';
  const std::size_t at = command_line.find(wanted);
  return at == std::string::npos ? "" : command_line.substr(at + wanted.size()).c_str();
}

// The secret is neither in the command line, which `ps` shows to everybody, nor in the environment.
TEST_F(SecretTest, AWorkerIsGivenItWhereNobodyElseSeesIt) {
  CoordinatorLink coordinator(Network(secret_));
  const std::string pass = ToText({secret_, {}});
  LocalWorkers workers(DISPERSA_BINARIES "/dispersa-worker",
                       {"--domain", std::to_string(domain_.domain()), "--address", "127.0.0.1", "--peer",
                        "127.0.0.1:" + std::to_string(CoordinatorPort(domain_.domain()))},
                       1, pass);
  const auto changes = workers.Poll(0.0, 0);
  ASSERT_EQ(changes.started.size(), 1u);
  bool is_heard = false;
  for (const auto deadline = Clock::now() + kPatience; Clock::now() < deadline && !is_heard;) {
    for (const CoordinatorEvent& event : coordinator.Wait(milliseconds(100))) {
      const auto* status = std::get_if<WorkerStatus>(&event.what);
      is_heard = is_heard || (status != nullptr && status->worker == changes.started[0].uuid);
    }
  }
  ASSERT_TRUE(is_heard);
  std::istringstream lines(pass);
  std::string secret;
  std::getline(lines, secret);
  std::getline(lines, secret);
  const pid_t pid = changes.started[0].pid;
  EXPECT_NE(TextOfProcess(pid, "cmdline").find(changes.started[0].uuid), std::string::npos);
  EXPECT_THAT(TextOfProcess(pid, "cmdline"), Not(HasSubstr(secret)));
  EXPECT_THAT(TextOfProcess(pid, "environ"), Not(HasSubstr(secret)));
  const std::string number = After("--run-pass", TextOfProcess(pid, "cmdline"));
  ASSERT_NE(number, "");
  std::error_code error;
  const std::string target =
      fs::read_symlink("/proc/" + std::to_string(pid) + "/fd/" + number, error).string();
  EXPECT_FALSE(target.starts_with("pipe:")) << "it is read and closed";
}

TEST(RunPass, AWorkerWithoutItDoesNotStart) {
  LocalWorkers workers(DISPERSA_BINARIES "/dispersa-worker", {"--peer", "127.0.0.1", "--domain", "39"}, 1,
                       "nonsense");
  workers.Poll(0.0, 0);
  std::vector<WorkerProcess> ended;
  for (const auto deadline = Clock::now() + kPatience; Clock::now() < deadline && ended.empty();) {
    ended = workers.Poll(0.0, 0).ended;
    std::this_thread::sleep_for(milliseconds(10));
  }
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].how, "exit code 2");
}

/// `dispersa run` as a process of its own.
class RunProcess {
 public:
  explicit RunProcess(const fs::path& folder) : out_(folder / "out") {
    pid_ = fork();
    if (pid_ != 0) return;
    const int log = open((folder / "log").c_str(), O_WRONLY | O_CREAT, 0600);
    dup2(log, 1);
    dup2(log, 2);
    // As many cases as take seconds: until a stranger is there.
    execl(DISPERSA_BINARIES "/dispersa", "dispersa", "run", DISPERSA_CAMPAIGNS "/smoke.yaml", "--workers",
          "1", "--cases", "1500", "--no-histories", "--out", out_.c_str(), nullptr);
    _exit(127);
  }
  ~RunProcess() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  bool IsRunning() {
    int status = 0;
    if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) pid_ = -1;
    return pid_ > 0;
  }
  /// Of its workers, those that ended too.
  std::vector<pid_t> Workers() const {
    std::vector<pid_t> pids;
    const auto execution = nlohmann::json::parse(TextOfFile(out_ / "execution.json"), nullptr, false);
    if (execution.is_discarded() || !execution.contains("workers")) return pids;
    for (const auto& worker : execution.at("workers")) pids.push_back(worker.at("pid").get<pid_t>());
    return pids;
  }

 private:
  fs::path out_;
  pid_t pid_ = -1;
};

// Another user reads the command line, joins the domain, and tells the worker that a new coordinator is
// there, which sends it home: one who can do that can also send it a campaign.
TEST(StrangerBesideARun, HasNoWordInIt) {
  TemporaryFolder folder;
  RunProcess run(folder.path());
  std::vector<pid_t> workers;
  std::string uuid, domain;
  for (const auto deadline = Clock::now() + kPatience; Clock::now() < deadline && uuid.empty();) {
    workers = run.Workers();
    if (!workers.empty()) {
      const std::string words = TextOfProcess(workers[0], "cmdline");
      uuid = After("--uuid", words);
      domain = After("--domain", words);
    }
    std::this_thread::sleep_for(milliseconds(10));
  }
  ASSERT_FALSE(uuid.empty()) << TextOfFile(folder / "log");
  std::vector<Peer> everybody;
  std::this_thread::sleep_for(milliseconds(500));
  std::ifstream sockets("/proc/self/net/udp");
  for (std::string line; std::getline(sockets, line);) {
    unsigned address = 0, port = 0;
    if (std::sscanf(line.c_str(), " %*d: %x:%x", &address, &port) == 2)
      everybody.push_back({"127.0.0.1", static_cast<std::uint16_t>(port)});
  }
  Participant stranger(InACoordinatorsPlace({std::stoi(domain), "127.0.0.1"}, {}, everybody));
  Writer<idl::OrdersV1PubSubType> writer(stranger, stranger.MakePublisher(PartitionOf(uuid)), kOrdersTopic);
  Orders orders;
  orders.worker = uuid;
  orders.coordinator_epoch = 99;
  orders.leave = true;
  int reached = 0;
  for (const auto deadline = Clock::now() + 4 * kPatience; Clock::now() < deadline && run.IsRunning();) {
    reached = std::max(reached, writer.matched());
    writer.Write(ToIdl(orders));
    std::this_thread::sleep_for(milliseconds(50));
  }
  EXPECT_FALSE(run.IsRunning()) << "the run has ended by itself";
  EXPECT_GE(reached, 1) << "the stranger has reached the worker";
  EXPECT_EQ(run.Workers(), workers) << "no worker has left: " << TextOfFile(folder / "log");
}

}  // namespace dispersa::seal_test
