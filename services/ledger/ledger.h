// Assigns cases to workers, records their results, and blames cases that end their workers. A pure state
// machine without clocks, messages or files. Time is an argument: seconds from any origin, never decreasing.
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
  double lease_s = 60.0;  ///< a worker that holds cases and reports nothing for longer is stuck
  int blames_to_quarantine = 3;
  double batch_duration_s = 0.25;  ///< target time of one slot for one assignment
  std::uint64_t max_batch = 64;    ///< cases
  std::uint64_t attempt_base =
      0;  ///< attempts count from here: ledgers of one coordinator have different ones
  std::uint64_t first_assignments = 4;  ///< that a worker holds at most before it has returned anything
  std::uint64_t first_case = 0;         ///< cases below are flown elsewhere
  double overdue_s =
      10.0;  ///< time without a result after which a worker loses its cases to workers without cases
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
  kSilent,   ///< its status messages stopped, the reason is unknown: blames the cases that it flew
};

enum class Acceptance {
  kAccepted,   ///< the first result of this case
  kDuplicate,  ///< a further result with the same bits: harmless
  kConflict,   ///< a further result with other bits: a machine or a build breaks the contract
  kUnknown,    ///< no case of this campaign
};

struct CaseBlames {
  std::uint64_t case_index = 0;
  std::vector<std::string> reasons;  ///< one for each blame
  bool is_certain = false;           ///< the worker saw the case end its child process: the last reason

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

/// Cases first_case .. cases - 1 of one campaign. Each ends done or quarantined. Rules of blame: only a case
/// that its worker reported as started is blamed. A blamed case (a suspect) waits until the queue is empty,
/// and then flies alone, on a worker without other cases. The N-th blame quarantines it. A late result is
/// accepted, even of a quarantined case.
class Ledger {
 public:
  Ledger(std::string engine_version, std::uint64_t cases, const LedgerOptions& options = {});

  /// A case with a result from an earlier run (resume). Call it before any assignment.
  void MarkDone(std::uint64_t case_index, const Digest& fingerprint);

  /// A second worker shall fly this case too, as soon as it has a result. The campaign is not complete
  /// before, while such a worker is present. `flown_by`: the worker that flew a case which is done already;
  /// empty: unknown.
  void RequireSecondFlight(std::uint64_t case_index, const std::string& flown_by = "");

  /// Adds cases at the end: `cases` is the new total.
  void Extend(std::uint64_t cases);

  /// The results of these cases were removed: they are flown again.
  void Reopen(const std::vector<std::uint64_t>& cases);
  /// Whether the worker was given this case and has not returned it.
  bool WasGiven(const std::string& worker, std::uint64_t case_index) const;
  /// Whether this is the result that the case has.
  bool IsResult(std::uint64_t case_index, const Digest& fingerprint) const;
  /// Which of two results that contradicted each other is wrong is known.
  void SettleConflict() { --progress_.conflicts; }

  /// A worker announces itself, or changes its announcement. Returns the reason if it is refused.
  std::optional<std::string> Join(const std::string& worker, const WorkerHello& hello, double now_s);
  /// The worker reports that it flies nothing. It counts as stuck no longer: its assignment got lost.
  void Idle(const std::string& worker);
  void Started(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt, double now_s);
  /// `fingerprint` covers every bit of the result.
  Acceptance Finished(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                      const Digest& fingerprint, double now_s);
  /// The case ended every child process in which this worker flew it: it is quarantined at once, unless it
  /// has a result. True: it has a result, and this was its required second flight.
  bool Quarantine(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                  const std::string& reason, double now_s);
  /// The worker is gone: its cases return to the queue. `reason` is kept with each blame.
  void Lost(const std::string& worker, WorkerEnd end, const std::string& reason);

