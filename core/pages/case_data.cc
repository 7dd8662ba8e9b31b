#include "core/pages/case_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/results/metric_catalogue.h"

namespace dispersa {
namespace {

std::vector<std::string> ShownMetrics(const CampaignSummary& summary) {
  std::vector<std::string> names;
  for (const WorstCases& worst : summary.worst_cases) names.push_back(worst.metric);
  const auto is_measured = [&](const char* name) {
    return std::any_of(summary.metrics.begin(), summary.metrics.end(),
                       [&](const MetricSummary& metric) { return metric.name == name; });
  };
  const std::initializer_list<const char*> of_orbit = {
      "injection_velocity_error_m_s", "injection_altitude_error_km", "perigee_km", "apogee_km"};
  std::vector<std::string> more(of_orbit.begin(), of_orbit.end());
  if (!summary.is_controlled) more.clear();
  for (const char* name : {"impact_crossrange_km", "impact_downrange_km"})
    if (is_measured(name)) more.push_back(name);
  for (const MetricSummary& metric : summary.metrics)
    if (metric.name.starts_with("propellant_left_stage") && metric.statistics.n > 0)
      more.push_back(metric.name);
  for (const std::string& name : more) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

/// Rows of the cases with the smallest and the largest values of each metric, ascending.
std::vector<std::size_t> Answering(const std::vector<std::string>& metrics, const CaseColumns& cases) {
  std::set<std::size_t> rows;
  const std::size_t each = kAnsweringCases / (2 * metrics.size());
  for (const std::string& metric : metrics) {
    const std::vector<double> values = CompletedValues(cases, metric);
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isfinite(values[i])) order.push_back(i);
    }
    const auto less = [&](std::size_t a, std::size_t b) {
      return values[a] != values[b] ? values[a] < values[b] : a < b;
    };
    const auto count = static_cast<std::ptrdiff_t>(std::min(each, order.size()));
    std::partial_sort(order.begin(), order.begin() + count, order.end(), less);
    rows.insert(order.begin(), order.begin() + count);
    std::partial_sort(order.rbegin(), order.rbegin() + count, order.rend(),
                      [&](std::size_t a, std::size_t b) { return less(b, a); });
    rows.insert(order.end() - count, order.end());
  }
  return {rows.begin(), rows.end()};
}

}  // namespace

std::string CaseData(const CampaignSummary& summary, const CaseColumns& cases) {
  const std::vector<std::string> metrics = ShownMetrics(summary);
  std::vector<std::size_t> rows;
  if (cases.rows() > kAnsweringCases) {
    rows = Answering(metrics, cases);
  } else {
    for (std::size_t i = 0; i < cases.rows(); ++i) rows.push_back(i);
  }
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (const std::string& metric : metrics) {
    const MetricInfo info = DescribeMetric(metric);
    names.push_back({{"name", metric}, {"title", info.title}, {"unit", info.unit}});
  }
  std::string json =
      fmt::format("{{\"flown\":{},{}\"metrics\":{},\"cases\":[", cases.rows(),
                  summary.python_law ? "" : "\"replay\":\"" + ReplayCommand() + "\",", names.dump());
  std::string lost, values;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    json += fmt::format("{}{}", i == 0 ? "" : ",", cases.index[rows[i]]);
    if (cases.outcome[rows[i]] != Outcome::kCompleted)
      lost += fmt::format("{}{}", lost.empty() ? "" : ",", cases.index[rows[i]]);
  }
  for (const std::string& metric : metrics) {
    const std::vector<double> column = CompletedValues(cases, metric);
    values += values.empty() ? "[" : ",\n[";
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i > 0) values += ",";
      const double value = column[rows[i]];
      values += std::isfinite(value) ? fmt::format("{:.6g}", value + 0.0) : "null";
    }
    values += "]";
  }
  return json + "],\"lost\":[" + lost + "],\"values\":[\n" + values + "]}";
}

}  // namespace dispersa
