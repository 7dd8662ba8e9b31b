// Selects the flight program with the least peak of q·alpha among those that reach the target.
//
// The target fixes three of the six variables. t1, t3 and t2 are free within the constraints. The genetic
// algorithm on objective (8) may stop anywhere on this manifold. This search moves along the manifold. Its
// variables are t1, t3 and t2, each individual is refined onto the target, and the tie-breaker becomes the
// objective.
#pragma once

#include "core/optimization/genetic_algorithm.h"
#include "core/trajectory/ascent.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

struct Selection {
  GeneticAlgorithmResult genetic;  ///< variables t1, t3, t2; objective: peak of q·alpha, Pa rad
  std::int64_t ascents = 0;        ///< number of ascents flown
};

/// `program` must reach the target. It is changed to the best one found, or stays if none is better.
Selection SelectProgram(const AscentModel& model, const TrajectoryProblem& problem,
                        const TrajectoryOptions& options, FlightProgram* program);

}  // namespace dispersa
