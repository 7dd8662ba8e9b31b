// The constraints of section II of the paper on an ascent: value, limit and margin of each.
#pragma once

#include <vector>

#include "core/trajectory/ascent.h"
#include "core/trajectory/reference.h"

namespace dispersa {

/// Always in the same order: axial and lateral load, programmed incidence, turn rate of the pitch-over, Mach
/// number at t2 (below the transonic range), incidence within it (exactly zero), q and q·alpha. Those
/// without a limit are reported with enforced = false.
std::vector<ConstraintMargin> ConstraintsOf(const TrajectoryProblem& problem, const FlightProgram& program,
                                            const AscentResult& ascent);

/// Whether every enforced constraint is satisfied.
bool AreSatisfied(const std::vector<ConstraintMargin>& constraints);

/// How far each enforced constraint is missed as a fraction of its limit, 0 where it is satisfied with
/// `reserve` (a fraction of the limit) to spare.
std::vector<double> Violations(const std::vector<ConstraintMargin>& constraints, double reserve);

}  // namespace dispersa
