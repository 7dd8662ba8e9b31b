// A minimisation problem over a box, with constraints. The optimiser knows nothing else about it.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace dispersa {

/// The value of one point of the search space.
struct Evaluation {
  /// To be minimised. A value that is not finite makes the point the worst infeasible one.
  double objective = 0.0;
  /// One value per constraint: 0 where it is satisfied, else the miss as a positive fraction of its limit, so
  /// that different constraints can be added. Negative values count as 0. A value that is infinite or not a
  /// number makes the point the worst infeasible one.
  std::vector<double> constraint_violations;
  /// Decides among points of equal objective: lower wins. Not a number counts as +infinity.
  double tie_breaker = 0.0;

  bool operator==(const Evaluation&) const = default;
};

/// Minimise `evaluate` for lower <= x <= upper. A variable with lower == upper is fixed.
struct BoundedProblem {
  std::vector<double> lower;  ///< shape (n), finite
  std::vector<double> upper;  ///< shape (n), finite, none below `lower`
  /// A pure function of a point of shape (n). Several threads call it at a time. Its exceptions reach the
  /// caller of the optimiser.
  std::function<Evaluation(const std::vector<double>&)> evaluate;
  /// Points, each of shape (n) and within the box, that the search starts with beside random ones.
  std::vector<std::vector<double>> known_points = {};
  /// Optional: `evaluate` for several points at once, for a problem that evaluates them faster side by side.
  std::function<std::vector<Evaluation>(std::span<const std::vector<double>>)> evaluate_together = nullptr;
  /// Largest number of points given to evaluate_together at a time, at least 1.
  std::size_t together = 1;
};

}  // namespace dispersa
