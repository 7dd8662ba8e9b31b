#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/analysis/campaign_summary.h"
#include "core/flight/flight_inputs.h"
#include "core/math/constants.h"
#include "core/results/json_number.h"
#include "core/results/metric_catalogue.h"
#include "core/results/sampling_text.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

Json StatisticsJson(const Summary& statistics) {
  return {{"n", statistics.n},
          {"undefined", statistics.undefined},
          {"mean", Number(statistics.mean)},
          {"std", Number(statistics.std)},
          {"min", Number(statistics.min)},
          {"p00_135", Number(statistics.p00_135)},
          {"p01", Number(statistics.p01)},
          {"p05", Number(statistics.p05)},
          {"p50", Number(statistics.p50)},
          {"p95", Number(statistics.p95)},
          {"p99", Number(statistics.p99)},
          {"p99_73", Number(statistics.p99_73)},
          {"p99_865", Number(statistics.p99_865)},
          {"max", Number(statistics.max)}};
}

const char* PlanName(PlanKind kind) {
  switch (kind) {
    case PlanKind::kFixed:
      return "fixed";
    case PlanKind::kGroupSequential:
      return "group_sequential";
    case PlanKind::kAnytime:
      return "anytime";
  }
  return "";
}

const char* LookVerdict(Verdict verdict) {
  return verdict == Verdict::kPass ? "pass" : verdict == Verdict::kFail ? "fail" : "inconclusive";
}

Json RequirementJson(const RequirementSummary& requirement) {
  Json json = {{"metric", requirement.metric}};
  json["id"] = requirement.id;
  json["rationale"] = requirement.rationale;
  json["source"] = requirement.source;
  json["side"] = requirement.low_limit ? "within" : requirement.below ? "below" : "above";
  json["limit"] = Number(requirement.limit);
  json["low_limit"] = OrNull(requirement.low_limit);
  json["every_case"] = requirement.every_case;
  json["probability"] = requirement.every_case ? Json(nullptr) : Json(requirement.probability);
  json["consumer_risk"] = requirement.every_case ? Json(nullptr) : Json(requirement.consumer_risk);
  json["plan"] = {{"kind", PlanName(requirement.plan.kind)},
                  {"looks", requirement.plan.looks},
                  {"spending", requirement.plan.kind != PlanKind::kGroupSequential ? Json(nullptr)
                               : requirement.plan.spending == Spending::kPocock    ? Json("pocock")
                                                                                   : Json("obrien_fleming")},
                  {"cases", requirement.planned}};
  json["n"] = requirement.n;
  json["failures"] = requirement.failures;
  json["lost_flights"] = requirement.lost_flights;
  json["not_measured"] = requirement.not_measured;
  json["success_lower"] = OrNull(requirement.success_lower);
  json["success_upper"] = OrNull(requirement.success_upper);
  json["bound"] = OrNull(requirement.bound);
  json["margin"] = OrNull(requirement.margin);
  if (const auto& worst = requirement.worst_completed)
    json["worst_completed"] = {{"case_index", worst->case_index}, {"value", Number(worst->value)}};
  else
    json["worst_completed"] = nullptr;
  json["verdict"] = requirement.verdict;
  json["attained_risk"] = OrNull(requirement.attained_risk);
  json["accepts"] = OrNull(requirement.accepts);
  json["rejects"] = OrNull(requirement.rejects);
  json["looks"] = ListOf(requirement.looks, [](const Look& look) -> Json {
    return {{"n", look.n},
            {"failures", look.failures},
            {"verdict", LookVerdict(look.verdict)},
            {"planned", look.planned}};
  });
  json["beyond_plan"] = requirement.beyond_plan;
  json["risk_if_each_look_were_the_only_one"] = OrNull(requirement.naive_risk);
  json["contradicted"] = requirement.contradicted;
  json["post_hoc"] = requirement.post_hoc;
  json["cases_needed"] = OrNull(requirement.cases_needed);
  json["pass_probability"] = ListOf(requirement.pass_chances, [](const auto& chance) -> Json {
    return {{"cases", chance.cases}, {"probability", chance.probability}};
  });
  json["convergence"] = ListOf(requirement.convergence, [](const auto& at) -> Json {
    return {{"n", at.n},
            {"failures", at.failures},
            {"success_lower", Number(at.success_lower)},
            {"success_upper", Number(at.success_upper)}};
  });
  json["sentence"] = requirement.sentence + AdviceSentence(requirement);
  return json;
}

