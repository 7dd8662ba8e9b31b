// The dispatcher with several campaigns and several workers: whose cases go to whom, and what one worker or
// one campaign does to the others.
#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "services/coordinator/dispatcher.h"
#include "tests/distributed/memory_store.h"
#include "tests/nominal_inputs.h"
#include "tests/test.h"

namespace dispersa::coordinator_dispatch_rules_test {
namespace {

CaseResult ResultOf(std::uint64_t case_index) {
  CaseResult result;
  result.case_index = case_index;
  ApplyNominal(result);  // what a campaign without dispersions draws
  result.metrics.resize(MetricCount(kUsualStages));
  return result;
}

class DispatchRules : public testing::Test {
 protected:
  struct Flying {
    FullStore* store = nullptr;
    std::unique_ptr<CampaignBook> book;
  };

  void Begin(char letter, std::uint64_t cases, int priority = 0) {
    Campaign campaign;
    campaign.flight_id = std::string(64, letter);
    campaign.sampling.cases = cases;
    auto store = std::make_unique<FullStore>();
    Flying& flying = flying_[letter];
    flying.store = store.get();
    flying.book =
        std::make_unique<CampaignBook>(campaign, std::move(store), LedgerOptions{.side_by_side = 1});
    flying.book->PauseOnDiskErrors();
    dispatcher_.BeginCampaign(*flying.book, priority);
  }
  void Join(const std::string& worker, std::uint32_t credits = 1) {
    dispatcher_.On(worker,
                   {worker, "host", 1, EngineVersion(), 1, credits, WorkerState::kReady, 0, kEpoch, {}, {}},
                   now_s_);
  }
  /// Of each assignment that is said now: the campaign's letter, its cases and "@worker".
  std::vector<std::string> Tick() {
    std::vector<std::string> said;
    for (const Orders& orders : dispatcher_.Tick(now_s_)) {
      for (const FlyOrder& order : orders.assignments) {
        std::string words(1, order.flight_id[0]);
        for (const std::uint64_t case_index : order.cases) {
          words += std::to_string(case_index);
          attempts_[{order.flight_id[0], case_index}] = order.attempt;
        }
        said.push_back(words + "@" + orders.worker);
      }
    }
    return said;
  }
  void Return(const std::string& worker, char letter, std::uint64_t case_index) {
    dispatcher_.On(worker,
                   Report{worker,
                          kEpoch,
                          ++reports_,
                          std::string(64, letter),
                          {{attempts_.at({letter, case_index}), ResultOf(case_index)}},
                          {}},
                   now_s_);
  }
  LedgerProgress Progress(char letter) { return flying_.at(letter).book->ledger().Progress(); }

