// The points of a stage's search: its variables, their bounds and where it starts, and the design that a
// point means.
#pragma once

#include <vector>

#include "core/optimization/genetic_algorithm.h"
#include "core/tuning/stage_design.h"
#include "core/tuning/tuned_plant.h"
#include "core/tuning/tuning_options.h"

namespace dispersa {

class StagePoints {
 public:
  StagePoints(const TunedPlant& plant, const TuningOptions& options) : plant_(plant), options_(options) {}

  /// Bounds and starting points, without results yet.
  BoundedProblem ProblemOf(int stage) const;
  /// All but the bandwidth at a point of the search.
  StageDesign ShapeOf(const std::vector<double>& point, int stage, double at_s) const;
  /// Of the last variables of a point.
  StageFilters FiltersAt(const std::vector<double>& point, int stage, double at_s) const;

 private:
  TunedPlant plant_;
  const TuningOptions& options_;
};

}  // namespace dispersa
