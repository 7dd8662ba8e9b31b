// A real worker against a coordinator that is made up: what the worker answers, and in whose name.
#include "services/worker/worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <map>
#include <thread>

#include "core/campaign_yaml/load.h"
#include "core/engine/version.h"
#include "services/transport/coordinator_link.h"
#include "services/transport/private_domain.h"

namespace dispersa {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kPatience(60);            // ample for what takes a second on an idle machine
constexpr milliseconds kNothingComes(500);  // a message needs less than 1 ms, a flight about 200 ms

class WorkerTest : public testing::Test {
 protected:
  WorkerTest()
      : network_{domain_.domain(), "127.0.0.1"},
        campaign_(LoadCampaign(DISPERSA_CAMPAIGNS "/smoke.yaml")),
        coordinator_(network_),
        worker_(*new Worker({network_, {"127.0.0.1", CoordinatorPort(network_.domain)}, "w", 1})),
        thread_([this] { worker_.Run(); }) {}
  ~WorkerTest() override {
    EXPECT_TRUE(Until([this] { return ready_; })) << "it still flies";
    worker_.Stop();
    thread_.join();
  }

  void Open(std::uint64_t epoch) {
    coordinator_.OpenCampaign(
        {epoch, campaign_.id, campaign_.flight_id, EngineVersion(), campaign_.name, campaign_.canonical_yaml});
  }
  void Order(std::uint64_t epoch, std::uint64_t case_index) {
    ready_ = false;
    coordinator_.Send("w", FlyOrder{epoch, campaign_.flight_id, 7, {case_index}});
  }
  void Listen(milliseconds timeout) {
    for (const CoordinatorEvent& event : coordinator_.Wait(timeout)) {
      if (const auto* status = std::get_if<WorkerStatus>(&event)) ready_ = status->started_cases.empty();
      const auto* report = std::get_if<Report>(&event);
      if (report == nullptr) continue;
      for (const FlownCase& flown : report->flown) epoch_of_[flown.result.case_index] = report->coordinator_epoch;
    }
  }
  [[nodiscard]] bool Until(const std::function<bool()>& condition) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!condition() && std::chrono::steady_clock::now() < deadline) Listen(milliseconds(50));
    return condition();
  }

  PrivateDomain domain_;
  NetworkOptions network_;
  Campaign campaign_;
  CoordinatorLink coordinator_;
  Worker& worker_;  ///< never destroyed: its flying threads stay, see Worker
  std::thread thread_;
  bool ready_ = false;
  std::map<std::uint64_t, std::uint64_t> epoch_of_;  ///< case -> epoch of the report that brought it
};

TEST_F(WorkerTest, AnOrderWaitsForTheOpeningOfItsOwnCoordinator) {
  Open(1);
  Order(1, 0);
  ASSERT_TRUE(Until([this] { return epoch_of_.contains(0); }));
  EXPECT_EQ(epoch_of_[0], 1u);
  // The coordinator is started again, and its order overtakes its opening of the same flight.
  Order(2, 1);
  const auto deadline = std::chrono::steady_clock::now() + kNothingComes;
  while (std::chrono::steady_clock::now() < deadline) Listen(milliseconds(50));
  EXPECT_FALSE(epoch_of_.contains(1)) << "flown in the name of a coordinator that did not ask for it";
  Open(2);
  ASSERT_TRUE(Until([this] { return epoch_of_.contains(1); }));
  EXPECT_EQ(epoch_of_[1], 2u);
}

// As when the network was down for longer than the lease: the worker sees the campaign close, and then only orders.
TEST_F(WorkerTest, FliesForACoordinatorThatWasOutOfReach) {
  Open(1);
  Order(1, 0);
  ASSERT_TRUE(Until([this] { return epoch_of_.contains(0); }));
  coordinator_.CloseCampaign(campaign_.flight_id);
  const auto deadline = std::chrono::steady_clock::now() + kNothingComes;
  while (std::chrono::steady_clock::now() < deadline) Listen(milliseconds(50));
  Order(1, 1);
  ASSERT_TRUE(Until([this] { return epoch_of_.contains(1); }));
}

}  // namespace
}  // namespace dispersa
