// Expressions that give one number of a flight from its values at each tick. README.md in this folder has the
// grammar.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/expressions/expression.h"

namespace dispersa {

/// A function over the ticks of a flight.
struct OverFlight {
  enum class Kind { kMax, kMin, kMean, kRms, kIntegral, kFirst, kLast, kDuration, kAt };
  Kind kind;
  Expression value;  ///< empty for kDuration
  std::optional<Expression> while_true = {};
  double at_s = 0.0;  ///< for kAt
};

/// Immutable after construction.
struct FlightExpression {
  std::vector<OverFlight> parts;
  Expression whole;  ///< its values are those of the parts
};

/// Parses the text. Throws ExpressionError.
FlightExpression ParseFlightExpression(const std::string& text, const LookUp& look_up);

/// Evaluates an expression over one flight, tick by tick. The expression must outlive the meter.
class FlightMeter {
 public:
  explicit FlightMeter(const FlightExpression& expression);

  void Add(double time_s, double tick_s, const double* values);
  /// The result. It is not finite if it is undefined.
  double Value() const;

 private:
  struct Sum {
    double value = 0.0;  ///< largest, smallest, sum, first, last or time
    double count = 0.0;  ///< number of ticks
  };
  const FlightExpression& expression_;
  std::vector<Sum> sums_;
};

}  // namespace dispersa
