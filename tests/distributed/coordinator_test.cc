// The coordinator against workers that break the protocol. The "workers" use the real protocol over real
// sockets, but make up their results.
#include "services/coordinator/coordinator.h"

#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/results/fingerprint.h"
#include "services/transport/complaints.h"
#include "services/transport/private_domain.h"
#include "services/transport/worker_link.h"
#include "tests/nominal_inputs.h"
#include "tests/temporary_folder.h"
#include "tests/test.h"

namespace dispersa::coordinator_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Ample for what takes milliseconds on an idle machine.
constexpr seconds kPatience(30);

CaseResult ResultOf(std::uint64_t case_index) {
  CaseResult result;
  result.case_index = case_index;
  result.outcome = Outcome::kCompleted;
  result.end_time_s = 570.0;
  result.end_stage = 4;
  const auto k = static_cast<double>(case_index);
  ApplyNominal(result);
  result.metrics.assign(MetricCount(kUsualStages), k / 3.0);
  result.metrics.back() = std::numeric_limits<double>::quiet_NaN();
  result.digest = {case_index, 1};
  return result;
}

class MadeUpWorker {
 public:
  MadeUpWorker(const NetworkOptions& network, const std::string& uuid)
      : status_{uuid, "host", 1, EngineVersion(), 1, 2, WorkerState::kReady, 0, 0, {}, {}},
        link_(network, {{"127.0.0.1", CoordinatorPort(network.domain)}}, uuid) {}

  /// Collects new messages, with assignments as single cases. Sends a status message.
  void Listen() {
    for (WorkerEvent& event : link_.Wait(milliseconds(0))) {
      const auto* orders = std::get_if<Orders>(&event);
      if (orders == nullptr) continue;
      if (status_.coordinator_epoch == 0) status_.coordinator_epoch = orders->coordinator_epoch;
      for (const FlyOrder& order : orders->assignments) {
        if (!known_.insert(order.attempt).second) continue;
        flight_id_ = order.flight_id;
        for (const std::uint64_t k : order.cases) cases.push_back({k, order.attempt});
      }
      dismissed = dismissed || orders->leave;
    }
    const auto now = std::chrono::steady_clock::now();
    if (now < said_ + milliseconds(200)) return;
    said_ = now;
    status_.held.assign(known_.begin(), known_.end());
    link_.Send(status_);
  }
  void Start(const StartedCase& which) { Send({}, {which}); }
  void Finish(const StartedCase& which) { Send({{which.attempt, ResultOf(which.case_index)}}, {}); }
  /// Flies all it has.
  void FlyAll() {
    for (; !cases.empty(); cases.pop_front()) {
      Start(cases.front());
      Finish(cases.front());
    }
  }
  void Say(WorkerState state) {
    status_.state = state;
    link_.Send(status_);
  }
  bool ready() const { return !flight_id_.empty(); }

  std::deque<StartedCase> cases;
  bool dismissed = false;

 private:
  void Send(std::vector<FlownCase> flown, std::vector<StartedCase> started) {
    link_.Send(Report{status_.worker, status_.coordinator_epoch, ++reports_, flight_id_, std::move(flown),
                      std::move(started)});
  }

  WorkerStatus status_;
  std::string flight_id_;
  std::set<std::uint64_t> known_;
  std::uint64_t reports_ = 0;
  std::chrono::steady_clock::time_point said_;
  WorkerLink link_;
};

class CoordinatorTest : public testing::Test {
 protected:
  void Open(std::uint64_t cases) {
    campaign_.name = "made up";
    campaign_.sampling.cases = cases;
    campaign_.canonical_yaml = "made up";
    campaign_.id = std::string(64, 'a');
    campaign_.flight_id = std::string(64, 'f');
    book_ = std::make_unique<CampaignBook>(campaign_, ResultFolder::Create(directory_ / "out", campaign_));
    coordinator_ = std::make_unique<Coordinator>(Network(), *book_);
  }
  NetworkOptions Network() const { return {domain_.domain(), "127.0.0.1"}; }

  /// Lets the coordinator and the workers run until the condition holds.
  [[nodiscard]] bool Until(const std::function<bool()>& condition, std::vector<MadeUpWorker*> workers) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      coordinator_->Step(milliseconds(2));
      for (MadeUpWorker* worker : workers) worker->Listen();
    }
    return true;
  }
  LedgerProgress Progress() const { return book_->ledger().Progress(); }

  PrivateDomain domain_;
  TemporaryFolder directory_;
  Campaign campaign_;
  std::unique_ptr<CampaignBook> book_;
  std::unique_ptr<Coordinator> coordinator_;
};

