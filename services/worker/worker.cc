#include "services/worker/worker.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <thread>
#include <utility>

#include "core/campaign_yaml/load.h"
#include "core/cases/plugin_check.h"
#include "core/flight/engine_version.h"
#include "core/math/assertion.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

constexpr std::chrono::milliseconds kRound(50);
// Hundreds of workers wait on one machine. Messages of the coordinator wake them.
constexpr std::chrono::milliseconds kIdleRound(200);
constexpr std::chrono::milliseconds kFarewell(500);
constexpr double kSayAgain_s = 10.0;
/// A drained worker waits so long for its last results to be stored.
constexpr double kLastWords_s = 10.0;

std::string HostName() {
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  return name;
}

}  // namespace

Worker::Worker(const WorkerOptions& options)
    : options_(options),
      desk_({.worker = options.uuid, .engine_version = EngineVersion(), .slots = options.slots}, 0.0) {
  Connect();
}

WorkerExit Worker::Run() {
  // Detached: a flight cannot be interrupted, so waiting for these threads could take too long.
  for (std::uint32_t i = 0; i < options_.slots; ++i) std::thread([this] { FlyForEver(); }).detach();
  for (bool is_idle = false;;) {
    std::vector<WorkerEvent> events;
    if (link_) {
      events = link_->Wait(is_idle ? kIdleRound : kRound);
    } else {
      std::this_thread::sleep_for(kRound);
    }
    const double now_s = Now();
    FlightDesk::Due due;
    std::optional<CampaignText> text;
    {
      const Lock lock(mutex_);
      for (const WorkerEvent& event : events) {
        if (const auto* orders = std::get_if<Orders>(&event)) {
          desk_.On(*orders, now_s);
        } else {
          desk_.On(std::get<TextPart>(event), now_s);
        }
      }
      if (link_ && link_->HasMet()) desk_.Met(now_s);
      due = desk_.Tick(now_s);
      text = desk_.TakeText();
      is_idle = desk_.IsIdle() && !desk_.draining();
    }
    if (!events.empty()) work_.notify_all();
    // Apart from this thread, which must go on saying that it lives.
    if (text) std::thread([this, text = *std::move(text)] { Load(text); }).detach();
    Send(due);
    if (due.new_connection) Connect();
    if (const auto exit = Exit(now_s)) return Leave(*exit);
  }
}

void Worker::Drain() {
  const Lock lock(mutex_);
  desk_.Drain();
}

// Makes a new participant and resolves the peer's name again. Anything stuck in the old participant, on
// either side, is gone with it.
void Worker::Connect() {
  std::shared_ptr<WorkerLink> link;
  {
    const Lock lock(mutex_);
    link_.reset();
  }
  try {
    link = std::make_shared<WorkerLink>(options_.network, options_.peers, options_.uuid);
  } catch (const NetworkError& error) {
    LogWarning("{}; it is tried again", error.what());
  }
  const Lock lock(mutex_);
  link_ = std::move(link);
}

void Worker::Load(const CampaignText& text) {
  std::string problem, id;
  bool engine_fault = false;
  std::shared_ptr<const CampaignFlights> flights;
  try {
    if (text.engine_version != EngineVersion()) {
      problem = "engine version " + text.engine_version + " of the coordinator differs from the worker's " +
                EngineVersion();
    } else {
      const Campaign campaign = ParseCampaign(text.text, text.name);
      id = campaign.id;
      if (campaign.result_id() == text.flight_id) {
        flights = std::make_shared<CampaignFlights>(campaign);
        CheckPluginIsDeterministic(*flights, campaign.sampling.cases);
      } else {
        problem = "flight id " + text.flight_id + " of the coordinator differs from the worker's " +
                  campaign.result_id();
      }
    }
  } catch (const std::exception& error) {
    problem = error.what();
    engine_fault = dynamic_cast<const AssertionFailed*>(&error) != nullptr;
  }
  const LogAbout about(id);
  if (engine_fault) return Break(text.flight_id, problem);
  if (!problem.empty()) flights.reset();
  if (!problem.empty()) LogError("campaign {} is refused: {}", text.name, problem);
  {
    const Lock lock(mutex_);
    desk_.Loaded(text.flight_id, std::move(flights), problem);
  }
  work_.notify_all();
}

// The jobs of one campaign as the engine takes them; a job of another campaign waits until all lanes are
// free.
class Worker::SlotQueue : public CaseQueue {
 public:
  SlotQueue(Worker& worker, Job first) : worker_(worker), flights_(first.flights), next_(std::move(first)) {}

  const CampaignFlights& flights() const { return *flights_; }
  std::optional<Job> TakeOther() { return std::exchange(next_, std::nullopt); }

  std::optional<std::uint64_t> Next(bool) override {
    if (!next_) next_ = worker_.Next(false);
    if (!next_ || next_->flights != flights_) return std::nullopt;
    const std::uint64_t case_index = next_->case_index;
    flying_.push_back(*std::exchange(next_, std::nullopt));
    return case_index;
  }
  void Done(CaseResult result) override {
    const Job job = Take(result.case_index);
    worker_.Done(job, std::move(result));
  }
  void Quarantined(std::uint64_t case_index, const std::string& reason) override {
    worker_.Quarantined(Take(case_index), reason);
  }

