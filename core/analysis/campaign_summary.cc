#include "core/analysis/campaign_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <sstream>

#include "core/analysis/likeness.h"
#include "core/analysis/stopping_rule.h"
#include "core/campaign/case_design.h"
#include "core/campaign/case_result.h"
#include "core/flight/step_limits.h"
#include "core/flight/structural_limits.h"
#include "core/input/input_error.h"
#include "core/results/metric_catalogue.h"
#include "core/results/sampling_text.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr std::size_t kWorstCases = 5;
/// Of them lost flights: all of those have their own list, and they shall not hide what limits the others.
constexpr std::size_t kLostAmongWorst = 1;

/// Between all limits that requirements set for a metric; none: no requirement does.
std::optional<Limits> AllLimits(const std::vector<Requirement>& requirements, const std::string& metric) {
  std::optional<Limits> all;
  for (const Requirement& requirement : requirements) {
    if (requirement.metric != metric) continue;
    const Limits limits = LimitsOf(requirement);
    if (!all) all.emplace();
    all->low = std::max(all->low, limits.low);
    all->high = std::min(all->high, limits.high);
    all->circle = limits.circle;
  }
  return all;
}

/// Worse is what has the smaller margin to the metric's limits. Without limits the metric's own sense
/// decides.
WorstCases FindWorst(const std::string& metric, const std::optional<Limits>& limits,
                     const CaseColumns& cases) {
  const std::vector<double> values = MeasuredValues(cases, metric);
  const Worse sense = DescribeMetric(metric).worse;
  constexpr Limits kBadness = {.high = 0.0};  // larger is worse
  const auto is_worse_value = [&](double a, double b) {
    return limits ? limits->IsWorse(a, b) : kBadness.IsWorse(Badness(sense, a), Badness(sense, b));
  };
  const auto is_worse = [&](std::size_t a, std::size_t b) {
    if (is_worse_value(values[a], values[b])) return true;
    return !is_worse_value(values[b], values[a]) && a < b;
  };
  // The worst of some rows, in order.
  const auto add = [&](std::vector<std::size_t> rows, std::size_t count, WorstCases* result) {
    const auto end = rows.begin() + static_cast<std::ptrdiff_t>(std::min(count, rows.size()));
    std::partial_sort(rows.begin(), end, rows.end(), is_worse);
    for (auto row = rows.begin(); row != end; ++row) {
      WorstCase one{.case_index = cases.index[*row], .value = std::nullopt, .outcome = cases.outcome[*row]};
      if (std::isfinite(values[*row])) one.value = values[*row];
      result->cases.push_back(one);
    }
  };
  std::vector<std::size_t> lost, others;
  for (std::size_t i = 0; i < cases.rows(); ++i) {
    const bool is_lost = cases.outcome[i] != Outcome::kCompleted || !std::isfinite(values[i]);
    (is_lost ? lost : others).push_back(i);
  }
  WorstCases result{.metric = metric, .cases = {}};
  add(std::move(lost), kLostAmongWorst, &result);
  add(std::move(others), kWorstCases - result.cases.size(), &result);
  return result;
}

CampaignVerdict Overall(const CampaignSummary& summary) {
  if (summary.flown < summary.cases) return CampaignVerdict::kIncomplete;
  const auto any = [&](const auto& condition) {
    return std::any_of(summary.requirements.begin(), summary.requirements.end(), condition);
  };
  const auto is = [](const char* verdict) {
    return [verdict](const RequirementSummary& requirement) { return requirement.verdict == verdict; };
  };
  const bool is_beyond = std::any_of(summary.load_checks.begin(), summary.load_checks.end(),
                                     [](const LoadCheck& check) { return check.failures > 0; });
  if (!IsIndependent(summary.sampling) && (is_beyond || !summary.requirements.empty())) {
    if (summary.cases < summary.design_points) return CampaignVerdict::kIncomplete;
    return is_beyond || any([](const RequirementSummary& requirement) { return requirement.failures > 0; })
               ? CampaignVerdict::kStudyViolated
               : CampaignVerdict::kStudy;
  }
  if (is_beyond || any(is("fail"))) return CampaignVerdict::kFail;
  if (summary.requirements.empty()) return CampaignVerdict::kNothingJudged;
  return any(is("not_evidence"))   ? CampaignVerdict::kNotEvidence
         : any(is("inconclusive")) ? CampaignVerdict::kInconclusive
                                   : CampaignVerdict::kPass;
}

