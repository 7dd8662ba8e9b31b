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

int FirstCondition() { return static_cast<int>(HistoryColumns().size()); }

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

OwnMetricsPlan::OwnMetricsPlan(const std::vector<OwnMetric>& metrics) {
  for (const OwnMetric& metric : metrics) expressions.push_back(metric.parsed);
  const auto read = [&](const Expression& expression) {
    for (const int position : expression.Positions())
      if (position < FirstCondition()) row_columns |= RowColumns{1} << position;
  };
  for (const FlightExpression& expression : expressions) {
    for (const OverFlight& part : expression.parts) {
      parts.emplace_back(part);
      read(part.value);
      if (part.while_true) read(*part.while_true);
    }
  }
}

std::vector<double> OwnMetricsPlan::ValuesOf(const std::vector<PartSum>& sums) const {
  std::vector<double> values;
  const PartSum* next = sums.data();
  for (const FlightExpression& expression : expressions) {
    const double value = ValueOf(expression, next);
    next += expression.parts.size();
    values.push_back(std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

}  // namespace dispersa
