#include "services/worker/worker.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "core/campaign_yaml/load.h"
#include "core/engine/version.h"

namespace dispersa {
namespace {

constexpr std::chrono::seconds kStatusPeriod(1);
constexpr std::chrono::seconds kFarewell(1);
constexpr std::size_t kClosedCampaigns = 4;

std::string HostName() {
  char name[256] = "";
  gethostname(name, sizeof name - 1);
  return name;
}

template <typename... F>
struct Overloaded : F... {
  using F::operator()...;
};

}  // namespace

Worker::Worker(const WorkerOptions& options)
    : options_(options), link_(std::make_unique<WorkerLink>(options.network, options.peer, options.uuid)) {}

WorkerExit Worker::Run() {
  // Detached: a flight cannot be interrupted, so nobody could wait for them.
  for (std::uint32_t i = 0; i < options_.slots; ++i) std::thread([this] { FlyForEver(); }).detach();
  SendStatus(WorkerState::kStarting);
  auto status_due = std::chrono::steady_clock::now() + kStatusPeriod;
  for (;;) {
    std::optional<WorkerExit> exit;
    for (const WorkerEvent& event : link_->Wait(kStatusPeriod)) {
      std::visit(Overloaded{[this](const CampaignDefinition& campaign) { Load(campaign); },
                            [this](const CampaignClosed& closed) { Close(closed); },
                            [this](const FlyOrder& order) { Enqueue(order); },
                            [&](const LeaveOrder&) { exit = WorkerExit::kTold; },
                            [&](const Refusal& refusal) {
                              spdlog::error("refused by the coordinator: {}", refusal.reason);
                              exit = WorkerExit::kRefused;
                            },
                            [](const Wakened&) {}},
                 event);
    }
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) exit = WorkerExit::kStopped;
    }
    if (exit) return Leave(*exit);
    if (const auto now = std::chrono::steady_clock::now(); now >= status_due) {
      SendStatus();
      status_due = now + kStatusPeriod;
    }
  }
}

void Worker::Stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  if (link_) link_->Wake();
}

void Worker::Load(const CampaignDefinition& definition) {
  std::string reason;
  try {
    if (definition.engine_version != EngineVersion()) {
      reason = "engine version " + definition.engine_version +
               " of the coordinator differs from the worker's " + EngineVersion();
    } else {
      const Campaign campaign = ParseCampaign(definition.canonical_yaml, definition.name);
      if (campaign.flight_id == definition.flight_id) {
        const CampaignKey key(definition.flight_id, definition.coordinator_epoch);
        campaigns_[key] = std::make_shared<LoadedCampaign>(definition.coordinator_epoch, campaign);
        std::erase(closed_, key);
      } else {
        reason = "flight id " + definition.flight_id + " of the coordinator differs from the worker's " +
                 campaign.flight_id;
      }
    }
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (!reason.empty()) {
    spdlog::error("campaign {} is refused: {}", definition.name, reason);
    link_->Send(CampaignRefusal{options_.uuid, definition.coordinator_epoch, definition.flight_id, reason});
    return;
  }
  const auto orders = std::exchange(early_orders_, {});
  for (const FlyOrder& order : orders) Enqueue(order);
}

void Worker::Close(const CampaignClosed& closed) {
  // A coordinator that was only out of reach seems closed too. When it is heard again its orders come, but not
  // its opening: the middleware knows that it was delivered. So the campaign is kept for a while.
  const CampaignKey key(closed.flight_id, closed.coordinator_epoch);
  if (campaigns_.contains(key) && std::find(closed_.begin(), closed_.end(), key) == closed_.end()) {
    closed_.push_back(key);
  }
  if (closed_.size() > kClosedCampaigns) {
    campaigns_.erase(closed_.front());
    closed_.pop_front();
  }
  std::erase_if(early_orders_, [&](const FlyOrder& order) {
    return order.flight_id == closed.flight_id && order.coordinator_epoch == closed.coordinator_epoch;
  });
}

void Worker::Enqueue(const FlyOrder& order) {
  const auto campaign = campaigns_.find({order.flight_id, order.coordinator_epoch});
  if (campaign == campaigns_.end()) {
    early_orders_.push_back(order);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    for (const std::uint64_t case_index : order.cases) {
      jobs_.push_back({campaign->second, case_index, order.attempt});
    }
  }
  work_.notify_all();
}

void Worker::FlyForEver() {
  Report report;
  report.worker = options_.uuid;
  std::unique_lock lock(mutex_);
  for (;;) {
    if (jobs_.empty() && !report.flown.empty()) {
      link_->Send(report);  // nothing to travel with
      report.flown.clear();
    }
    work_.wait(lock, [this] { return !jobs_.empty() && !stopping_; });
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    if (!report.flown.empty() && (report.flight_id != job.campaign->flight_id ||
                                  report.coordinator_epoch != job.campaign->coordinator_epoch)) {
      link_->Send(report);
      report.flown.clear();
    }
    report.coordinator_epoch = job.campaign->coordinator_epoch;
    report.flight_id = job.campaign->flight_id;
    report.started = {{job.case_index, job.attempt}};
    // Sent before the flight, so that the coordinator knows what to blame if this process ends in it.
    link_->Send(report);
    report.started.clear();
    report.flown.clear();
    const auto flying = flying_.insert(job.case_index);

    lock.unlock();
    CaseResult result = job.campaign->flights.FlyCase(job.case_index);
    lock.lock();

    flying_.erase(flying);
    ++flown_;
    report.flown.push_back({job.attempt, std::move(result)});
    // Once stopping, the connection may be gone at any time.
    work_.wait(lock, [this] { return !stopping_; });
  }
}

void Worker::SendStatus(std::optional<WorkerState> state) {
  WorkerStatus status;
  {
    const std::lock_guard lock(mutex_);
    status.flown = flown_;
    status.started_cases.assign(flying_.begin(), flying_.end());
    status.state = state.value_or(flying_.empty() ? WorkerState::kReady : WorkerState::kFlying);
  }
  status.worker = options_.uuid;
  status.host = HostName();
  status.pid = static_cast<std::uint32_t>(getpid());
  status.engine_version = EngineVersion();
  status.slots = options_.slots;
  status.credits = options_.slots + 1;  // one waits while the slots fly
  link_->Send(status);
}

WorkerExit Worker::Leave(WorkerExit exit) {
  SendStatus(WorkerState::kLeaving);
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  link_->Drain(kFarewell);
  const std::lock_guard lock(mutex_);
  link_.reset();
  return exit;
}

}  // namespace dispersa
