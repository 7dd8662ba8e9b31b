#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/flight/flight_inputs.h"
#include "core/math/constants.h"
#include "core/report/campaign_summary.h"
#include "core/report/metric_catalogue.h"
#include "core/report/sampling_text.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

Json Number(double value) { return std::isfinite(value) ? Json(value + 0.0) : Json(nullptr); }

template <typename T>
Json OrNull(const std::optional<T>& value) {
  if (!value) return nullptr;
  if constexpr (std::is_same_v<T, double>) {
    return Number(*value);
  } else {
    return *value;
  }
}

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

Json RequirementJson(const RequirementSummary& requirement) {
  Json json = {{"metric", requirement.metric}};
  json["side"] = requirement.below ? "below" : "above";
  json["limit"] = Number(requirement.limit);
  json["probability"] = requirement.probability;
  json["consumer_risk"] = requirement.consumer_risk;
  json["n"] = requirement.n;
  json["failures"] = requirement.failures;
  json["lost_flights"] = requirement.lost_flights;
  json["success_lower"] = OrNull(requirement.success_lower);
  json["success_upper"] = OrNull(requirement.success_upper);
  json["verdict"] = requirement.verdict;
  json["cases_needed"] = OrNull(requirement.cases_needed);
  json["sentence"] = requirement.sentence;
  return json;
}

Json NominalJson(const CaseResult& nominal) {
  Json metrics = Json::object();
  for (std::size_t i = 0; i < nominal.metrics.size(); ++i)
    metrics[MetricNames()[i]] = Number(nominal.metrics[i]);
  return {{"outcome", OutcomeName(nominal.outcome)},
          {"end_time_s", Number(nominal.end_time_s)},
          {"metrics", metrics},
          {"digest", nominal.digest.Hex()}};
}

}  // namespace

std::string SummaryJson(const CampaignSummary& summary) {
  Json json;
  json["schema"] = "dispersa/summary/1";
  json["campaign"] = {{"name", summary.name},           {"id", summary.id},
                      {"flight_id", summary.flight_id}, {"seed", summary.seed},
                      {"cases", summary.cases},         {"sampling", SamplingMethodName(summary.sampling)},
                      {"vehicle", summary.vehicle},     {"reference", summary.reference},
                      {"autopilot", summary.autopilot}};
  json["engine"] = summary.engine;
  json["reference_orbit"] = {
      {"altitude_km", Number(summary.reference_orbit.altitude_m * 1e-3)},
      {"velocity_m_s", Number(summary.reference_orbit.velocity_m_s)},
      {"flight_path_angle_deg", Number(summary.reference_orbit.flight_path_angle_rad * kDegPerRad)},
      {"inclination_deg", Number(summary.reference_orbit.inclination_rad * kDegPerRad)}};
  json["verdict"] = CampaignVerdictName(summary.verdict);
  json["design_study"] = !IsIndependent(summary.sampling);
  json["flown"] = summary.flown;
  json["outcomes"] = Json::object();
  for (int i = 0; i < kOutcomeCount; ++i) {
    json["outcomes"][OutcomeName(static_cast<Outcome>(i))] = summary.outcomes[static_cast<std::size_t>(i)];
  }
  json["lost_flights"] = Json::array();
  for (const LostFlight& lost : summary.lost_flights) {
    json["lost_flights"].push_back({{"case_index", lost.case_index},
                                    {"outcome", OutcomeName(lost.outcome)},
                                    {"end_time_s", Number(lost.end_time_s)},
                                    {"end_stage", lost.end_stage},
                                    {"reason", lost.reason}});
  }
  json["requirements"] = Json::array();
  for (const RequirementSummary& requirement : summary.requirements) {
    json["requirements"].push_back(RequirementJson(requirement));
  }
  json["metrics"] = Json::object();
  for (const MetricSummary& metric : summary.metrics)
    json["metrics"][metric.name] = StatisticsJson(metric.statistics);
  json["quarantined"] = Json::array();
  for (const QuarantinedCase& quarantined : summary.quarantined) {
    json["quarantined"].push_back({{"case_index", quarantined.case_index}, {"reason", quarantined.reason}});
  }
  json["worst_cases"] = Json::array();
  for (const WorstCases& worst : summary.worst_cases) {
    for (const WorstCase& one : worst.cases) {
      json["worst_cases"].push_back({{"metric", worst.metric},
                                     {"case_index", one.case_index},
                                     {"value", OrNull(one.value)},
                                     {"outcome", OutcomeName(one.outcome)},
                                     {"replay", ReplayCommand(one.case_index)}});
    }
  }
  json["dispersions"] = Json::array();
  for (const DispersionSummary& dispersion : summary.dispersions) {
    json["dispersions"].push_back({{"dispersion", dispersion.dispersion},
                                   {"input", dispersion.input},
                                   {"declared", dispersion.declared},
                                   {"expected_mean", OrNull(dispersion.expected_mean)},
                                   {"expected_std", OrNull(dispersion.expected_std)},
                                   {"consistent", OrNull(dispersion.consistent)},
                                   {"drawn", StatisticsJson(dispersion.drawn)}});
  }
  json["nominal"] = summary.nominal ? NominalJson(*summary.nominal) : Json(nullptr);
  return json.dump(2) + "\n";
}

std::string ReplayCommand(std::uint64_t case_index) {
  return fmt::format("dispersa replay . --case {}", case_index);
}

}  // namespace dispersa