  /// Takes the cases of stuck workers away from them and blames the cases that flew too long. Returns these
  /// workers. They get no more cases until they report something or are idle. When nothing else waits and a
  /// worker has nothing to do, overdue cases are taken away sooner, once each and without a blame.
  std::vector<std::string> Expire(double now_s);
  /// The assignments to send now, if all workers fly for this ledger alone.
  std::vector<Assignment> Assign(double now_s);
  /// Cases for one worker, if there are any for it. `elsewhere`: assignments of other ledgers that it holds.
  std::optional<Assignment> GiveTo(const std::string& worker, std::uint64_t elsewhere, double now_s);
  /// The worker is leaving: it finishes the `begun` cases; its other cases return to the queue.
  void Withdraw(const std::string& worker, const std::vector<std::uint64_t>& begun);

  /// Cases of an assignment that the worker still owes.
  std::vector<std::uint64_t> Owed(const std::string& worker, std::uint64_t attempt) const;
  /// Assignments that it holds.
  std::uint64_t Batches(const std::string& worker) const;
  /// Whether the worker flies a suspect and may hold nothing else.
  bool IsAlone(const std::string& worker) const;
  /// The fingerprint of the accepted result.
  Digest FingerprintOf(std::uint64_t case_index) const { return cases_.FingerprintOf(case_index); }

  bool Complete() const;
  LedgerProgress Progress() const;
  /// By case index.
  std::vector<CaseBlames> Quarantined() const;
  std::size_t WorkerCount() const { return workers_.size(); }

 private:
  bool Has(std::uint64_t case_index) const {
    return case_index >= options_.first_case && case_index < cases_.size();
  }
  /// No case counts twice.
  void CheckSums() const;
  /// The second flight of a case that two workers must fly.
  struct SecondFlight {
    std::string first;        ///< the worker that returned its result; empty: none, or unknown
    bool is_flown = false;    ///< the second flight is under way
    bool is_settled = false;  ///< another worker has flown it, or cannot
    int blames = 0;           ///< in second flights
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
    std::uint64_t returned = 0;    ///< results
    double last_returned_s = 0.0;  ///< or when it was given something after it had nothing
    bool alone = false;            ///< holds a suspect
    bool stuck = false;
    bool slow = false;  ///< its cases were overdue: others come first until it returns one
    bool leaving = false;
  };

  bool NeedsSecondFlight(std::uint64_t case_index, const SecondFlight& flight) const;
  bool MayNeedSecondFlight() const;
  std::vector<std::uint64_t> SecondFlightsFor(const std::string& id, const Worker& worker) const;
  void TakeBackOverdue(double now_s);
  bool IsAnyoneQuick() const;
  bool IsHeld(std::uint64_t case_index) const;
  // Out of the queue that it waits in, if it waits.
  void TakeOut(std::uint64_t case_index, CaseState state);
  // Its result is still welcome.
  void RememberGiven(const std::string& worker, std::uint64_t case_index);
  // A worker holds it no longer, without a result.
  void Drop(std::uint64_t case_index, bool blames);
  double Lease() const;
  std::uint64_t BatchSize() const;
  Assignment Give(const std::string& id, Worker& worker, std::vector<std::uint64_t> cases, double now_s);
  void Release(Worker& worker, std::map<std::uint64_t, Held>::iterator held);
  void Return(std::uint64_t case_index);
  void Blame(std::uint64_t case_index, const std::string& reason);
  // The worker no longer owes this case.
  void Settle(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt, double now_s);

  std::string engine_version_;
  LedgerOptions options_;
  CaseTable cases_;
  IndexSet waiting_;
  IndexSet suspects_;
  std::map<std::uint64_t, std::vector<std::string>> blames_;  ///< case index -> reasons
  std::set<std::uint64_t> quarantined_at_once_;
  std::map<std::uint64_t, SecondFlight> second_flights_;          ///< by case index
  std::map<std::uint64_t, std::vector<std::string>> taken_from_;  ///< by case index: the last workers
  std::map<std::string, Worker> workers_;
  std::uint64_t next_attempt_ = 1;
  std::uint64_t slots_ = 0;
  double mean_case_s_ = 0.0;  ///< recent; 0: none finished yet
  double longest_case_s_ = 0.0;
  LedgerProgress progress_;
};

}  // namespace dispersa
