// The real ledger, dispatcher and flight desks over a made-up network. Messages are lost, repeated, reordered
// and delayed. Connections fail in one or both directions. Workers and coordinators die at any step. Workers
// return false results if all cases are audited. Still every campaign ends with the right results.
// DISPERSA_SIMULATED_WORLDS: number of worlds (default 2000; tests/run --long: 1,000,000).
#include <variant>

#include "core/analysis/stopping_rule.h"
#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "core/results/fingerprint.h"
#include "services/coordinator/dispatcher.h"
#include "services/log/log.h"
#include "services/worker/flight_desk.h"
#include "tests/nominal_inputs.h"
#include "tests/test.h"

namespace dispersa::simulation_test {

constexpr double kStep_s = 0.1;
constexpr std::size_t kTextPart = 5;  // bytes: a text takes several

/// The part that survives a coordinator: a disk.
struct Disk {
  std::map<std::uint64_t, CaseResult> rows;
  std::int64_t planned_cases = 0;
  std::map<std::uint64_t, std::string> worker_of;
  std::set<std::pair<std::uint64_t, std::string>> audited;
  std::set<std::uint64_t> quarantined;
};

class DiskStore : public ResultStore {
 public:
  explicit DiskStore(Disk& disk) : disk_(disk) {}
  void Store(std::span<const CaseResult> results, std::span<const ExecutionRecord> records) override {
    for (const CaseResult& result : results) {
      const auto [row, added] = disk_.rows.emplace(result.case_index, result);
      EXPECT_EQ(Fingerprint(row->second), Fingerprint(result)) << "another result over the stored one";
    }
    for (const ExecutionRecord& record : records) disk_.worker_of[record.case_index] = record.worker;
  }
  void Quarantine(const QuarantinedCase& quarantined) override {
    disk_.quarantined.insert(quarantined.case_index);
  }
  std::vector<std::pair<std::uint64_t, Digest>> Fingerprints() const override {
    std::vector<std::pair<std::uint64_t, Digest>> all;
    for (const auto& [case_index, result] : disk_.rows) all.emplace_back(case_index, Fingerprint(result));
    return all;
  }
  CaseResult Load(std::uint64_t case_index) const override { return disk_.rows.at(case_index); }
  void ForEach(const std::function<void(const CaseResult&)>& callback) const override {
    for (const auto& [case_index, result] : disk_.rows) callback(result);
  }
  std::int64_t PlannedCases() const override { return disk_.planned_cases; }
  std::vector<std::int64_t> PastLooks() const override { return {}; }
  std::optional<std::string> WorkerOf(std::uint64_t case_index) const override {
    return disk_.worker_of.at(case_index);
  }
  void AppendAudits(std::span<const Claim> claims) override {
    for (const Claim& claim : claims) disk_.audited.emplace(claim.case_index, claim.worker);
  }
  void ForEachUnaudited(const std::function<void(const Claim&)>& callback) const override {
    for (const auto& [case_index, result] : disk_.rows) {
      const std::string& worker = disk_.worker_of.at(case_index);
      if (!disk_.audited.contains({case_index, worker}))
        callback({worker, case_index, Fingerprint(result), false});
    }
  }
  std::vector<std::uint64_t> Disown(const std::string& worker) override {
    std::vector<std::uint64_t> cases;
    for (const auto& [case_index, who] : disk_.worker_of)
      if (IsMeantBy(worker, who, "")) cases.push_back(case_index);
    for (const std::uint64_t case_index : cases)
      disk_.rows.erase(case_index), disk_.worker_of.erase(case_index);
    return cases;
  }

