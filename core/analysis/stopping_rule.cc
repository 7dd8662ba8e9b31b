#include "core/analysis/stopping_rule.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/analysis/requirement_summary.h"
#include "core/campaign/case_result.h"
#include "core/results/sampling_text.h"

namespace dispersa {
namespace {

/// Least distance between looks of an anytime plan, in cases. Such a plan could stop after every case; the
/// rule looks about a hundred times.
constexpr std::uint64_t kLeastStep = 20;

std::vector<std::uint64_t> StoppingLooks(const Campaign& campaign, std::int64_t planned) {
  std::set<std::uint64_t> looks = {campaign.sampling.cases};
  for (const Requirement& requirement : campaign.requirements) {
    for (const std::int64_t look : LookCounts(requirement.plan, planned))
      looks.insert(static_cast<std::uint64_t>(look));
    if (requirement.plan.kind != PlanKind::kAnytime) continue;
    const std::uint64_t step = std::max(kLeastStep, (campaign.sampling.cases + 99) / 100);
    for (std::uint64_t look = step; look < campaign.sampling.cases; look += step) looks.insert(look);
  }
  looks.erase(looks.upper_bound(campaign.sampling.cases), looks.end());
  return {looks.begin(), looks.end()};
}

}  // namespace

StoppingRule::StoppingRule(const Campaign& campaign, std::int64_t planned,
                           std::vector<std::int64_t> past_looks)
    : requirements_(campaign.requirements),
      holm_(campaign.verdicts.holm),
      stops_(campaign.verdicts.stop_when_decided && IsIndependent(campaign.sampling.method) &&
             !campaign.requirements.empty()),
      planned_(planned),
      past_looks_(std::move(past_looks)),
      looks_(stops_ ? StoppingLooks(campaign, planned) : std::vector{campaign.sampling.cases}),
      target_(looks_.front()),
      failed_(requirements_.size()) {
  const MetricList metrics = MetricsOf(campaign);
  for (const Requirement& requirement : requirements_)
    columns_.push_back(metrics.PositionOf(requirement.metric));
}

void StoppingRule::Add(const CaseResult& result) {
  std::vector<double> values;
  for (const std::size_t column : columns_) values.push_back(result.metrics[column]);
  Add(result.case_index, result.outcome == Outcome::kCompleted, values);
}

void StoppingRule::Add(const CaseColumns& cases) {
  if (!stops_) return;
  std::vector<std::vector<double>> columns;
  for (const std::size_t column : columns_) columns.push_back(cases.metrics[column]);
  std::vector<double> values(columns_.size());
  for (std::size_t row = 0; row < cases.rows(); ++row) {
    for (std::size_t i = 0; i < columns_.size(); ++i) values[i] = columns[i][row];
    Add(cases.index[row], cases.outcome[row] == Outcome::kCompleted, values);
  }
}

void StoppingRule::Add(std::uint64_t case_index, bool completed, const std::vector<double>& values) {
  if (!stops_) return;
  present_.push_back(case_index);
  for (std::size_t i = 0; i < requirements_.size(); ++i) {
    if (!completed || !LimitsOf(requirements_[i]).Meets(values[i]))
      failed_[i].push_back(static_cast<std::int64_t>(case_index));
  }
}

bool StoppingRule::Settled(const std::vector<std::uint64_t>& quarantined) const {
  std::set<std::uint64_t> settled(quarantined.begin(), quarantined.end());
  settled.insert(present_.begin(), present_.end());
  return std::distance(settled.begin(), settled.lower_bound(target_)) == static_cast<std::ptrdiff_t>(target_);
}

bool StoppingRule::Advance(const std::vector<std::uint64_t>& quarantined) {
  if (!stops_ || target_ == looks_.back() || !Settled(quarantined)) return false;
  // A folder may hold cases beyond the target from an earlier run without this rule. They stay.
  const bool all_seen = present_.empty() || *std::max_element(present_.begin(), present_.end()) < target_;
  if (all_seen && Decided(quarantined)) return false;
  target_ = *std::upper_bound(looks_.begin(), looks_.end(), target_);
  return true;
}

bool StoppingRule::Decided(const std::vector<std::uint64_t>& quarantined) const {
  std::vector<PlannedRequirement> planned;
  std::vector<CaseTally> tallies;
  for (std::size_t i = 0; i < requirements_.size(); ++i) {
    const Requirement& requirement = requirements_[i];
    planned.push_back({requirement.probability, requirement.consumer_risk, requirement.plan, planned_});
    CaseTally tally{failed_[i], {quarantined.begin(), quarantined.end()}};
    std::sort(tally.failed.begin(), tally.failed.end());
    std::sort(tally.missing.begin(), tally.missing.end());
    tallies.push_back(std::move(tally));
  }
  const auto verdicts = DecideAll(planned, holm_, static_cast<std::int64_t>(target_), tallies, past_looks_);
  return std::none_of(verdicts.begin(), verdicts.end(), [](const PlannedVerdict& verdict) {
    return verdict.verdict == Verdict::kInconclusive;
  });
}

}  // namespace dispersa