Json InjectionJson(const InjectionSummary& injection) {
  const auto containment = [](const Containment& one) -> Json {
    return {{"stated", one.stated},
            {"inside", one.inside},
            {"empirical", one.empirical},
            {"lower", one.limits.lower},
            {"upper", one.limits.upper}};
  };
  return {{"coordinates", kInjectionMetrics},
          {"n", injection.scatter.n},
          {"mean", ListOf(injection.scatter.mean, Number)},
          {"covariance",
           ListOf(injection.scatter.covariance, [](const auto& row) { return ListOf(row, Number); })},
          {"containment", ListOf(injection.containment, containment)}};
}

Json NominalJson(const CaseResult& nominal, const CampaignSummary& summary) {
  Json metrics = Json::object();
  for (const MetricSummary& metric : summary.metrics)
    metrics[metric.name] = Number(nominal.metrics[summary.metric_list.PositionOf(metric.name)]);
  return {{"outcome", OutcomeName(nominal.outcome)},
          {"end_time_s", Number(nominal.end_time_s)},
          {"metrics", metrics},
          {"digest", nominal.digest.Hex()}};
}

Json EventsJson(const CampaignSummary& summary) {
  return ListOf(summary.events, [&](const EventSummary& event) {
    const SeenEvent* const nominal =
        summary.nominal ? FindEvent(summary.nominal->events, event.name) : nullptr;
    Json json = {{"event", event.name}, {"flights", event.flights()}};
    for (std::size_t i = 0; i < event.values.size(); ++i) {
      const Summary& over = event.values[i];
      json[kEventValueNames[i]] = {
          {"nominal", nominal == nullptr ? Json(nullptr) : Number(nominal->*SeenEvent::kValues[i])},
          {"p01", Number(over.p01)},
          {"p50", Number(over.p50)},
          {"p99", Number(over.p99)}};
    }
    return json;
  });
}

Json CampaignJson(const CampaignSummary& summary) {
  Json json = {
      {"name", summary.name},
      {"id", summary.id},
      {"flight_id", summary.flight_id},
      {"seed", summary.seed},
      {"cases", summary.cases},
      {"max_cases", summary.max_cases},
      {"planned_cases", summary.planned_cases},
      {"sampling", SamplingMethodName(summary.sampling)},
      {"design", IsIndependent(summary.sampling) ? "monte_carlo" : "study"},
      {"design_points", IsEnumerated(summary.sampling) ? Json(summary.design_points) : Json(nullptr)},
      {"replicates", summary.replicates},
      {"vehicle", summary.vehicle},
      {"reference", summary.reference},
      {"autopilot", summary.autopilot}};
  if (summary.python_law)
    json["python_law"] = {{"name", summary.python_law->name}, {"sha256", summary.python_law->sha256}};
  return json;
}

Json ReferenceOrbitJson(const CampaignSummary& summary) {
  const auto& orbit = summary.reference_orbit;
  return {{"altitude_km", Number(orbit.altitude_m * 1e-3)},
          {"velocity_m_s", Number(orbit.velocity_m_s)},
          {"flight_path_angle_deg", Number(orbit.flight_path_angle_rad * kDegPerRad)},
          {"inclination_deg", Number(orbit.inclination_rad * kDegPerRad)}};
}

Json OutcomesJson(const CampaignSummary& summary) {
  Json json = Json::object();
  for (int i = 0; i < kOutcomeCount; ++i)
    json[OutcomeName(static_cast<Outcome>(i))] = summary.outcomes[static_cast<std::size_t>(i)];
  return json;
}

