#include "core/analysis/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <tuple>

#include "core/analysis/campaign_summary.h"
#include "core/analysis/load_check.h"
#include "core/analysis/requirement_summary.h"
#include "core/campaign/case_result.h"
#include "core/campaign/dispersion_table.h"
#include "core/flight/flight_inputs.h"
#include "core/results/requirement_text.h"
#include "core/results/sampling_text.h"
#include "core/results/text.h"
#include "core/statistics/paired.h"
#include "core/statistics/two_samples.h"

namespace dispersa {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Pairs that the comparison lists for each metric, in either direction.
constexpr std::size_t kNamedPairs = 5;

/// Rows of the case indices that both campaigns have, in ascending order.
struct SharedRows {
  std::vector<std::size_t> a, b;
};

SharedRows FindShared(const CaseColumns& a, const CaseColumns& b) {
  SharedRows shared;
  for (std::size_t row = 0, other = 0; row < a.rows(); ++row) {
    while (other < b.rows() && b.index[other] < a.index[row]) ++other;
    if (other == b.rows() || b.index[other] != a.index[row]) continue;
    shared.a.push_back(row);
    shared.b.push_back(other);
  }
  return shared;
}

std::string Cases(std::size_t count) { return fmt::format("{} case{}", count, count == 1 ? "" : "s"); }

Pairing FindPairing(const CaseColumns& a, const CaseColumns& b, const SharedRows& shared) {
  Pairing pairing;
  pairing.shared = shared.a.size();
  pairing.only_a = a.rows() - pairing.shared;
  pairing.only_b = b.rows() - pairing.shared;
  std::size_t varying = 0;
  for (std::size_t input = 0; input < std::min(a.inputs.size(), b.inputs.size()); ++input) {
    if (a.inputs[input].empty() || b.inputs[input].empty()) continue;
    const std::vector<double> of_a = a.inputs[input];
    const std::vector<double> of_b = b.inputs[input];
    std::size_t differs = 0;
    bool varies = false;
    for (std::size_t i = 0; i < pairing.shared; ++i) {
      differs += of_a[shared.a[i]] != of_b[shared.b[i]];
      varies = varies || of_a[shared.a[i]] != of_a[shared.a[0]] || of_b[shared.b[i]] != of_b[shared.b[0]];
    }
    if (differs > 0)
      pairing.changed.push_back({InputColumns()[input].name, InputKey(static_cast<int>(input)), differs});
    if (!varies) continue;
    ++varying;
    if (differs == 0) pairing.same.push_back(InputColumns()[input].name);
  }
  // An input that never varies is equal in both without any draw, so it does not show that cases are paired.
  pairing.paired = pairing.shared > 0 && (!pairing.same.empty() || (varying == 0 && pairing.changed.empty()));
  if (!pairing.paired) {
    pairing.sentence =
        pairing.shared == 0
            ? "Unpaired: no case index has a result in both campaigns."
            : "Unpaired: no input that varies has the same value in the same case of both campaigns. "
              "The flights are compared as two independent samples.";
    return pairing;
  }
  pairing.sentence =
      pairing.changed.empty()
          ? fmt::format("Paired: every input has the same value in both campaigns in all of {} shared.",
                        Cases(pairing.shared))
          : fmt::format(
                "Paired: {} of the {} inputs that vary have the same value in both campaigns in all of {} "
                "shared; the changed inputs are listed.",
                pairing.same.size(), varying, Cases(pairing.shared));
  if (pairing.only_a + pairing.only_b > 0) {
    pairing.sentence += fmt::format(" {} of A and {} of B have no partner and are left out.",
                                    Cases(pairing.only_a), Cases(pairing.only_b));
  }
  return pairing;
}

/// The values of one campaign that are compared. NaN is left out; an infinite value stands for a lost flight.
struct MetricValues {
  std::vector<double> values;
  std::size_t lost = 0;
};

MetricValues ValuesOf(const CaseColumns& cases, const std::vector<std::size_t>& rows,
                      const std::vector<double>& all, Worse worse) {
  MetricValues result;
  for (const std::size_t row : rows) {
    const bool lost = cases.outcome[row] != Outcome::kCompleted;
    result.lost += lost;
    double value = all[row];
    if (lost)
      value = worse == Worse::kNeither ? kUndefined : worse == Worse::kSmaller ? -kInfinity : kInfinity;
    result.values.push_back(value);
  }
  return result;
}

double NoInfinity(double value) { return std::isfinite(value) ? value : kUndefined; }

struct NamedProbability {
  const char* name;
  double probability;
};

std::vector<NamedProbability> TailsOf(Worse worse) {
  switch (worse) {
    case Worse::kLarger:
    case Worse::kFartherFromZero:
      return {{"p95", 0.95}, {"p99", 0.99}, {"p99_73", 0.9973}};
    case Worse::kSmaller:
      return {{"p05", 0.05}, {"p01", 0.01}, {"p00_27", 0.0027}};
    case Worse::kNeither:
      return {{"p05", 0.05}, {"p95", 0.95}, {"p01", 0.01}, {"p99", 0.99}};
  }
  return {};
}

/// The median of the pairs, and the pairs that gain and lose most. `sign` is -1 for a metric of which more is
/// better.
void ComparePairs(const std::vector<double>& a, const std::vector<double>& b,
                  const std::vector<std::uint64_t>& index, double sign, MetricComparison& result) {
  std::vector<double> turned_a, turned_b;
  for (std::size_t i = 0; i < a.size();
       ++i) {  // a lost flight is undefined to ComparePaired, and infinitely bad
    turned_a.push_back(std::isfinite(a[i]) ? sign * a[i] : kUndefined);
    turned_b.push_back(std::isfinite(b[i]) ? sign * b[i] : kUndefined);
  }
  const PairedDifference d = ComparePaired(turned_a, turned_b, kComparisonConfidence);
  result.difference = NoInfinity(sign * d.median_difference);
  result.interval = sign > 0.0 ? d.difference_interval
                               : Interval{-d.difference_interval.upper, -d.difference_interval.lower};
  if (sign > 0.0) {
    result.ratio = NoInfinity(d.median_ratio);
    result.ratio_interval = d.ratio_interval;
  }
  result.a_better = d.worse;
  result.b_better = d.better;
  result.equal = d.equal;
  result.p = d.sign_test_p;

  std::vector<std::size_t> order(a.size());
  std::vector<double> change(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    order[i] = i;
    const bool has_a = std::isfinite(a[i]), has_b = std::isfinite(b[i]);
    change[i] = has_a && has_b ? sign * (b[i] - a[i]) : has_a ? kInfinity : has_b ? -kInfinity : 0.0;
  }
  const auto name = [&](std::vector<MetricComparison::Pair>& named, double direction) {
    std::vector<std::size_t> worst(std::min(kNamedPairs, order.size()));
    std::partial_sort_copy(order.begin(), order.end(), worst.begin(), worst.end(),
                           [&](std::size_t i, std::size_t j) {
                             const double of_i = direction * change[i], of_j = direction * change[j];
                             return of_i != of_j ? of_i > of_j : i < j;
                           });
    for (const std::size_t i : worst) {
      if (direction * change[i] > 0.0) named.push_back({index[i], NoInfinity(a[i]), NoInfinity(b[i])});
    }
  };
  name(result.losses, 1.0);
  name(result.gains, -1.0);
}

/// The direction of the median. If as many pairs are better as worse, or without pairs, the ranks decide, as
/// in the test: a median may be that of a lost flight.
bool IsMedianWorse(const MetricComparison& metric, double sign) {
  if (metric.a_better != metric.b_better) return metric.a_better > metric.b_better;
  return sign * metric.tendency >= 0.0;
}

/// The finding is that of the largest difference that is certain and matters, with its p. The tails of a
/// metric are several families of tests, so each has its part of the risk.
void Judge(double practical_share, MetricComparison& metric) {
  const double least = practical_share * metric.scale;
  const double risk = 1.0 - kComparisonConfidence;
  const double sign = metric.info.worse == Worse::kSmaller ? -1.0 : 1.0;
  bool is_certain = false, is_worse = false;
  metric.found_p = metric.p_holm;
  const auto consider = [&](const std::string& name, double difference, double p, bool worse, bool matters) {
    const double effect =
        std::isfinite(difference) && metric.scale > 0.0 ? std::fabs(difference) / metric.scale : kInfinity;
    const bool is_first = !is_certain || (matters && metric.effect_in.empty());
    is_certain = true;
    if (!is_first && (!matters || effect <= metric.effect)) return;
    metric.found_in = name;
    metric.found_p = p;
    if (!matters) return;
    metric.effect = effect;
    metric.effect_in = name;
    is_worse = worse;
  };
  if (metric.p_holm <= risk)
    consider("median", metric.difference, metric.p_holm, IsMedianWorse(metric, sign),
             metric.lost_a != metric.lost_b || !(std::fabs(metric.difference) < least));
  for (const PercentileComparison& tail : metric.tails)
    if (tail.p_holm <= risk / static_cast<double>(metric.tails.size()) && std::isfinite(tail.difference) &&
        tail.difference != 0.0)
      consider(tail.name, tail.difference, tail.p_holm, sign * tail.difference > 0.0,
               std::fabs(tail.difference) >= least);
  metric.finding = !is_certain                            ? "not shown"
                   : metric.effect_in.empty()             ? kTooSmall
                   : metric.info.worse == Worse::kNeither ? "differs"
                   : is_worse                             ? "worse"
                                                          : "better";
}

/// What the metric's requirements allow, or how it spreads in A; if that is nothing, how far it reaches in
/// both.
void SetScale(const ComparedCampaign& a, const ComparedCampaign& b, ComparedValues values,
              MetricComparison& result) {
  double allowed = kInfinity;
  for (const Campaign* campaign : {&a.campaign, &b.campaign}) {
    for (const Requirement& requirement : campaign->requirements) {
      if (requirement.metric != result.metric) continue;
      // Of a place or an altitude a limit is no size: only a range has one.
      const double allows = requirement.within ? (*requirement.within)[1] - (*requirement.within)[0]
                            : result.info.worse == Worse::kNeither
                                ? 0.0
                                : std::fabs(requirement.above ? *requirement.above : *requirement.below);
      if (allows > 0.0) allowed = std::min(allowed, allows);
    }
  }
  if (std::isfinite(allowed)) {
    result.scale = allowed;
    result.scale_of = "limit";
    return;
  }
  const std::vector<double> of_a = SortedFinite(values.a);
  result.scale_of = "spread";
  result.scale = of_a.empty() ? 0.0 : Quantile(of_a, 0.95) - Quantile(of_a, 0.05);
  if (result.scale > 0.0) return;
  values.a.insert(values.a.end(), values.b.begin(), values.b.end());
  const std::vector<double> of_both = SortedFinite(values.a);
  result.scale_of = "range";
  result.scale = of_both.empty() ? 0.0 : of_both.back() - of_both.front();
}

MetricComparison CompareMetric(const std::string& metric, const ComparedCampaign& a_side,
                               const ComparedCampaign& b_side, const SharedRows& rows, bool paired,
                               bool independent) {
  const CaseColumns &a = a_side.cases, &b = b_side.cases;
  MetricComparison result;
  result.metric = metric;
  result.info = DescribeMetric(metric);
  const Worse worse = result.info.worse;
  const Circle circle = worse == Worse::kFartherFromZero ? Circle{} : result.info.circle;
  const ComparedValues compared = ValuesToCompare(a, b, metric);
  SetScale(a_side, b_side, compared, result);
  MetricValues of_a = ValuesOf(a, rows.a, compared.a, worse);
  MetricValues of_b = ValuesOf(b, rows.b, compared.b, worse);
  result.lost_a = of_a.lost;
  result.lost_b = of_b.lost;
  std::vector<std::uint64_t> index;
  if (paired) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < of_a.values.size(); ++i) {
      if (std::isnan(of_a.values[i]) || std::isnan(of_b.values[i])) continue;
      of_a.values[kept] = of_a.values[i];
      of_b.values[kept++] = of_b.values[i];
      index.push_back(a.index[rows.a[i]]);
    }
    result.undefined = of_a.values.size() - kept;
    of_a.values.resize(kept);
    of_b.values.resize(kept);
  } else {
    for (MetricValues* side : {&of_a, &of_b})
      result.undefined += std::erase_if(side->values, [](double value) { return std::isnan(value); });
  }
  result.n_a = of_a.values.size();
  result.n_b = of_b.values.size();
  if (result.n_a == 0 || result.n_b == 0) return result;

  // All around a circle there is no percentile. A pair still has a difference.
  const bool has_percentiles = !LiesAllAround(of_a.values, circle) && !LiesAllAround(of_b.values, circle);
  QuantileDifference median;
  if (has_percentiles)
    median = CompareQuantiles(of_a.values, of_b.values, 0.5, kComparisonConfidence, paired);
  result.median_a = median.a;
  result.median_b = median.b;
  if (paired) {
    std::vector<double> near_a = of_b.values;
    for (std::size_t i = 0; i < near_a.size(); ++i)
      if (std::isfinite(of_a.values[i])) near_a[i] = NearTo(of_a.values[i], near_a[i], circle);
    ComparePairs(of_a.values, near_a, index, worse == Worse::kSmaller ? -1.0 : 1.0, result);
  } else if (has_percentiles) {
    result.difference = median.difference;
    result.interval = median.interval;
    result.tendency = TendencyOf(of_a.values, of_b.values);
    result.p = LocationP(of_a.values, of_b.values);
  }
  for (const auto& [name, probability] : TailsOf(worse)) {
    if (!has_percentiles) break;
    const QuantileDifference tail =
        CompareQuantiles(of_a.values, of_b.values, probability, kComparisonConfidence, paired);
    PercentileComparison percentile{name,          probability, tail.a,    tail.b, tail.difference,
                                    tail.interval, kUndefined,  kUndefined};
    // If neither sample reaches the percentile, there is nothing to test.
    if (std::isfinite(tail.a) || std::isfinite(tail.b)) percentile.p = tail.p;
    result.tails.push_back(std::move(percentile));
  }
  if (!independent) {
    result.interval = result.ratio_interval = {kUndefined, kUndefined};
    result.p = kUndefined;
    for (PercentileComparison& tail : result.tails) {
      tail.interval = {kUndefined, kUndefined};
      tail.p = kUndefined;
    }
  }
  return result;
}

