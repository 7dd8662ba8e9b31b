// One number of a flight, from values that it has at each tick. README.md beside this file has the grammar.
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
  Expression value;  ///< of kDuration: none
  std::optional<Expression> while_true = {};
  double at_s = 0.0;  ///< of kAt
};

/// Immutable once made.
struct FlightExpression {
  std::vector<OverFlight> parts;
  Expression whole;  ///< of the parts' values
};

/// Throws ExpressionError.
FlightExpression ParseFlightExpression(const std::string& text, const LookUp& look_up);

/// The parts of one flight's expression, tick after tick. The expression must outlive it.
class FlightMeter {
 public:
  explicit FlightMeter(const FlightExpression& expression);

  void Add(double time_s, double tick_s, const double* values);
  /// Not finite where it is undefined.
  double Value() const;

 private:
  struct Sum {
    double value = 0.0;  ///< largest, smallest, sum, first, last or time
    double count = 0.0;  ///< of ticks
  };
  const FlightExpression& expression_;
  std::vector<Sum> sums_;
};

}  // namespace dispersa
