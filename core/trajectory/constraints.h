// The constraints of section II of the paper on an ascent: value, limit and margin of each.
#pragma once

#include <vector>

#include "core/trajectory/ascent.h"
#include "core/trajectory/reference.h"

namespace dispersa {

/// Always in the same order: axial and lateral load, programmed incidence, turn rate of the pitch-over, Mach
/// number at t2 (below the transonic range), transonic incidence (exactly zero), q and q·alpha. A constraint
/// without a limit is reported with enforced = false.
std::vector<ConstraintMargin> ConstraintsOf(const TrajectoryProblem& problem, const FlightProgram& program,
                                            const AscentResult& ascent);

/// Whether every enforced constraint is satisfied.
bool AreSatisfied(const std::vector<ConstraintMargin>& constraints);

/// The miss of each enforced constraint as a fraction of its limit. It is 0 if the constraint holds with
/// `reserve`, a fraction of the limit, to spare.
std::vector<double> Violations(const std::vector<ConstraintMargin>& constraints, double reserve);

}  // namespace dispersa
