#include "core/expressions/expression.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {
namespace {

double Power(double base, int exponent) {
  double product = base;
  for (int i = 1; i < exponent; ++i) product *= base;
  return product;
}

}  // namespace

double Expression::Evaluate(const double* values) const {
  using Kind = ExpressionStep::Kind;
  std::array<double, kDepth + 1> stack;  // the first stays unused
  double* top = stack.data();
  *top = 0.0;
  for (const ExpressionStep& step : steps_) {
    switch (step.kind) {
      case Kind::kNumber:
        *++top = step.number;
        break;
      case Kind::kValue:
        *++top = values[step.position];
        break;
      case Kind::kNegative:
        *top = -*top;
        break;
      case Kind::kPower:
        *top = Power(*top, step.position);
        break;
      case Kind::kAbs:
        *top = std::fabs(*top);
        break;
      case Kind::kSqrt:
        *top = Sqrt(*top);
        break;
      case Kind::kExp:
        *top = Exp(*top);
        break;
      case Kind::kLog:
        *top = Log(*top);
        break;
      case Kind::kSinDeg:
        *top = Sin(*top * kRadPerDeg);
        break;
      case Kind::kCosDeg:
        *top = Cos(*top * kRadPerDeg);
        break;
      case Kind::kNot:
        *top = 1.0 - *top;
        break;
      default: {
        const double right = *top--;
        const double left = *top;
        switch (step.kind) {
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
            *top = right > left || std::isnan(right) ? right : left;
            break;
          case Kind::kSmaller:
            *top = right < left || std::isnan(right) ? right : left;
            break;
          case Kind::kBelow:
            *top = left < right ? 1.0 : 0.0;
            break;
          case Kind::kAtMost:
            *top = left <= right ? 1.0 : 0.0;
            break;
          case Kind::kAbove:
            *top = left > right ? 1.0 : 0.0;
            break;
          case Kind::kAtLeast:
            *top = left >= right ? 1.0 : 0.0;
            break;
          default:  // kOr
            *top = left + right > 0.0 ? 1.0 : 0.0;
        }
      }
    }
  }
  return *top;
}

std::vector<int> Expression::Positions() const {
  std::vector<int> positions;
  for (const ExpressionStep& step : steps_)
    if (step.kind == ExpressionStep::Kind::kValue) positions.push_back(step.position);
  std::sort(positions.begin(), positions.end());
  positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
  return positions;
}

}  // namespace dispersa
