#include "core/expressions/flight_expression.h"

#include <limits>

#include "core/math/functions.h"

namespace dispersa {

using Kind = OverFlight::Kind;

SummedPart::SummedPart(const OverFlight& part) : kind(part.kind), value(part.value.steps()), at_s(part.at_s) {
  if (part.while_true) while_true = part.while_true->steps();
}

double ValueOf(const FlightExpression& expression, const PartSum* sums) {
  std::vector<double> values;
  for (const OverFlight& part : expression.parts) {
    const PartSum& sum = *sums++;
    if (sum.count == 0.0)
      values.push_back(part.kind == Kind::kDuration ? 0.0 : std::numeric_limits<double>::quiet_NaN());
    else if (part.kind == Kind::kMean)
      values.push_back(sum.value / sum.count);
    else if (part.kind == Kind::kRms)
      values.push_back(Sqrt(sum.value / sum.count));
    else
      values.push_back(sum.value);
  }
  return expression.whole.Evaluate(values.data());
}

}  // namespace dispersa
