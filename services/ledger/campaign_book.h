// The ledger of a campaign together with the store that its results go to.
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
#include "core/results/result_folder.h"
#include "core/results/result_store.h"
#include "services/ledger/audit.h"
#include "services/ledger/ledger.h"
#include "services/ledger/running_tally.h"
#include "services/program/exit_code.h"

namespace dispersa {

/// The exit code of a campaign that ends with this verdict after so many results that contradicted others:
/// any is an internal error (1), whatever the verdict says.
ExitCode CampaignExitCode(CampaignVerdict verdict, std::uint64_t conflicts);

/// The worker's name when a campaign is flown by the process that writes its folder.
inline constexpr char kInProcess[] = "in process";

/// Results are stored in batches; nothing that was accepted is lost by more than one batch. Not thread-safe.
/// Times are seconds from any origin. Storing throws ResultError, unless the book is told to be patient.
class CampaignBook {
 public:
  CampaignBook(const Campaign& campaign, std::unique_ptr<ResultStore> store,
               const LedgerOptions& options = {});
  CampaignBook(const Campaign& campaign, ResultFolder folder, const LedgerOptions& options = {});

  const Campaign& campaign() const { return campaign_; }
  /// Of a book that was made with one.
  const ResultFolder& folder() const { return *folder_; }
  Ledger& ledger() { return ledger_; }
  const Ledger& ledger() const { return ledger_; }
  /// Whether nothing is left to fly. Extends the ledger to the campaign's next look when all cases up to this
  /// one are settled and its requirements are not decided.
  bool Complete();
  std::uint64_t flown_now() const { return flown_now_; }  ///< accepted since construction

  /// Why its results cannot be believed, in words for the user: its control law is not deterministic. Nothing
  /// of it needs to be flown any more.
  const std::optional<std::string>& refusal() const { return refusal_; }

  /// From now on an error of the disk is no exception. A full disk pauses the book: results are kept in
  /// memory, and are stored when there is space. Any other error breaks it.
  void PauseOnDiskErrors() { pauses_on_disk_errors_ = true; }
  /// Why nothing can be stored now; empty: it can. Nothing should be assigned meanwhile.
  const std::string& pause() const { return pause_; }
  /// Why nothing can be stored any more; empty: it can.
  const std::string& breakdown() const { return breakdown_; }
  /// Results that were accepted and are not stored yet.
  std::uint64_t unstored() const { return results_.size(); }

  /// What the first cases of a campaign with a plug-in gave before it: every result of them must be the same,
  /// what the store holds too.
  void Expect(std::vector<CaseResult> flown);

  /// Counts from what the store holds; to be called before the first result.
  void KeepTally();
  /// How the requirements stand by what has been accepted, in a book that keeps a tally.
  const RunningTally& tally() const { return *tally_; }

  /// From now on nothing is complete before its audit is, of what the store holds already too. Nothing if the
  /// share is 0, or when it is called again.
  void KeepAudit(const AuditOptions& options);
  bool IsAudited() const { return audit_.has_value(); }
  /// What is to be flown again now.
  std::vector<Claim> TakeClaims() { return audit_ ? audit_->Take() : std::vector<Claim>(); }
  /// What it gave. False: the worker returned something else.
  bool Settle(const Claim& claim, const Digest& truth);
  /// Results that were flown again since construction, and agreed.
  std::uint64_t confirmed() const { return confirmed_; }
  /// Whatever this worker returned is flown again. A campaign that stops when it is decided keeps the cases
  /// that it was extended to.
  void Disown(const std::string& worker);

  void Start(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt, double now_s);
  /// A result that differs from the one already accepted is logged, stored nowhere, and counted as a conflict
  /// in the ledger's progress, until an audit tells who is wrong. Without audit it refuses a campaign whose
  /// control law is a plug-in.
  Acceptance Accept(const std::string& worker, const std::string& host, std::uint64_t attempt,
                    const CaseResult& result, double now_s);
  /// Ledger::Quarantine. A case that another worker could fly refuses the campaign, if two were to fly it.
  void Quarantine(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                  const std::string& reason, double now_s);
  /// Stores what has gathered if it is time to. True: all that was accepted so far is stored.
  bool FlushIfDue(double now_s);
  void Flush();
  /// False: not everything is stored, see pause() and breakdown().
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
  std::optional<StoppingRule> rule_;      ///< of a campaign that stops when it is decided
  std::optional<RunningTally> tally_;
  std::optional<Audit> audit_;
  std::uint64_t confirmed_ = 0;
  std::optional<std::string> refusal_;
  std::vector<CaseResult> expected_;
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
