#include "services/ledger/campaign_book.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/results/fingerprint.h"
#include "core/results/result_differences.h"
#include "services/log/log.h"
#include "services/program/utc.h"

namespace dispersa {
namespace {

constexpr double kFlushPeriod_s = 0.5;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kFlownTwice = 2;   // first cases of a campaign with a plug-in, by two workers
constexpr std::size_t kFlushCount = 4000;  // 4 MB; at 20,000 results/s five transactions a second
constexpr double kFullPeriod_s = 5.0;      // a full disk is tried again so often

/// With what the folder holds already, so that the target is where an interrupted run left it.
std::optional<StoppingRule> RuleOf(const Campaign& campaign, const ResultStore& store) {
  if (!campaign.verdicts.stop_when_decided || store.ItsShare()) return std::nullopt;
  StoppingRule rule(campaign, store.PlannedCases(), store.PastLooks());
  store.ForEach([&](const CaseResult& result) { rule.Add(result); });
  while (rule.Advance({})) {
  }
  return rule;
}

/// The cases up to the present look, or those of the store's share.
CaseRange RangeOf(const Campaign& campaign, const ResultStore& store,
                  const std::optional<StoppingRule>& rule) {
  if (const auto share = store.ItsShare()) return share->cases;
  return {0, rule ? rule->target() : campaign.sampling.cases};
}

LedgerOptions From(std::uint64_t first_case, LedgerOptions options) {
  options.first_case = first_case;
  return options;
}

std::string Title(const Campaign& campaign) { return campaign.name + " (" + campaign.id.substr(0, 8) + ")"; }

std::string By(const std::string& worker, const std::string& title = "") {
  return worker == kInProcess ? worker : "by " + title + worker;
}

}  // namespace

ExitCode CampaignExitCode(StandingVerdict verdict, std::uint64_t conflicts, bool gate) {
  if (conflicts > 0) return kExitInternalError;
  switch (verdict) {
    case StandingVerdict::kPass:
      return kExitDone;
    case StandingVerdict::kNothingJudged:
      return gate ? kExitNotEvidence : kExitDone;
    case StandingVerdict::kInconclusive:
      return kExitInconclusive;
    case StandingVerdict::kNotEvidence:
      return kExitNotEvidence;
    case StandingVerdict::kFail:
      return kExitRequirementFailed;
    case StandingVerdict::kIncomplete:
      return kExitIncomplete;
  }
  return kExitInternalError;
}

CampaignBook::CampaignBook(const Campaign& campaign, ResultFolder folder, const LedgerOptions& options)
    : CampaignBook(campaign, std::make_unique<ResultFolder>(std::move(folder)), options) {
  folder_ = static_cast<const ResultFolder*>(store_.get());
}

CampaignBook::CampaignBook(const Campaign& campaign, std::unique_ptr<ResultStore> store,
                           const LedgerOptions& options)
    : campaign_(campaign),
      store_(std::move(store)),
      design_(campaign),
      rows_(campaign),
      rule_(RuleOf(campaign, *store_)),
      range_(RangeOf(campaign, *store_, rule_)),
      ledger_(EngineVersion(), range_.end, From(range_.first, options)) {
  DISPERSA_ASSERT(!rule_ || range_.size() > 0);
  for (const auto& [case_index, fingerprint] : store_->Fingerprints()) {
    if (range_.Contains(case_index)) ledger_.MarkDone(case_index, fingerprint);
  }
  if (!campaign_.autopilot.plugin) return;
  for (std::uint64_t i = range_.first; i < std::min(range_.first + kFlownTwice, range_.end); ++i)
    ledger_.RequireSecondFlight(i, store_->WorkerOf(i).value_or(""));
}

bool CampaignBook::HasItsMetrics(const CaseResult& result) const {
  return result.metrics.size() == MetricsOf(campaign_).size();
}

bool CampaignBook::IsDrawnSo(const CaseResult& result) const {
  return HasInputs(rows_, InputValues(design_.Draw(result.case_index), rows_.column_class()), result);
}

void CampaignBook::KeepTally() {
  tally_.emplace(campaign_);
  store_->ForEach([&](const CaseResult& result) { tally_->Add(result); });
}

void CampaignBook::KeepAudit(const AuditOptions& options) {
  if (options.share <= 0.0 || audit_ || (campaign_.autopilot.plugin && !options.with_plugins)) return;
  audit_.emplace(options);
  store_->ForEachUnaudited([&](const Claim& claim) { audit_->Consider(claim); });
}

bool CampaignBook::Settle(const Claim& claim, const Digest& truth) {
  DISPERSA_ASSERT(audit_ && claim.case_index < ledger_.Progress().total, claim.case_index);
  audit_->Settle();
  if (claim.is_dispute) ledger_.SettleConflict();
  if (claim.fingerprint != truth) return false;
  if (!claim.is_dispute) audits_.push_back(claim);
  ++confirmed_;
  return true;
}

template <typename Action>
bool CampaignBook::Try(Action action) {
  try {
    action();
    return true;
  } catch (const ResultError& error) {
    if (!pauses_on_disk_errors_) throw;
    if (error.kind() == ResultError::Kind::kDiskFull) {
      if (pause_.empty()) LogError("campaign {} is paused: {}", Title(campaign_), error.what());
      pause_ = error.what();
    } else {
      breakdown_ = error.what();
    }
    return false;
  }
}

void CampaignBook::Break(const std::string& fault) {
  const LogAbout about(campaign_.id);
  if (!breakdown_.empty()) return;
  LogError("campaign {} ends: {}", Title(campaign_), fault);
  try {
    Try([this] { Flush(); });
  } catch (const AssertionFailed&) {  // what is to be stored may be what is broken
  }
  breakdown_ = fault;
}

void CampaignBook::Disown(const std::string& worker) {
  if (audit_) audit_->Drop(worker);
  disowned_.push_back(worker);
  TryFlush();
}

void CampaignBook::RemoveResultsOf(const std::string& worker) {
  DISPERSA_ASSERT(results_.empty(), results_.size());  // one that is stored later would stay
  const std::vector<std::uint64_t> cases = store_->Disown(worker);
  if (cases.empty()) return;
  LogWarning("campaign {}: {} results of worker {} are removed; their cases are flown again",
             Title(campaign_), cases.size(), worker);
  ledger_.Reopen(cases);
  if (rule_) rule_ = RuleOf(campaign_, *store_);
  if (tally_) KeepTally();
}

// Two results, of which one at least is wrong: both are flown again.
void CampaignBook::Dispute(Claim claim) {
  DISPERSA_ASSERT(audit_ && !claim.is_dispute, claim.case_index);
  std::optional<std::string> other;
  Try([&] {
    Flush();
    other = store_->WorkerOf(claim.case_index);
  });
  if (!other) return;  // nobody to expel: it stays a conflict
  audit_->Add({*other, claim.case_index, ledger_.FingerprintOf(claim.case_index), false});
  claim.is_dispute = true;
  audit_->Add(claim);
}

std::string CampaignBook::FlownBy(std::uint64_t case_index) const {
  return By(store_->WorkerOf(case_index).value_or("another"), "worker ");
}

void CampaignBook::Refuse(std::uint64_t case_index, const std::string& once, const std::string& again,
                          const std::string& difference) {
  if (refusal_) return;
  refusal_ = fmt::format("the control law {} is not deterministic: of case {}, flown {} and again {}, {}",
                         campaign_.autopilot.plugin->name, case_index, once, again, difference);
}

void CampaignBook::RefuseForDifference(const CaseResult& first, const std::string& once,
                                       const CaseResult& second, const std::string& again) {
  const std::vector<ResultDifference> differences = Differences(first, second, rows_, MetricsOf(campaign_));
  if (differences.empty()) return;
  const ResultDifference& at = differences.front();
  Refuse(second.case_index, once, again,
         fmt::format("{} is '{}' once and '{}' again", at.name, at.first, at.second));
}

void CampaignBook::Expect(std::vector<CaseResult> flown) {
  expected_ = std::move(flown);
  for (const CaseResult& result : expected_) {
    const auto worker = store_->WorkerOf(result.case_index);
    if (worker) CompareWithExpected(store_->Load(result.case_index), *worker);
  }
}

// An audit finds out which of two workers is wrong; without one, the campaign cannot be believed.
void CampaignBook::CompareWithExpected(const CaseResult& result, const std::string& worker) {
  if (audit_) return;
  for (const CaseResult& expected : expected_)
    if (expected.case_index == result.case_index)
      RefuseForDifference(expected, "here before the campaign", result, By(worker));
}

void CampaignBook::Quarantine(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                              const std::string& reason, double now_s) {
  if (!ledger_.Quarantine(worker, case_index, attempt, reason, now_s)) return;
  Try([&] {
    Flush();
    Refuse(case_index, FlownBy(case_index), By(worker), "the flight ended well once, and again " + reason);
  });
}

bool CampaignBook::Complete() {
  if (!ledger_.Complete() || !disowned_.empty() || (audit_ && !audit_->IsSettled())) return false;
  std::vector<std::uint64_t> quarantined_indices;
  for (const CaseBlames& blamed : ledger_.Quarantined()) quarantined_indices.push_back(blamed.case_index);
  DISPERSA_ASSERT(quarantined_indices.size() + ledger_.Progress().done == ledger_.Progress().total,
                  quarantined_indices.size(), ledger_.Progress().done, ledger_.Progress().total);
  // A rule that was made anew, after a worker's results were removed, begins below what was asked for before.
  while (rule_ && rule_->Advance(quarantined_indices)) {
    if (rule_->target() <= ledger_.Progress().total) continue;
    ledger_.Extend(rule_->target());
    return false;
  }
  return true;
}

void CampaignBook::Start(const std::string& worker, std::uint64_t case_index, std::uint64_t attempt,
                         double now_s) {
  ledger_.Started(worker, case_index, attempt, now_s);
  starts_[{worker, case_index}] = {now_s, UtcNow()};
}

Acceptance CampaignBook::Accept(const std::string& worker, const std::string& host, std::uint64_t attempt,
                                const CaseResult& result, double now_s) {
  const Claim claim{worker, result.case_index, Fingerprint(result), false, host};
  const Acceptance acceptance =
      ledger_.Finished(worker, result.case_index, attempt, claim.fingerprint, now_s);
  auto start = starts_.extract({worker, result.case_index});
  switch (acceptance) {
    case Acceptance::kAccepted:
      DISPERSA_ASSERT(ledger_.IsResult(result.case_index, claim.fingerprint), result.case_index);
      CompareWithExpected(result, worker);
      results_.push_back(result);
      if (rule_) rule_->Add(result);
      if (tally_) tally_->Add(result);
      ++flown_now_;
      records_.push_back(start.empty() ? ExecutionRecord{result.case_index, worker, host, "", kUnknown}
                                       : ExecutionRecord{result.case_index, worker, host, start.mapped().utc,
                                                         now_s - start.mapped().now_s});
      if (audit_) audit_->Consider(claim);
      break;
    case Acceptance::kConflict: {
      const LogAbout about(campaign_.id);
      if (audit_) {
        Dispute(claim);
      } else if (campaign_.autopilot.plugin) {
        Try([&] {
          Flush();
          RefuseForDifference(store_->Load(result.case_index), FlownBy(result.case_index), result,
                              By(worker));
        });
        if (refusal_) break;
      }
      LogError("case {}: worker {} on {} returned other bits than an earlier result: {}", result.case_index,
               worker, host,
               audit_ ? "it is flown again here"
                      : "a processor, a library or a build breaks the floating-point contract; no result "
                        "can be trusted");
      break;
    }
    case Acceptance::kUnknown: {
      const LogAbout about(campaign_.id);
      LogError("case {} of worker {} on {} does not exist in this campaign", result.case_index, worker, host);
      break;
    }
    case Acceptance::kDuplicate:
      break;
  }
  return acceptance;
}

bool CampaignBook::FlushIfDue(double now_s) {
  const double period_s = pause_.empty() ? kFlushPeriod_s : kFullPeriod_s;
  if ((results_.size() < kFlushCount || !pause_.empty()) && now_s - flushed_s_ < period_s) return false;
  flushed_s_ = now_s;
  return TryFlush();
}

bool CampaignBook::TryFlush() {
  const LogAbout about(campaign_.id);
  if (!breakdown_.empty()) return false;
  bool is_stored = false;
  Guard([&] { is_stored = Try([this] { Flush(); }); });
  if (!is_stored) return false;
  if (!pause_.empty()) LogInfo("campaign {} continues: its results can be stored again", Title(campaign_));
  pause_.clear();
  return true;
}

void CampaignBook::Flush() {
  DISPERSA_ASSERT(results_.size() == records_.size(), results_.size(), records_.size());
  DISPERSA_ASSERT(flown_now_ >= results_.size(), flown_now_, results_.size());
  if (!results_.empty()) {
    store_->Store(results_, records_);
    results_.clear();
    records_.clear();
  }
  if (!audits_.empty()) {
    store_->AppendAudits(audits_);
    audits_.clear();
  }
  while (!disowned_.empty()) {
    RemoveResultsOf(disowned_.back());
    disowned_.pop_back();
  }
  if (ledger_.Progress().quarantined != quarantined_) {
    for (const CaseBlames& blamed : ledger_.Quarantined()) {
      // The reasons of each attempt name processes and signals; what is stored must not differ between runs.
      store_->Quarantine({blamed.case_index, blamed.is_certain
                                                 ? blamed.reasons.back()
                                                 : "every attempt to fly it ended or hung its worker"});
    }
    quarantined_ = ledger_.Progress().quarantined;
    DISPERSA_ASSERT(ledger_.Quarantined().size() == quarantined_, quarantined_);
  }
}

}  // namespace dispersa