/// One family of tests for the medians, and one for each percentile.
void AdjustMetrics(double practical_share, std::vector<MetricComparison>& metrics) {
  std::vector<double> p;
  for (const MetricComparison& metric : metrics) p.push_back(metric.p);
  const std::vector<double> adjusted = HolmAdjusted(p);
  for (std::size_t i = 0; i < metrics.size(); ++i) metrics[i].p_holm = adjusted[i];
  for (const char* name : {"p95", "p99", "p99_73", "p05", "p01", "p00_27"}) {
    std::vector<PercentileComparison*> family;
    std::vector<double> tail_p;
    for (MetricComparison& metric : metrics) {
      for (PercentileComparison& tail : metric.tails) {
        if (tail.name != name) continue;
        family.push_back(&tail);
        tail_p.push_back(tail.p);
      }
    }
    const std::vector<double> tail_adjusted = HolmAdjusted(tail_p);
    for (std::size_t i = 0; i < family.size(); ++i) family[i]->p_holm = tail_adjusted[i];
  }
  for (MetricComparison& metric : metrics) Judge(practical_share, metric);
}

/// Whether each row fails a limit: lost, undefined or outside.
std::vector<bool> Failing(const Limits& limits, const std::vector<double>& completed,
                          const std::vector<std::size_t>& rows) {
  std::vector<bool> fails;
  for (const std::size_t row : rows) fails.push_back(!limits.Meets(completed[row]));
  return fails;
}

