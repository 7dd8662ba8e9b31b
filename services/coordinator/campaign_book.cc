#include "services/coordinator/campaign_book.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "core/flight/engine_version.h"
#include "core/report/fingerprint.h"
#include "services/coordinator/utc.h"

namespace dispersa {
namespace {

constexpr double kFlushPeriod_s = 0.5;
constexpr std::size_t kFlushCount = 1000;

/// With what the folder holds already, so that the target is where an interrupted run left it.
std::optional<StoppingRule> RuleOf(const Campaign& campaign, const ResultStore& store) {
  const auto* folder = dynamic_cast<const ResultFolder*>(&store);
  if (!campaign.verdicts.stop_when_decided || folder == nullptr) return std::nullopt;
  StoppingRule rule(campaign, std::stoll(folder->Provenance("planned_cases")), folder->PastLooks());
  folder->ForEach([&](const CaseResult& result) { rule.Add(result); });
  while (rule.Advance({})) {
  }
  return rule;
}

RunningTally TallyOf(const Campaign& campaign, const ResultStore& store) {
  RunningTally tally(campaign);
  if (const auto* folder = dynamic_cast<const ResultFolder*>(&store)) {
    folder->ForEach([&](const CaseResult& result) { tally.Add(result); });
  }
  return tally;
}

}  // namespace

int CampaignExitCode(CampaignVerdict verdict, std::uint64_t conflicts) {
  constexpr int kInternalError = 1;
  return conflicts > 0 ? kInternalError : VerdictExitCode(verdict);
}

CampaignBook::CampaignBook(const Campaign& campaign, ResultFolder folder, const LedgerOptions& options)
    : CampaignBook(campaign, std::make_unique<ResultFolder>(std::move(folder)), options) {}

CampaignBook::CampaignBook(const Campaign& campaign, std::unique_ptr<ResultStore> store,
                           const LedgerOptions& options)
    : campaign_(campaign),
      store_(std::move(store)),
      rule_(RuleOf(campaign, *store_)),
      tally_(TallyOf(campaign, *store_)),
      ledger_(EngineVersion(), rule_ ? rule_->target() : campaign.sampling.cases, options) {
  const std::uint64_t cases = ledger_.Progress().total;
  for (const auto& [case_index, fingerprint] : store_->Fingerprints()) {
    if (case_index < cases) ledger_.MarkDone(case_index, fingerprint);
  }
}

bool CampaignBook::Complete() {
  if (!ledger_.Complete()) return false;
  std::vector<std::uint64_t> given_up;
  for (const BlamedCase& blamed : ledger_.Quarantined()) given_up.push_back(blamed.case_index);
  if (!rule_ || !rule_->Advance(given_up)) return true;
  ledger_.Extend(rule_->target());
  return false;
}

void CampaignBook::Start(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                         double now_s) {
  ledger_.Started(worker, case_index, attempt, now_s);
  starts_[{worker, case_index}] = {now_s, UtcNow()};
}

Acceptance CampaignBook::Accept(const std::string& worker, const std::string& host, std::uint64_t attempt,
                                const CaseResult& result, double now_s) {
  const Acceptance acceptance =
      ledger_.Finished(worker, result.case_index, attempt, Fingerprint(result), now_s);
  auto start = starts_.extract({worker, result.case_index});
  switch (acceptance) {
    case Acceptance::kAccepted:
      results_.push_back(result);
      if (rule_) rule_->Add(result);
      tally_.Add(result);
      ++flown_now_;
      if (!start.empty()) {
        records_.push_back(
            {result.case_index, worker, host, start.mapped().utc, now_s - start.mapped().now_s});
      }
      break;
    case Acceptance::kConflict:
      spdlog::error(
          "case {}: worker {} on {} returned other bits than were returned before: a processor, a "
          "library or a build breaks the floating-point contract; no result can be trusted",
          result.case_index, worker, host);
      break;
    case Acceptance::kUnknown:
      spdlog::error("case {} of worker {} on {} does not exist in this campaign", result.case_index, worker,
                    host);
      break;
    case Acceptance::kDuplicate:
      break;
  }
  return acceptance;
}

bool CampaignBook::FlushIfDue(double now_s) {
  if (results_.size() < kFlushCount && now_s - flushed_s_ < kFlushPeriod_s) return false;
  flushed_s_ = now_s;
  Flush();
  return true;
}

void CampaignBook::Flush() {
  if (!results_.empty()) {
    store_->Append(results_);
    results_.clear();
  }
  if (!records_.empty()) {
    store_->AppendExecution(records_);
    records_.clear();
  }
  if (ledger_.Progress().quarantined != quarantined_) {
    for (const BlamedCase& blamed : ledger_.Quarantined()) {
      // The reasons of each attempt name processes and signals; what is stored must not differ between runs.
      store_->Quarantine({blamed.case_index, "every attempt to fly it ended or hung its worker"});
    }
    quarantined_ = ledger_.Progress().quarantined;
  }
}

}  // namespace dispersa