 private:
  Disk& disk_;
};

CaseResult ResultOf(std::uint64_t case_index) {
  CaseResult result;
  result.case_index = case_index;
  ApplyNominal(result);
  result.digest = {case_index, 7};
  result.outcome = Outcome::kCompleted;
  result.metrics.assign(MetricCount(kUsualStages), 0.0);
  result.metrics[0] = static_cast<double>(case_index) / 3.0;
  return result;
}

Campaign CampaignNumber(int number, std::uint64_t cases) {
  Campaign campaign;
  campaign.name = "c" + std::to_string(number);
  campaign.flight_id = std::string(63, 'f') + std::to_string(number);
  campaign.id = std::string(64, 'a');
  campaign.canonical_yaml = "the text of campaign " + std::to_string(number);
  campaign.sampling.cases = cases;
  return campaign;
}

/// One that stops at the look at which it is decided: cases 0 and 1 break its requirement, the others keep
/// it.
Campaign CampaignThatStops(int number) {
  Campaign campaign = CampaignNumber(number, 24);
  campaign.requirements = {{MetricNames()[0], {}, 0.5, 0.5, 0.3}};
  campaign.requirements[0].plan = {PlanKind::kGroupSequential, 6, Spending::kPocock};
  campaign.verdicts.stop_when_decided = true;
  return campaign;
}

/// The number of cases at which it stops without a network.
std::uint64_t CasesUntilDecided(const Campaign& campaign) {
  StoppingRule rule(campaign, static_cast<std::int64_t>(campaign.sampling.cases), {});
  std::uint64_t flown = 0;
  do {
    for (; flown < rule.target(); ++flown) rule.Add(ResultOf(flown));
  } while (rule.Advance({}));
  return flown;
}

struct Weather {
  double loss, repetition, worst_delay_s, worker_death, coordinator_death, freeze;
  double lies;  ///< of the results of a worker that lies; then all results are audited
};

class World {
 public:
  World(std::uint64_t seed, const Weather& weather)
      : chance_(seed), weather_(weather), campaigns_(1 + Draw(2)), disks_(campaigns_) {
    for (int c = 0; c < campaigns_; ++c) {
      stops_.push_back(Draw(3) == 0);
      cases_.push_back(stops_[c] ? CasesUntilDecided(CampaignThatStops(c)) : 1 + Draw(8));
      disks_[c].planned_cases = static_cast<std::int64_t>(CampaignOf(c).sampling.cases);
    }
    StartCoordinator();
    for (int w = 0; w < 1 + Draw(3); ++w) StartWorker(w);
  }

  /// Troubles end at `calm_s`; returns when all is done, or never.
  bool Run(double calm_s, double limit_s) {
    for (; now_s_ < limit_s; now_s_ += kStep_s) {
      if (now_s_ < calm_s) {
        Trouble();
      } else {
        weather_ = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, weather_.lies};  // a liar goes on lying
      }
      Deliver();
      StepWorkers();
      if (StepCoordinator()) return true;
    }
    return false;
  }

  void Check() const {
    for (int c = 0; c < campaigns_; ++c) {
      const std::uint64_t settled = disks_[c].rows.size() + quarantined_at_end_[c];
      // Lies that were found out, and quarantined cases, may have put a decision off, and never
      // brought it about.
      if (stops_[c] && (weather_.lies > 0.0 || quarantined_at_end_[c] > 0))
        ASSERT_GE(settled, cases_[c]);
      else
        ASSERT_EQ(settled, cases_[c]);
      for (const auto& [case_index, result] : disks_[c].rows)
        ASSERT_EQ(Fingerprint(result), Fingerprint(ResultOf(case_index)));
    }
    ASSERT_EQ(conflicts_, 0u);
  }
  double now_s() const { return now_s_; }
  std::string Tell() const {
    std::string text;
    for (int c = 0; c < campaigns_; ++c) {
      text += std::to_string(disks_[c].rows.size()) + "/" + std::to_string(cases_[c]) + " stored, " +
              std::to_string(books_[c]->ledger().Progress().total) + " wanted, " +
              std::to_string(books_[c]->ledger().Progress().done) + " done; ";
    }
    for (const auto& [slot, worker] : workers_) {
      const WorkerStatus status = worker.desk->Status(WorkerState::kReady);
      text += worker.name + " holds " + std::to_string(status.held.size()) + ", flies " +
              std::to_string(worker.flying.size()) + "; ";
    }
    return text;
  }

 private:
  using Message = std::variant<WorkerStatus, Report, TextRequest, CampaignRefusal, Orders, TextPart>;
  struct Packet {
    double due_s;
    std::string from, to;  ///< connections; "" is the coordinator
    Message message;
  };
  struct Flight {
    Job job;
    double ends_s;
  };
  struct SimWorker {
    std::string name, connection;
    std::unique_ptr<FlightDesk> desk;
    std::vector<Flight> flying;
    double frozen_until_s = 0.0;
    bool deaf = false, dumb = false;  ///< until it makes a new connection
    std::uint32_t slots = 1;
    bool lies = false;
  };
  struct Audited {
    double due_s;
    std::string flight_id;
    Claim claim;
  };

  Campaign CampaignOf(int c) const { return stops_[c] ? CampaignThatStops(c) : CampaignNumber(c, cases_[c]); }
  int Draw(int n) { return static_cast<int>(chance_() % static_cast<unsigned>(n)); }
  bool Happens(double probability) {
    return probability > 0.0 && std::uniform_real_distribution<>(0.0, 1.0)(chance_) < probability;
  }

