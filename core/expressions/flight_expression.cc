#include "core/expressions/flight_expression.h"

#include <cmath>
#include <limits>

#include "core/math/functions.h"

namespace dispersa {

using Kind = OverFlight::Kind;

FlightMeter::FlightMeter(const FlightExpression& expression)
    : expression_(expression), sums_(expression.parts.size()) {}

void FlightMeter::Add(double time_s, double tick_s, const double* values) {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const OverFlight& part = expression_.parts[i];
    Sum& sum = sums_[i];
    // The tick nearest to the time, or the later of two.
    if (part.kind == Kind::kAt && (sum.count > 0.0 || time_s + 0.5 * tick_s <= part.at_s)) continue;
    if (part.kind == Kind::kFirst && sum.count > 0.0) continue;
    if (part.while_true && !(part.while_true->Evaluate(values) > 0.0)) continue;
    if (part.kind == Kind::kDuration) {
      sum.count += 1.0;
      sum.value = sum.count * tick_s;
      continue;
    }
    const double value = part.value.Evaluate(values);
    if (part.kind == Kind::kAt) {  // undefined there, undefined in all
      sum = {value, 1.0};
      continue;
    }
    if (!std::isfinite(value)) continue;
    const bool is_first = sum.count == 0.0;
    sum.count += 1.0;
    switch (part.kind) {
      case Kind::kMax:
        if (is_first || value > sum.value) sum.value = value;
        break;
      case Kind::kMin:
        if (is_first || value < sum.value) sum.value = value;
        break;
      case Kind::kMean:
        sum.value += value;
        break;
      case Kind::kRms:
        sum.value += value * value;
        break;
      case Kind::kIntegral:
        sum.value += value * tick_s;
        break;
      default:  // kFirst, kLast
        sum.value = value;
    }
  }
}

double FlightMeter::Value() const {
  std::vector<double> values;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Sum& sum = sums_[i];
    const Kind kind = expression_.parts[i].kind;
    if (sum.count == 0.0)
      values.push_back(kind == Kind::kDuration ? 0.0 : std::numeric_limits<double>::quiet_NaN());
    else if (kind == Kind::kMean)
      values.push_back(sum.value / sum.count);
    else if (kind == Kind::kRms)
      values.push_back(Sqrt(sum.value / sum.count));
    else
      values.push_back(sum.value);
  }
  return expression_.whole.Evaluate(values.data());
}

}  // namespace dispersa
