// A campaign's own metrics: expressions over the columns of histories, summed up over every tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/expressions/flight_expression.h"
#include "core/math/stages.h"

namespace dispersa {

/// Largest number of own metrics in a campaign.
inline constexpr std::size_t kMaxOwnMetrics = 100;

struct OwnMetric {
  std::string name;        ///< ends in its unit, as every metric's name
  std::string expression;  ///< single spaces
  std::string meaning;     ///< from the campaign file; may be empty
  FlightExpression parsed = {};

  /// Equal definitions have equal values in each flight.
  bool IsSameAs(const OwnMetric& other) const { return name == other.name && expression == other.expression; }
};

/// Position in `known` of each metric of `wanted` with an equal definition. None if any of them is missing.
std::optional<std::vector<std::size_t>> FindOwn(const std::vector<OwnMetric>& wanted,
                                                const std::vector<OwnMetric>& known);

/// Parses a metric for a vehicle of `stages` stages under this autopilot. Throws ExpressionError.
FlightExpression ParseOwnMetric(const std::string& expression, int stages, const AutopilotConfig& autopilot);

/// Conditions stand behind the columns of a row: any burn, the burn of each stage, the coast.
inline constexpr int kRowConditions = 1 + kMaxStages + 1;

/// What flights sum up for a campaign's own metrics.
struct OwnMetricsPlan {
  std::vector<FlightExpression> expressions;
  std::vector<SummedPart> parts;  ///< of all expressions, one after the other
  std::uint64_t row_columns = 0;  ///< RowColumns (history_columns.h) that they read

  explicit OwnMetricsPlan(const std::vector<OwnMetric>& metrics);
  OwnMetricsPlan(const OwnMetricsPlan&) = delete;
  OwnMetricsPlan& operator=(const OwnMetricsPlan&) = delete;

  /// Of a flight with these sums of the parts. NaN where a metric is undefined.
  std::vector<double> ValuesOf(const std::vector<PartSum>& sums) const;
};

}  // namespace dispersa