  static constexpr std::uint64_t kEpoch = 7;
  Dispatcher dispatcher_{kEpoch, EngineVersion()};
  std::map<char, Flying> flying_;
  std::map<std::pair<char, std::uint64_t>, std::uint64_t> attempts_;
  std::uint64_t reports_ = 0;
  double now_s_ = 0.0;
};

TEST_F(DispatchRules, AHigherPriorityIsFlownFirst) {
  Begin('a', 10, 1);
  Begin('b', 10, 2);
  Begin('c', 10, 0);
  Join("w", 2);
  EXPECT_THAT(Tick(), ElementsAre("b0@w", "b1@w"));
}

TEST_F(DispatchRules, OfEqualPrioritiesEachHasAsManyInFlight) {
  Begin('a', 10);
  Begin('b', 10);
  Join("w", 3);
  EXPECT_THAT(Tick(), ElementsAre("a0@w", "b0@w", "a1@w"));
  Join("x");
  EXPECT_THAT(Tick(), ElementsAre("b1@x")) << "of a two fly, of b one";
}

TEST_F(DispatchRules, CreditsAreForAllCampaignsTogether) {
  for (const char letter : {'a', 'b', 'c'}) Begin(letter, 10);
  Join("w", 4);
  EXPECT_EQ(Tick().size(), 4u);
  EXPECT_THAT(Tick(), IsEmpty());
}

TEST_F(DispatchRules, TheLastCaseGoesToOneThatHasFlownSomething) {
  Begin('a', 2);
  Join("known");
  ASSERT_THAT(Tick(), ElementsAre("a0@known"));
  Return("known", 'a', 0);
  Join("a stranger");
  EXPECT_THAT(Tick(), ElementsAre("a1@known"));
}

TEST_F(DispatchRules, ACampaignThatWaitsForTheDiskHoldsNobodyUp) {
  Begin('a', 10, 5);
  Begin('b', 10);
  Join("w");
  ASSERT_THAT(Tick(), ElementsAre("a0@w"));
  flying_.at('a').store->problem = ResultError::Kind::kDiskFull;
  Return("w", 'a', 0);
  now_s_ = 1.0;
  EXPECT_THAT(Tick(), ElementsAre("b0@w"));
}

TEST_F(DispatchRules, AWorkerThatRefusesOneCampaignKeepsTheOther) {
  Begin('a', 1);
  Begin('b', 1);
  Join("w", 2);
  ASSERT_EQ(Tick().size(), 2u);
  dispatcher_.On("w", CampaignRefusal{"w", kEpoch, std::string(64, 'a'), "no law"}, now_s_);
  EXPECT_EQ(Progress('a').waiting, 1u);
  EXPECT_EQ(Progress('b').assigned, 1u);
  EXPECT_EQ(dispatcher_.RefusalByAll(std::string(64, 'a')), "no law");
  EXPECT_EQ(dispatcher_.RefusalByAll(std::string(64, 'b')), std::nullopt);
}

TEST_F(DispatchRules, AWorkerThatIsLostIsLostToEachCampaign) {
  Begin('a', 1);
  Begin('b', 1);
  Join("w", 2);
  ASSERT_EQ(Tick().size(), 2u);
  now_s_ = 11.0;
  Tick();
  EXPECT_EQ(Progress('a').waiting, 1u);
  EXPECT_EQ(Progress('b').waiting, 1u);
}

TEST_F(DispatchRules, AnExpelledWorkersResultsLeaveEachCampaign) {
  Begin('a', 2);
  Begin('b', 2);
  Join("node1_x", 2);
  ASSERT_THAT(Tick(), ElementsAre("a0@node1_x", "b0@node1_x"));
  Return("node1_x", 'a', 0);
  Return("node1_x", 'b', 0);
  EXPECT_EQ(Progress('a').done + Progress('b').done, 2u);
  dispatcher_.Expel({{"node1", {"case 4 gives other bits"}}});
  EXPECT_EQ(Progress('a').waiting, 2u);
  EXPECT_EQ(Progress('b').waiting, 2u);
}

// On a full disk their results cannot be removed yet; then those of both are.
TEST_F(DispatchRules, OfTwoThatAreExpelledNeithersResultsStay) {
  Begin('a', 3);
  for (const char* worker : {"node1_x", "node2_y", "node3_z"}) Join(worker);
  ASSERT_EQ(Tick().size(), 3u);
  Return("node1_x", 'a', 0);
  Return("node2_y", 'a', 1);
  Return("node3_z", 'a', 2);
  flying_.at('a').store->problem = ResultError::Kind::kDiskFull;
  dispatcher_.Expel({{"node1", {"a reason"}}, {"node3", {"another"}}});
  EXPECT_EQ(Progress('a').done, 3u);
  EXPECT_FALSE(flying_.at('a').book->Complete());
  flying_.at('a').store->problem.reset();
  EXPECT_TRUE(flying_.at('a').book->TryFlush());
  EXPECT_EQ(Progress('a').done, 1u);
  EXPECT_EQ(flying_.at('a').store->WorkerOf(1), "node2_y");
}

}  // namespace
}  // namespace dispersa::coordinator_dispatch_rules_test
