// The points of a stage's search: variables, bounds, starting points, and the design at a point.
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

  /// Bounds and starting points; `evaluate` is not set.
  BoundedProblem ProblemOf(int stage) const;
  /// The design at a point of the search, without the bandwidth.
  StageDesign ShapeOf(const std::vector<double>& point, int stage, double at_s) const;
  /// The filters from the last variables of a point. Frequencies follow the first mode at time `at_s` after
  /// ignition.
  StageFilters FiltersAt(const std::vector<double>& point, int stage, double at_s) const;

 private:
  TunedPlant plant_;
  const TuningOptions& options_;
};

}  // namespace dispersa
