// A thousand workers of one coordinator in simulated time: the real dispatcher, ledger and flight desks, and
// a coordinator's thread whose work takes as long as it was measured to take. How much one coordinator bears,
// how busy it is, and how long results wait, without a thousand machines. The same numbers in each run.
// DISPERSA_PRINT_CAPACITY=1 prints the table of the capacity page.
#include <queue>
#include <variant>

#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "services/coordinator/dispatcher.h"
#include "services/log/log.h"
#include "services/worker/flight_desk.h"
#include "tests/distributed/forgetful_store.h"
#include "tests/nominal_inputs.h"
#include "tests/test.h"

namespace dispersa::thousand_workers_test {

/// Processor time of the coordinator's process, on one of two virtual cores at 2.8 GHz. All of it counts as
/// the work of one thread, which is more than the truth: the middleware's threads have a share of it.
/// `python3 tests/benchmarks/messages.py build/release` measures the first three on processes.
/// DISPERSA_PRINT_CAPACITY=1 measures the fourth.
struct Costs {
  double status_s;            ///< a status that comes, and half of the orders that go
  double report_s;            ///< a report that comes, without its results, and its acknowledgement
  double result_s;            ///< a result: decoded, checked, stored
  double worker_and_round_s;  ///< of each round of the loop, for each worker that is there
};
constexpr Costs kWithoutKeys = {206e-6, 108e-6, 42e-6, 0.6e-6};

constexpr double kLatency_s = 0.2e-3;  // of the network, each way
constexpr double kWake_s = 0.05;       // of a worker's and the coordinator's loop without messages

const std::string kFlight(64, 'f');

Campaign Endless() {
  Campaign campaign;
  campaign.flight_id = kFlight;
  campaign.sampling.cases = 100'000'000;
  campaign.canonical_yaml = "a text";
  return campaign;
}

CaseResult ResultOf(std::uint64_t case_index) {
  CaseResult result;
  result.case_index = case_index;
  ApplyNominal(result);
  result.digest = {case_index, 7};
  result.metrics.resize(MetricCount(kUsualStages));
  return result;
}

/// Keeps how often each case was stored, and nothing else of it.
class CountingStore : public ForgetfulStore {
 public:
  explicit CountingStore(std::vector<std::uint8_t>& times) : times_(times) {}
  void Store(std::span<const CaseResult> results, std::span<const ExecutionRecord>) override {
    for (const CaseResult& result : results) {
      if (result.case_index >= times_.size()) times_.resize(2 * result.case_index + 1024);
      ++times_[result.case_index];
    }
  }
  void Quarantine(const QuarantinedCase&) override { ADD_FAILURE() << "nobody is to blame"; }
  CaseResult Load(std::uint64_t case_index) const override { return ResultOf(case_index); }

 private:
  std::vector<std::uint8_t>& times_;
};

struct Scale {
  int workers;
  double flight_s;   ///< on average; single flights take 0.8 to 1.2 of it
  double warm_up_s;  ///< not counted
  double counted_s;
};

struct Figures {
  double results_per_s = 0.0;
  double coordinator_share = 0.0;  ///< of one core
  double workers_share = 0.0;      ///< of the workers' cores that fly
  double wait_median_s = 0.0;      ///< from the end of a flight until the coordinator has its result
  double wait_99_s = 0.0;
  std::size_t joined = 0;
  std::uint64_t renewed = 0;  ///< connections, by workers that heard nothing
  std::uint64_t twice = 0, conflicts = 0;

  bool operator==(const Figures&) const = default;
};

class Service {
 public:
  Service(const Scale& scale, const Costs& costs) : scale_(scale), costs_(costs) {
    auto store = std::make_unique<CountingStore>(times_);
    book_ = std::make_unique<CampaignBook>(Endless(), std::move(store));
    dispatcher_.BeginCampaign(*book_);
    for (int w = 0; w < scale.workers; ++w) {
      Worker& worker = workers_.emplace_back();
      worker.name = "node" + std::to_string(w) + "_0123456789abcdef0123456789abcdef";
      worker.desk = std::make_unique<FlightDesk>(
          FlightDeskOptions{.worker = worker.name, .engine_version = EngineVersion()}, 0.0);
      // They were not started at the same moment.
      At(0.5 * w / scale.workers, {w, Wake{}});
    }
    At(0.0, {kCoordinator, Wake{}});
  }