  void StartCoordinator() {
    ++epoch_;
    books_.clear();
    audited_.clear();
    const AuditOptions audit = {weather_.lies > 0.0 ? 1.0 : 0.0, epoch_};
    dispatcher_ = std::make_unique<Dispatcher>(epoch_, EngineVersion(), DispatcherOptions{.audit = audit});
    for (int c = 0; c < campaigns_; ++c) {
      books_.push_back(std::make_unique<CampaignBook>(
          CampaignOf(c), std::make_unique<DiskStore>(disks_[c]),
          LedgerOptions{.lease_s = 20.0, .attempt_base = static_cast<std::uint64_t>(c) << 32}));
      dispatcher_->BeginCampaign(*books_.back(), c % 2);
    }
    coordinator_frozen_until_s_ = now_s_ + (epoch_ > 1 ? 0.1 * Draw(60) : 0.0);
  }
  void StartWorker(int slot) {
    SimWorker worker;
    worker.name = "w" + std::to_string(slot) + "n" + std::to_string(++incarnations_);
    worker.slots = 1 + static_cast<std::uint32_t>(Draw(2));
    worker.desk = std::make_unique<FlightDesk>(
        FlightDeskOptions{.worker = worker.name, .engine_version = EngineVersion(), .slots = worker.slots},
        now_s_);
    worker.connection = worker.name + "c0";
    worker.lies = weather_.lies > 0.0 && slot > 0 && Happens(0.5);  // one slot's workers are honest
    workers_[slot] = std::move(worker);
  }

  void Trouble() {
    if (Happens(weather_.coordinator_death)) StartCoordinator();
    if (Happens(weather_.freeze)) coordinator_frozen_until_s_ = now_s_ + 0.1 * Draw(100);
    for (auto& [slot, worker] : workers_) {
      if (Happens(weather_.freeze)) worker.frozen_until_s = now_s_ + 0.1 * Draw(100);
      if (Happens(weather_.freeze)) worker.deaf = true;
      if (Happens(weather_.freeze)) worker.dumb = true;
      if (Happens(weather_.worker_death)) StartWorker(slot);
    }
  }

  void Send(const std::string& from, const std::string& to, Message message) {
    const int copies = Happens(weather_.loss) ? 0 : Happens(weather_.repetition) ? 2 : 1;
    for (int i = 0; i < copies; ++i) {
      const double delay_s = std::uniform_real_distribution<>(0.0, weather_.worst_delay_s + 1e-3)(chance_);
      packets_.push_back({now_s_ + delay_s, from, to, message});
    }
  }

  void Deliver() {
    std::vector<Packet> due;
    std::erase_if(packets_, [&](Packet& packet) {
      if (packet.due_s > now_s_) return false;
      due.push_back(std::move(packet));
      return true;
    });
    std::shuffle(due.begin(), due.end(), chance_);
    for (Packet& packet : due) {
      if (packet.to.empty()) {
        if (coordinator_frozen_until_s_ > now_s_) {
          packet.due_s = coordinator_frozen_until_s_;
          packets_.push_back(std::move(packet));
        } else {
          ToCoordinator(packet);
        }
        continue;
      }
      for (auto& [slot, worker] : workers_) {
        if (worker.deaf || (worker.connection != packet.to && worker.name != packet.to)) continue;
        if (const auto* orders = std::get_if<Orders>(&packet.message)) worker.desk->On(*orders, now_s_);
        if (const auto* part = std::get_if<TextPart>(&packet.message)) worker.desk->On(*part, now_s_);
      }
    }
  }
  void ToCoordinator(const Packet& packet) {
    if (const auto* status = std::get_if<WorkerStatus>(&packet.message))
      dispatcher_->On(packet.from, *status, clock_s_);
    if (const auto* report = std::get_if<Report>(&packet.message))
      dispatcher_->On(packet.from, *report, clock_s_);
    if (const auto* refusal = std::get_if<CampaignRefusal>(&packet.message)) {
      dispatcher_->On(packet.from, *refusal, clock_s_);
    }
    if (const auto* request = std::get_if<TextRequest>(&packet.message)) {
      if (const auto part = dispatcher_->On(*request, kTextPart, clock_s_)) Send("", part->worker, *part);
    }
  }

  void StepWorkers() {
    for (auto& [slot, worker] : workers_) {
      if (worker.frozen_until_s > now_s_) continue;
      FlightDesk& desk = *worker.desk;
      std::erase_if(worker.flying, [&](Flight& flight) {
        if (flight.ends_s > now_s_) return false;
        CaseResult result = ResultOf(flight.job.case_index);
        if (worker.lies && Happens(weather_.lies)) result.metrics[0] += 1.0;
        desk.Done(flight.job, std::move(result), now_s_);
        return true;
      });
      while (const auto text = desk.TakeText()) {
        const bool whole = text->text == CampaignNumber(text->flight_id.back() - '0', 1).canonical_yaml;
        desk.Loaded(text->flight_id, nullptr, whole ? "" : "half a text");
      }
      while (worker.flying.size() < worker.slots) {
        auto job = desk.Next(now_s_);
        if (!job) break;
        worker.flying.push_back({*std::move(job), now_s_ + 0.02 * Draw(100)});
      }
      for (Report& report : desk.TakeReports(now_s_)) Say(worker, std::move(report));
      const FlightDesk::Due due = desk.Tick(now_s_);
      if (due.new_connection) {
        worker.connection = worker.name + "c" + std::to_string(++connections_);
        worker.deaf = worker.dumb = false;
      }
      if (due.status) Say(worker, *due.status);
      for (const Report& report : due.reports) Say(worker, report);
      for (const TextRequest& request : due.text_requests) Say(worker, request);
      for (const CampaignRefusal& refusal : due.refusals) Say(worker, refusal);
    }
    for (auto& [slot, worker] : workers_) {
      if (!worker.desk->refusal().empty())
        StartWorker(slot);  // expelled: it ends, and somebody starts it again
    }
  }

