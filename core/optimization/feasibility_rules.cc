#include "core/optimization/feasibility_rules.h"

#include <cmath>
#include <limits>

namespace dispersa {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
}

Merit MeritOf(const Evaluation& evaluation) {
  Merit merit{.violation = 0.0,
              .objective = evaluation.objective,
              .tie_breaker = std::isnan(evaluation.tie_breaker) ? kInfinity : evaluation.tie_breaker};
  for (const double violation : evaluation.constraint_violations) {
    if (!std::isfinite(violation)) {
      merit.violation = kInfinity;
    } else if (violation > 0.0) {
      merit.violation += violation;
    }
  }
  if (!std::isfinite(merit.objective)) {
    merit.violation = kInfinity;
    merit.objective = kInfinity;
  }
  return merit;
}

bool IsBetter(const Merit& a, const Merit& b, double tie_threshold) {
  if (a.violation != b.violation) return a.violation < b.violation;
  if (!a.IsFeasible()) return false;
  const bool tied = a.objective <= tie_threshold && b.objective <= tie_threshold;
  if (tied && a.tie_breaker != b.tie_breaker) return a.tie_breaker < b.tie_breaker;
  if (a.objective != b.objective) return a.objective < b.objective;
  return a.tie_breaker < b.tie_breaker;
}

}  // namespace dispersa
