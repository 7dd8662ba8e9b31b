#include "services/coordinator/coordinator.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "core/engine/version.h"

namespace dispersa {
namespace {

constexpr double kLastMessages_s = 0.2;
constexpr double kExpirePeriod_s = 1.0;
constexpr std::chrono::milliseconds kFarewell(500);

}  // namespace

Coordinator::Coordinator(const NetworkOptions& network, CampaignBook& book)
    : epoch_(static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count())),
      book_(book),
      link_(network) {
  const Campaign& campaign = book.campaign();
  link_.OpenCampaign(
      {epoch_, campaign.id, campaign.flight_id, EngineVersion(), campaign.name, campaign.canonical_yaml});
}

void Coordinator::Step(std::chrono::milliseconds timeout) {
  for (const CoordinatorEvent& event : link_.Wait(timeout)) {
    std::visit([this](const auto& what) { On(what); }, event);
  }
  const double now_s = Now();
  const auto due = std::stable_partition(endings_.begin(), endings_.end(),
                                         [&](const Ending& ending) { return ending.due_s > now_s; });
  const std::vector<Ending> ended(due, endings_.end());
  endings_.erase(due, endings_.end());
  for (const Ending& ending : ended) Lose(ending.worker, ending.end, ending.reason);

  if (now_s - expired_s_ >= kExpirePeriod_s) {
    expired_s_ = now_s;
    for (const std::string& stuck : book_.ledger().Expire(now_s)) {
      spdlog::warn("worker {} has reported nothing for too long; its cases return to the queue", stuck);
      if (supervised_.contains(stuck)) unresponsive_.insert(stuck);
    }
  }
  for (Assignment& assignment : book_.ledger().Assign(now_s)) {
    link_.Send(assignment.worker,
               FlyOrder{epoch_, book_.campaign().flight_id, assignment.attempt, std::move(assignment.cases)});
  }
  book_.FlushIfDue(now_s);
}

void Coordinator::Supervise(const std::string& worker) { supervised_.insert(worker); }

void Coordinator::WorkerEnded(const std::string& worker, WorkerEnd end, const std::string& reason) {
  endings_.push_back({Now() + kLastMessages_s, worker, end, reason});
}

std::vector<std::string> Coordinator::TakeUnresponsive() {
  std::vector<std::string> taken(unresponsive_.begin(), unresponsive_.end());
  unresponsive_.clear();
  return taken;
}

void Coordinator::Dismiss() {
  for (const auto& [worker, host] : joined_) link_.Send(worker, LeaveOrder{epoch_});
  for (const auto& [worker, host] : joined_) link_.Drain(worker, kFarewell);
  link_.CloseCampaign(book_.campaign().flight_id);
}

void Coordinator::On(const WorkerStatus& status) {
  if (banned_.contains(status.worker)) return;
  if (status.state == WorkerState::kLeaving) {
    if (!supervised_.contains(status.worker)) Lose(status.worker, WorkerEnd::kLeft, "it left");
    return;
  }
  const auto refusal =
      book_.ledger().Join(status.worker, {status.engine_version, status.slots, status.credits}, Now());
  if (refusal) {
    spdlog::error("worker {} (process {} on {}) is refused: {}", status.worker, status.pid, status.host,
                  *refusal);
    link_.Refuse({status.worker, *refusal});
    refusal_ = refusal;
    banned_.insert(status.worker);
    return;
  }
  if (status.started_cases.empty()) book_.ledger().Idle(status.worker);
  if (joined_.insert_or_assign(status.worker, status.host).second && !supervised_.contains(status.worker)) {
    spdlog::info("worker {} joined: process {} on {}, {} slots", status.worker, status.pid, status.host,
                 status.slots);
  }
}

void Coordinator::On(const Report& report) {
  // Results of an earlier coordinator are as good as any; its assignments mean nothing.
  if (report.flight_id != book_.campaign().flight_id) return;
  const double now_s = Now();
  const auto joined = joined_.find(report.worker);
  for (const FlownCase& flown : report.flown) {
    const std::uint64_t attempt = report.coordinator_epoch == epoch_ ? flown.attempt : 0;
    book_.Accept(report.worker, joined == joined_.end() ? "" : joined->second, attempt, flown.result, now_s);
  }
  if (report.coordinator_epoch != epoch_) return;
  for (const StartedCase& started : report.started) {
    book_.Start(report.worker, started.case_index, started.attempt, now_s);
  }
}

void Coordinator::On(const CampaignRefusal& refusal) {
  if (refusal.flight_id != book_.campaign().flight_id || refusal.coordinator_epoch != epoch_) return;
  spdlog::error("worker {} refuses the campaign: {}", refusal.worker, refusal.reason);
  refusal_ = refusal.reason;
  Lose(refusal.worker, WorkerEnd::kLeft, refusal.reason);
  banned_.insert(refusal.worker);
}

void Coordinator::On(const WorkerSilent& silent) {
  if (banned_.contains(silent.worker)) return;
  if (supervised_.contains(silent.worker)) {
    unresponsive_.insert(silent.worker);
  } else {
    // It may come back: then its status lets it join again.
    Lose(silent.worker, WorkerEnd::kSilent, "its worker fell silent");
  }
}

void Coordinator::On(const WorkerGone& gone) {
  if (!supervised_.contains(gone.worker)) Lose(gone.worker, WorkerEnd::kSilent, "its worker vanished");
}

void Coordinator::Lose(const std::string& worker, WorkerEnd end, const std::string& reason) {
  const bool known = joined_.erase(worker) > 0;
  const bool supervised = supervised_.erase(worker) > 0;
  if (supervised) banned_.insert(worker);
  unresponsive_.erase(worker);
  book_.ledger().Lost(worker, end, reason);
  link_.Forget(worker);
  if (known && !supervised) spdlog::warn("worker {} is lost: {}", worker, reason);
}

double Coordinator::Now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - origin_).count();
}

}  // namespace dispersa