 private:
  Job Take(std::uint64_t case_index) {
    const auto found = std::find_if(flying_.begin(), flying_.end(),
                                    [&](const Job& each) { return each.case_index == case_index; });
    DISPERSA_ASSERT(found != flying_.end(), case_index);
    Job job = std::move(*found);
    flying_.erase(found);
    return job;
  }

  Worker& worker_;
  std::shared_ptr<const CampaignFlights> flights_;
  std::optional<Job> next_;
  std::vector<Job> flying_;
};

void Worker::FlyForEver() {
  std::optional<Job> job = Next(true);
  while (job) {
    const std::string flight_id = job->flight_id;
    SlotQueue queue(*this, *std::move(job));
    try {
      queue.flights().FlyCases(queue);
    } catch (const AssertionFailed& fault) {
      return Break(flight_id, fault.what());
    }
    job = queue.TakeOther();
    if (!job) job = Next(true);
  }
}

void Worker::Break(const std::string& flight_id, const std::string& fault) {
  const Lock lock(mutex_);
  if (fault_.empty()) fault_ = fault;
  desk_.Loaded(flight_id, nullptr, fault, true);
}

std::optional<Job> Worker::Next(bool wait) {
  Lock lock(mutex_);
  for (;;) {
    std::optional<Job> job = closed_ ? std::nullopt : desk_.Next(Now());
    for (const Report& report : desk_.TakeReports(Now())) {
      if (link_) link_->Send(report);
    }
    if (job || !wait || closed_) return job;
    lock.Wait(work_);
  }
}

void Worker::Done(const Job& job, CaseResult result) {
  const Lock lock(mutex_);
  desk_.Done(job, std::move(result), Now());
}

void Worker::Quarantined(const Job& job, const std::string& reason) {
  const Lock lock(mutex_);
  desk_.Quarantined(job, reason, Now());
}

void Worker::Send(const FlightDesk::Due& due) {
  if (!link_) return;
  if (due.status) {
    WorkerStatus status = *due.status;
    status.host = HostName();
    status.pid = static_cast<std::uint32_t>(getpid());
    link_->Send(status);
  }
  for (const Report& report : due.reports) link_->Send(report);
  for (const TextRequest& request : due.text_requests) link_->Send(request);
  for (const CampaignRefusal& refusal : due.refusals) link_->Send(refusal);
}

std::optional<WorkerExit> Worker::Exit(double now_s) {
  const Lock lock(mutex_);
  if (desk_.IsHeard(now_s)) {
    if (told_s_ > 0.0) LogInfo("the coordinator at {} answers again", Where());
    heard_s_ = now_s;
    told_s_ = 0.0;
  } else if (now_s - std::max(heard_s_, told_s_) > kSayAgain_s) {
    told_s_ = now_s;
    LogWarning(
        "no coordinator has answered at {} for {:.0f} s; it is tried again. One that has as many workers as "
        "it serves says so in its own log",
        Where(), now_s - heard_s_);
  }
  if (!desk_.IsIdle()) busy_s_ = now_s;
  if (!desk_.refusal().empty()) {
    problem_ = fmt::format("refused by the coordinator: {}", desk_.refusal());
    return WorkerExit::kRefused;
  }
  if (desk_.left()) return WorkerExit::kTold;
  if (!fault_.empty()) {
    problem_ = fault_;
    return WorkerExit::kFault;
  }
  if (desk_.draining()) {
    if (draining_s_ == 0.0) draining_s_ = now_s;
    // Cases under way are finished. The worker waits until the results are stored, as long as a coordinator
    // is there to store them.
    if (desk_.IsIdle() ||
        (!desk_.IsFlying() && now_s - std::max(busy_since_drain_s_, draining_s_) > kLastWords_s)) {
      return WorkerExit::kDrained;
    }
    if (desk_.IsFlying()) busy_since_drain_s_ = now_s;
  }
  if (options_.patience_s && now_s - heard_s_ > *options_.patience_s) {
    problem_ = fmt::format("no coordinator has answered at {} for {:.0f} s; the worker ends", Where(),
                           now_s - heard_s_);
    return WorkerExit::kNoCoordinator;
  }
  if (options_.idle_exit_s && now_s - busy_s_ > *options_.idle_exit_s) return WorkerExit::kIdle;
  return std::nullopt;
}

WorkerExit Worker::Leave(WorkerExit exit) {
  FlightDesk::Due last, left;
  {
    const Lock lock(mutex_);
    closed_ = true;
    last = desk_.Tick(Now());
    last.status.reset();
    left.status = desk_.Status(WorkerState::kLeft);
  }
  work_.notify_all();
  Send(last);
  // Statuses have a socket of their own, and nobody listens to a worker that has left.
  if (link_ && exit == WorkerExit::kFault) link_->Drain(kFarewell);
  Send(left);
  if (link_) link_->Drain(kFarewell);
  const Lock lock(mutex_);
  link_.reset();
  return exit;
}

std::string Worker::Where() const {
  std::string text;
  for (const Peer& peer : options_.peers)
    text += fmt::format("{}{}:{}", text.empty() ? "" : " or ", peer.host, peer.port);
  return text;
}

double Worker::Now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - origin_).count();
}

}  // namespace dispersa