class CaseChanges {
 public:
  CaseChanges(const CaseColumns& a, const CaseColumns& b, const SharedRows& rows)
      : a_(a), b_(b), rows_(rows) {}

  /// `fails_a[i]` and `fails_b[i]` belong to pair i. `values_a` and `values_b` are indexed by row of their
  /// campaign; empty if the requirement has no value.
  void Add(const std::string& requirement, const std::vector<bool>& fails_a, const std::vector<bool>& fails_b,
           const std::vector<double>& values_a, const std::vector<double>& values_b, const Limits& limits) {
    for (std::size_t i = 0; i < fails_a.size(); ++i) {
      if (fails_a[i] == fails_b[i]) continue;
      ChangedCase& changed = (fails_b[i] ? harmed_ : rescued_)[i];
      changed.reasons.push_back({requirement, values_a.empty() ? kUndefined : values_a[rows_.a[i]],
                                 values_b.empty() ? kUndefined : values_b[rows_.b[i]], limits});
    }
  }
  std::vector<ChangedCase> Harmed() const { return List(harmed_); }
  std::vector<ChangedCase> Rescued() const { return List(rescued_); }

 private:
  std::vector<ChangedCase> List(const std::map<std::size_t, ChangedCase>& changes) const {
    std::vector<ChangedCase> list;
    for (const auto& [i, changed] : changes) {
      list.push_back(changed);
      list.back().case_index = a_.index[rows_.a[i]];
      list.back().outcome_a = a_.outcome[rows_.a[i]];
      list.back().outcome_b = b_.outcome[rows_.b[i]];
    }
    return list;
  }

