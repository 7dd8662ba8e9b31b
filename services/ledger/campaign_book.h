// The ledger of a campaign together with the store of its results.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/analysis/campaign_summary.h"
#include "core/analysis/stopping_rule.h"
#include "core/campaign/campaign.h"
#include "core/campaign/case_design.h"
#include "core/math/assertion.h"
#include "core/results/result_folder.h"
#include "core/results/result_store.h"
#include "services/ledger/audit.h"
#include "services/ledger/ledger.h"
#include "services/ledger/running_tally.h"
#include "services/program/exit_code.h"

namespace dispersa {

/// The exit code of a campaign whose verdict stands so. One conflict (two different results of a case) makes
/// it an internal error (1), whatever the verdict is. A `gate` lets nothing pass if nothing was judged.
ExitCode CampaignExitCode(StandingVerdict verdict, std::uint64_t conflicts, bool gate = false);

/// The worker's name when the process that writes the folder flies the cases itself.
inline constexpr char kInProcess[] = "in process";

/// Stores results in batches; a crash loses at most the last batch. Not thread-safe. Times are seconds from
/// any origin. Storing throws ResultError, unless PauseOnDiskErrors was called.
class CampaignBook {
 public:
  CampaignBook(const Campaign& campaign, std::unique_ptr<ResultStore> store,
               const LedgerOptions& options = {});
  CampaignBook(const Campaign& campaign, ResultFolder folder, const LedgerOptions& options = {});

  const Campaign& campaign() const { return campaign_; }
  /// Only of a book that was made with a folder.
  const ResultFolder& folder() const {
    DISPERSA_ASSERT(folder_ != nullptr);
    return *folder_;
  }
  Ledger& ledger() { return ledger_; }
  const Ledger& ledger() const { return ledger_; }
  /// Whether nothing is left to fly. When all cases up to the present look are settled and a requirement is
  /// undecided, this extends the ledger to the next look.
  bool Complete();
  std::uint64_t flown_now() const { return flown_now_; }  ///< accepted since construction

  /// Set when the control law is not deterministic: the error message for the user. The campaign then ends.
  const std::optional<std::string>& refusal() const { return refusal_; }

  /// From now on a disk error throws no exception. A full disk pauses the book: it keeps results in memory
  /// and stores them when there is space. Any other error breaks the book.
  void PauseOnDiskErrors() { pauses_on_disk_errors_ = true; }
  /// Why nothing can be stored now; empty: storing works. Assign no cases while it is set.
  const std::string& pause() const { return pause_; }
  /// Why nothing can be stored any more, or which rule of the program is broken; empty: all is well.
  const std::string& breakdown() const { return breakdown_; }
  /// After a fault of the program: what has been accepted is stored, and nothing follows.
  void Break(const std::string& fault);
  /// Does something with this book or its ledger. A broken rule of the program breaks this book alone.
  template <typename Action>
  void Guard(Action action) {
    try {
      action();
    } catch (const AssertionFailed& fault) {
      Break(fault.what());
    }
  }
  /// Results that were accepted and are not stored yet.
  std::uint64_t unstored() const { return results_.size(); }

  /// The results that the determinism check of a plug-in gave for the first cases. Every other result of
  /// these cases, also a stored one, must have the same bits.
  void Expect(std::vector<CaseResult> flown);

  /// Starts a tally from the stored results. Call it before the first result arrives.
  void KeepTally();
  /// The state of the requirements after the accepted results. The book keeps a tally.
  const RunningTally& tally() const {
    DISPERSA_ASSERT(tally_.has_value());
    return *tally_;
  }

  /// From now on the campaign is complete only when its audit is; stored results are audited too. No effect
  /// if the share is 0, or when called again.
  void KeepAudit(const AuditOptions& options);
  bool IsAudited() const { return audit_.has_value(); }
  /// Results to be flown again now.
  std::vector<Claim> TakeClaims() { return audit_ ? audit_->Take() : std::vector<Claim>(); }
  /// `truth`: the fingerprint of the repeated flight. False: the worker returned a different result.
  bool Settle(const Claim& claim, const Digest& truth);
  /// Repeated flights since construction that agreed.
  std::uint64_t confirmed() const { return confirmed_; }
  /// Whether a result's inputs are those that the campaign draws for its case.
  bool IsDrawnSo(const CaseResult& result) const;
  /// Whether it has as many metrics as the campaign measures.
  bool HasItsMetrics(const CaseResult& result) const;
  /// All cases of the workers that `worker` denotes (IsMeantBy) are flown again. A campaign that stops when
  /// it is decided keeps the cases that it was extended to.
  void Disown(const std::string& worker);

  void Start(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt, double now_s);
  /// A result that differs from the accepted one is logged, is not stored, and counts as a conflict in the
  /// ledger's progress until an audit settles it. Without audit, a conflict under a plug-in refuses the
  /// campaign.
  Acceptance Accept(const std::string& worker, const std::string& host, std::uint64_t attempt,
                    const CaseResult& result, double now_s);
  /// See Ledger::Quarantine. If two workers had to fly the case and one could not, the campaign is refused.
  void Quarantine(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                  const std::string& reason, double now_s);
  /// Stores the accepted results when due. True: all accepted results are stored.
  bool FlushIfDue(double now_s);
  void Flush();
  /// False: some results are not stored; see pause() and breakdown().
  bool TryFlush();

 private:
  template <typename Action>
  bool Try(Action action);
  void RemoveResultsOf(const std::string& worker);
  void Dispute(Claim claim);
  std::string FlownBy(std::uint64_t case_index) const;
  void Refuse(std::uint64_t case_index, const std::string& once, const std::string& again,
              const std::string& difference);
  void RefuseForDifference(const CaseResult& first, const std::string& once, const CaseResult& second,
                           const std::string& again);
  void CompareWithExpected(const CaseResult& result, const std::string& worker);

  Campaign campaign_;
  std::unique_ptr<ResultStore> store_;
  const ResultFolder* folder_ = nullptr;  ///< the store, if it is one
  CaseDesign design_;
  RowInputs rows_;
  std::optional<StoppingRule> rule_;  ///< of a campaign that stops when it is decided
  std::optional<RunningTally> tally_;
  std::optional<Audit> audit_;
  std::uint64_t confirmed_ = 0;
  std::optional<std::string> refusal_;
  std::vector<CaseResult> expected_;
  CaseRange range_;  ///< at the start
  Ledger ledger_;
  std::vector<CaseResult> results_;
  std::vector<ExecutionRecord> records_;
  std::vector<Claim> audits_;          ///< confirmed
  std::vector<std::string> disowned_;  ///< workers whose results are to be removed
  struct StartTime {
    double now_s;
    std::string utc;
  };
  std::map<std::pair<std::string, std::uint64_t>, StartTime> starts_;  ///< by worker and case
  std::size_t quarantined_ = 0;                                        ///< stored as such
  std::uint64_t flown_now_ = 0;
  double flushed_s_ = 0.0;
  bool pauses_on_disk_errors_ = false;
  std::string pause_, breakdown_;
};

}  // namespace dispersa