  Figures Run() {
    const double end_s = scale_.warm_up_s + scale_.counted_s;
    while (!events_.empty() && events_.top().at_s < end_s) {
      Event event = std::move(const_cast<Event&>(events_.top()));
      events_.pop();
      now_s_ = event.at_s;
      if (event.who == kCoordinator) {
        Coordinate(event);
      } else {
        Work(workers_[static_cast<std::size_t>(event.who)], event);
      }
    }
    return Count();
  }

 private:
  static constexpr int kCoordinator = -1;
  struct Wake {
    std::uint64_t round = 0;  ///< of the coordinator, after which it wakes
  };
  struct FlightEnds {};
  using What =
      std::variant<Wake, FlightEnds, Orders, TextPart, WorkerStatus, Report, TextRequest, CampaignRefusal>;
  struct Event {
    int who;
    What what;
    double at_s = 0.0;
    std::uint64_t number = 0;  ///< what comes first goes first
    bool operator<(const Event& other) const {
      return at_s != other.at_s ? at_s > other.at_s : number > other.number;
    }
  };
  struct Worker {
    std::string name;
    std::unique_ptr<FlightDesk> desk;
    std::optional<Job> job;
  };

  void At(double at_s, Event event) {
    event.at_s = at_s;
    event.number = ++numbers_;
    events_.push(std::move(event));
  }
  bool Counts() const { return now_s_ >= scale_.warm_up_s; }

  void Work(Worker& worker, Event& event) {
    if (const auto* orders = std::get_if<Orders>(&event.what)) worker.desk->On(*orders, now_s_);
    if (const auto* part = std::get_if<TextPart>(&event.what)) worker.desk->On(*part, now_s_);
    while (const auto text = worker.desk->TakeText()) worker.desk->Loaded(text->flight_id, nullptr, "");
    if (std::holds_alternative<FlightEnds>(event.what)) {
      done_s_[worker.job->case_index % done_s_.size()] = now_s_;
      worker.desk->Done(*worker.job, ResultOf(worker.job->case_index), now_s_);
      worker.job.reset();
    }
    Fly(worker, event.who);
    if (std::holds_alternative<Wake>(event.what)) {
      const FlightDesk::Due due = worker.desk->Tick(now_s_);
      if (due.status) Say(*due.status);
      for (const Report& report : due.reports) Say(report);
      for (const TextRequest& request : due.text_requests) Say(request);
      renewed_ += due.new_connection;
      At(now_s_ + kWake_s, {event.who, Wake{}});
    }
  }
  void Fly(Worker& worker, int who) {
    if (!worker.job) worker.job = worker.desk->Next(now_s_);
    for (Report& report : worker.desk->TakeReports(now_s_)) Say(std::move(report));
    if (!worker.job || worker.job->started_s < now_s_) return;
    // A flight's length is that of its case, whoever flies it.
    const double share = 0.8 + 0.4 * static_cast<double>(worker.job->case_index * 2654435761u % 1000) / 999.0;
    const double takes_s = scale_.flight_s * share;
    if (Counts()) flown_s_ += std::min(takes_s, scale_.warm_up_s + scale_.counted_s - now_s_);
    worker.job->started_s = now_s_ - 1e-12;  // its end is on its way
    At(now_s_ + takes_s, {who, FlightEnds{}});
  }
  void Say(What message) { At(now_s_ + kLatency_s, {kCoordinator, std::move(message)}); }

