#include "core/report/campaign_summary.h"

#include <algorithm>
#include <cmath>

#include "core/report/metric_catalogue.h"

namespace dispersa {
namespace {

constexpr std::size_t kWorstCases = 5;
/// Of them lost flights: all of those have their own list, and they shall not hide what limits the others.
constexpr std::size_t kLostAmongWorst = 1;

/// Shown in full in any report, after the metrics of the requirements.
const char* const kUsualMetrics[] = {"pitch_error_peak_deg", "pitch_error_rms_deg", "deflection_peak_deg",
                                     "q_alpha_max_pa_rad"};

WorstCases FindWorst(const std::string& metric, Worse worse, const CaseColumns& cases) {
  const std::vector<double>& values = cases.metrics.at(MetricColumn(metric));
  const auto lost = [&](std::size_t i) {
    return cases.outcome[i] != Outcome::kCompleted || !std::isfinite(values[i]);
  };
  std::vector<std::size_t> order(cases.rows());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto is_worse = [&](std::size_t a, std::size_t b) {
    if (lost(a) != lost(b)) return lost(a);
    const double badness_a = std::isfinite(values[a]) ? Badness(worse, values[a]) : HUGE_VAL;
    const double badness_b = std::isfinite(values[b]) ? Badness(worse, values[b]) : HUGE_VAL;
    return badness_a != badness_b ? badness_a > badness_b : a < b;
  };
  std::sort(order.begin(), order.end(), is_worse);
  WorstCases result{.metric = metric, .cases = {}};
  for (std::size_t i = 0; i < order.size() && result.cases.size() < kWorstCases; ++i) {
    const std::size_t row = order[i];
    if (i >= kLostAmongWorst && lost(row)) continue;
    WorstCase worst{.case_index = cases.index[row], .value = std::nullopt, .outcome = cases.outcome[row]};
    if (std::isfinite(values[row])) worst.value = values[row];
    result.cases.push_back(worst);
  }
  return result;
}

CampaignVerdict Overall(const CampaignSummary& summary) {
  if (summary.flown < summary.cases) return CampaignVerdict::kIncomplete;
  const auto any = [&](const char* verdict) {
    return std::any_of(summary.requirements.begin(), summary.requirements.end(),
                       [&](const RequirementSummary& requirement) { return requirement.verdict == verdict; });
  };
  if (any("fail")) return CampaignVerdict::kFail;
  return any("inconclusive") ? CampaignVerdict::kInconclusive : CampaignVerdict::kPass;
}

}  // namespace

const char* CampaignVerdictName(CampaignVerdict verdict) {
  switch (verdict) {
    case CampaignVerdict::kPass:
      return "pass";
    case CampaignVerdict::kInconclusive:
      return "inconclusive";
    case CampaignVerdict::kFail:
      return "fail";
    case CampaignVerdict::kIncomplete:
      return "incomplete";
  }
  return "";
}

int VerdictExitCode(CampaignVerdict verdict) {
  switch (verdict) {
    case CampaignVerdict::kPass:
      return 0;
    case CampaignVerdict::kInconclusive:
      return 4;
    case CampaignVerdict::kFail:
      return 3;
    case CampaignVerdict::kIncomplete:
      return 5;
  }
  return 1;
}

std::vector<std::string> KeyMetrics(const Campaign& campaign) {
  std::vector<std::string> metrics;
  const auto add = [&](const std::string& name) {
    const bool exists = MetricColumn(name) < MetricNames().size();
    if (exists && std::find(metrics.begin(), metrics.end(), name) == metrics.end()) metrics.push_back(name);
  };
  for (const Requirement& requirement : campaign.requirements) add(requirement.metric);
  for (const char* name : kUsualMetrics) add(name);
  return metrics;
}

CampaignSummary BuildSummary(const ResultFolder& folder, const Campaign& campaign) {
  return BuildSummary(folder, campaign, ReadColumns(folder, DispersedInputs(campaign)));
}

CampaignSummary BuildSummary(const ResultFolder& folder, const Campaign& campaign, const CaseColumns& cases) {
  CampaignSummary summary;
  summary.name = campaign.name;
  summary.id = campaign.id;
  summary.flight_id = campaign.flight_id;
  summary.seed = campaign.sampling.seed;
  summary.cases = campaign.sampling.cases;
  summary.flown = cases.rows();
  summary.sampling = campaign.sampling.method;
  summary.engine = folder.Provenance("engine");
  summary.vehicle = campaign.vehicle.name;
  summary.reference = campaign.reference.name;
  summary.reference_orbit = campaign.reference.orbit;
  summary.autopilot = campaign.autopilot.name;
  for (const Outcome outcome : cases.outcome) ++summary.outcomes[static_cast<std::size_t>(outcome)];
  summary.lost_flights = cases.lost_flights;
  for (std::size_t i = 0; i < MetricNames().size(); ++i) {
    summary.metrics.push_back({MetricNames()[i], Summarize(cases.metrics[i])});
  }
  const auto missing = static_cast<std::int64_t>(summary.cases - summary.flown);
  for (const Requirement& requirement : campaign.requirements) {
    summary.requirements.push_back(Judge(requirement, campaign.sampling.method, cases, missing));
  }
  summary.quarantined = folder.QuarantinedCases();
  for (const std::string& metric : KeyMetrics(campaign)) {
    Worse worse = DescribeMetric(metric).worse;
    for (const Requirement& requirement : campaign.requirements) {
      if (requirement.metric == metric) worse = requirement.above ? Worse::kSmaller : Worse::kLarger;
    }
    summary.worst_cases.push_back(FindWorst(metric, worse, cases));
  }
  summary.dispersions = SummarizeDispersions(campaign, cases);
  summary.verdict = Overall(summary);
  return summary;
}

}  // namespace dispersa
