#include "services/coordinator/coordinator.h"

#include <algorithm>
#include <random>
#include <utility>

#include "core/flight/engine_version.h"
#include "services/coordinator/service.h"
#include "services/program/exit_code.h"

namespace dispersa {
namespace {

constexpr std::chrono::milliseconds kFarewell(500);
/// Longer rounds count as this long: a process that was stopped, or a machine that slept, must not take what
/// it did not hear meanwhile for silence.
constexpr double kLongestRound_s = 0.5;
/// The state of a conversation with a client is dropped if the client asks nothing for this time.
constexpr double kClientPatience_s = 30.0;
constexpr std::size_t kMaxClients = 256;
constexpr std::size_t kTextPart = 256 << 10;

std::uint64_t Draw() {
  std::random_device device;
  return std::uint64_t{device()} << 32 | device();
}

}  // namespace

// Everybody learns the epoch. Nobody learns which results are audited.
Coordinator::Coordinator(const NetworkOptions& network, std::optional<double> audit_share,
                         std::uint64_t epoch)
    : epoch_(epoch),
      dispatcher_(epoch_, EngineVersion(),
                  {.audit = {audit_share.value_or(kUsualAuditShare), Draw(), audit_share.has_value()}}),
      link_(network) {
  if (dispatcher_.audit().share > 0.0) auditor_.emplace();
  if (network.keys) revocations_.emplace(*network.keys);
}

Coordinator::Coordinator(const NetworkOptions& network, CampaignBook& book, std::optional<double> audit_share)
    : Coordinator(network, audit_share) {
  dispatcher_.BeginCampaign(book);
}

void Coordinator::Step(std::chrono::milliseconds timeout) {
  const std::vector<CoordinatorEvent> events = link_.Wait(timeout);
  Advance();
  for (const CoordinatorEvent& event : events) Handle(event);
  if (auditor_) {
    dispatcher_.TakeClaims([this](const Campaign& campaign, std::vector<Claim> claims) {
      auditor_->Fly(campaign, std::move(claims));
    });
    for (const Auditor::Verdict& verdict : auditor_->Take())
      dispatcher_.Audited(verdict.flight_id, verdict.claim, verdict.truth);
    for (const Auditor::Fault& fault : auditor_->TakeFaults()) dispatcher_.Break(fault.flight_id, fault.what);
  }
  if (revocations_) revocations_->RefreshIfDue();
  Send(dispatcher_.Tick(now_s_));
  for (const std::string& forgotten : dispatcher_.TakeForgotten()) link_.Forget(forgotten);
  ForgetClients();
}

void Coordinator::Answer(const Request& request) {
  if (!answer_) return;
  if (!clients_.contains(request.client) && clients_.size() >= kMaxClients) return;  // it asks again
  clients_[request.client] = now_s_;
  link_.Send(answer_(request));
}

void Coordinator::ForgetClients() {
  std::erase_if(clients_, [this](const auto& client) {
    if (now_s_ - client.second < kClientPatience_s) return false;
    link_.Forget(client.first);
    return true;
  });
}

void Coordinator::Advance() {
  const auto now = std::chrono::steady_clock::now();
  now_s_ += std::min(std::chrono::duration<double>(now - last_).count(), kLongestRound_s);
  last_ = now;
}

void Coordinator::RefuseRevoked(const CoordinatorEvent& event) {
  if (const auto* request = std::get_if<Request>(&event.what)) {
    link_.Send({request->client, request->number, kExitBadInput, "the keys of this client are revoked", ""});
    clients_[request->client] = now_s_;
  } else if (const auto* status = std::get_if<WorkerStatus>(&event.what)) {
    dispatcher_.RefuseKeys(status->worker);
  }
}

void Coordinator::Handle(const CoordinatorEvent& event) {
  if (revocations_ && revocations_->IsOf(event.sender)) return RefuseRevoked(event);
  if (const auto* request = std::get_if<TextRequest>(&event.what)) {
    if (const auto part = dispatcher_.On(*request, kTextPart, now_s_)) link_.Send(*part);
  } else if (const auto* asked = std::get_if<Request>(&event.what)) {
    Answer(*asked);
  } else if (std::holds_alternative<SenderGone>(event.what)) {
    dispatcher_.Gone(event.sender);
  } else if (const auto* status = std::get_if<WorkerStatus>(&event.what)) {
    dispatcher_.On(event.sender, *status, now_s_);
  } else if (const auto* refusal = std::get_if<CampaignRefusal>(&event.what)) {
    dispatcher_.On(event.sender, *refusal, now_s_);
  } else if (const auto* report = std::get_if<Report>(&event.what)) {
    const std::vector<const FlownCase*> accepted = dispatcher_.On(event.sender, *report, now_s_);
    if (accepted.empty() || !link_.HasResultObservers()) return;
    for (const FlownCase* flown : accepted)
      link_.Publish(dispatcher_.FlightIdOf(report->flight_id), report->worker, *flown);
  }
}

void Coordinator::Send(const std::vector<Orders>& messages) {
  for (const Orders& orders : messages) link_.Send(orders);
}

void Coordinator::Dismiss() {
  dispatcher_.Dismiss();
  const std::vector<Orders> messages = dispatcher_.Tick(now_s_);
  Send(messages);
  for (const Orders& orders : messages) link_.Drain(orders.worker, kFarewell);
}

void Coordinator::Publish(CampaignProgress progress) {
  progress.coordinator_epoch = epoch_;
  progress.workers = static_cast<std::uint32_t>(joined());
  link_.Publish(progress);
}

}  // namespace dispersa
