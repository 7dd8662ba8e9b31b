// Who flies which case, what came back, who is to blame. A pure state machine: it knows neither clocks,
// messages nor files; time is an argument, in seconds from any origin, and never decreases.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/flight/digest.h"
#include "services/ledger/case_table.h"
#include "services/ledger/index_set.h"

namespace dispersa {

struct LedgerOptions {
  double lease_s = 60.0;  ///< a worker that holds cases and reports nothing for so long is stuck
  int blames_to_quarantine = 3;
  double batch_duration_s = 0.25;  ///< what one slot should need for one assignment
  std::uint64_t max_batch = 64;    ///< cases
  std::uint64_t attempt_base =
      0;  ///< attempts count from here: ledgers of one coordinator have different ones
  std::uint64_t side_by_side = 8;  ///< cases that a slot may fly at the same time: the widest engine's lanes
};

/// A worker as it announces itself.
struct WorkerHello {
  std::string engine_version;
  std::uint32_t slots = 1;    ///< cases that it flies at the same time
  std::uint32_t credits = 2;  ///< assignments that it holds at the same time
};

struct Assignment {
  std::string worker;
  std::uint64_t attempt = 0;  ///< of this assignment, unique within a ledger
  std::vector<std::uint64_t> cases;

  bool operator==(const Assignment&) const = default;
};

enum class WorkerEnd {
  kLeft,     ///< by its own decision
  kKilled,   ///< from outside (SIGKILL, SIGTERM): blames no case
  kCrashed,  ///< by itself (a signal such as SIGSEGV, or an exit code): blames the cases that it flew
  kSilent,   ///< its heartbeat stopped and nothing tells why: blames the cases that it flew
};

enum class Acceptance {
  kAccepted,   ///< the first result of this case
  kDuplicate,  ///< a further one with the same bits: harmless
  kConflict,   ///< a further one with other bits: some machine or build breaks the contract
  kUnknown,    ///< no case of this campaign
};

struct CaseBlames {
  std::uint64_t case_index = 0;
  std::vector<std::string> reasons;  ///< one of each blame
  bool is_certain = false;  ///< its worker has seen alone what it does, and gave it up: the last reason

  bool operator==(const CaseBlames&) const = default;
};

struct LedgerProgress {
  std::uint64_t total = 0;
  std::uint64_t done = 0;
  std::uint64_t quarantined = 0;
  std::uint64_t waiting = 0;   ///< for a worker; suspects included
  std::uint64_t assigned = 0;  ///< to a worker that still lives
  std::uint64_t duplicates = 0;
  std::uint64_t conflicts = 0;
};

/// Cases 0 .. cases - 1 of one campaign. Each ends done or quarantined. Rules of blame: only a case that
/// its worker reported as started is blamed; a blamed case waits until the queue is empty and is then flown
/// alone, by a worker that holds nothing else; the N-th blame quarantines it. A result is welcome whenever
/// it comes, even of a quarantined case.
class Ledger {
 public:
  Ledger(std::string engine_version, std::uint64_t cases, const LedgerOptions& options = {});

  /// A case whose result exists already (resume). Before any assignment.
  void MarkDone(std::uint64_t case_index, const Digest& fingerprint);

  /// Two workers shall fly this case, if two attend: the one that did not fly it first does so as soon as it
  /// has a result. Nothing is complete before, as long as somebody is there who could. `flown_by`: of a case
  /// that is done already; empty if nobody knows.
  void RequireSecondFlight(std::uint64_t case_index, const std::string& flown_by = "");

  /// Adds cases at the end: there are so many in all from now on.
  void Extend(std::uint64_t cases);

  /// Results of these cases are not believed any more: they are flown again.
  void Reopen(const std::vector<std::uint64_t>& cases);
  /// Which of two results that contradicted each other is wrong is known.
  void SettleConflict() { --progress_.conflicts; }

