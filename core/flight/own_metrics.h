// Metrics that a campaign defines itself: expressions over the columns of histories, evaluated at every tick.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/expressions/flight_expression.h"

namespace dispersa {

/// Of one campaign.
inline constexpr std::size_t kMaxOwnMetrics = 100;

struct OwnMetric {
  std::string name;        ///< with its unit at the end, as of every metric
  std::string expression;  ///< single spaces
  std::string meaning;     ///< what the file says of it (may be empty)
  FlightExpression parsed = {};

  /// Equal definitions give a flight equal values.
  bool IsSameAs(const OwnMetric& other) const { return name == other.name && expression == other.expression; }
};

/// Where each of `wanted` stands among `known`, with an equal definition. None: one of them does not.
std::optional<std::vector<std::size_t>> FindOwn(const std::vector<OwnMetric>& wanted,
                                                const std::vector<OwnMetric>& known);

/// Of a vehicle of so many stages under this autopilot. Throws ExpressionError.
FlightExpression ParseOwnMetric(const std::string& expression, int stages, const AutopilotConfig& autopilot);

/// The values of a campaign's own metrics in one flight.
class OwnMetricsMeter {
 public:
  /// The metrics must outlive it.
  OwnMetricsMeter(const std::vector<OwnMetric>& metrics, double tick_s);

  /// One tick. `row`: the values of HistoryColumns(). It is left longer. `burning_stage`: from 1; 0: none
  /// burns.
  void Add(double time_s, int burning_stage, bool coasting, std::vector<double>& row);
  /// NaN where a metric is undefined.
  std::vector<double> Values() const;

 private:
  std::vector<FlightMeter> meters_;
  double tick_s_;
};

}  // namespace dispersa
