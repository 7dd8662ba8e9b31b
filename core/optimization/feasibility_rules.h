// The order in which a genetic algorithm prefers evaluations.
//
// K. Deb, "An efficient constraint handling method for genetic algorithms", Computer Methods in Applied
// Mechanics and Engineering 186 (2000) 311-338, section 3. A feasible point beats an infeasible one. Of two
// infeasible points the smaller sum of violations wins. Of two feasible points the lower objective wins.
// Added here: feasible objectives as good as the best known one are equal, and the lower tie-breaker wins.
#pragma once

#include "core/optimization/bounded_problem.h"

namespace dispersa {

/// The numbers of an evaluation on which the order depends. None is NaN.
struct Merit {
  double violation = 0.0;  ///< sum of the violations (0: feasible, +infinity: worst)
  double objective = 0.0;
  double tie_breaker = 0.0;

  bool IsFeasible() const { return violation == 0.0; }
};

Merit MeritOf(const Evaluation& evaluation);

/// Whether a is strictly better than b. Feasible objectives of at most `tie_threshold` are equal: then the
/// lower tie-breaker wins, and after that the lower objective.
///
/// A threshold makes this a strict weak order. A tolerance between a and b would not: a could equal b, b
/// equal c, and a still beat c. The best of a run could then drift by one tolerance in each generation.
bool IsBetter(const Merit& a, const Merit& b, double tie_threshold);

}  // namespace dispersa