  // A round of the coordinator's loop takes all that has come, and then makes orders. It begins when a
  // message comes, or after a while without one.
  void Coordinate(Event& event) {
    if (const auto* wake = std::get_if<Wake>(&event.what)) {
      if (wake->round != rounds_) return;  // a message came before
      if (now_s_ < free_s_ + kWake_s && inbox_.empty()) {
        At(free_s_ + kWake_s, {kCoordinator, Wake{rounds_}});
        return;
      }
      DoRound();
      return;
    }
    inbox_.push_back(std::move(event.what));
    if (free_s_ <= now_s_) DoRound();
  }
  void DoRound() {
    ++rounds_;
    double work_s = costs_.worker_and_round_s * static_cast<double>(dispatcher_.joined());
    for (What& what : std::exchange(inbox_, {})) {
      work_s += CostOf(what);
      Take(what, now_s_ + work_s);
    }
    free_s_ = now_s_ + work_s;
    for (Orders& orders : dispatcher_.Tick(free_s_)) {
      const int who = NumberOf(orders.worker);
      At(free_s_ + kLatency_s, {who, std::move(orders)});
    }
    for (auto& [who, part] : std::exchange(texts_, {})) At(free_s_ + kLatency_s, {who, std::move(part)});
    const double end_s = scale_.warm_up_s + scale_.counted_s;
    busy_s_ += std::max(0.0, std::min(free_s_, end_s) - std::max(now_s_, scale_.warm_up_s));
    At(free_s_, {kCoordinator, Wake{rounds_}});
  }
  double CostOf(const What& what) const {
    const auto* report = std::get_if<Report>(&what);
    if (report == nullptr) return costs_.status_s;
    return costs_.report_s + costs_.result_s * static_cast<double>(report->flown.size());
  }
  void Take(What& what, double at_s) {
    if (const auto* status = std::get_if<WorkerStatus>(&what)) dispatcher_.On(status->worker, *status, at_s);
    if (const auto* refusal = std::get_if<CampaignRefusal>(&what))
      dispatcher_.On(refusal->worker, *refusal, at_s);
    if (const auto* report = std::get_if<Report>(&what)) {
      for (const FlownCase* flown : dispatcher_.On(report->worker, *report, at_s)) {
        if (!Counts()) continue;
        ++results_;
        waits_s_.push_back(at_s - done_s_[flown->result.case_index % done_s_.size()]);
      }
    }
    if (const auto* request = std::get_if<TextRequest>(&what)) {
      if (auto part = dispatcher_.On(*request, 1 << 20, at_s))
        texts_.emplace_back(NumberOf(request->worker), *std::move(part));
    }
  }
  static int NumberOf(const std::string& worker) { return std::atoi(worker.c_str() + 4); }

  Figures Count() {
    book_->Flush();
    std::sort(waits_s_.begin(), waits_s_.end());
    Figures figures;
    figures.results_per_s = static_cast<double>(results_) / scale_.counted_s;
    figures.coordinator_share = busy_s_ / scale_.counted_s;
    figures.workers_share = flown_s_ / (scale_.counted_s * scale_.workers);
    if (!waits_s_.empty()) {
      figures.wait_median_s = waits_s_[waits_s_.size() / 2];
      figures.wait_99_s = waits_s_[waits_s_.size() * 99 / 100];
    }
    figures.joined = dispatcher_.joined();
    figures.renewed = renewed_;
    for (const std::uint8_t times : times_) figures.twice += times > 1;
    figures.conflicts = book_->ledger().Progress().conflicts;
    return figures;
  }

