// Selects, among the flight programs that reach the target, the one with the least peak of q·alpha.
//
// The target fixes three of the six variables. t1, t3 and t2 are free within the constraints, and the genetic
// algorithm on objective (8) stops anywhere on that manifold. This search moves along the manifold: t1, t3
// and t2 are its variables, each individual is refined onto the target, and the tie-breaker becomes the
// objective.
#pragma once

#include "core/optimization/genetic_algorithm.h"
#include "core/trajectory/ascent.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

struct Selection {
  GeneticAlgorithmResult genetic;  ///< variables t1, t3, t2; objective: peak of q·alpha, Pa rad
  std::int64_t ascents = 0;        ///< flown
};

/// Changes `program`, which reaches the target, to the best found, or leaves it if none is better.
Selection SelectProgram(const AscentModel& model, const TrajectoryProblem& problem,
                        const TrajectoryOptions& options, FlightProgram* program);

}  // namespace dispersa