  const CaseColumns& a_;
  const CaseColumns& b_;
  const SharedRows& rows_;
  std::map<std::size_t, ChangedCase> harmed_, rescued_;  ///< by pair
};

/// The flights that fail the requirement. Empty if the campaign's flights do not have the metric.
std::vector<bool> FailsOf(const ComparedCampaign& compared, const Requirement& requirement,
                          const std::vector<double>& values, const std::vector<std::size_t>& rows) {
  if (!WhyNotMeasured(compared.campaign, requirement.metric).empty()) return {};
  return Failing(LimitsOf(requirement), values, rows);
}

/// Of the rows that both have. A campaign without a checked limit has no failures.
void CompareLoadChecks(const ComparedCampaign& a, const ComparedCampaign& b, const SharedRows& rows,
                       Comparison& comparison) {
  const auto failures = [](const ComparedCampaign& of, const std::vector<std::size_t>& chosen) {
    const std::vector<bool> beyond = BeyondCheckedLimits(of.campaign, of.cases);
    std::size_t count = 0;
    if (!beyond.empty())
      for (const std::size_t row : chosen) count += beyond[row];
    return count;
  };
  std::vector<LoadCheck> checks = CheckLoads(a.campaign, a.cases);
  if (checks.empty()) checks = CheckLoads(b.campaign, b.cases);
  for (const LoadCheck& check : checks)
    comparison.load_checks.push_back({check.metric, failures(a, rows.a), failures(b, rows.b)});
}

