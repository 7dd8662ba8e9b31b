#include "core/report/case_columns.h"

#include <algorithm>

#include "core/flight/flight_inputs.h"
#include "core/flight/metrics.h"
#include "core/statistics/summary.h"

namespace dispersa {
CaseColumns ReadColumns(const ResultFolder& folder, const std::vector<int>& wanted_inputs) {
  CaseColumns columns;
  columns.inputs.resize(InputColumns().size());
  columns.metrics.resize(MetricNames().size());
  folder.ForEach([&](const CaseResult& result) {
    columns.index.push_back(result.case_index);
    columns.outcome.push_back(result.outcome);
    if (result.outcome != Outcome::kCompleted) {
      columns.lost_flights.push_back(
          {result.case_index, result.outcome, result.end_time_s, result.end_stage, result.reason});
    }
    for (const int input : wanted_inputs) {
      columns.inputs[static_cast<std::size_t>(input)].push_back(
          result.inputs[static_cast<std::size_t>(input)]);
    }
    for (std::size_t i = 0; i < columns.metrics.size(); ++i) columns.metrics[i].push_back(result.metrics[i]);
  });
  return columns;
}

std::vector<double> CompletedValues(const CaseColumns& cases, const std::string& metric) {
  std::vector<double> values = cases.metrics[MetricColumn(metric)];
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (cases.outcome[i] != Outcome::kCompleted) values[i] = kUndefined;
  }
  return values;
}

std::size_t LostCount(const CaseColumns& cases) {
  return static_cast<std::size_t>(
      std::count_if(cases.outcome.begin(), cases.outcome.end(),
                    [](Outcome outcome) { return outcome != Outcome::kCompleted; }));
}

}  // namespace dispersa
