#include "services/coordinator/campaign_book.h"

#include <spdlog/spdlog.h>

#include <bit>
#include <cstring>
#include <utility>

#include "core/engine/version.h"
#include "services/coordinator/utc.h"

namespace dispersa {
namespace {

constexpr double kFlushPeriod_s = 0.5;
constexpr std::size_t kFlushCount = 1000;

}  // namespace

Digest Fingerprint(const CaseResult& result) {
  std::vector<double> words = {std::bit_cast<double>(result.case_index),
                               static_cast<double>(result.outcome),
                               result.end_time_s,
                               static_cast<double>(result.end_stage),
                               std::bit_cast<double>(result.digest.high),
                               std::bit_cast<double>(result.digest.low),
                               static_cast<double>(result.reason.size())};
  const std::size_t reason_at = words.size();
  words.resize(reason_at + (result.reason.size() + sizeof(double) - 1) / sizeof(double));
  std::memcpy(words.data() + reason_at, result.reason.data(), result.reason.size());
  words.push_back(static_cast<double>(result.inputs.size()));
  words.insert(words.end(), result.inputs.begin(), result.inputs.end());
  words.insert(words.end(), result.metrics.begin(), result.metrics.end());
  Digester digester;
  digester.Add(words.data(), words.size());
  return digester.Finish();
}

CampaignBook::CampaignBook(const Campaign& campaign, ResultFolder folder, const LedgerOptions& options)
    : campaign_(campaign),
      folder_(std::move(folder)),
      ledger_(EngineVersion(), campaign.sampling.cases, options) {
  for (const std::uint64_t case_index : folder_.PresentCases()) {
    if (case_index < campaign.sampling.cases) ledger_.MarkDone(case_index);
  }
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

void CampaignBook::FlushIfDue(double now_s) {
  if (results_.size() < kFlushCount && now_s - flushed_s_ < kFlushPeriod_s) return;
  flushed_s_ = now_s;
  Flush();
}

void CampaignBook::Flush() {
  if (!results_.empty()) {
    folder_.Append(results_);
    results_.clear();
  }
  if (!records_.empty()) {
    folder_.AppendExecution(records_);
    records_.clear();
  }
  if (ledger_.Progress().quarantined != quarantined_) {
    for (const BlamedCase& blamed : ledger_.Quarantined()) {
      // The reasons of each attempt name processes and signals; what is stored must not differ between runs.
      folder_.Quarantine({blamed.case_index, "every attempt to fly it ended or hung its worker"});
    }
    quarantined_ = ledger_.Progress().quarantined;
  }
}

}  // namespace dispersa
