// A real worker against a made-up coordinator: the worker's answers, and the names in them.
#include "services/worker/worker.h"

#include "core/campaign_yaml/load.h"
#include "core/flight/engine_version.h"
#include "services/transport/coordinator_link.h"
#include "services/transport/private_domain.h"
#include "tests/test.h"

namespace dispersa::worker_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kRunning = -1;
constexpr seconds kPatience(60);  // ample for what takes a second on an idle machine

class WorkerTest : public testing::Test {
 protected:
  WorkerTest()
      : network_{domain_.domain(), "127.0.0.1"}, campaign_(LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml")) {
    coordinator_.emplace(network_);
  }
  ~WorkerTest() override {
    if (thread_.joinable()) {
      worker_->Drain();
      thread_.join();
    }
  }

  void StartWorker(WorkerOptions options = {}) {
    options.network = network_;
    options.peers = {{"127.0.0.1", CoordinatorPort(network_.domain)}};
    options.uuid = "w";
    worker_ = new Worker(options);
    thread_ = std::thread([this] { exit_ = static_cast<int>(worker_->Run()); });
  }
  void Order(std::uint64_t attempt, std::vector<std::uint64_t> cases) {
    orders_.assignments.push_back({campaign_.flight_id, attempt, std::move(cases)});
  }
  /// A coordinator that repeats its orders as long as it acknowledges nothing of them.
  void Listen(milliseconds timeout) {
    orders_.worker = "w";
    orders_.coordinator_epoch = epoch_;
    if (const auto now = std::chrono::steady_clock::now(); now > said_ + milliseconds(200)) {
      said_ = now;
      coordinator_->Send(orders_);
    }
    for (const CoordinatorEvent& event : coordinator_->Wait(timeout)) {
      if (const auto* status = std::get_if<WorkerStatus>(&event.what)) status_ = *status;
      if (const auto* request = std::get_if<TextRequest>(&event.what)) {
        ++text_requests_;
        coordinator_->Send(TextPart{"w", request->flight_id, campaign_.name, engine_version_, text_.size(),
                                    request->offset, text_.substr(request->offset, 4000)});
      }
      if (const auto* refusal = std::get_if<CampaignRefusal>(&event.what)) refusal_ = refusal->reason;
      const auto* report = std::get_if<Report>(&event.what);
      if (report == nullptr) continue;
      for (const FlownCase& flown : report->flown) {
        epoch_of_[flown.result.case_index] = report->coordinator_epoch;
        ++times_[flown.result.case_index];
        if (acknowledge_) orders_.acknowledged.push_back(report->number);
      }
    }
  }
  [[nodiscard]] bool Until(const std::function<bool()>& condition, seconds patience = kPatience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (!condition() && std::chrono::steady_clock::now() < deadline) Listen(milliseconds(50));
    return condition();
  }

  PrivateDomain domain_;
  NetworkOptions network_;
  Campaign campaign_;
  std::string text_ = campaign_.canonical_yaml;
  std::string engine_version_ = EngineVersion();
  std::optional<CoordinatorLink> coordinator_;
  std::uint64_t epoch_ = 1;
  Orders orders_;
  bool acknowledge_ = true;
  std::chrono::steady_clock::time_point said_;
  Worker* worker_ = nullptr;  ///< never destroyed: its flying threads stay, see Worker
  std::thread thread_;
  std::atomic<int> exit_ = kRunning;
  WorkerStatus status_;
  int text_requests_ = 0;
  std::optional<std::string> refusal_;
  std::map<std::uint64_t, std::uint64_t> epoch_of_;  ///< case -> epoch of the report that brought it
  std::map<std::uint64_t, int> times_;               ///< case -> reports of it
};

