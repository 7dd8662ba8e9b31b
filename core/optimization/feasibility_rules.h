// The order in which a genetic algorithm prefers evaluations.
//
// K. Deb, "An efficient constraint handling method for genetic algorithms", Computer Methods in Applied
// Mechanics and Engineering 186 (2000) 311-338, section 3: a feasible point beats an infeasible one; of two
// infeasible points the one with the smaller sum of violations wins; of two feasible ones the one with the
// lower objective. Added here: feasible objectives that are as good as the best one known are equal, and
// then the lower tie-breaker wins.
#pragma once

#include "core/optimization/bounded_problem.h"

namespace dispersa {

/// An evaluation reduced to what the order depends on; holds no NaN.
struct Merit {
  double violation = 0.0;  ///< sum of the violations; 0: feasible; +infinity: worst
  double objective = 0.0;
  double tie_breaker = 0.0;

  bool IsFeasible() const { return violation == 0.0; }
};

Merit MeritOf(const Evaluation& evaluation);

/// Whether a is strictly better than b. Feasible objectives of at most `tie_threshold` are equal: then the
/// lower tie-breaker wins, and after that the lower objective.
///
/// A threshold, rather than a tolerance between a and b, makes this a strict weak order: with a tolerance,
/// a could equal b, b equal c and a still beat c, and the best of a run could drift by one tolerance in each
/// generation.
bool IsBetter(const Merit& a, const Merit& b, double tie_threshold);

}  // namespace dispersa
