// A campaign's own metrics: expressions over the columns of histories, evaluated at every tick.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/expressions/flight_expression.h"

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

/// Evaluates a campaign's own metrics in one flight.
class OwnMetricsMeter {
 public:
  /// The metrics must outlive the meter.
  OwnMetricsMeter(const std::vector<OwnMetric>& metrics, double tick_s);

  /// Parts of a row that the expressions read: bits of RowPart (history_columns.h).
  unsigned parts() const { return parts_; }
  /// Adds one tick. `row` has the values of HistoryColumns(), with these parts; further values are appended
  /// to it. `burning_stage` counts from 1; 0: no stage burns.
  void Add(double time_s, int burning_stage, bool coasting, std::vector<double>& row);
  /// NaN where a metric is undefined.
  std::vector<double> Values() const;

 private:
  std::vector<FlightMeter> meters_;
  double tick_s_;
  unsigned parts_ = 0;
};

}  // namespace dispersa
