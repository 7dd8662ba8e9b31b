#include "core/expressions/expression.h"

#include <algorithm>

#include "core/expressions/evaluate.h"

namespace dispersa {

double Expression::Evaluate(const double* values) const { return lanes::Evaluate<double>(steps(), values); }

std::vector<int> Expression::Positions() const {
  std::vector<int> positions;
  for (const ExpressionStep& step : steps_)
    if (step.kind == ExpressionStep::Kind::kValue) positions.push_back(step.position);
  std::sort(positions.begin(), positions.end());
  positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
  return positions;
}

}  // namespace dispersa