void CompareRequirements(const ComparedCampaign& a, const ComparedCampaign& b, const SharedRows& rows,
                         Comparison& comparison) {
  const bool paired = comparison.pairing.paired;
  std::vector<Requirement> requirements = a.campaign.requirements;
  requirements.insert(requirements.end(), b.campaign.requirements.begin(), b.campaign.requirements.end());
  CompareLoadChecks(a, b, rows, comparison);
  CaseChanges changes(a.cases, b.cases, rows);
  if (paired) {
    const auto lost = [](const CaseColumns& cases, const std::vector<std::size_t>& of) {
      std::vector<bool> is_lost;
      for (const std::size_t row : of) is_lost.push_back(cases.outcome[row] != Outcome::kCompleted);
      return is_lost;
    };
    changes.Add("flight completed", lost(a.cases, rows.a), lost(b.cases, rows.b), {}, {}, {});
  }
  for (std::size_t i = 0; i < requirements.size(); ++i) {
    const std::string words = LimitText(requirements[i]);
    const bool of_a = i < a.campaign.requirements.size();
    const auto known = std::find_if(comparison.requirements.begin(), comparison.requirements.end(),
                                    [&](const RequirementComparison& each) { return each.words == words; });
    if (known != comparison.requirements.end()) {
      (of_a ? known->in_a : known->in_b) = true;
      continue;
    }
    RequirementComparison result;
    result.metric = requirements[i].metric;
    result.words = words;
    (of_a ? result.in_a : result.in_b) = true;
    const std::vector<double> values_a = ValuesToJudge(requirements[i], a.cases);
    const std::vector<double> values_b = ValuesToJudge(requirements[i], b.cases);
    const std::vector<bool> fails_a = FailsOf(a, requirements[i], values_a, rows.a);
    const std::vector<bool> fails_b = FailsOf(b, requirements[i], values_b, rows.b);
    result.n_a = fails_a.size();
    result.n_b = fails_b.size();
    result.failures_a = static_cast<std::size_t>(std::count(fails_a.begin(), fails_a.end(), true));
    result.failures_b = static_cast<std::size_t>(std::count(fails_b.begin(), fails_b.end(), true));
    double correlation = 0.0;
    if (paired && result.n_a == result.n_b) {
      for (std::size_t pair = 0; pair < fails_a.size(); ++pair) {
        ++(fails_a[pair] ? (fails_b[pair] ? result.both_fail : result.only_a_fails)
                         : (fails_b[pair] ? result.only_b_fails : result.both_meet));
      }
      changes.Add(words, fails_a, fails_b, values_a, values_b, LimitsOf(requirements[i]));
      const auto real = [](std::size_t count) { return static_cast<double>(count); };
      const double margins = real(result.failures_a) * real(result.n_a - result.failures_a) *
                             real(result.failures_b) * real(result.n_b - result.failures_b);
      if (margins > 0.0) {
        correlation = (real(result.both_fail) * real(result.both_meet) -
                       real(result.only_a_fails) * real(result.only_b_fails)) /
                      std::sqrt(margins);
      }
    }
    if (result.n_a > 0 && result.n_b > 0) {
      const auto count = [](std::size_t n) { return static_cast<std::int64_t>(n); };
      const double rate_a = static_cast<double>(result.failures_a) / static_cast<double>(result.n_a);
      const double rate_b = static_cast<double>(result.failures_b) / static_cast<double>(result.n_b);
      result.difference = rate_b - rate_a;
      if (comparison.independent) {
        result.interval = DifferenceLimits(
            rate_a, ClopperPearson(count(result.failures_a), count(result.n_a), kComparisonConfidence),
            rate_b, ClopperPearson(count(result.failures_b), count(result.n_b), kComparisonConfidence),
            correlation);
        result.p = paired ? McNemarP(count(result.only_a_fails), count(result.only_b_fails))
                          : FisherP(count(result.failures_a), count(result.n_a), count(result.failures_b),
                                    count(result.n_b));
      }
    }
    comparison.requirements.push_back(std::move(result));
  }
  std::vector<double> p;
  for (const RequirementComparison& requirement : comparison.requirements) p.push_back(requirement.p);
  const std::vector<double> adjusted = HolmAdjusted(p);
  for (std::size_t i = 0; i < adjusted.size(); ++i) {
    RequirementComparison& requirement = comparison.requirements[i];
    requirement.p_holm = adjusted[i];
    const bool shown = adjusted[i] <= 1.0 - kComparisonConfidence && requirement.difference != 0.0;
    requirement.finding = !shown ? "not shown" : requirement.difference > 0.0 ? "worse" : "better";
  }
  comparison.harmed = changes.Harmed();
  comparison.rescued = changes.Rescued();
}