void HoldAgainstLimits(const StructuralLimits& limits, const CaseColumns& cases, CampaignSummary* summary) {
  for (const StructuralLimit& one : AllStructuralLimits()) {
    if (!(limits.*one.limit > 0.0)) continue;
    CampaignSummary::Limit held{.metric = one.metric, .limit = limits.*one.limit};
    const std::vector<double> loads = cases.metrics.at(MetricColumn(one.metric));
    for (std::size_t i = 0; i < cases.rows(); ++i) {
      held.exceeded += loads[i] > held.limit;
      if (!(loads[i] > held.largest.value_or(-HUGE_VAL))) continue;
      held.largest = loads[i];
      held.largest_case = cases.index[i];
    }
    summary->limits.push_back(std::move(held));
  }
  if (summary->limits.empty()) return;
  const std::vector<double> any = cases.metrics.at(MetricColumn("structural_limit_exceeded"));
  summary->beyond_limits = static_cast<std::uint64_t>(
      std::count_if(any.begin(), any.end(), [](double exceeded) { return exceeded > 0.0; }));
}

/// Flights with a part that a step hardly resolves, and those that were refused for one.
std::uint64_t NearStepLimit(const CaseColumns& cases) {
  const std::vector<double> fractions = cases.metrics.at(MetricColumn("step_limit_fraction"));
  return static_cast<std::uint64_t>(std::count_if(fractions.begin(), fractions.end(),
                                                  [](double fraction) { return fraction > kNearStepLimit; }));
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

const char* CampaignVerdictName(CampaignVerdict verdict) {
  switch (verdict) {
    case CampaignVerdict::kPass:
      return "pass";
    case CampaignVerdict::kNothingJudged:
      return "nothing_judged";
    case CampaignVerdict::kInconclusive:
      return "inconclusive";
    case CampaignVerdict::kNotEvidence:
      return "not_evidence";
    case CampaignVerdict::kStudy:
    case CampaignVerdict::kStudyViolated:
      return "study";
    case CampaignVerdict::kFail:
      return "fail";
    case CampaignVerdict::kIncomplete:
      return "incomplete";
  }
  return "";
}

std::uint64_t CasesToFly(const ResultFolder& folder, const Campaign& campaign, const CaseColumns& cases) {
  StoppingRule rule(campaign, folder.PlannedCases(), folder.PastLooks());
  rule.Add(cases);
  std::vector<std::uint64_t> quarantined;
  for (const QuarantinedCase& one : folder.QuarantinedCases()) quarantined.push_back(one.case_index);
  while (rule.Advance(quarantined)) {
  }
  return rule.target();
}

void RequireWhole(const ResultFolder& folder) {
  if (!folder.ItsShare()) return;
  throw InputError(folder.directory().string() + ": is a share of a campaign, which is judged as a whole",
                   "the folder that `dispersa merge` makes of all shares");
}

std::string MissingWords(std::uint64_t flown, std::uint64_t cases) {
  return fmt::format("{} of {} cases have a result", flown, cases);
}

std::vector<std::string> Warnings(const CampaignSummary& summary) {
  std::vector<std::string> warnings;
  if (summary.nominal && summary.nominal->outcome != Outcome::kCompleted)
    warnings.push_back(NominalLoss(*summary.nominal));
  if (summary.python_law)
    warnings.push_back(
        fmt::format("Flown with a Python law, {}: nobody without it can fly these cases again.",
                    summary.python_law->name));
  const bool independent = IsIndependent(summary.sampling);
  if (summary.flown < summary.cases) {
    warnings.push_back("Incomplete: " + MissingWords(summary.flown, summary.cases) + ".");
    for (const RequirementSummary& requirement : summary.requirements) {
      if (requirement.verdict != "fail") continue;
      warnings.push_back(
          fmt::format("Not met whatever the missing cases bring: {}.", RequirementWords(requirement)));
    }
  }
  if (summary.cases < summary.design_points) {
    warnings.push_back(fmt::format("Incomplete design: {} of its {} points are in the campaign.",
                                   summary.cases, summary.design_points));
  }
  if (!independent && !summary.requirements.empty()) {
    warnings.push_back(
        "Design study: its points are chosen, not drawn, so it shows no probability in flight.");
  }
  for (const RequirementSummary& requirement : summary.requirements) {
    if (requirement.contradicted)
      warnings.push_back(fmt::format("Contradiction: {} was decided both ways.", requirement.metric));
  }
  if (summary.beyond_limits > 0) {
    std::string loads;
    for (const CampaignSummary::Limit& one : summary.limits) {
      if (one.exceeded == 0) continue;
      const MetricInfo info = DescribeMetric(one.metric);
      const std::string unit = info.unit.empty() ? "" : " " + info.unit;
      loads += fmt::format("{}{} above {}{} in {}, up to {}{} in case {}", loads.empty() ? "" : "; ",
                           one.metric, StatedText(one.limit), unit, one.exceeded,
                           RoundedText(*one.largest, Rounding::kNearest, one.limit), unit, one.largest_case);
    }
    warnings.push_back(fmt::format("Structural limits of the vehicle were exceeded in {} of {} flights: {}.",
                                   summary.beyond_limits, summary.flown, loads));
  }
  if (summary.near_step_limit > 0) {
    warnings.push_back(
        fmt::format("Near the limit of the integration's step: in {} of {} flights the fastest actuator or "
                    "bending mode has more than {:.0f} % of the frequency that a step resolves "
                    "(step_limit_fraction); shorter ticks of the autopilot resolve more.",
                    summary.near_step_limit, summary.flown, 100.0 * kNearStepLimit));
  }
  const std::uint64_t completed = summary.outcomes[static_cast<std::size_t>(Outcome::kCompleted)];
  if (completed < summary.flown) {
    warnings.push_back(
        fmt::format("{} of {} flights were lost: statistics and percentiles cover the {} that were "
                    "completed, and every lost flight fails every requirement.",
                    summary.flown - completed, summary.flown, completed));
  }
  return warnings;
}

std::vector<std::string> WithWarnings(std::vector<std::string> notes, const CampaignSummary& summary) {
  for (std::string& warning : Warnings(summary)) {
    const bool is_first = summary.nominal && warning == NominalLoss(*summary.nominal);
    notes.insert(is_first ? notes.begin() : notes.end(), std::move(warning));
  }
  return notes;
}

std::string JointRiskSentence(const CampaignSummary& summary) {
  if (summary.requirements.empty() || !IsIndependent(summary.sampling)) return "";
  std::string sentence =
      fmt::format("A design that misses any requirement passes them all with a probability of at most {}.",
                  PercentText(summary.overall_risk));
  if (summary.requirements.size() > 1) {
    sentence += summary.holm
                    ? fmt::format(" The risk that any of the {} passes is wrong is at most {} (Holm).",
                                  summary.requirements.size(), PercentText(summary.any_risk))
                    : fmt::format(
                          " The risks that the {} requirements allow add up to {}; joint: holm keeps them "
                          "together at the largest one.",
                          summary.requirements.size(), PercentText(summary.any_risk));
  }
  return sentence;
}

std::string AdviceTogether(const CampaignSummary& summary) {
  std::int64_t open = 0, extended = 0;
  bool can_extend = true;
  RequirementSummary::Advice most;
  most.likely.probability = 1.0;
  for (std::size_t i = 0; i < summary.requirements.size(); ++i) {
    const RequirementSummary& requirement = summary.requirements[i];
    if (summary.standing.requirements[i].verdict != "inconclusive" || !requirement.advice) continue;
    const RequirementSummary::Advice& advice = *requirement.advice;
    ++open;
    most.least = std::max(most.least, advice.least);
    most.likely.cases = std::max(most.likely.cases, advice.likely.cases);
    most.likely.probability = std::min(most.likely.probability, advice.likely.probability);
    can_extend = can_extend && advice.extended;
    extended = std::max(extended, advice.extended.value_or(0));
  }
  if (open == 0) return "";
  std::string text = fmt::format(
      "To decide {}: a new campaign needs {} flights or more. By what was seen here, a campaign of {} "
      "flights "
      "passes {} with a probability of {}{}.",
      open == 1 ? "the inconclusive requirement" : fmt::format("all {} inconclusive requirements", open),
      most.least, most.likely.cases, open == 1 ? "it" : "each of them", open == 1 ? "" : "at least ",
      ShareText(most.likely.probability));
  // Where earlier attempts have spent the risk, each requirement's reason says what would decide it.
  if (can_extend && summary.standing.attempts.size() < 2)
    text += fmt::format(
        " This campaign, extended, needs {} flights in all with no further failure (any-time rule).",
        extended);
  return text;
}

void RecordLooks(const ResultFolder& folder, const Campaign& campaign, const CampaignSummary& summary) {
  if (summary.verdict == CampaignVerdict::kIncomplete || !IsIndependent(summary.sampling)) return;
  for (std::size_t i = 0; i < summary.requirements.size(); ++i) {
    const RequirementSummary& requirement = summary.requirements[i];
    folder.RecordLook({campaign.requirements_id, RequirementLine(campaign.requirements[i]),
                       static_cast<std::int64_t>(summary.cases), requirement.failures, requirement.verdict});
  }
}

std::vector<std::string> KeyMetrics(const Campaign& campaign) {
  std::vector<std::string> metrics;
  const auto add = [&](const std::string& name) {
    if (std::find(metrics.begin(), metrics.end(), name) == metrics.end()) metrics.push_back(name);
  };
  for (const Requirement& requirement : campaign.requirements) add(requirement.metric);
  for (const OwnMetric& metric : campaign.own_metrics) add(metric.name);
  for (const std::size_t i : MeasuredMetrics(campaign))
    if (i < Metrics().size() && Metrics()[i].is_usual) add(Metrics()[i].name);
  return metrics;
}

CampaignSummary BuildSummary(const ResultFolder& folder, const Campaign& campaign) {
  return BuildSummary(folder, campaign, ReadColumns(folder, DispersedInputs(campaign)));
}

CampaignSummary BuildSummary(const ResultFolder& folder, const Campaign& campaign, const CaseColumns& cases,
                             int threads) {
  RequireWhole(folder);
  // Half of the work.
  std::future<std::vector<MetricDrivers>> drivers =
      std::async(threads > 1 ? std::launch::async : std::launch::deferred,
                 [&] { return FindDrivers(campaign, KeyMetrics(campaign), cases); });
  CampaignSummary summary;
  summary.name = campaign.name;
  summary.id = campaign.id;
  summary.flight_id = campaign.flight_id;
  summary.seed = campaign.sampling.seed;
  summary.max_cases = campaign.sampling.cases;
  summary.quarantined = folder.QuarantinedCases();
  JudgingContext context;
  context.method = campaign.sampling.method;
  context.replicates = campaign.sampling.replicates;
  context.design_points = DesignSize(campaign);
  context.registered = Lines(folder.Provenance("requirements"));
  if (context.registered.empty()) context.registered = {"no requirement"};
  context.holm = campaign.verdicts.holm;
  context.cases = CasesToFly(folder, campaign, cases);
  // The campaign by itself, as if it were the first: what was planned or read before is judged by StandingOf.
  context.planned = static_cast<std::int64_t>(campaign.sampling.cases);
  summary.cases = context.cases;
  summary.replicates = context.replicates;
  summary.design_points = context.design_points;
  summary.planned_cases = context.planned;
  summary.holm = context.holm;
  summary.requirements_id = campaign.requirements_id;
  summary.registered_requirements_id = folder.Provenance("requirements_id");
  summary.flown = cases.rows();
  summary.reached = cases.rows() == 0 ? 0 : cases.index.back() + 1;
  summary.sampling = campaign.sampling.method;
  summary.engine = folder.Provenance("engine");
  summary.vehicle = campaign.vehicle.name;
  summary.is_controlled = campaign.course.is_controlled;
  summary.reference = campaign.reference.name;
  summary.reference_orbit = campaign.reference.orbit;
  summary.autopilot = campaign.autopilot.name;
  if (const auto& plugin = campaign.autopilot.plugin; plugin && plugin->in_python)
    summary.python_law = {plugin->name, plugin->sha256};
  for (const Outcome outcome : cases.outcome) ++summary.outcomes[static_cast<std::size_t>(outcome)];
  summary.lost_flights = cases.lost_flights;
  summary.metric_list = folder.metric_list();
  summary.own_metrics = campaign.own_metrics;
  const std::vector<std::size_t> shown = MeasuredMetrics(campaign);
  for (const std::size_t i : folder.metrics()) {
    if (std::find(shown.begin(), shown.end(), i) == shown.end()) continue;
    const std::string& name = folder.metric_list().NameAt(i);
    const std::vector<double> values = CompletedValues(cases, name);
    const bool is_all_around = LiesAllAround(values, CircleOf(name));
    const std::vector<double> sorted = is_all_around ? std::vector<double>() : SortedFinite(values);
    const Summary statistics = is_all_around ? Summarize(values, CircleOf(name))
                                             : SummarizeSorted(sorted, values.size() - sorted.size());
    summary.metrics.push_back({name, statistics, Skewness(sorted), Percentiles(sorted)});
  }
  HoldAgainstLimits(campaign.vehicle.limits, cases, &summary);
  summary.load_checks = CheckLoads(campaign, cases);
  summary.near_step_limit = NearStepLimit(cases);
  context.no_evidence = WhyNoEvidence(campaign, cases);
  summary.requirements = JudgeAll(campaign.requirements, context, cases);
  for (const Requirement& requirement : campaign.requirements) {
    summary.overall_risk = std::max(summary.overall_risk, requirement.consumer_risk);
    summary.any_risk += requirement.consumer_risk;
  }
  if (summary.holm) summary.any_risk = summary.overall_risk;
  summary.any_risk = std::min(summary.any_risk, 1.0);
  for (const std::string& metric : KeyMetrics(campaign))
    summary.worst_cases.push_back(FindWorst(metric, AllLimits(campaign.requirements, metric), cases));
  summary.events = SummarizeEvents(cases);
  summary.injection = SummarizeInjection(cases);
  summary.dispersions = SummarizeDispersions(campaign, cases);
  summary.failure_drivers = FindFailureDrivers(campaign, cases);
  summary.drivers = drivers.get();
  summary.verdict = Overall(summary);
  summary.standing = StandingOf(folder, campaign, summary);
  return summary;
}

}  // namespace dispersa
