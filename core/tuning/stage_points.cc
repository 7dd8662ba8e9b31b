#include "core/tuning/stage_points.h"

#include <algorithm>
#include <cmath>

#include "core/math/constants.h"
#include "core/tuning/regulator.h"

namespace dispersa {

BoundedProblem StagePoints::ProblemOf(int stage) const {
  const bool learns = Learns(plant_.campaign.autopilot);
  BoundedProblem problem;
  struct Variable {
    Bounds bounds;
    double start;
    double held_start = start;  ///< in the second starting point, which a search with held plants has
  };
  std::vector<Variable> variables = {{kBandwidthOfLargest, kBandwidthOfLargest.high}};
  if (options_.regulator) {
    variables.push_back({kIntegralWeightPower, kStartIntegralWeightPower});
    variables.push_back({kRateWeightPower, kStartRateWeightPower});
  } else {
    variables.push_back({kDamping, kStartDamping, kHeldDampingStart});
    if (learns && options_.dispersed > 0)
      variables.push_back({kHeldLearning, kHeldLearningStart});
    else if (learns)
      variables.push_back({kLearning, kStartLearning});
  }
  if (plant_.FirstMode(stage) > 0.0) {
    variables.push_back({kLowPassPower, kStartLowPassPower, kHeldLowPassPowerStart});
    variables.push_back({kLowPassDamping, kStartLowPassDamping, kHeldLowPassDampingStart});
    variables.push_back({kNotchPower, kStartNotchPower, kHeldNotchPowerStart});
    variables.push_back({kNotchZerosDamping, kStartNotchZerosDamping, kHeldNotchZerosDampingStart});
    variables.push_back({kNotchPolesDamping, kStartNotchPolesDamping, kHeldNotchPolesDampingStart});
    if (!BlendedGyros(plant_.campaign.autopilot, stage).empty())
      variables.push_back({kGyroWeight, kStartGyroWeight, kHeldGyroWeightStart});
  }
  problem.known_points = {{}};
  if (options_.dispersed > 0) problem.known_points.push_back({});
  for (const Variable& variable : variables) {
    problem.lower.push_back(variable.bounds.low);
    problem.upper.push_back(variable.bounds.high);
    problem.known_points[0].push_back(variable.start);
    if (options_.dispersed > 0) problem.known_points[1].push_back(variable.held_start);
  }
  return problem;
}

StageDesign StagePoints::ShapeOf(const std::vector<double>& point, int stage, double at_s) const {
  StageDesign design;
  std::size_t next = 1;
  if (options_.regulator) {
    const RegulatorGains k = SolveRegulator({std::pow(10.0, point[1]), 1.0, std::pow(10.0, point[2])});
    const double w = std::sqrt(k.kp_1_s2);
    design.damping = k.kd_1_s / (2.0 * w);
    design.learning = k.ki_1_s3 / (w * w * w);
    next = 3;
  } else {
    design.damping = point[next++];
    design.learning = Learns(plant_.campaign.autopilot) ? point[next++] : 0.0;
  }
  if (plant_.FirstMode(stage) > 0.0)
    design.filters = FiltersAt({point.begin() + static_cast<std::ptrdiff_t>(next), point.end()}, stage, at_s);
  return design;
}

StageFilters StagePoints::FiltersAt(const std::vector<double>& point, int stage, double at_s) const {
  const double first_mode_rad_s = plant_.FirstMode(stage, at_s);
  const double fastest_rad_s = kFastestPoles * kPi / plant_.campaign.autopilot.tick_s;
  StageFilters filters;
  filters.low_pass_rad_s = std::min(std::pow(10.0, point[0]) * first_mode_rad_s, fastest_rad_s);
  filters.low_pass_damping = point[1];
  filters.notch_rad_s = std::min(std::pow(10.0, point[2]) * first_mode_rad_s, fastest_rad_s);
  filters.notch_zeros_damping = point[3];
  filters.notch_poles_damping = point[4];
  if (!BlendedGyros(plant_.campaign.autopilot, stage).empty()) filters.first_gyro_weight = point[5];
  return filters;
}

}  // namespace dispersa
