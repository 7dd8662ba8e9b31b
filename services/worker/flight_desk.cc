#include "services/worker/flight_desk.h"

#include <algorithm>
#include <utility>

#include "core/math/assertion.h"

namespace dispersa {
namespace {

constexpr std::size_t kKnownCampaigns = 8;
constexpr std::size_t kMaxAnnounced = 64;
constexpr std::size_t kMaxFlownInReport = 128;  // about 130 kB
constexpr std::size_t kRepeatedAtOnce = 64;     // reports
constexpr double kGatherAtMost_s = 0.1;
constexpr double kMeanWeight = 0.1;  // of the newest flight

}  // namespace

FlightDesk::FlightDesk(const FlightDeskOptions& options, double now_s)
    : options_(options),
      status_due_s_(now_s),
      heard_s_(now_s),
      connected_s_(now_s),
      patience_s_(options.deaf_s) {}

void FlightDesk::On(const Orders& orders, double now_s) {
  // Orders of a replaced coordinator are ignored while its successor is heard.
  if (orders.coordinator_epoch < epoch_ && IsHeard(now_s)) return;
  heard_s_ = now_s;
  patience_s_ = options_.deaf_s;
  for (const std::uint64_t number : orders.acknowledged) {
    const auto owed = owed_.find(number);
    if (owed == owed_.end()) continue;
    DISPERSA_ASSERT(unstored_ >= owed->second.report.flown.size(), unstored_, number);
    unstored_ -= owed->second.report.flown.size();
    if (owed->second.report.coordinator_epoch == epoch_) {
      for (const FlownCase& flown : owed->second.report.flown) {
        const auto attempt = attempts_.find(flown.attempt);
        if (attempt == attempts_.end()) continue;
        DISPERSA_ASSERT(attempt->second.unstored > 0, flown.attempt);
        --attempt->second.unstored;
        DropAttempt(attempt);
      }
    }
    owed_.erase(owed);
  }
  if (orders.coordinator_epoch != epoch_) Follow(orders.coordinator_epoch);
  if (!orders.refusal.empty()) refusal_ = orders.refusal;
  leave_ = leave_ || orders.leave;
  for (const std::uint64_t attempt : orders.revoked) Revoke(attempt);
  for (const FlyOrder& order : orders.assignments) Take(order);
}

// Another start of the coordinator, or another coordinator: it knows nothing of what the last one wanted.
void FlightDesk::Follow(std::uint64_t epoch) {
  epoch_ = epoch;
  queue_.clear();
  announced_.clear();
  attempts_.clear();
  flying_.clear();
  refused_.clear();
  status_due_s_ = heard_s_;
  // Half a text of the last one may not fit the half of this one.
  for (auto& [flight_id, campaign] : campaigns_) {
    if (!campaign.complete) campaign.text.text.clear(), campaign.requested_s.reset();
  }
}

void FlightDesk::Take(const FlyOrder& order) {
  if (draining_ || attempts_.contains(order.attempt)) return;
  KnownCampaign& campaign = campaigns_[order.flight_id];
  campaign.used = ++uses_;
  if (!campaign.problem.empty()) {
    refused_.insert(order.flight_id);
    return;
  }
  attempts_[order.attempt].unflown = order.cases.size();
  for (const std::uint64_t case_index : order.cases) {
    queue_.push_back({nullptr, order.flight_id, epoch_, order.attempt, case_index});
  }
  Forget();
}

void FlightDesk::Revoke(std::uint64_t revoked) {
  const auto attempt = attempts_.find(revoked);
  if (attempt == attempts_.end()) return;
  attempt->second.unflown -= std::erase_if(queue_, [&](const Job& job) { return job.attempt == revoked; });
  DropAttempt(attempt);
}

void FlightDesk::DropAttempt(std::map<std::uint64_t, Attempt>::iterator attempt) {
  if (attempt->second.unflown == 0 && attempt->second.unstored == 0) attempts_.erase(attempt);
}

// Campaigns without a case held here are forgotten, except the few that were used last.
void FlightDesk::Forget() {
  while (campaigns_.size() > kKnownCampaigns) {
    auto oldest = campaigns_.end();
    for (auto known = campaigns_.begin(); known != campaigns_.end(); ++known) {
      const auto is_of = [&](const Job& job) { return job.flight_id == known->first; };
      if (std::any_of(queue_.begin(), queue_.end(), is_of)) continue;
      if (oldest == campaigns_.end() || known->second.used < oldest->second.used) oldest = known;
    }
    if (oldest == campaigns_.end()) return;
    campaigns_.erase(oldest);
  }
}

void FlightDesk::On(const TextPart& part, double now_s) {
  heard_s_ = now_s;
  const auto found = campaigns_.find(part.flight_id);
  if (found == campaigns_.end() || found->second.complete || part.offset != found->second.text.text.size())
    return;
  KnownCampaign& campaign = found->second;
  if (part.offset > 0 && part.size != campaign.size) return;
  campaign.size = part.size;
  campaign.text.flight_id = part.flight_id;
  campaign.text.name = part.name;
  campaign.text.engine_version = part.engine_version;
  campaign.text.text += part.bytes;
  campaign.requested_s.reset();
  campaign.complete = campaign.text.text.size() == campaign.size;
}

std::optional<CampaignText> FlightDesk::TakeText() {
  for (auto& [flight_id, campaign] : campaigns_) {
    if (!campaign.complete || campaign.taken) continue;
    campaign.taken = true;
    return std::move(campaign.text);
  }
  return std::nullopt;
}

void FlightDesk::Loaded(const std::string& flight_id, std::shared_ptr<const CampaignFlights> flights,
                        const std::string& problem, bool engine_fault) {
  const auto campaign = campaigns_.find(flight_id);
  if (campaign == campaigns_.end()) return;
  DISPERSA_ASSERT(problem.empty() || flights == nullptr);
  campaign->second.ready = problem.empty();
  campaign->second.flights = std::move(flights);
  campaign->second.problem = problem;
  campaign->second.engine_fault = engine_fault;
  if (problem.empty()) return;
  refused_.insert(flight_id);
  std::erase_if(queue_, [&](const Job& job) {
    if (job.flight_id != flight_id) return false;
    if (const auto attempt = attempts_.find(job.attempt); attempt != attempts_.end()) {
      --attempt->second.unflown;
      DropAttempt(attempt);
    }
    return true;
  });
}

std::optional<Job> FlightDesk::Next(double now_s) {
  if (announced_.empty() && !Announce(now_s)) {
    Finish(now_s);  // there is no start to travel with
    return std::nullopt;
  }
  Job job = std::move(announced_.front());
  announced_.pop_front();
  job.started_s = now_s;
  flying_.emplace(job.attempt, job.case_index);
  ++in_flight_;
  return job;
}

// Moves the first case that can be flown, and those behind it that take no time, from the queue to the
// announced.
bool FlightDesk::Announce(double now_s) {
  if (draining_ || unstored_ >= options_.max_unstored) return false;
  const auto first = std::find_if(queue_.begin(), queue_.end(), [this](const Job& job) {
    const auto campaign = campaigns_.find(job.flight_id);
    return campaign != campaigns_.end() && campaign->second.ready;
  });
  if (first == queue_.end()) return false;
  const std::string flight_id = first->flight_id;
  const KnownCampaign& campaign = campaigns_[flight_id];
  std::size_t count = 1;
  if (mean_flight_s_ > 0.0 && mean_flight_s_ < options_.announce_s) {
    count = std::min(kMaxAnnounced, static_cast<std::size_t>(options_.announce_s / mean_flight_s_));
  }
  if (next_.flight_id != flight_id || next_.coordinator_epoch != epoch_ ||
      next_.flown.size() >= kMaxFlownInReport) {
    Finish(now_s);
  }
  next_.flight_id = flight_id;
  next_.coordinator_epoch = epoch_;
  for (auto job = first; count > 0 && job != queue_.end() && job->flight_id == flight_id; --count) {
    job->flights = campaign.flights;
    next_.started.push_back({job->case_index, job->attempt});
    announced_.push_back(std::move(*job));
    job = queue_.erase(job);
  }
  Finish(now_s);
  return true;
}

// Makes a report of the gathered results.
void FlightDesk::Finish(double now_s) {
  Report report = std::exchange(next_, {});
  report.worker = options_.worker;
  if (report.flown.empty()) {
    if (!report.started.empty()) starts_.push_back(std::move(report));
    return;
  }
  report.number = next_number_++;
  ready_.push_back(report.number);
  owed_[report.number] = {std::move(report), std::nullopt, now_s};
}

void FlightDesk::Done(const Job& job, CaseResult result, double now_s) {
  Give(job, {job.attempt, std::move(result)}, now_s);
}

void FlightDesk::Quarantined(const Job& job, const std::string& reason, double now_s) {
  FlownCase flown{job.attempt, {}, true};
  flown.result.case_index = job.case_index;
  flown.result.reason = reason;
  Give(job, std::move(flown), now_s);
}

void FlightDesk::Give(const Job& job, FlownCase flown, double now_s) {
  const double seconds = now_s - job.started_s;
  mean_flight_s_ =
      mean_flight_s_ == 0.0 ? seconds : mean_flight_s_ + kMeanWeight * (seconds - mean_flight_s_);
  ++flown_;
  DISPERSA_ASSERT(in_flight_ > 0, job.case_index);
  --in_flight_;
  if (job.coordinator_epoch == epoch_) {
    if (const auto flying = flying_.find({job.attempt, job.case_index}); flying != flying_.end())
      flying_.erase(flying);
    if (const auto attempt = attempts_.find(job.attempt); attempt != attempts_.end()) {
      DISPERSA_ASSERT(attempt->second.unflown > 0, job.attempt);
      --attempt->second.unflown;
      ++attempt->second.unstored;
    }
  }
  if (!next_.flown.empty() &&
      (next_.flight_id != job.flight_id || next_.coordinator_epoch != job.coordinator_epoch ||
       next_.flown.size() >= kMaxFlownInReport)) {
    Finish(now_s);
  }
  next_.flight_id = job.flight_id;
  next_.coordinator_epoch = job.coordinator_epoch;
  if (next_.flown.empty()) gathered_s_ = now_s;
  next_.flown.push_back(std::move(flown));
  ++unstored_;
}

std::vector<Report> FlightDesk::TakeReports(double now_s) {
  std::vector<Report> reports = std::exchange(starts_, {});
  for (const std::uint64_t number : std::exchange(ready_, {})) {
    Owed& owed = owed_.at(number);
    owed.sent_s = now_s;
    reports.push_back(owed.report);
  }
  return reports;
}

FlightDesk::Due FlightDesk::Tick(double now_s) {
  Due due;
  if (now_s >= status_due_s_) {
    status_due_s_ = now_s + options_.status_s;
    due.status = Status(draining_        ? WorkerState::kDraining
                        : in_flight_ > 0 ? WorkerState::kFlying
                                         : WorkerState::kReady);
  }
  // Results that would be sent with the start of a next case do not wait for a case that takes long.
  if (!next_.flown.empty() && now_s - gathered_s_ > kGatherAtMost_s) Finish(now_s);
  due.reports = TakeReports(now_s);
  // Messages to a coordinator that does not answer are lost. When it answers again, all are repeated.
  if (IsHeard(now_s)) {
    for (auto& [number, owed] : owed_) {
      if (due.reports.size() >= kRepeatedAtOnce) break;
      if (!owed.sent_s || now_s - *owed.sent_s < options_.repeat_s) continue;
      owed.sent_s = now_s;
      due.reports.push_back(owed.report);
      due.reports.back().started.clear();
    }
    for (auto& [flight_id, campaign] : campaigns_) {
      const bool wanted = std::any_of(queue_.begin(), queue_.end(),
                                      [id = &flight_id](const Job& job) { return job.flight_id == *id; });
      if (!wanted || campaign.complete ||
          (campaign.requested_s && now_s - *campaign.requested_s < options_.repeat_s))
        continue;
      campaign.requested_s = now_s;
      due.text_requests.push_back({options_.worker, flight_id, campaign.text.text.size()});
    }
    for (const std::string& flight_id : std::exchange(refused_, {})) {
      const KnownCampaign& campaign = campaigns_[flight_id];
      due.refusals.push_back({options_.worker, epoch_, flight_id, campaign.problem, campaign.engine_fault});
    }
  }
  const bool deaf = now_s - std::max(heard_s_, connected_s_) > patience_s_;
  // The worker hears the coordinator, but is not heard: its repeated messages are not acknowledged.
  const bool dumb = !owed_.empty() && IsHeard(now_s) && now_s - connected_s_ > 2 * options_.longest_deaf_s &&
                    now_s - owed_.begin()->second.made_s > 2 * options_.longest_deaf_s;
  if (deaf || dumb) {
    due.new_connection = true;
    connected_s_ = now_s;
    if (deaf) patience_s_ = std::min(2 * patience_s_, options_.longest_deaf_s);
    status_due_s_ = now_s;
  }
  return due;
}

WorkerStatus FlightDesk::Status(WorkerState state) const {
  WorkerStatus status;
  status.worker = options_.worker;
  status.engine_version = options_.engine_version;
  status.slots = options_.slots;
  status.credits = options_.slots * (options_.lanes + 1);  // for each slot one waits while the lanes fly
  status.state = state;
  status.flown = flown_;
  status.coordinator_epoch = epoch_;
  for (const auto& [attempt, what] : attempts_) status.held.push_back(attempt);
  for (const auto& [attempt, case_index] : flying_) status.started.push_back({case_index, attempt});
  if (!draining_) {
    for (const Job& job : announced_) status.started.push_back({job.case_index, job.attempt});
  }
  return status;
}

void FlightDesk::Drain() {
  draining_ = true;
  for (std::deque<Job>* jobs : {&queue_, &announced_}) {
    for (const Job& job : *jobs) {
      if (const auto attempt = attempts_.find(job.attempt); attempt != attempts_.end()) {
        --attempt->second.unflown;
        DropAttempt(attempt);
      }
    }
    jobs->clear();
  }
  status_due_s_ = 0.0;
}

bool FlightDesk::IsIdle() const {
  return queue_.empty() && announced_.empty() && in_flight_ == 0 && owed_.empty() && next_.flown.empty();
}

}  // namespace dispersa