  void Say(const SimWorker& worker, Message message) {
    if (!worker.dumb) Send(worker.connection, "", std::move(message));
  }

  bool StepCoordinator() {
    if (coordinator_frozen_until_s_ > now_s_) return false;
    clock_s_ += kStep_s;  // stands still while it is frozen, as Coordinator's clock does
    dispatcher_->TakeClaims([this](const Campaign& campaign, std::vector<Claim> claims) {
      for (Claim& claim : claims)
        audited_.push_back({clock_s_ + 0.02 * Draw(100), campaign.flight_id, std::move(claim)});
    });
    std::vector<Audited> due;
    std::erase_if(audited_, [&](Audited& each) {
      if (each.due_s > clock_s_) return false;
      due.push_back(std::move(each));
      return true;
    });
    for (const Audited& each : due)
      dispatcher_->Audited(each.flight_id, each.claim, Fingerprint(ResultOf(each.claim.case_index)));
    for (Orders& orders : dispatcher_->Tick(clock_s_)) {
      const std::string to = orders.worker;
      Send("", to, std::move(orders));
    }
    bool complete = true;
    for (const auto& book : books_) complete = complete && book->Complete();
    if (!complete) return false;
    quarantined_at_end_.clear();
    for (const auto& book : books_) {
      book->Flush();
      conflicts_ += book->ledger().Progress().conflicts;
      quarantined_at_end_.push_back(book->ledger().Progress().quarantined);
    }
    return true;
  }

  std::mt19937_64 chance_;
  Weather weather_;
  int campaigns_;
  std::vector<bool> stops_;  ///< when it is decided
  std::vector<std::uint64_t> cases_;
  std::vector<Disk> disks_;
  double now_s_ = 0.0, clock_s_ = 0.0;
  std::uint64_t epoch_ = 0;
  int incarnations_ = 0, connections_ = 0;
  double coordinator_frozen_until_s_ = 0.0;
  std::vector<std::unique_ptr<CampaignBook>> books_;
  std::unique_ptr<Dispatcher> dispatcher_;
  std::map<int, SimWorker> workers_;
  std::vector<Packet> packets_;
  std::vector<Audited> audited_;
  std::vector<std::uint64_t> quarantined_at_end_;
  std::uint64_t conflicts_ = 0;
};

std::uint64_t Worlds() {
  const char* text = std::getenv("DISPERSA_SIMULATED_WORLDS");
  return text == nullptr ? 2000 : std::strtoull(text, nullptr, 10);
}

TEST(Simulation, EveryWorldComesToItsEndSoonAfterItsTroubles) {
  SetLogLevel(LogLevel::kNothing);
  constexpr double kCalm_s = 20.0;
  // Delays that may be under way when the faults end: a lease of 20 s, a connection renewed after 30 s, and
  // both once more.
  constexpr double kLimit_s = kCalm_s + 120.0;
  double latest_s = 0.0;
  for (std::uint64_t seed = 1; seed <= Worlds(); ++seed) {
    std::mt19937_64 chance(seed * 977);
    const auto up_to = [&](double most) {
      return chance() % 3 == 0 ? 0.0 : std::uniform_real_distribution<>(0.0, most)(chance);
    };
    Weather weather = {up_to(0.6), up_to(0.3), up_to(3.0), up_to(0.02), up_to(0.02), up_to(0.01), 0.0};
    weather.lies = up_to(1.0);
    World world(seed, weather);
    ASSERT_TRUE(world.Run(kCalm_s, kLimit_s)) << "world " << seed << " hangs: " << world.Tell();
    world.Check();
    ASSERT_FALSE(testing::Test::HasFailure()) << "world " << seed;
    latest_s = std::max(latest_s, world.now_s());
  }
  RecordProperty("latest_s", std::to_string(latest_s));
  SetLogLevel(LogLevel::kInfo);
}

}  // namespace dispersa::simulation_test
