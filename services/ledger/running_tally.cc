#include "services/ledger/running_tally.h"

#include <cmath>

#include "core/analysis/campaign_summary.h"
#include "core/math/assertion.h"
#include "core/statistics/intervals.h"

namespace dispersa {

RunningTally::RunningTally(const Campaign& campaign)
    : requirements_(campaign.requirements),
      failures_(requirements_.size()),
      independent_(IsIndependent(campaign.sampling.method)) {
  const MetricList metrics = MetricsOf(campaign);
  metric_count_ = metrics.size();
  for (const Requirement& requirement : requirements_)
    columns_.push_back(metrics.PositionOf(requirement.metric));
  for (const std::string& metric : KeyMetrics(campaign)) {
    histograms_.push_back({metric, metrics.PositionOf(metric), {}, {}});
    for (const Requirement& requirement : requirements_)
      if (requirement.metric == metric) histograms_.back().limits = LimitsOf(requirement);
  }
}

void RunningTally::Add(const CaseResult& result) {
  DISPERSA_ASSERT(result.metrics.size() == metric_count_, result.case_index, result.metrics.size());
  ++n_;
  for (std::size_t i = 0; i < requirements_.size(); ++i) {
    const bool met = result.outcome == Outcome::kCompleted &&
                     LimitsOf(requirements_[i]).Meets(result.metrics[columns_[i]]);
    failures_[i] += met ? 0 : 1;
    DISPERSA_ASSERT(failures_[i] <= n_, failures_[i], n_);
  }
  if (result.outcome != Outcome::kCompleted) return;
  for (MetricHistogram& histogram : histograms_) {
    if (const double value = result.metrics[histogram.column]; std::isfinite(value))
      histogram.values.Add(histogram.limits.Represented(value));
  }
}

std::vector<RequirementStanding> RunningTally::Standings() const {
  std::vector<RequirementStanding> standings;
  for (std::size_t i = 0; i < requirements_.size(); ++i) {
    const Requirement& requirement = requirements_[i];
    RequirementStanding standing{requirement.metric, LineWords(RequirementLine(requirement)), n_,
                                 failures_[i], independent_ ? "inconclusive" : "study"};
    if (independent_ && n_ > 0) {
      const double confidence = 1.0 - requirement.consumer_risk, failing = 1.0 - requirement.probability;
      if (ClopperPearsonUpper(failures_[i], n_, confidence) <= failing) standing.so_far = "pass";
      if (ClopperPearsonLower(failures_[i], n_, confidence) > failing) standing.so_far = "fail";
    }
    standings.push_back(std::move(standing));
  }
  return standings;
}

}  // namespace dispersa