Comparison::Side SideOf(const ComparedCampaign& compared) {
  const Campaign& campaign = compared.campaign;
  return {compared.folder,
          campaign.name,
          campaign.id,
          campaign.flight_id,
          compared.engine,
          campaign.vehicle.name,
          campaign.reference.name,
          campaign.autopilot.name,
          SamplingMethodName(campaign.sampling.method),
          campaign.sampling.seed,
          compared.to_fly.value_or(campaign.sampling.cases),
          compared.cases.rows(),
          compared.cases.rows() - LostCount(compared.cases),
          !(campaign.autopilot.plugin && campaign.autopilot.plugin->in_python)};
}

/// What the changed values are of, by the first part of their path.
std::string DiffersWords(const std::vector<CampaignChange>& changes) {
  std::vector<std::pair<std::string, std::size_t>> parts;
  for (const CampaignChange& change : changes) {
    const std::string part = change.path.substr(0, change.path.find_first_of(".["));
    const auto known =
        std::find_if(parts.begin(), parts.end(), [&](const auto& one) { return one.first == part; });
    ++(known == parts.end() ? parts.emplace_back(part, 0).second : known->second);
  }
  std::string words;
  for (std::size_t i = 0; i < parts.size(); ++i)
    words += fmt::format("{}{} ({} value{})",
                         i == 0                  ? ""
                         : i + 1 == parts.size() ? " and "
                                                 : ", ",
                         parts[i].first, parts[i].second, parts[i].second == 1 ? "" : "s");
  return words;
}

/// "injection_altitude_km" of "injection_altitude_error_km"; empty if the metric is no error.
std::string ValueOfError(const std::string& metric) {
  const std::size_t at = metric.find("_error_");
  return at == std::string::npos ? "" : metric.substr(0, at) + metric.substr(at + 6);
}

/// So that one change is counted once.
void MarkCounted(std::vector<MetricComparison>& metrics) {
  for (MetricComparison& metric : metrics) {
    const bool has_error = std::any_of(metrics.begin(), metrics.end(), [&](const MetricComparison& other) {
      return ValueOfError(other.metric) == metric.metric;
    });
    metric.is_counted = !metric.info.is_part && !has_error;
  }
}

struct Findings {
  std::size_t all = 0, better = 0, worse = 0, differs = 0, too_small = 0;

  void Add(const std::string& finding) {
    ++all;
    better += finding == "better";
    worse += finding == "worse";
    differs += finding == "differs";
    too_small += finding == kTooSmall;
  }
  const char* Together() const {
    return better > 0 && worse > 0 ? "mixed" : better > 0 ? "better" : worse > 0 ? "worse" : "";
  }
};

/// " B is worse in 3 of 7 requirements, most in pitch_error_rms_deg below 0.05: broken in 601 of 1000 flights
/// of B, in 0 of 1000 of A."; empty if there is none.
std::string FoundWords(const std::vector<RequirementComparison>& requirements, const std::string& finding,
                       std::size_t count) {
  const RequirementComparison* most = nullptr;
  for (const RequirementComparison& each : requirements)
    if (each.finding == finding &&
        (most == nullptr || std::fabs(each.difference) > std::fabs(most->difference)))
      most = &each;
  if (most == nullptr) return "";
  return fmt::format(
      "B is {} in {} of {} requirement{}{}{}: broken in {} of {} flights of B, in {} of {} of A.", finding,
      count, requirements.size(), requirements.size() == 1 ? "" : "s", count == 1 ? ", " : ", most in ",
      most->words, most->failures_b, most->n_b, most->failures_a, most->n_a);
}