  /// A worker announces itself, or changes what it announced. Returns why it is refused, if it is.
  std::optional<std::string> Join(const std::string& worker, const WorkerHello& hello, double now_s);
  /// The worker says that it flies nothing. If it was stuck it is so no longer: what it was given got lost.
  void Idle(const std::string& worker);
  void Started(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt, double now_s);
  /// `fingerprint` covers every bit of the result.
  Acceptance Finished(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                      const Digest& fingerprint, double now_s);
  /// The worker survived what the case does to every process that flies it: it is quarantined at once, unless
  /// it has a result. True: another worker has flown it, and this one was to do the same.
  bool Quarantine(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                  const std::string& reason, double now_s);
  /// The worker is gone: its cases return to the queue. `reason` is kept with each blame.
  void Lost(const std::string& worker, WorkerEnd end, const std::string& reason);

  /// Takes the cases of stuck workers away from them, with a blame for those that flew too long, and
  /// returns these workers; they get no more cases until they report something or are idle.
  std::vector<std::string> Expire(double now_s);
  /// What to send now, when all workers fly for this ledger alone.
  std::vector<Assignment> Assign(double now_s);
  /// Cases for one worker, if there are any that it may have. `elsewhere`: assignments that it holds of other
  /// ledgers.
  std::optional<Assignment> GiveTo(const std::string& worker, std::uint64_t elsewhere, double now_s);
  /// The worker takes no more, and begins none but these of what it holds: the others return to the queue.
  void Withdraw(const std::string& worker, const std::vector<std::uint64_t>& begun);

  /// Cases of an assignment that the worker still owes.
  std::vector<std::uint64_t> Owed(const std::string& worker, std::uint64_t attempt) const;
  /// Assignments that it holds.
  std::uint64_t Batches(const std::string& worker) const;
  /// It flies a suspect and may hold nothing else.
  bool IsAlone(const std::string& worker) const;
  /// Of the result that was accepted.
  Digest FingerprintOf(std::uint64_t case_index) const { return cases_.FingerprintOf(case_index); }

  bool Complete() const;
  LedgerProgress Progress() const;
  /// By case index.
  std::vector<CaseBlames> Quarantined() const;
  std::size_t WorkerCount() const { return workers_.size(); }

 private:
  /// Of a case that two workers shall fly.
  struct SecondFlight {
    std::string first;        ///< who returned its result; empty: nobody, or nobody knows
    bool is_flown = false;    ///< now, for the second time
    bool is_settled = false;  ///< another worker has flown it, or cannot
    int blames = 0;           ///< of workers that were to
  };
  struct Held {
    std::uint64_t attempt = 0;
    std::optional<double> started_s;
  };
  struct Worker {
    WorkerHello hello;
    std::map<std::uint64_t, Held> held;              ///< by case index
    std::map<std::uint64_t, std::uint64_t> batches;  ///< attempt -> cases of it that are still held
    double last_report_s = 0.0;
    bool alone = false;  ///< holds a suspect
    bool stuck = false;
    bool leaving = false;
  };

  bool NeedsSecondFlight(std::uint64_t case_index, const SecondFlight& flight) const;
  bool MayNeedSecondFlight() const;
  std::vector<std::uint64_t> SecondFlightsFor(const std::string& id, const Worker& worker) const;
  // A worker holds it no longer, without a result.
  void Drop(std::uint64_t case_index, bool blames);
  double Lease() const;
  std::uint64_t BatchSize() const;
  Assignment Give(const std::string& id, Worker& worker, std::vector<std::uint64_t> cases, double now_s);
  void Release(Worker& worker, std::map<std::uint64_t, Held>::iterator held);
  void Return(std::uint64_t case_index);
  void Blame(std::uint64_t case_index, const std::string& reason);
  // What the worker owed is no longer owed.
  void Settle(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt, double now_s);

  std::string engine_version_;
  LedgerOptions options_;
  CaseTable cases_;
  IndexSet waiting_;
  IndexSet suspects_;
  std::map<std::uint64_t, std::vector<std::string>> blames_;  ///< case index -> reasons
  std::set<std::uint64_t> quarantined_at_once_;
  std::map<std::uint64_t, SecondFlight> second_flights_;  ///< by case index
  std::map<std::string, Worker> workers_;
  std::uint64_t next_attempt_ = 1;
  std::uint64_t slots_ = 0;
  double mean_case_s_ = 0.0;  ///< recent; 0: none finished yet
  double longest_case_s_ = 0.0;
  LedgerProgress progress_;
};

}  // namespace dispersa