TEST_F(CoordinatorTest, FliesACampaignAndDismissesItsWorkers) {
  Open(50);
  MadeUpWorker a(Network(), "a");
  MadeUpWorker b(Network(), "b");
  ASSERT_TRUE(Until([&] { return coordinator_->joined() == 2; }, {&a, &b}));
  ASSERT_TRUE(Until(
      [&] {
        a.FlyAll();
        b.FlyAll();
        return book_->ledger().Complete();
      },
      {&a, &b}));
  book_->Flush();
  coordinator_->Dismiss();
  EXPECT_TRUE(Until([&] { return a.dismissed && b.dismissed; }, {&a, &b}));
  ASSERT_EQ(book_->folder().PresentCases().size(), 50u);
  for (std::uint64_t k = 0; k < 50; ++k) {
    const CaseResult stored = book_->folder().Load(k);
    EXPECT_EQ(stored.digest, ResultOf(k).digest);
    EXPECT_EQ(stored.inputs_digest, ResultOf(k).inputs_digest);
    EXPECT_EQ(stored.metrics.front(), ResultOf(k).metrics.front());
  }
}

TEST_F(CoordinatorTest, ASupervisedWorkersExitStatusDecidesWhoIsToBlame) {
  Open(2);
  coordinator_->Supervise("a");
  {
    MadeUpWorker a(Network(), "a");
    ASSERT_TRUE(Until([&] { return a.ready() && a.cases.size() == 2; }, {&a}));
    a.Start(a.cases[0]);
    for (int i = 0; i < 20; ++i) coordinator_->Step(milliseconds(5));
  }
  // It is gone, but nothing happens until its parent tells how.
  for (int i = 0; i < 20; ++i) coordinator_->Step(milliseconds(5));
  EXPECT_EQ(Progress().assigned, 2u);
  coordinator_->WorkerEnded("a", WorkerEnd::kKilled, "signal 9");
  ASSERT_TRUE(Until([&] { return Progress().waiting == 2; }, {}));
  // Not blamed: another worker gets case 0 together with case 1 at once.
  MadeUpWorker b(Network(), "b");
  ASSERT_TRUE(Until([&] { return b.cases.size() == 2; }, {&b}));
  EXPECT_EQ(b.cases[0].case_index, 0u);
}

TEST_F(CoordinatorTest, NobodySpeaksForAnotherWorker) {
  Open(3);
  MadeUpWorker a(Network(), "a");
  ASSERT_TRUE(Until([&] { return a.ready() && !a.cases.empty(); }, {&a}));
  const std::uint64_t before = Complaints();
  MadeUpWorker forger(Network(), "a");
  ASSERT_TRUE(Until([&] { return Complaints() > before; }, {&a, &forger}));
  forger.Say(WorkerState::kLeft);
  const std::uint64_t status = Complaints();
  ASSERT_TRUE(Until([&] { return Complaints() > status; }, {&a}));
  EXPECT_EQ(coordinator_->joined(), 1u);
}

TEST(FingerprintTest, ChangesWithEveryField) {
  const CaseResult base = ResultOf(1);
  const std::vector<std::function<void(CaseResult&)>> changes = {
      [](CaseResult& r) { r.case_index = 2; },
      [](CaseResult& r) { r.outcome = Outcome::kImpact; },
      [](CaseResult& r) { r.end_time_s = std::nextafter(r.end_time_s, 0.0); },
      [](CaseResult& r) { r.end_stage = 3; },
      [](CaseResult& r) { r.reason = "x"; },
      [](CaseResult& r) { r.reason = std::string(1, '\0'); },
      [](CaseResult& r) { r.inputs.push_back(1.0); },
      [](CaseResult& r) { r.inputs_digest.high ^= 1; },
      [](CaseResult& r) { r.inputs_digest.low ^= 1; },
      [](CaseResult& r) { r.metrics[1] = 0.0; },
      [](CaseResult& r) { r.inputs.push_back(r.metrics[0]), r.metrics.erase(r.metrics.begin()); },
      [](CaseResult& r) { r.metrics[2] = std::numeric_limits<double>::quiet_NaN(); },
      [](CaseResult& r) { r.digest.high ^= 1; },
      [](CaseResult& r) { r.digest.low ^= 1; },
      [](CaseResult& r) {
        r.events = {{"lift_off", 0.0, 1.0, 2.0, 3.0, 4.0}};
      },
      [](CaseResult& r) {
        r.events = {{"max_q", 0.0, 1.0, 2.0, 3.0, 4.0}};
      },
      [](CaseResult& r) {
        r.events = {{"max_q", 0.5, 1.0, 2.0, 3.0, 4.0}};
      },
      [](CaseResult& r) {
        r.events = {{"max_q", 0.0, 1.5, 2.0, 3.0, 4.0}};
      },
      [](CaseResult& r) {
        r.events = {{"max_q", 0.0, 1.0, 2.5, 3.0, 4.0}};
      },
      [](CaseResult& r) {
        r.events = {{"max_q", 0.0, 1.0, 2.0, 3.5, 4.0}};
      },
      [](CaseResult& r) {
        r.events = {{"max_q", 0.0, 1.0, 2.0, 3.0, 4.5}};
      },
  };
  EXPECT_EQ(Fingerprint(base), Fingerprint(ResultOf(1)));
  std::vector<Digest> seen = {Fingerprint(base)};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CaseResult changed = base;
    changes[i](changed);
    const Digest fingerprint = Fingerprint(changed);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), fingerprint), 0) << i;
    seen.push_back(fingerprint);
  }
}

}  // namespace dispersa::coordinator_test
