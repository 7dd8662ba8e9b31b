// The ledger of a campaign together with the store that its results go to.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/report/campaign_summary.h"
#include "core/report/result_folder.h"
#include "core/report/result_store.h"
#include "core/report/stopping_rule.h"
#include "services/coordinator/ledger.h"
#include "services/coordinator/running_tally.h"

namespace dispersa {

/// The exit code of a campaign that ends with this verdict after so many results that contradicted others:
/// any is an internal error (1), whatever the verdict says.
int CampaignExitCode(CampaignVerdict verdict, std::uint64_t conflicts);

/// Results are stored in batches; nothing that was accepted is lost by more than one batch. Not thread-safe.
/// Times are seconds from any origin. Storing throws ResultError.
class CampaignBook {
 public:
  CampaignBook(const Campaign& campaign, std::unique_ptr<ResultStore> store,
               const LedgerOptions& options = {});
  CampaignBook(const Campaign& campaign, ResultFolder folder, const LedgerOptions& options = {});

  const Campaign& campaign() const { return campaign_; }
  /// Of a book that was made with one.
  const ResultFolder& folder() const { return dynamic_cast<const ResultFolder&>(*store_); }
  Ledger& ledger() { return ledger_; }
  const Ledger& ledger() const { return ledger_; }
  /// Whether nothing is left to fly. Extends the ledger to the campaign's next look when all cases up to this
  /// one are settled and its requirements are not decided.
  bool Complete();
  std::uint64_t flown_now() const { return flown_now_; }  ///< accepted since construction

  /// How the requirements stand by what has been accepted.
  const RunningTally& tally() const { return tally_; }

  void Start(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt, double now_s);
  /// A result that differs from the one already accepted is logged, stored nowhere, and counted as a conflict
  /// in the ledger's progress.
  Acceptance Accept(const std::string& worker, const std::string& host, std::uint64_t attempt,
                    const CaseResult& result, double now_s);
  /// Stores what has gathered if it is time to. True: all that was accepted so far is stored.
  bool FlushIfDue(double now_s);
  void Flush();

 private:
  Campaign campaign_;
  std::unique_ptr<ResultStore> store_;
  std::optional<StoppingRule> rule_;  ///< of a campaign that stops when it is decided
  RunningTally tally_;
  Ledger ledger_;
  std::vector<CaseResult> results_;
  std::vector<ExecutionRecord> records_;
  struct StartTime {
    double now_s;
    std::string utc;
  };
  std::map<std::pair<std::string, std::uint64_t>, StartTime> starts_;  ///< by worker and case
  std::size_t quarantined_ = 0;                                        ///< stored as such
  std::uint64_t flown_now_ = 0;
  double flushed_s_ = 0.0;
};

}  // namespace dispersa
