// The parts of flight expressions, tick by tick, of W flights side by side (core/math/lanes.h).
#pragma once

#include "core/expressions/evaluate.h"
#include "core/expressions/flight_expression.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
struct PartSumOf {
  T value, count;
};

/// Adds a tick of the lanes to a part. `values`: of the columns that the expressions read.
template <class T>
DISPERSA_OUT_OF_LINE void AddTick(const SummedPart& part, MaskOf<T> lanes, T time_s, double tick_s,
                                  const T* values, PartSumOf<T>& sum) {
  using Kind = OverFlight::Kind;
  const auto is_first = sum.count <= T(0.0);
  // The tick nearest to the time, or the later of two.
  if (part.kind == Kind::kAt) lanes = lanes & is_first & (time_s + T(0.5 * tick_s) > T(part.at_s));
  if (part.kind == Kind::kFirst) lanes = lanes & is_first;
  if (!Any(lanes)) return;
  if (part.while_true.count > 0) lanes = lanes & (Evaluate(part.while_true, values) > T(0.0));
  if (part.kind == Kind::kDuration) {
    sum.count = Select(lanes, sum.count + T(1.0), sum.count);
    sum.value = sum.count * T(tick_s);
    return;
  }
  if (!Any(lanes)) return;
  const T value = Evaluate(part.value, values);
  // At a time: undefined there, undefined in all.
  if (part.kind != Kind::kAt) lanes = lanes & (Abs(value) < T(__builtin_inf()));
  T next = value;  // kFirst, kLast, kAt
  switch (part.kind) {
    case Kind::kMax:
      next = Select(is_first | (value > sum.value), value, sum.value);
      break;
    case Kind::kMin:
      next = Select(is_first | (value < sum.value), value, sum.value);
      break;
    case Kind::kMean:
      next = sum.value + value;
      break;
    case Kind::kRms:
      next = sum.value + value * value;
      break;
    case Kind::kIntegral:
      next = sum.value + value * T(tick_s);
      break;
    default:
      break;
  }
  sum.value = Select(lanes, next, sum.value);
  sum.count = Select(lanes, sum.count + T(1.0), sum.count);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