TEST_F(WorkerTest, FetchesTheTextInPartsFliesAndReportsUntilItIsAcknowledged) {
  acknowledge_ = false;
  StartWorker();
  Order(7, {0, 1});
  ASSERT_TRUE(Until([this] { return times_[0] >= 2 && times_[1] >= 2; }))
      << "repeated until it is acknowledged";
  EXPECT_GE(text_requests_, static_cast<int>(text_.size() / 4000));
  EXPECT_EQ(status_.held, std::vector<std::uint64_t>{7}) << "held until it is acknowledged";
  orders_.assignments.clear();
  acknowledge_ = true;
  ASSERT_TRUE(Until([this] { return status_.held.empty(); }));
  const auto times = times_;
  EXPECT_FALSE(Until([&] { return times_ != times; }, seconds(3))) << "and then no more";
}

TEST_F(WorkerTest, FollowsACoordinatorThatWasStartedAgain) {
  StartWorker();
  Order(7, {0});
  ASSERT_TRUE(Until([this] { return epoch_of_.contains(0); }));
  EXPECT_EQ(epoch_of_[0], 1u);
  coordinator_.reset();
  coordinator_.emplace(network_);
  epoch_ = 2;
  orders_ = {};
  Order(7, {1});
  ASSERT_TRUE(Until([this] { return epoch_of_.contains(1); }));
  EXPECT_EQ(epoch_of_[1], 2u);
}

TEST_F(WorkerTest, RefusesATextOfOtherFlights) {
  text_ = LoadCampaign(DISPERSA_CAMPAIGNS "/nominal.yaml").canonical_yaml;
  StartWorker();
  Order(7, {0});
  ASSERT_TRUE(Until([this] { return refusal_.has_value(); }));
  EXPECT_EQ(refusal_->substr(0, 10 + campaign_.flight_id.size()), "flight id " + campaign_.flight_id);
  ASSERT_TRUE(Until([this] { return status_.held.empty(); }));
}

TEST_F(WorkerTest, RefusesATextOfAnotherEngine) {
  engine_version_ = "other";
  StartWorker();
  Order(7, {0});
  ASSERT_TRUE(Until([this] { return refusal_.has_value(); }));
  EXPECT_EQ(*refusal_,
            "engine version other of the coordinator differs from the worker's " + EngineVersion());
  EXPECT_TRUE(times_.empty());
}

TEST_F(WorkerTest, ADrainedWorkerFinishesWhatItFliesAndHandsBackTheRest) {
  StartWorker();
  // More than are flown before anybody notices that the first have started.
  std::vector<std::uint64_t> cases(1000);
  std::iota(cases.begin(), cases.end(), 0);
  Order(7, cases);
  ASSERT_TRUE(Until([this] { return !status_.started.empty(); }));
  worker_->Drain();
  ASSERT_TRUE(Until([this] { return exit_ != kRunning; }));
  EXPECT_EQ(exit_, static_cast<int>(WorkerExit::kDrained));
  EXPECT_EQ(status_.state, WorkerState::kLeft);
  EXPECT_FALSE(times_.empty()) << "what it flew";
  EXPECT_LT(times_.size(), cases.size()) << "the rest";
}

TEST_F(WorkerTest, GivesUpWithoutACoordinatorWhenItIsAskedTo) {
  coordinator_.reset();
  WorkerOptions options;
  options.patience_s = 1.0;
  StartWorker(options);
  thread_.join();
  EXPECT_EQ(exit_, static_cast<int>(WorkerExit::kNoCoordinator));
}

TEST_F(WorkerTest, LeavesWhenItIsIdleForLong) {
  WorkerOptions options;
  options.idle_exit_s = 1.0;
  StartWorker(options);
  Order(7, {0});
  ASSERT_TRUE(Until([this] { return times_.contains(0); }));
  orders_.assignments.clear();  // it would fly it again
  ASSERT_TRUE(Until([this] { return exit_ != kRunning; }));
  EXPECT_EQ(exit_, static_cast<int>(WorkerExit::kIdle));
}

}  // namespace dispersa::worker_test
