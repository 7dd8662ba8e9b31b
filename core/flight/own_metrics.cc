#include "core/flight/own_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/flight/history.h"
#include "core/flight/history_columns.h"
#include "core/input/read_value.h"
#include "core/math/stages.h"

namespace dispersa {
namespace {

// Conditions stand behind the columns: any burn, the burn of each stage, the coast.
int FirstCondition() { return static_cast<int>(HistoryColumns().size()); }
constexpr int kConditions = 1 + kMaxStages + 1;

NamedValue Find(const std::string& name, int stages, const AutopilotConfig& autopilot) {
  if (name == "burn") return {FirstCondition(), true};
  if (name == "coast") return {FirstCondition() + 1 + kMaxStages, true};
  for (int stage = 1; stage <= kMaxStages; ++stage) {
    if (name != "burn" + std::to_string(stage)) continue;
    if (stage > stages)
      throw UnknownName{"the vehicle has no stage " + std::to_string(stage),
                        "burn1 to burn" + std::to_string(stages)};
    return {FirstCondition() + stage, true};
  }
  const std::vector<int> known = HistoryColumnsUnder(autopilot);
  const int column = FindHistoryColumn(name);
  if (std::find(known.begin(), known.end(), column) != known.end()) return {column, false};
  if (column >= 0)
    throw UnknownName{"'" + name + "' is a column of other control laws", "a column of this law's histories"};
  std::vector<std::string> names = {"burn", "coast"};
  for (const int position : known) names.push_back(HistoryColumns()[static_cast<std::size_t>(position)]);
  throw UnknownName{
      "'" + name + "' is not a column of histories" + DidYouMean(name, names),
      "a column of `dispersa fly --history`, burn, burn1 to burn" + std::to_string(stages) + ", or coast"};
}

}  // namespace

std::optional<std::vector<std::size_t>> FindOwn(const std::vector<OwnMetric>& wanted,
                                                const std::vector<OwnMetric>& known) {
  std::vector<std::size_t> places;
  for (const OwnMetric& metric : wanted) {
    const auto same = std::find_if(known.begin(), known.end(),
                                   [&](const OwnMetric& other) { return metric.IsSameAs(other); });
    if (same == known.end()) return std::nullopt;
    places.push_back(static_cast<std::size_t>(same - known.begin()));
  }
  return places;
}

FlightExpression ParseOwnMetric(const std::string& expression, int stages, const AutopilotConfig& autopilot) {
  return ParseFlightExpression(expression,
                               [&](const std::string& name) { return Find(name, stages, autopilot); });
}

OwnMetricsMeter::OwnMetricsMeter(const std::vector<OwnMetric>& metrics, double tick_s) : tick_s_(tick_s) {
  meters_.reserve(metrics.size());
  const auto read = [&](const Expression& expression) {
    for (const int position : expression.Positions())
      if (position < FirstCondition()) parts_ |= PartsOf(position);
  };
  for (const OwnMetric& metric : metrics) {
    meters_.emplace_back(metric.parsed);
    for (const OverFlight& part : metric.parsed.parts) {
      read(part.value);
      if (part.while_true) read(*part.while_true);
    }
  }
}

void OwnMetricsMeter::Add(double time_s, int burning_stage, bool coasting, std::vector<double>& row) {
  row.resize(HistoryColumns().size() + kConditions, 0.0);
  double* const conditions = row.data() + FirstCondition();
  if (burning_stage > 0) conditions[0] = conditions[burning_stage] = 1.0;
  if (coasting) conditions[1 + kMaxStages] = 1.0;
  for (FlightMeter& meter : meters_) meter.Add(time_s, tick_s_, row.data());
}

std::vector<double> OwnMetricsMeter::Values() const {
  std::vector<double> values;
  for (const FlightMeter& meter : meters_) {
    const double value = meter.Value();
    values.push_back(std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

}  // namespace dispersa
