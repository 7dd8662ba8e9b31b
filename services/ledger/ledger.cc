#include "services/ledger/ledger.h"

#include <algorithm>
#include <utility>

#include "core/math/assertion.h"

namespace dispersa {
namespace {

// A flight of the same campaign takes about as long as another; a factor of 20 over the longest seen is
// a hang and not a slow case on a busy machine.
constexpr double kLeasePerLongestCase = 20.0;
constexpr double kMeanWeight = 0.1;            // of the newest duration in the running mean
constexpr std::size_t kRememberedWorkers = 4;  // that a case was taken from

}  // namespace

Ledger::Ledger(std::string engine_version, std::uint64_t cases, const LedgerOptions& options)
    : engine_version_(std::move(engine_version)),
      options_(options),
      cases_(cases),
      next_attempt_(options.attempt_base + 1) {
  DISPERSA_ASSERT(options.blames_to_quarantine > 0 && options.first_assignments > 0,
                  options.blames_to_quarantine, options.first_assignments);
  DISPERSA_ASSERT(options.side_by_side > 0 && options.max_batch > 0, options.side_by_side, options.max_batch);
  DISPERSA_ASSERT(options.first_case <= cases, options.first_case, cases);
  waiting_.AddRange(options.first_case, cases);
  progress_.total = cases - options.first_case;
}

void Ledger::MarkDone(std::uint64_t case_index, const Digest& fingerprint) {
  DISPERSA_ASSERT(Has(case_index) && next_attempt_ == options_.attempt_base + 1, case_index, cases_.size());
  if (!waiting_.Remove(case_index)) return;
  cases_.SetDone(case_index, fingerprint);
  ++progress_.done;
  CheckSums();
}

void Ledger::CheckSums() const {
  DISPERSA_ASSERT(progress_.total == cases_.size() - options_.first_case, progress_.total, cases_.size());
  DISPERSA_ASSERT(
      progress_.done + progress_.quarantined + waiting_.Count() + suspects_.Count() <= progress_.total,
      progress_.done, progress_.quarantined, waiting_.Count(), suspects_.Count(), progress_.total);
}

void Ledger::RequireSecondFlight(std::uint64_t case_index, const std::string& flown_by) {
  DISPERSA_ASSERT(Has(case_index), case_index, cases_.size());
  DISPERSA_ASSERT(flown_by.empty() || cases_.StateOf(case_index) == CaseState::kDone, case_index);
  second_flights_[case_index].first = flown_by;
}

void Ledger::Extend(std::uint64_t cases) {
  DISPERSA_ASSERT(cases >= cases_.size(), cases, cases_.size());
  if (cases == cases_.size()) return;
  waiting_.AddRange(cases_.size(), cases);
  progress_.total += cases - cases_.size();
  cases_.Extend(cases);
  CheckSums();
}

void Ledger::Reopen(const std::vector<std::uint64_t>& cases) {
  for (const std::uint64_t case_index : cases) {
    if (!Has(case_index) || cases_.StateOf(case_index) != CaseState::kDone) continue;
    DISPERSA_ASSERT(progress_.done > 0, case_index);
    --progress_.done;
    if (const auto flight = second_flights_.find(case_index); flight != second_flights_.end())
      flight->second = {};
    if (IsHeld(case_index)) {
      cases_.Set(case_index, CaseState::kAssigned);
    } else {
      Return(case_index);
    }
  }
  CheckSums();
}

// A worker may hold a case that another one returned: it was taken from that one, or needs a second flight.
bool Ledger::IsHeld(std::uint64_t case_index) const {
  return std::any_of(workers_.begin(), workers_.end(),
                     [&](const auto& each) { return each.second.held.contains(case_index); });
}

bool Ledger::WasGiven(const std::string& worker, std::uint64_t case_index) const {
  const auto entry = workers_.find(worker);
  if (entry != workers_.end() && entry->second.held.contains(case_index)) return true;
  const auto taken = taken_from_.find(case_index);
  return taken != taken_from_.end() &&
         std::find(taken->second.begin(), taken->second.end(), worker) != taken->second.end();
}

bool Ledger::IsResult(std::uint64_t case_index, const Digest& fingerprint) const {
  return Has(case_index) && cases_.StateOf(case_index) == CaseState::kDone &&
         cases_.FingerprintOf(case_index) == fingerprint;
}

void Ledger::RememberGiven(const std::string& worker, std::uint64_t case_index) {
  std::vector<std::string>& workers = taken_from_[case_index];
  std::erase(workers, worker);
  if (workers.size() == kRememberedWorkers) workers.erase(workers.begin());
  workers.push_back(worker);
  DISPERSA_ASSERT(workers.size() <= kRememberedWorkers, case_index, workers.size());
}

std::optional<std::string> Ledger::Join(const std::string& worker, const WorkerHello& hello, double now_s) {
  if (hello.engine_version != engine_version_) {
    return "engine version " + hello.engine_version + " of the worker differs from the coordinator's " +
           engine_version_;
  }
  auto [entry, is_new] = workers_.try_emplace(worker);
  if (is_new) {
    entry->second.last_report_s = now_s;
  } else {
    DISPERSA_ASSERT(slots_ >= entry->second.hello.slots, slots_, entry->second.hello.slots);
    slots_ -= entry->second.hello.slots;
  }
  slots_ += hello.slots;
  entry->second.hello = hello;
  return std::nullopt;
}

void Ledger::Idle(const std::string& worker) {
  const auto entry = workers_.find(worker);
  if (entry != workers_.end()) entry->second.stuck = false;
}

void Ledger::Started(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                     double now_s) {
  const auto entry = workers_.find(worker);
  if (entry == workers_.end()) return;
  entry->second.last_report_s = now_s;
  entry->second.stuck = false;
  const auto held = entry->second.held.find(case_index);
  if (held == entry->second.held.end() || held->second.attempt != attempt) return;  // of a lease that expired
  if (!held->second.started_s) held->second.started_s = now_s;
}

void Ledger::Settle(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                    double now_s) {
  const auto entry = workers_.find(worker);
  if (entry != workers_.end()) {
    entry->second.last_report_s = now_s;
    entry->second.stuck = false;
    const auto held = entry->second.held.find(case_index);
    if (held != entry->second.held.end() && held->second.attempt == attempt) {
      if (held->second.started_s) {
        const double duration_s = now_s - *held->second.started_s;
        DISPERSA_ASSERT(duration_s >= 0.0, duration_s);
        longest_case_s_ = std::max(longest_case_s_, duration_s);
        mean_case_s_ =
            mean_case_s_ == 0.0 ? duration_s : mean_case_s_ + kMeanWeight * (duration_s - mean_case_s_);
      }
      Release(entry->second, held);
    }
  }
}

bool Ledger::Quarantine(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                        const std::string& reason, double now_s) {
  const auto entry = workers_.find(worker);
  if (!Has(case_index) || entry == workers_.end()) return false;
  const auto held = entry->second.held.find(case_index);
  // The case must be held by this attempt. Otherwise others fly it, or have flown it.
  if (held == entry->second.held.end() || held->second.attempt != attempt) return false;
  held->second.started_s.reset();  // how long it took says nothing of the others
  Settle(worker, case_index, attempt, now_s);
  const CaseState state = cases_.StateOf(case_index);
  if (const auto flight = second_flights_.find(case_index);
      flight != second_flights_.end() && state == CaseState::kDone && flight->second.first != worker) {
    return !std::exchange(flight->second.is_settled, true);
  }
  if (state == CaseState::kDone || state == CaseState::kQuarantined) return false;
  TakeOut(case_index, state);
  blames_[case_index].push_back(reason);
  quarantined_at_once_.insert(case_index);
  cases_.Set(case_index, CaseState::kQuarantined);
  ++progress_.quarantined;
  CheckSums();
  return false;
}

void Ledger::TakeOut(std::uint64_t case_index, CaseState state) {
  if (state != CaseState::kWaiting && state != CaseState::kSuspect) return;
  const bool was_there = (state == CaseState::kWaiting ? waiting_ : suspects_).Remove(case_index);
  DISPERSA_ASSERT(was_there, case_index);
}

Acceptance Ledger::Finished(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                            const Digest& fingerprint, double now_s) {
  Settle(worker, case_index, attempt, now_s);
  if (!Has(case_index)) return Acceptance::kUnknown;
  if (const auto entry = workers_.find(worker); entry != workers_.end()) {
    ++entry->second.returned;
    entry->second.last_returned_s = now_s;
    entry->second.slow = false;
  }
  const CaseState state = cases_.StateOf(case_index);
  const auto flight = second_flights_.find(case_index);
  if (state == CaseState::kDone) {
    if (flight != second_flights_.end() && flight->second.first != worker) flight->second.is_settled = true;
    if (cases_.FingerprintOf(case_index) != fingerprint) {
      ++progress_.conflicts;
      return Acceptance::kConflict;
    }
    ++progress_.duplicates;
    return Acceptance::kDuplicate;
  }
  TakeOut(case_index, state);
  if (state == CaseState::kQuarantined) {
    DISPERSA_ASSERT(progress_.quarantined > 0, case_index);
    --progress_.quarantined;
  }
  blames_.erase(case_index);
  quarantined_at_once_.erase(case_index);
  cases_.SetDone(case_index, fingerprint);
  if (flight != second_flights_.end()) flight->second.first = worker;
  ++progress_.done;
  CheckSums();
  return Acceptance::kAccepted;
}

void Ledger::Lost(const std::string& worker, WorkerEnd end, const std::string& reason) {
  const auto entry = workers_.find(worker);
  if (entry == workers_.end()) return;
  const bool blames = end == WorkerEnd::kCrashed || end == WorkerEnd::kSilent;
  DISPERSA_ASSERT(slots_ >= entry->second.hello.slots, slots_, entry->second.hello.slots);
  slots_ -= entry->second.hello.slots;
  const auto held = std::move(entry->second.held);
  workers_.erase(entry);
  for (const auto& [case_index, how] : held) {
    RememberGiven(worker, case_index);
    Drop(case_index, blames && how.started_s);
    if (cases_.StateOf(case_index) != CaseState::kAssigned) continue;  // another worker's result came
    if (blames && how.started_s) {
      Blame(case_index, reason);
    } else {
      Return(case_index);
    }
  }
  CheckSums();
}

std::vector<std::string> Ledger::Expire(double now_s) {
  const double lease_s = Lease();
  DISPERSA_ASSERT(lease_s > 0.0, lease_s);
  std::vector<std::string> stuck;
  for (auto& [id, worker] : workers_) {
    if (worker.held.empty()) continue;
    bool expired = now_s - worker.last_report_s > lease_s;
    for (const auto& [case_index, held] : worker.held) {
      expired = expired || (held.started_s && now_s - *held.started_s > lease_s);
    }
    if (!expired) continue;
    stuck.push_back(id);
    const auto held = std::move(worker.held);
    worker.held.clear();
    worker.batches.clear();
    worker.alone = false;
    worker.stuck = true;
    for (const auto& [case_index, how] : held) {
      RememberGiven(id, case_index);
      Drop(case_index, how.started_s && now_s - *how.started_s > lease_s);
      if (cases_.StateOf(case_index) != CaseState::kAssigned) continue;
      if (how.started_s && now_s - *how.started_s > lease_s) {
        Blame(case_index, "no result within its lease");
      } else {
        Return(case_index);
      }
    }
  }
  TakeBackOverdue(now_s);
  CheckSums();
  return stuck;
}

// The last cases of a campaign do not wait for a worker that is slow, or that never means to return them. A
// case that takes so long with everybody is then left to its second worker.
void Ledger::TakeBackOverdue(double now_s) {
  if (!waiting_.Empty() || !suspects_.Empty()) return;
  const bool is_somebody_idle = std::any_of(workers_.begin(), workers_.end(), [](const auto& each) {
    return each.second.held.empty() && !each.second.stuck && !each.second.slow && !each.second.leaving;
  });
  if (!is_somebody_idle) return;
  const double overdue_s = std::max(options_.overdue_s, kLeasePerLongestCase * longest_case_s_);
  for (auto& [id, worker] : workers_) {
    if (worker.alone || now_s - worker.last_returned_s <= overdue_s) continue;
    for (auto held = worker.held.begin(); held != worker.held.end();) {
      const auto here = held++;
      const std::uint64_t case_index = here->first;
      if (cases_.StateOf(case_index) != CaseState::kAssigned || taken_from_.contains(case_index)) continue;
      RememberGiven(id, case_index);
      Release(worker, here);
      Return(case_index);
      worker.slow = true;
    }
  }
}

bool Ledger::IsAnyoneQuick() const {
  return std::any_of(workers_.begin(), workers_.end(), [](const auto& each) {
    return !each.second.slow && !each.second.stuck && !each.second.leaving;
  });
}

std::vector<Assignment> Ledger::Assign(double now_s) {
  std::vector<Assignment> assignments;
  // One assignment a worker in turn, so that few cases spread over all workers.
  for (bool given = true; given && (!waiting_.Empty() || MayNeedSecondFlight());) {
    given = false;
    for (auto& [id, worker] : workers_) {
      if (waiting_.Empty() && !MayNeedSecondFlight()) break;
      if (auto assignment = GiveTo(id, 0, now_s)) {
        assignments.push_back(*std::move(assignment));
        given = true;
      }
    }
  }
  if (!waiting_.Empty()) return assignments;
  for (auto& [id, worker] : workers_) {
    if (suspects_.Empty()) break;
    if (auto assignment = GiveTo(id, 0, now_s)) assignments.push_back(*std::move(assignment));
  }
  return assignments;
}

std::optional<Assignment> Ledger::GiveTo(const std::string& worker, std::uint64_t elsewhere, double now_s) {
  const auto entry = workers_.find(worker);
  if (entry == workers_.end()) return std::nullopt;
  Worker& to = entry->second;
  // A worker may hold many cases only after it has returned many. Otherwise one worker could stop a campaign
  // by taking its cases.
  const std::uint64_t most =
      std::min<std::uint64_t>(to.hello.credits, options_.first_assignments + to.returned);
  if (to.stuck || to.leaving || to.alone || to.batches.size() + elsewhere >= most) return std::nullopt;
  if (to.slow && IsAnyoneQuick()) return std::nullopt;
  // First what may show that nothing more needs to be flown.
  if (std::vector<std::uint64_t> again = SecondFlightsFor(worker, to); !again.empty())
    return Give(worker, to, std::move(again), now_s);
  if (!waiting_.Empty()) return Give(worker, to, waiting_.TakeRun(BatchSize()), now_s);
  if (suspects_.Empty() || !to.held.empty() || elsewhere > 0) return std::nullopt;
  DISPERSA_ASSERT(to.batches.empty(), to.batches.size());
  to.alone = true;
  return Give(worker, to, suspects_.TakeRun(1), now_s);
}

void Ledger::Withdraw(const std::string& worker, const std::vector<std::uint64_t>& begun) {
  const auto entry = workers_.find(worker);
  if (entry == workers_.end()) return;
  entry->second.leaving = true;
  for (auto held = entry->second.held.begin(); held != entry->second.held.end();) {
    const auto here = held++;
    if (std::find(begun.begin(), begun.end(), here->first) != begun.end()) continue;
    const std::uint64_t case_index = here->first;
    RememberGiven(worker, case_index);
    Release(entry->second, here);
    if (cases_.StateOf(case_index) == CaseState::kAssigned) Return(case_index);
  }
  DISPERSA_ASSERT(entry->second.held.size() <= begun.size(), entry->second.held.size(), begun.size());
  CheckSums();
}

std::vector<std::uint64_t> Ledger::Owed(const std::string& worker, std::uint64_t attempt) const {
  std::vector<std::uint64_t> owed;
  const auto entry = workers_.find(worker);
  if (entry == workers_.end() || !entry->second.batches.contains(attempt)) return owed;
  for (const auto& [case_index, held] : entry->second.held) {
    if (held.attempt == attempt) owed.push_back(case_index);
  }
  DISPERSA_ASSERT(owed.size() == entry->second.batches.at(attempt), attempt, owed.size());
  return owed;
}

std::uint64_t Ledger::Batches(const std::string& worker) const {
  const auto entry = workers_.find(worker);
  return entry == workers_.end() ? 0 : entry->second.batches.size();
}

bool Ledger::IsAlone(const std::string& worker) const {
  const auto entry = workers_.find(worker);
  return entry != workers_.end() && entry->second.alone;
}

bool Ledger::Complete() const {
  if (progress_.done + progress_.quarantined != progress_.total) return false;
  return std::none_of(second_flights_.begin(), second_flights_.end(), [this](const auto& each) {
    if (!NeedsSecondFlight(each.first, each.second)) return false;
    return std::any_of(workers_.begin(), workers_.end(), [&](const auto& other) {
      const auto& [id, worker] = other;
      return id != each.second.first &&
             (worker.held.contains(each.first) || (!worker.stuck && !worker.leaving));
    });
  });
}

bool Ledger::NeedsSecondFlight(std::uint64_t case_index, const SecondFlight& flight) const {
  return !flight.is_settled && cases_.StateOf(case_index) == CaseState::kDone;
}

bool Ledger::MayNeedSecondFlight() const {
  return std::any_of(second_flights_.begin(), second_flights_.end(), [this](const auto& each) {
    return NeedsSecondFlight(each.first, each.second) && !each.second.is_flown;
  });
}

std::vector<std::uint64_t> Ledger::SecondFlightsFor(const std::string& id, const Worker& worker) const {
  std::vector<std::uint64_t> wanted;
  for (const auto& [case_index, flight] : second_flights_) {
    if (NeedsSecondFlight(case_index, flight) && !flight.is_flown && flight.first != id &&
        !worker.held.contains(case_index))
      wanted.push_back(case_index);
  }
  return wanted;
}

void Ledger::Drop(std::uint64_t case_index, bool blames) {
  const auto flight = second_flights_.find(case_index);
  if (flight == second_flights_.end()) return;
  flight->second.is_flown = false;
  if (blames && cases_.StateOf(case_index) == CaseState::kDone &&
      ++flight->second.blames >= options_.blames_to_quarantine)
    flight->second.is_settled = true;
}

LedgerProgress Ledger::Progress() const {
  LedgerProgress progress = progress_;
  progress.waiting = waiting_.Count() + suspects_.Count();
  progress.assigned = progress.total - progress.done - progress.quarantined - progress.waiting;
  return progress;
}

std::vector<CaseBlames> Ledger::Quarantined() const {
  std::vector<CaseBlames> quarantined;
  for (const auto& [case_index, reasons] : blames_) {
    if (cases_.StateOf(case_index) == CaseState::kQuarantined)
      quarantined.push_back({case_index, reasons, quarantined_at_once_.contains(case_index)});
  }
  return quarantined;
}

double Ledger::Lease() const { return std::max(options_.lease_s, kLeasePerLongestCase * longest_case_s_); }

std::uint64_t Ledger::BatchSize() const {
  // At least two rounds for every slot, so that the last cases end everywhere at about the same time.
  const std::uint64_t share = waiting_.Count() / (2 * std::max<std::uint64_t>(slots_, 1));
  const double by_duration = mean_case_s_ > 0.0 ? options_.batch_duration_s / mean_case_s_ : 1.0;
  const double by_lanes = by_duration * static_cast<double>(options_.side_by_side);
  const double wanted = std::min(by_lanes, static_cast<double>(std::min(share, options_.max_batch)));
  const auto size = static_cast<std::uint64_t>(std::max(wanted, 1.0));
  DISPERSA_ASSERT(size <= std::max<std::uint64_t>(options_.max_batch, 1), size);
  // Whole packs, so that no lane flies alone.
  return size > options_.side_by_side ? size - size % options_.side_by_side : size;
}

Assignment Ledger::Give(const std::string& id, Worker& worker, std::vector<std::uint64_t> cases,
                        double now_s) {
  DISPERSA_ASSERT(!cases.empty());
  if (worker.held.empty())
    worker.last_report_s = worker.last_returned_s = now_s;  // an idle worker has nothing to report
  const std::uint64_t attempt = next_attempt_++;
  for (const std::uint64_t case_index : cases) {
    const CaseState state = cases_.StateOf(case_index);
    DISPERSA_ASSERT(state != CaseState::kAssigned && state != CaseState::kQuarantined, case_index);
    if (state == CaseState::kDone) {
      second_flights_.at(case_index).is_flown = true;
    } else {
      cases_.Set(case_index, CaseState::kAssigned);
    }
    const bool is_new = worker.held.emplace(case_index, Held{attempt, std::nullopt}).second;
    DISPERSA_ASSERT(is_new, case_index, attempt);
  }
  worker.batches[attempt] = cases.size();
  return {id, attempt, std::move(cases)};
}

void Ledger::Release(Worker& worker, std::map<std::uint64_t, Held>::iterator held) {
  const auto batch = worker.batches.find(held->second.attempt);
  DISPERSA_ASSERT(batch != worker.batches.end() && batch->second > 0, held->first, held->second.attempt);
  if (--batch->second == 0) worker.batches.erase(batch);
  Drop(held->first, false);
  worker.held.erase(held);
  if (!worker.held.empty()) return;
  DISPERSA_ASSERT(worker.batches.empty(), worker.batches.size());
  worker.alone = false;
}

void Ledger::Return(std::uint64_t case_index) {
  const CaseState state = cases_.StateOf(case_index);
  DISPERSA_ASSERT(state == CaseState::kAssigned || state == CaseState::kDone, case_index);
  const bool suspect = blames_.contains(case_index);
  cases_.Set(case_index, suspect ? CaseState::kSuspect : CaseState::kWaiting);
  (suspect ? suspects_ : waiting_).Add(case_index);
}

void Ledger::Blame(std::uint64_t case_index, const std::string& reason) {
  DISPERSA_ASSERT(cases_.StateOf(case_index) == CaseState::kAssigned, case_index);
  std::vector<std::string>& reasons = blames_[case_index];
  reasons.push_back(reason);
  DISPERSA_ASSERT(std::ssize(reasons) <= options_.blames_to_quarantine, case_index, reasons.size());
  if (std::ssize(reasons) < options_.blames_to_quarantine) {
    Return(case_index);
    return;
  }
  cases_.Set(case_index, CaseState::kQuarantined);
  ++progress_.quarantined;
}

}  // namespace dispersa