  Scale scale_;
  Costs costs_;
  std::vector<std::uint8_t> times_;  ///< that each case was stored
  Dispatcher dispatcher_{7, EngineVersion(), DispatcherOptions{}};
  std::unique_ptr<CampaignBook> book_;
  std::vector<Worker> workers_;
  std::priority_queue<Event> events_;
  std::vector<What> inbox_;
  std::vector<std::pair<int, TextPart>> texts_;
  std::vector<double> done_s_ = std::vector<double>(1 << 22);  ///< by case
  std::vector<double> waits_s_;
  std::uint64_t numbers_ = 0, results_ = 0, rounds_ = 0, renewed_ = 0;
  double now_s_ = 0.0, free_s_ = 0.0, busy_s_ = 0.0, flown_s_ = 0.0;
};

/// A first worker joins, and many more: what a round costs for each of them. It differs from run to run.
double RoundCost_s() {
  constexpr int kWorkers = 1000, kRounds = 200;
  std::vector<std::uint8_t> times;
  CampaignBook book(Endless(), std::make_unique<CountingStore>(times));
  Dispatcher dispatcher(7, EngineVersion(), DispatcherOptions{});
  dispatcher.BeginCampaign(book);
  for (int w = 0; w < kWorkers; ++w) {
    const std::string name = "node" + std::to_string(w) + "_0123456789abcdef0123456789abcdef";
    dispatcher.On(
        name, WorkerStatus{name, "host", 1, EngineVersion(), 1, 9, WorkerState::kReady, 0, 7, {}, {}}, 0.0);
  }
  dispatcher.Tick(0.1);  // all get what they may hold
  const std::clock_t begun = std::clock();
  for (int i = 0; i < kRounds; ++i) dispatcher.Tick(0.2);
  return static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC / kRounds / kWorkers;
}

Figures FiguresOf(const Scale& scale) {
  SetLogLevel(LogLevel::kNothing);
  const Figures figures = Service(scale, kWithoutKeys).Run();
  SetLogLevel(LogLevel::kInfo);
  EXPECT_EQ(figures.twice, 0u);
  EXPECT_EQ(figures.conflicts, 0u);
  return figures;
}

void ExpectAllThere(const Figures& figures, std::size_t workers) {
  EXPECT_EQ(figures.joined, workers) << "nobody is taken for lost";
  EXPECT_EQ(figures.renewed, 0u) << "everybody hears";
}

TEST(ThousandWorkers, AreKeptBusyByOneCoordinatorBelowItsLimit) {
  const Figures figures = FiguresOf({1000, 0.5, 3.0, 3.0});
  ExpectAllThere(figures, 1000);
  EXPECT_GT(figures.workers_share, 0.9);
  EXPECT_NEAR(figures.results_per_s, 2000.0, 100.0);
  EXPECT_LT(figures.wait_99_s, 0.5);
}

// Short flights ask for more than one thread can do. It is busy all the time, nobody is lost, and no case is
// flown twice.
TEST(ThousandWorkers, WhoAskForTooMuchWaitAndAreNotLost) {
  const Figures figures = FiguresOf({1000, 0.1, 4.0, 6.0});
  EXPECT_EQ(figures.joined, 1000u);
  EXPECT_GT(figures.coordinator_share, 0.99);
  EXPECT_LT(figures.workers_share, 0.9);
  EXPECT_GT(figures.results_per_s, 2000.0);
}

TEST(ThousandWorkers, AreTheSameInEachRun) {
  EXPECT_EQ(FiguresOf({100, 0.02, 0.5, 1.0}), FiguresOf({100, 0.02, 0.5, 1.0}));
}

// At every length of flight nobody is lost. On request for all scales, and printed.
TEST(ThousandWorkers, AreNotLostWhateverAFlightTakes) {
  const bool prints = std::getenv("DISPERSA_PRINT_CAPACITY") != nullptr;
  if (prints) {
    std::printf("a round, for each worker: %.2f us measured now, %.2f us in the table\n", 1e6 * RoundCost_s(),
                1e6 * kWithoutKeys.worker_and_round_s);
    std::printf(
        "| workers | a flight | results/s | workers fly | coordinator busy | wait of a result: median | 99 "
        "%% | lost |\n");
  }
  for (const int workers : prints ? std::vector<int>{100, 300, 1000} : std::vector<int>{100}) {
    for (const double flight_s : {0.02, 0.05, 0.1, 0.3, 1.0, 3.0}) {
      const Figures figures = FiguresOf({workers, flight_s, 4.0, 6.0});
      EXPECT_EQ(figures.joined, static_cast<std::size_t>(workers)) << flight_s;
      if (!prints) continue;
      std::printf("| %d | %.1f ms | %.0f | %.0f %% | %.0f %% | %.0f ms | %.0f ms | %zu |\n", workers,
                  1e3 * flight_s, figures.results_per_s, 100.0 * figures.workers_share,
                  100.0 * figures.coordinator_share, 1e3 * figures.wait_median_s, 1e3 * figures.wait_99_s,
                  static_cast<std::size_t>(workers) - figures.joined);
    }
  }
}

}  // namespace dispersa::thousand_workers_test
