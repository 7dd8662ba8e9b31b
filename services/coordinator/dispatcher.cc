#include "services/coordinator/dispatcher.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/cases/plugin_check.h"
#include "core/input/printable.h"
#include "core/math/assertion.h"
#include "core/results/fingerprint.h"
#include "services/log/log.h"
#include "services/transport/complaints.h"

namespace dispersa {
namespace {

constexpr double kExpirePeriod_s = 1.0;
/// In one message, so that it fits into a few datagrams.
constexpr std::size_t kMaxAcknowledged = 4096;
constexpr std::size_t kMaxRemembered = 1000;
constexpr std::uint32_t kCreditsPerSlot = 32;  // more than a slot with the widest lanes asks for
constexpr std::size_t kFaultyWorkers = 2;      // with so many a fault is no machine's: the campaign ends

}  // namespace

Dispatcher::Dispatcher(std::uint64_t epoch, std::string engine_version, const DispatcherOptions& options)
    : epoch_(epoch), engine_version_(std::move(engine_version)), options_(options) {
  DISPERSA_ASSERT(epoch != 0);
}

void Dispatcher::BeginCampaign(CampaignBook& book, int priority) {
  FlyingCampaign& campaign = campaigns_[book.campaign().result_id()];
  DISPERSA_ASSERT(campaign.book == nullptr || campaign.book == &book);
  campaign.book = &book;
  campaign.priority = priority;
  book.Guard([&] {
    book.KeepAudit(options_.audit);
    for (const auto& [id, worker] : workers_) book.ledger().Join(id, worker.hello, worker.heard_s);
  });
}

void Dispatcher::EndCampaign(const std::string& flight_id) {
  const auto found = campaigns_.find(flight_id);
  if (found == campaigns_.end()) return;
  Acknowledge(found->second);
  campaigns_.erase(found);
  // Cases of it that a worker still holds are revoked when the worker's status reports them.
  for (auto& [id, worker] : workers_) {
    worker.ForgetSent(flight_id);
    std::erase_if(worker.orders.assignments,
                  [&](const FlyOrder& order) { return order.flight_id == flight_id; });
  }
}

void Dispatcher::On(const std::string& sender, const WorkerStatus& status, double now_s) {
  if (ended_.contains(status.worker)) return;
  if (const auto why = WhyExpelled(expelled_, status.worker, status.host)) {
    TellRefusal(status.worker, *why);
    return;
  }
  if (const auto refused = refused_.find(status.worker); refused != refused_.end()) {
    TellRefusal(status.worker, refused->second);
    return;
  }
  if (status.coordinator_epoch > epoch_) {
    LeaveToYounger(status.worker, now_s);
    return;
  }
  led_by_younger_.erase(status.worker);
  const auto known = workers_.find(status.worker);
  if (known != workers_.end() && known->second.sender != sender) {
    // A worker that renewed its connection, or another process that uses its name while it runs.
    if (!known->second.sender_gone && now_s - known->second.heard_s <= options_.silence_s) {
      Disagree(sender, "it speaks for worker " + status.worker + " of another participant");
      return;
    }
    known->second.sender = sender;
    known->second.sender_gone = false;
  }
  if (status.state == WorkerState::kLeft) {
    if (!supervised_.contains(status.worker)) Lose(status.worker, WorkerEnd::kLeft, "it left");
    return;
  }
  if (!Join(sender, status, now_s)) return;
  Compare(workers_.at(status.worker), status, now_s);
}

// Another host took our place. This worker ignores our orders while it hears the younger coordinator. Empty
// orders let it come back when that one is silent.
void Dispatcher::LeaveToYounger(const std::string& worker, double now_s) {
  led_s_ = now_s;
  const bool is_news = led_by_younger_.size() < kMaxRemembered && led_by_younger_.insert(worker).second;
  if (workers_.contains(worker)) Lose(worker, WorkerEnd::kLeft, "it follows a younger coordinator");
  if (is_news) {
    LogWarning(
        "worker {} follows a coordinator that was started later, and gets no cases here: if another host "
        "took "
        "over, stop this coordinator",
        worker);
  }
  TellRefusal(worker, "");
}

bool Dispatcher::Join(const std::string& sender, const WorkerStatus& status, double now_s) {
  auto known = workers_.find(status.worker);
  if (known == workers_.end()) {
    if (status.engine_version != engine_version_) {
      Refuse(status.worker, "engine version " + Printable(status.engine_version) +
                                " of the worker differs from the coordinator's " + engine_version_);
      return false;
    }
    if (workers_.size() >= options_.max_workers) {
      Disagree(sender, "there are " + std::to_string(options_.max_workers) + " workers already");
      return false;
    }
    known = workers_.try_emplace(status.worker).first;
    known->second.sender = sender;
    known->second.orders.worker = status.worker;
    known->second.orders.coordinator_epoch = epoch_;
    known->second.last_orders_s = now_s - options_.pulse_s;
    known->second.last_report_s = now_s;
    if (!supervised_.contains(status.worker)) {
      LogInfo("worker {} joined: process {} on {}, {} slots", status.worker, status.pid,
              Printable(status.host), status.slots);
    }
  }
  Worker& worker = known->second;
  worker.host = status.host;
  worker.state = status.state;
  worker.flown = status.flown;
  worker.heard_s = now_s;
  const std::int64_t unreported = static_cast<std::int64_t>(status.flown) - worker.results;
  if (!worker.unreported || unreported < *worker.unreported || status.held.empty())
    worker.unreported = unreported;
  worker.report_due_s = unreported > *worker.unreported ? options_.report_silence_s
                        : status.held.empty() || !status.started.empty()
                            ? std::numeric_limits<double>::infinity()
                            : options_.load_silence_s;
  // The number of credits is limited, whatever the worker says: cases must be left for others.
  worker.hello = {status.engine_version, status.slots,
                  std::min(status.credits, kCreditsPerSlot * status.slots)};
  ForEach([&](const std::string&, FlyingCampaign& campaign) {
    if (!campaign.refused_by.contains(status.worker) && !campaign.faulty.contains(status.worker))
      campaign.book->ledger().Join(status.worker, worker.hello, now_s);
  });
  return true;
}

void Dispatcher::Refuse(const std::string& worker, const std::string& reason) {
  LogError("worker {} is refused: {}", worker, reason);
  refusal_ = reason;
  if (refused_.size() < kMaxRemembered) refused_[worker] = reason;
  TellRefusal(worker, reason);
}

void Dispatcher::RefuseKeys(const std::string& worker) {
  const std::string reason = "its keys are revoked";
  if (workers_.contains(worker)) {
    Lose(worker, WorkerEnd::kKilled, reason);
    ForEach([&](const std::string&, FlyingCampaign& campaign) { campaign.book->Disown(worker); });
  }
  Refuse(worker, reason);
}

void Dispatcher::TakeClaims(const OnClaims& fly) {
  ForEach([&](const std::string&, FlyingCampaign& campaign) {
    fly(campaign.book->campaign(), campaign.book->TakeClaims());
  });
}

void Dispatcher::Audited(const std::string& flight_id, const Claim& claim, const Digest& truth) {
  const auto campaign = campaigns_.find(flight_id);
  if (campaign == campaigns_.end()) return;  // closed meanwhile
  ++audits_;
  bool agrees = true;
  campaign->second.book->Guard([&] { agrees = campaign->second.book->Settle(claim, truth); });
  if (agrees) return;
  Expel(Sentence(expelled_, claim.worker, claim.host.empty() ? HostOf(claim.worker) : claim.host,
                 "case " + std::to_string(claim.case_index) + " of campaign " +
                     campaign->second.book->campaign().name +
                     ", flown again by the coordinator, gives other bits than the worker returned"));
}

std::string Dispatcher::HostOf(const std::string& worker) const {
  const auto known = workers_.find(worker);
  return known == workers_.end() || known->second.host.empty() ? "unknown" : known->second.host;
}

void Dispatcher::Expel(const ExpulsionMap& names, bool is_news) {
  for (const auto& [name, expulsion] : names) {
    if (!expelled_.emplace(name, expulsion).second) continue;
    if (is_news) LogError("{} may not fly here any more: {}", Printable(name), expulsion.reason);
    refusal_ = expulsion.reason;
    std::vector<std::string> workers;
    for (const auto& [id, worker] : workers_) {
      if (IsMeantBy(name, id, worker.host)) workers.push_back(id);
    }
    for (const std::string& worker : workers) {
      TellRefusal(worker, expulsion.reason);
      Lose(worker, WorkerEnd::kKilled, "expelled");
    }
    ForEach([&name = name](const std::string&, FlyingCampaign& campaign) { campaign.book->Disown(name); });
  }
}

void Dispatcher::TellRefusal(const std::string& worker, const std::string& reason) {
  Orders orders;
  orders.worker = worker;
  orders.coordinator_epoch = epoch_;
  orders.refusal = reason;
  refusals_.push_back(std::move(orders));
}

// Compares the cases that the worker holds with those it was given. Only here are lost messages found and
// replaced.
void Dispatcher::Compare(Worker& worker, const WorkerStatus& status, double now_s) {
  const std::string& id = status.worker;
  const bool follows = status.coordinator_epoch == epoch_;
  const std::set<std::uint64_t> held(follows ? status.held.begin() : status.held.end(), status.held.end());
  std::map<std::string, std::vector<std::uint64_t>> begun;  // cases, by flight id
  if (follows) {
    for (const StartedCase& started : status.started) {
      const auto sent = worker.sent.find(started.attempt);
      if (sent == worker.sent.end()) continue;
      const auto campaign = campaigns_.find(sent->second.flight_id);
      if (campaign == campaigns_.end()) continue;
      CampaignBook& book = *campaign->second.book;
      book.Guard([&] { book.Start(id, started.case_index, started.attempt, now_s); });
      begun[sent->second.flight_id].push_back(started.case_index);
    }
  }
  for (auto sent = worker.sent.begin(); sent != worker.sent.end();) {
    const auto here = sent++;
    if (held.contains(here->first)) continue;
    const auto campaign = campaigns_.find(here->second.flight_id);
    std::vector<std::uint64_t> owed;
    if (campaign != campaigns_.end()) owed = campaign->second.book->ledger().Owed(id, here->first);
    if (owed.empty()) {
      worker.sent.erase(here);
    } else if (now_s - here->second.at_s >= options_.repeat_s) {
      GiveOrder(worker, here->second.flight_id, here->first, std::move(owed), now_s);
    }
  }
  worker.orders.revoked.clear();
  for (const std::uint64_t attempt : held) {
    if (!worker.sent.contains(attempt)) worker.orders.revoked.push_back(attempt);
  }
  ForEach([&](const std::string& flight_id, FlyingCampaign& campaign) {
    Ledger& ledger = campaign.book->ledger();
    if (status.state == WorkerState::kDraining) ledger.Withdraw(id, begun[flight_id]);
    if (held.empty() && status.started.empty()) ledger.Idle(id);
  });
}

std::vector<const FlownCase*> Dispatcher::On(const std::string& sender, const Report& report, double now_s) {
  if (ended_.contains(report.worker)) return {};
  const auto known = workers_.find(report.worker);
  // A worker that has not joined will report again when it has.
  if (known == workers_.end()) return {};
  if (known->second.sender != sender) {
    Disagree(sender, "it reports for worker " + report.worker + " of another participant");
    return {};
  }
  known->second.heard_s = known->second.last_report_s = now_s;
  known->second.results += static_cast<std::int64_t>(report.flown.size());
  const auto campaign = campaigns_.find(report.flight_id);
  if (campaign == campaigns_.end()) {
    known->second.orders.acknowledged.push_back(report.number);  // nobody wants it any more
    return {};
  }
  std::vector<const FlownCase*> accepted;
  campaign->second.book->Guard(
      [&] { Take(sender, report, known->second, campaign->second, accepted, now_s); });
  return accepted;
}

void Dispatcher::Take(const std::string& sender, const Report& report, Worker& worker,
                      FlyingCampaign& campaign, std::vector<const FlownCase*>& accepted, double now_s) {
  // Results for an earlier coordinator are as good as any; its assignments mean nothing.
  const bool follows = report.coordinator_epoch == epoch_;
  CampaignBook& book = *campaign.book;
  for (const FlownCase& flown : report.flown) {
    if (flown.is_quarantined && !book.campaign().autopilot.plugin) {
      Disagree(sender, "it quarantines a case although the campaign has no plug-in");
      continue;
    }
    if (flown.is_quarantined) {
      book.Quarantine(report.worker, flown.result.case_index, follows ? flown.attempt : 0,
                      Printable(flown.result.reason, 1000), now_s);
      continue;
    }
    if (!MayReturn(sender, report, flown, book)) {
      if (!workers_.contains(report.worker)) return;  // expelled
      continue;
    }
    const Acceptance acceptance =
        book.Accept(report.worker, worker.host, follows ? flown.attempt : 0, flown.result, now_s);
    if (acceptance == Acceptance::kAccepted) {
      accepted.push_back(&flown);
      worker.is_known = true;
    }
  }
  if (!report.flown.empty()) campaign.unstored.emplace_back(report.worker, report.number);
  if (!follows) return;
  for (const StartedCase& started : report.started) {
    book.Start(report.worker, started.case_index, started.attempt, now_s);
  }
}

bool Dispatcher::MayReturn(const std::string& sender, const Report& report, const FlownCase& flown,
                           CampaignBook& book) {
  const std::uint64_t case_index = flown.result.case_index;
  if (!book.ledger().WasGiven(report.worker, case_index)) {
    // A report whose acknowledgement got lost, or of cases that an earlier coordinator gave: they are flown
    // again.
    if (book.ledger().IsResult(case_index, Fingerprint(flown.result))) return true;
    if (report.coordinator_epoch == epoch_)
      Disagree(sender, "it returns case " + std::to_string(case_index) + ", which it was not given");
    return false;
  }
  const bool is_drawn_so = book.IsDrawnSo(flown.result);
  if (is_drawn_so && book.HasItsMetrics(flown.result)) return true;
  Disagree(sender, is_drawn_so ? "a result has other metrics than its campaign"
                               : "a result has other inputs than its case");
  Expel(Sentence(expelled_, report.worker, HostOf(report.worker),
                 "case " + std::to_string(case_index) + " of campaign " + book.campaign().name +
                     (is_drawn_so ? ": its metrics are not those of the campaign"
                                  : ": its inputs are not those that the campaign draws")));
  return false;
}

void Dispatcher::On(const std::string& sender, const CampaignRefusal& refusal, double now_s) {
  const auto campaign = campaigns_.find(refusal.flight_id);
  const auto known = workers_.find(refusal.worker);
  if (campaign == campaigns_.end() || known == workers_.end() || refusal.coordinator_epoch != epoch_) return;
  if (known->second.sender != sender) {
    Disagree(sender, "it refuses a campaign for worker " + refusal.worker + " of another participant");
    return;
  }
  known->second.heard_s = known->second.last_report_s = now_s;
  const std::string reason = Printable(refusal.reason, 1000);
  CampaignBook& book = *campaign->second.book;
  const LogAbout about(book.campaign().id);
  if (refusal.engine_fault) {
    NoteFault(refusal, reason, campaign->second, known->second);
  } else {
    if (!campaign->second.refused_by.emplace(refusal.worker, reason).second) return;
    LogError("worker {} refuses the campaign {}: {}", refusal.worker, book.campaign().name, reason);
    refusal_ = reason;
  }
  book.Guard([&] { book.ledger().Lost(refusal.worker, WorkerEnd::kLeft, reason); });
  known->second.ForgetSent(refusal.flight_id);
}

// One worker may have bad memory, or another library. What two of them find is the program's: a third would
// find the same, or worse, another result.
void Dispatcher::NoteFault(const CampaignRefusal& refusal, const std::string& reason,
                           FlyingCampaign& campaign, Worker& worker) {
  worker.is_faulty = true;
  if (!campaign.faulty.insert(refusal.worker).second) return;
  LogError("worker {} leaves with a fault of its own in the campaign {}: {}", refusal.worker,
           campaign.book->campaign().name, reason);
  if (campaign.faulty.size() >= kFaultyWorkers) campaign.book->Break(reason);
}

void Dispatcher::Break(const std::string& flight_id, const std::string& fault) {
  if (const auto campaign = campaigns_.find(flight_id); campaign != campaigns_.end())
    campaign->second.book->Break(fault);
}

std::string Dispatcher::FlightIdOf(const std::string& result_id) const {
  const auto campaign = campaigns_.find(result_id);
  return campaign == campaigns_.end() ? "" : campaign->second.book->campaign().flight_id;
}

std::optional<std::string> Dispatcher::RefusalByAll(const std::string& flight_id) const {
  const auto campaign = campaigns_.find(flight_id);
  if (campaign == campaigns_.end()) return std::nullopt;
  std::vector<std::string> reasons;
  for (const auto& [id, worker] : workers_) {
    if (worker.is_faulty) continue;  // it leaves: others take its place
    const auto refused = campaign->second.refused_by.find(id);
    if (refused == campaign->second.refused_by.end()) return std::nullopt;
    reasons.push_back(refused->second);
  }
  if (reasons.empty()) return std::nullopt;
  // Others may lack leave to fly any law.
  const auto of_law = std::find_if(reasons.begin(), reasons.end(), IsOfTheLaw);
  return of_law == reasons.end() ? reasons.front() : *of_law;
}

std::optional<TextPart> Dispatcher::On(const TextRequest& request, std::size_t limit, double now_s) {
  const auto campaign = campaigns_.find(request.flight_id);
  const auto known = workers_.find(request.worker);
  if (campaign == campaigns_.end() || known == workers_.end()) return std::nullopt;
  known->second.last_report_s = now_s;
  const Campaign& what = campaign->second.book->campaign();
  if (request.offset > what.canonical_yaml.size()) return std::nullopt;
  return TextPart{request.worker,
                  request.flight_id,
                  what.name,
                  engine_version_,
                  what.canonical_yaml.size(),
                  request.offset,
                  what.canonical_yaml.substr(request.offset, limit)};
}

bool Dispatcher::ReceivesReports(double now_s) const {
  if (led_s_ && now_s - *led_s_ <= options_.silence_s) return true;  // they fly for another coordinator
  return std::any_of(workers_.begin(), workers_.end(), [now_s](const auto& each) {
    return now_s - each.second.last_report_s <= each.second.report_due_s;
  });
}

void Dispatcher::Gone(const std::string& sender) {
  for (auto& [id, worker] : workers_) {
    if (worker.sender == sender) worker.sender_gone = true;
  }
}

void Dispatcher::Supervise(const std::string& worker) { supervised_.insert(worker); }

void Dispatcher::WorkerEnded(const std::string& worker, WorkerEnd end, const std::string& reason,
                             double now_s) {
  endings_.push_back({now_s + options_.last_messages_s, worker, end, reason});
}

std::vector<std::string> Dispatcher::TakeUnresponsive() {
  std::vector<std::string> taken(unresponsive_.begin(), unresponsive_.end());
  unresponsive_.clear();
  return taken;
}

std::vector<std::string> Dispatcher::TakeForgotten() { return std::exchange(forgotten_, {}); }

std::vector<Orders> Dispatcher::Tick(double now_s) {
  ForEach([&](const std::string&, FlyingCampaign& campaign) {
    if (campaign.book->FlushIfDue(now_s)) Acknowledge(campaign);
  });
  const auto due = std::stable_partition(endings_.begin(), endings_.end(),
                                         [&](const Ending& ending) { return ending.due_s > now_s; });
  const std::vector<Ending> ended(due, endings_.end());
  endings_.erase(due, endings_.end());
  for (const Ending& ending : ended) Lose(ending.worker, ending.end, ending.reason);
  LoseSilent(now_s);
  Expire(now_s);
  if (!dismissed_) Assign(now_s);

  std::vector<Orders> messages = std::exchange(refusals_, {});
  for (auto& [id, worker] : workers_) {
    Orders& orders = worker.orders;
    orders.leave = dismissed_;
    const bool something =
        !orders.assignments.empty() || !orders.revoked.empty() || !orders.acknowledged.empty();
    if (!something && now_s - worker.last_orders_s < options_.pulse_s) continue;
    worker.last_orders_s = now_s;
    Orders message = orders;
    orders.assignments.clear();
    orders.revoked.clear();
    orders.acknowledged.clear();
    if (message.acknowledged.size() > kMaxAcknowledged) {
      orders.acknowledged.assign(message.acknowledged.begin() + kMaxAcknowledged, message.acknowledged.end());
      message.acknowledged.resize(kMaxAcknowledged);
    }
    messages.push_back(std::move(message));
  }
  return messages;
}

void Dispatcher::Dismiss() {
  dismissed_ = true;
  for (auto& [id, worker] : workers_) worker.last_orders_s = -options_.pulse_s;
}

void Dispatcher::LoseSilent(double now_s) {
  std::vector<std::string> silent;
  for (const auto& [id, worker] : workers_) {
    if (now_s - worker.heard_s > options_.silence_s) silent.push_back(id);
  }
  for (const std::string& id : silent) {
    if (supervised_.contains(id)) {
      unresponsive_.insert(id);
      workers_.at(id).heard_s = now_s;  // said once; again if it is still there then
    } else {
      // It may come back: then its status lets it join again.
      Lose(id, WorkerEnd::kSilent, "its worker fell silent");
    }
  }
}

void Dispatcher::Expire(double now_s) {
  if (now_s - expired_s_ < kExpirePeriod_s) return;
  expired_s_ = now_s;
  ForEach([&](const std::string& flight_id, FlyingCampaign& campaign) {
    for (const std::string& stuck : campaign.book->ledger().Expire(now_s)) {
      LogWarning("worker {} has reported nothing for too long; its cases return to the queue", stuck);
      if (supervised_.contains(stuck)) unresponsive_.insert(stuck);
      if (const auto worker = workers_.find(stuck); worker != workers_.end())
        worker->second.ForgetSent(flight_id);
    }
  });
}

void Dispatcher::Assign(double now_s) {
  // One assignment a worker in turn, so that few cases spread over all workers. First to those that have
  // flown something: the last cases go to no stranger.
  for (bool given = true; given;) {
    given = false;
    for (const bool is_known : {true, false}) {
      for (auto& [id, worker] : workers_)
        if (worker.is_known == is_known) given = AssignTo(id, worker, now_s) || given;
    }
  }
}

bool Dispatcher::AssignTo(const std::string& id, Worker& worker, double now_s) {
  if (worker.is_faulty) return false;
  std::uint64_t batches = 0;
  std::vector<FlyingCampaign*> by_right;
  for (auto& [flight_id, campaign] : campaigns_) {
    if (campaign.book->ledger().IsAlone(id)) return false;
    batches += campaign.book->ledger().Batches(id);
    by_right.push_back(&campaign);
  }
  if (batches >= worker.hello.credits) return false;
  if (by_right.size() > 1) {
    // First by priority; of equal ones, that which has the least in flight.
    std::map<const FlyingCampaign*, std::uint64_t> assigned;
    for (const FlyingCampaign* campaign : by_right)
      assigned[campaign] = campaign->book->ledger().Progress().assigned;
    std::stable_sort(by_right.begin(), by_right.end(), [&](const FlyingCampaign* a, const FlyingCampaign* b) {
      return a->priority != b->priority ? a->priority > b->priority : assigned[a] < assigned[b];
    });
  }
  for (FlyingCampaign* campaign : by_right) {
    if (!campaign->book->pause().empty() || !campaign->book->breakdown().empty()) continue;
    bool given = false;
    campaign->book->Guard([&] {
      Ledger& ledger = campaign->book->ledger();
      auto assignment = ledger.GiveTo(id, batches - ledger.Batches(id), now_s);
      if (!assignment) return;
      given = true;
      GiveOrder(worker, campaign->book->campaign().result_id(), assignment->attempt,
                std::move(assignment->cases), now_s);
    });
    if (given) return true;
  }
  return false;
}

void Dispatcher::GiveOrder(Worker& worker, const std::string& flight_id, std::uint64_t attempt,
                           std::vector<std::uint64_t> cases, double now_s) {
  DISPERSA_ASSERT(!cases.empty() && campaigns_.contains(flight_id), attempt);
  worker.sent[attempt] = {flight_id, now_s};
  worker.orders.assignments.push_back({flight_id, attempt, std::move(cases)});
}

void Dispatcher::Acknowledge(FlyingCampaign& campaign) {
  for (const auto& [id, report] : std::exchange(campaign.unstored, {})) {
    if (const auto worker = workers_.find(id); worker != workers_.end()) {
      worker->second.orders.acknowledged.push_back(report);
    }
  }
}

void Dispatcher::Worker::ForgetSent(const std::string& flight_id) {
  std::erase_if(sent, [&](const auto& each) { return each.second.flight_id == flight_id; });
}

void Dispatcher::Lose(const std::string& worker, WorkerEnd end, const std::string& reason) {
  // A fault of the program is no case's, however its process ends.
  if (const auto found = workers_.find(worker); found != workers_.end() && found->second.is_faulty)
    end = WorkerEnd::kLeft;
  const bool known = workers_.erase(worker) > 0;
  const bool supervised = supervised_.erase(worker) > 0;
  if (supervised) ended_.insert(worker);
  unresponsive_.erase(worker);
  ForEach([&](const std::string&, FlyingCampaign& campaign) {
    std::erase_if(campaign.unstored, [&](const auto& report) { return report.first == worker; });
    campaign.book->ledger().Lost(worker, end, reason);
  });
  forgotten_.push_back(worker);
  if (!known || supervised || led_by_younger_.contains(worker)) return;
  if (end == WorkerEnd::kLeft) {
    LogInfo("worker {} left", worker);
  } else {
    LogWarning("worker {} is lost: {}", worker, reason);
  }
}

std::vector<Dispatcher::WorkerView> Dispatcher::Workers() const {
  std::vector<WorkerView> views;
  for (const auto& [id, worker] : workers_) {
    views.push_back({id, worker.host, worker.hello.slots, worker.state, worker.flown});
  }
  return views;
}

void Dispatcher::Disagree(const std::string& sender, const std::string& what) {
  ++refused_messages_;
  Complain("message", sender, what);
}

}  // namespace dispersa