Json LostFlightsJson(const CampaignSummary& summary) {
  return ListOf(summary.lost_flights, [&](const LostFlight& lost) -> Json {
    return {{"case_index", lost.case_index},
            {"outcome", OutcomeName(lost.outcome)},
            {"end_time_s", Number(lost.end_time_s)},
            {"end_stage", lost.end_stage},
            {"reason", lost.reason}};
  });
}

Json LimitsJson(const CampaignSummary& summary) {
  Json loads = Json::array();
  for (const CampaignSummary::Limit& one : summary.limits) {
    loads.push_back({{"metric", one.metric},
                     {"limit", one.limit},
                     {"exceeded", one.exceeded},
                     {"largest", OrNull(one.largest)},
                     {"largest_case", one.largest ? Json(one.largest_case) : Json(nullptr)}});
  }
  return {{"exceeded", summary.beyond_limits}, {"loads", std::move(loads)}};
}

Json LoadChecksJson(const CampaignSummary& summary) {
  return ListOf(summary.load_checks, [&](const LoadCheck& check) -> Json {
    return {{"metric", check.metric}, {"n", check.n}, {"failures", check.failures}};
  });
}

Json RequirementsJson(const CampaignSummary& summary) {
  return ListOf(summary.requirements,
                [](const RequirementSummary& requirement) { return RequirementJson(requirement); });
}

Json JointRiskJson(const CampaignSummary& summary) {
  return {{"method", summary.holm ? "holm" : "each"},
          {"overall_risk", summary.overall_risk},
          {"any_risk", summary.any_risk},
          {"requirements_id", summary.requirements_id},
          {"registered_requirements_id", summary.registered_requirements_id},
          {"sentence", JointRiskSentence(summary)}};
}

Json MetricsJson(const CampaignSummary& summary) {
  Json json = Json::object();
  for (const MetricSummary& metric : summary.metrics) {
    const MetricInfo info = DescribeMetric(metric.name);
    Json& of = json[metric.name] = {{"group", info.group}, {"label", info.title}, {"unit", info.unit}};
    of.update(StatisticsJson(metric.statistics));
    of["skewness"] = Number(metric.skewness);
    of["percentile_confidence"] = kPercentileConfidence;
    for (const Percentile& percentile : metric.percentiles) {
      of["percentiles"][percentile.name] = {{"estimate", Number(percentile.estimate)},
                                            {"lower", Number(percentile.limits.lower)},
                                            {"upper", Number(percentile.limits.upper)}};
    }
  }
  for (const OwnMetric& metric : summary.own_metrics)
    json[metric.name].update({{"expression", metric.expression}, {"description", metric.meaning}});
  return json;
}

Json DriversJson(const CampaignSummary& summary) {
  Json json = Json::object();
  for (const MetricDrivers& metric : summary.drivers) {
    Json& list = json[metric.metric] = Json::array();
    for (const Driver& driver : metric.drivers) {
      list.push_back({{"input", driver.input},
                      {"key", driver.key},
                      {"same_as", driver.same_as},
                      {"feature", driver.feature},
                      {"index", Number(driver.index)},
                      {"low", Number(driver.low)},
                      {"high", Number(driver.high)},
                      {"partial_rank_correlation", Number(driver.partial)},
                      {"correlated_with", driver.correlated_with}});
    }
  }
  return json;
}

Json FailureInputsJson(const FailureDrivers& requirement) {
  return ListOf(requirement.drivers, [&](const FailureDriver& driver) -> Json {
    return {{"input", driver.input},     {"key", driver.key},
            {"feature", driver.feature}, {"larger", driver.larger},
            {"p", Number(driver.p)},     {"false_discovery_rate", Number(driver.false_discovery_rate)}};
  });
}

Json FailurePairsJson(const FailureDrivers& requirement) {
  return ListOf(requirement.pairs, [&](const FailurePair& pair) -> Json {
    return {{"inputs", {pair.first, pair.second}},
            {"keys", {pair.first_key, pair.second_key}},
            {"features", {pair.first_feature, pair.second_feature}},
            {"correlation", Number(pair.correlation)},
            {"p", Number(pair.p)},
            {"false_discovery_rate", Number(pair.false_discovery_rate)}};
  });
}

