// Expressions over W flights side by side (core/math/lanes.h).
#pragma once

#include "core/expressions/expression.h"
#include "core/math/constants.h"
#include "core/math/lanes.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

template <class T>
DISPERSA_INLINE MaskOf<T> IsNan(T a) {
  return !(a <= a);
}
template <class T>
DISPERSA_INLINE T OneWhere(MaskOf<T> mask) {
  return Select(mask, T(1.0), T(0.0));
}

/// The result of an expression over `values`, lane by lane. It is not finite where it is undefined.
template <class T>
DISPERSA_OUT_OF_LINE T Evaluate(const ExpressionSteps& of, const T* values) {
  using Kind = ExpressionStep::Kind;
  T stack[Expression::kDepth + 1];  // the first stays unused
  T* top = stack;
  *top = T(0.0);
  for (const ExpressionStep *step = of.steps, *const end = of.steps + of.count; step != end; ++step) {
    switch (step->kind) {
      case Kind::kNumber:
        *++top = T(step->number);
        continue;
      case Kind::kValue:
        *++top = values[step->position];
        continue;
      case Kind::kNegative:
        *top = -*top;
        continue;
      case Kind::kPower: {
        const T base = *top;
        for (int i = 1; i < step->position; ++i) *top = *top * base;
        continue;
      }
      case Kind::kAbs:
        *top = Abs(*top);
        continue;
      case Kind::kSqrt:
        *top = Sqrt(*top);
        continue;
      case Kind::kExp:
        *top = Exp(*top);
        continue;
      case Kind::kLog:
        *top = Log(*top);
        continue;
      case Kind::kSinDeg:
        *top = Sin(*top * T(kRadPerDeg));
        continue;
      case Kind::kCosDeg:
        *top = Cos(*top * T(kRadPerDeg));
        continue;
      case Kind::kNot:
        *top = T(1.0) - *top;
        continue;
      default:
        break;
    }
    const T right = *top--, left = *top;
    switch (step->kind) {
      case Kind::kAdd:
        *top = left + right;
        break;
      case Kind::kSubtract:
        *top = left - right;
        break;
      case Kind::kMultiply:
      case Kind::kAnd:
        *top = left * right;
        break;
      case Kind::kDivide:
        *top = left / right;
        break;
      // An undefined value of two is not lost.
      case Kind::kLarger:
        *top = Select((right > left) | IsNan(right), right, left);
        break;
      case Kind::kSmaller:
        *top = Select((right < left) | IsNan(right), right, left);
        break;
      case Kind::kBelow:
        *top = OneWhere<T>(left < right);
        break;
      case Kind::kAtMost:
        *top = OneWhere<T>(left <= right);
        break;
      case Kind::kAbove:
        *top = OneWhere<T>(left > right);
        break;
      case Kind::kAtLeast:
        *top = OneWhere<T>(left >= right);
        break;
      default:  // kOr
        *top = OneWhere<T>(left + right > T(0.0));
    }
  }
  return *top;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