/// " The largest change for the worse: pitch_error_rms_deg, median …."; empty if no counted metric has the
/// finding.
std::string LargestWords(const std::vector<const MetricComparison*>& by_effect, const std::string& finding,
                         const char* title) {
  for (const MetricComparison* each : by_effect)
    if (each->is_counted && each->finding == finding)
      return fmt::format(" {}: {}, {}.", title, each->metric, EffectWords(*each));
  return "";
}

/// Of the largest effect; a metric that is neither good nor bad says something only if there is no other.
std::string FindingByEffect(const std::vector<const MetricComparison*>& by_effect) {
  std::string differs = "no relevant difference";
  for (const MetricComparison* each : by_effect) {
    if (!each->is_counted || each->effect_in.empty()) continue;
    if (each->finding != "differs") return each->finding;
    differs = each->finding;
  }
  return differs;
}

void Conclude(Comparison& comparison) {
  MarkCounted(comparison.metrics);
  Findings requirements, metrics;
  for (const RequirementComparison& each : comparison.requirements) requirements.Add(each.finding);
  for (const MetricComparison& each : comparison.metrics)
    if (each.is_counted) metrics.Add(each.finding);
  std::string& sentence = comparison.sentence;
  if (!comparison.independent) {
    comparison.finding = "not judged";
    sentence =
        "The points of at least one campaign are chosen, not drawn: differences are shown without limits.";
  } else {
    const std::vector<const MetricComparison*> by_effect = ByEffect(comparison);
    comparison.finding = requirements.Together();
    if (comparison.finding.empty()) comparison.finding = FindingByEffect(by_effect);
    if (comparison.requirements.empty()) {
      sentence = "Neither campaign states a requirement.";
    } else if (requirements.better + requirements.worse == 0) {
      sentence = "No requirement is shown to be broken more often in A or in B.";
    } else {
      sentence = FoundWords(comparison.requirements, "worse", requirements.worse);
      const std::string better = FoundWords(comparison.requirements, "better", requirements.better);
      sentence += (sentence.empty() || better.empty() ? "" : " ") + better;
    }
    const std::string worse = LargestWords(by_effect, "worse", "The largest change for the worse");
    const std::string better = LargestWords(by_effect, "better", "The largest change for the better");
    const bool is_better_first = comparison.finding == "better";
    sentence += (is_better_first ? better : worse) + (is_better_first ? worse : better) +
                LargestWords(by_effect, "differs", "The largest change that is neither good nor bad");
    sentence += fmt::format(
        " Of {} metrics, each counted once, B is better in {}, worse in {}, and differs in {} that are "
        "neither good nor bad.{}",
        metrics.all, metrics.better, metrics.worse, metrics.differs,
        metrics.too_small == 0
            ? ""
            : fmt::format(" In {} the difference is certain but too small to matter: less than {} of the "
                          "limit or of the spread.",
                          metrics.too_small, PercentText(comparison.practical_share)));
  }
  if (comparison.pairing.paired) {
    sentence += fmt::format(" {} harmed by the change from A to B, {} rescued.",
                            Cases(comparison.harmed.size()), comparison.rescued.size());
  }
}

}  // namespace

ComparedValues ValuesToCompare(const CaseColumns& a, const CaseColumns& b, const std::string& metric) {
  ComparedValues values{CompletedValues(a, metric), CompletedValues(b, metric)};
  const MetricInfo info = DescribeMetric(metric);
  if (info.worse == Worse::kFartherFromZero) {
    for (std::vector<double>* side : {&values.a, &values.b})
      for (double& value : *side) value = std::fabs(NearTo(0.0, value, info.circle));
    return values;
  }
  const std::optional<double> of_a = CentreOf(values.a, info.circle), of_b = CentreOf(values.b, info.circle);
  if (of_a && of_b)
    for (double& value : values.b) value += NearTo(*of_a, *of_b, info.circle) - *of_b;
  return values;
}

std::vector<std::string> IncompleteSides(const Comparison& comparison) {
  std::vector<std::string> sides;
  for (const auto& [letter, side] : {std::pair{"A", &comparison.a}, std::pair{"B", &comparison.b}})
    if (side->flown < side->cases)
      sides.push_back(fmt::format("{} ({}) is incomplete: {}", letter, SideTitle(comparison, *side),
                                  MissingWords(side->flown, side->cases)));
  return sides;
}