Json FailureDriversJson(const CampaignSummary& summary) {
  return ListOf(summary.failure_drivers, [&](const FailureDrivers& requirement) -> Json {
    return {{"metric", requirement.metric},
            {"basis", requirement.nearest ? "nearest" : "failed"},
            {"flights", requirement.flights},
            {"inputs", FailureInputsJson(requirement)},
            {"pairs", FailurePairsJson(requirement)}};
  });
}

Json QuarantinedJson(const CampaignSummary& summary) {
  return ListOf(summary.quarantined, [&](const QuarantinedCase& quarantined) -> Json {
    return {{"case_index", quarantined.case_index}, {"reason", quarantined.reason}};
  });
}

Json WorstCasesJson(const CampaignSummary& summary) {
  Json list = Json::array();
  for (const WorstCases& worst : summary.worst_cases) {
    for (const WorstCase& one : worst.cases) {
      list.push_back({{"metric", worst.metric},
                      {"case_index", one.case_index},
                      {"value", OrNull(one.value)},
                      {"outcome", OutcomeName(one.outcome)},
                      {"replay", summary.python_law ? Json(nullptr) : Json(ReplayCommand(one.case_index))}});
    }
  }
  return list;
}

Json InputsJson(const CampaignSummary& summary) {
  Json json = Json::object();
  for (const DispersionSummary& dispersion : summary.dispersions)
    json[dispersion.input] = {{"key", dispersion.key}, {"unit", SplitUnit(dispersion.input).unit}};
  return json;
}

Json DispersionsJson(const CampaignSummary& summary) {
  return ListOf(summary.dispersions, [&](const DispersionSummary& dispersion) -> Json {
    return {{"dispersion", dispersion.dispersion},
            {"input", dispersion.input},
            {"key", dispersion.key},
            {"declared", dispersion.declared},
            {"expected_mean", OrNull(dispersion.expected_mean)},
            {"expected_std", OrNull(dispersion.expected_std)},
            {"consistent", OrNull(dispersion.consistent)},
            {"drawn", StatisticsJson(dispersion.drawn)}};
  });
}

Json EnvelopeJson(const CampaignSummary& summary) {
  if (!summary.envelope) return nullptr;
  return {{"flights", summary.envelope->flights}, {"extreme_flights", summary.envelope->extreme_flights}};
}

}  // namespace

std::string SummaryJson(const CampaignSummary& summary) {
  Json json;
  json["schema"] = "dispersa/summary/1";
  json["campaign"] = CampaignJson(summary);
  json["engine"] = summary.engine;
  json["reference_orbit"] = ReferenceOrbitJson(summary);
  json["verdict"] = CampaignVerdictName(summary.verdict);
  json["design_study"] = !IsIndependent(summary.sampling);
  json["warnings"] = Warnings(summary);
  json["flown"] = summary.flown;
  json["outcomes"] = OutcomesJson(summary);
  json["lost_flights"] = LostFlightsJson(summary);
  json["limits"] = LimitsJson(summary);
  json["load_checks"] = LoadChecksJson(summary);
  json["near_step_limit"] = summary.near_step_limit;
  json["requirements"] = RequirementsJson(summary);
  json["joint"] = JointRiskJson(summary);
  json["metrics"] = MetricsJson(summary);
  json["events"] = EventsJson(summary);
  json["injection"] = summary.injection ? InjectionJson(*summary.injection) : Json(nullptr);
  json["drivers"] = DriversJson(summary);
  json["failure_drivers"] = FailureDriversJson(summary);
  json["quarantined"] = QuarantinedJson(summary);
  json["worst_cases"] = WorstCasesJson(summary);
  json["inputs"] = InputsJson(summary);
  json["dispersions"] = DispersionsJson(summary);
  json["envelope"] = EnvelopeJson(summary);
  json["nominal"] = summary.nominal ? NominalJson(*summary.nominal, summary) : Json(nullptr);
  return json.dump(2) + "\n";
}

std::string ReplayCommand() { return "dispersa replay . --case "; }

std::string ReplayCommand(std::uint64_t case_index) { return ReplayCommand() + std::to_string(case_index); }

}  // namespace dispersa
