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

/// A part as flights sum it up. It lives as long as its FlightExpression.
struct SummedPart {
  OverFlight::Kind kind;
  ExpressionSteps value;
  ExpressionSteps while_true;  ///< none: always
  double at_s = 0.0;

  explicit SummedPart(const OverFlight& part);
};

/// What a part has seen of a flight.
struct PartSum {
  double value = 0.0;  ///< largest, smallest, sum, first, last or time
  double count = 0.0;  ///< number of ticks
};

/// The result over a flight, of the sums of its parts. It is not finite if it is undefined.
double ValueOf(const FlightExpression& expression, const PartSum* sums);

}  // namespace dispersa