std::string SideTitle(const Comparison& comparison, const Comparison::Side& side) {
  const auto last = [](const std::string& folder) {
    const std::filesystem::path path = std::filesystem::path(folder + "/.").lexically_normal();
    return path.parent_path().filename().string();
  };
  const std::string title = last(side.folder);
  return title.empty() || last(comparison.a.folder) == last(comparison.b.folder) ? side.folder : title;
}

std::vector<const MetricComparison*> ByEffect(const Comparison& comparison) {
  std::vector<const MetricComparison*> metrics;
  for (const MetricComparison& each : comparison.metrics) metrics.push_back(&each);
  std::stable_sort(metrics.begin(), metrics.end(), [](const auto* x, const auto* y) {
    return x->effect_in.empty() != y->effect_in.empty() ? y->effect_in.empty() : x->effect > y->effect;
  });
  return metrics;
}

std::string ShareOfScale(const MetricComparison& metric) {
  const std::string scale = metric.scale_of + (metric.scale_of == "spread"  ? " of A"
                                               : metric.scale_of == "range" ? " of A and B"
                                                                            : "");
  return metric.effect < 1.0 ? fmt::format("{:.2g} % of the {}", 100.0 * metric.effect, scale)
                             : fmt::format("{} times the {}", RoundedText(metric.effect), scale);
}

std::string EffectWords(const MetricComparison& metric) {
  if (metric.effect_in.empty()) return "";
  double a = metric.median_a, b = metric.median_b, difference = metric.difference;
  for (const PercentileComparison& tail : metric.tails)
    if (tail.name == metric.effect_in) std::tie(a, b, difference) = std::tie(tail.a, tail.b, tail.difference);
  const auto value = [&](double number) {
    if (!std::isfinite(number)) return std::string("a lost flight");
    const std::string text = std::isfinite(difference) && difference != 0.0
                                 ? ScatterText(number, 0.1 * std::fabs(difference))
                                 : RoundedText(number);
    return metric.info.unit.empty() ? text : text + " " + metric.info.unit;
  };
  std::string words = fmt::format("{} {} in A, {} in B", metric.effect_in, value(a), value(b));
  if (std::isfinite(metric.effect)) words += ": a change by " + ShareOfScale(metric);
  if (metric.lost_a != metric.lost_b)
    words += fmt::format("; {} flights lost in A, {} in B", metric.lost_a, metric.lost_b);
  return words;
}

Comparison Compare(const ComparedCampaign& a, const ComparedCampaign& b,
                   const std::vector<std::string>& metrics, std::vector<CampaignChange> changes,
                   double practical_share) {
  Comparison comparison;
  comparison.practical_share = practical_share;
  comparison.differs = DiffersWords(changes);
  comparison.a = SideOf(a);
  comparison.b = SideOf(b);
  comparison.changes = std::move(changes);
  comparison.independent =
      IsIndependent(a.campaign.sampling.method) && IsIndependent(b.campaign.sampling.method);
  SharedRows rows = FindShared(a.cases, b.cases);
  comparison.pairing = FindPairing(a.cases, b.cases, rows);
  if (!comparison.pairing.paired) {
    rows = {};
    for (std::size_t row = 0; row < a.cases.rows(); ++row) rows.a.push_back(row);
    for (std::size_t row = 0; row < b.cases.rows(); ++row) rows.b.push_back(row);
  }
  std::vector<std::string> candidates = metrics.empty() ? MetricNames() : metrics;
  if (metrics.empty())
    for (const OwnMetric& metric : a.campaign.own_metrics)
      if (FindOwn({metric}, b.campaign.own_metrics)) candidates.push_back(metric.name);
  for (const std::string& metric : candidates) {
    if (!WhyNotMeasured(a.campaign, metric).empty() || !WhyNotMeasured(b.campaign, metric).empty()) continue;
    MetricComparison result =
        CompareMetric(metric, a, b, rows, comparison.pairing.paired, comparison.independent);
    const bool defined =
        std::isfinite(result.median_a) || std::isfinite(result.median_b) || result.lost_a + result.lost_b > 0;
    if (!metrics.empty() || (result.n_a > 0 && result.n_b > 0 && defined))
      comparison.metrics.push_back(std::move(result));
  }
  AdjustMetrics(practical_share, comparison.metrics);
  CompareRequirements(a, b, rows, comparison);
  Conclude(comparison);
  return comparison;
}

std::string ReplayCommand(const std::string& folder, std::uint64_t case_index) {
  return fmt::format("dispersa replay {} --case {}", ShellWord(folder), case_index);
}

std::string ReplayCommand(const Comparison::Side& side, std::uint64_t case_index) {
  return side.has_its_law ? ReplayCommand(side.folder, case_index) : "";
}

}  // namespace dispersa
