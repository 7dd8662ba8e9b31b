// The least sum of squares of a linear model within bounds: one step of the corrector.
#pragma once

#include <Eigen/Core>

#include <array>

#include "core/guidance/plan.h"

namespace dispersa {

/// Energy, path (two), plane, node, place, and the fall into the air. A miss that does not count is 0, and so
/// are its slopes.
inline constexpr int kMisses = 7;
using Misses = Eigen::Matrix<double, kMisses, 1>;
using Unknowns = Eigen::Matrix<double, kPlanUnknowns, 1>;

/// Model of the sum of squares |miss + J s|² + |y + s|² + max(y + s, 0)' D max(y + s, 0), all without units.
/// `low` is not above 0, `high` not below.
struct StepModel {
  Eigen::Matrix<double, kMisses, kPlanUnknowns> jacobian =
      Eigen::Matrix<double, kMisses, kPlanUnknowns>::Zero();
  Misses miss = Misses::Zero();
  Unknowns departure = Unknowns::Zero();  ///< y
  Unknowns low = Unknowns::Zero(), high = Unknowns::Zero();
  Unknowns dearer = Unknowns::Zero();  ///< the diagonal D, not below 0
  std::array<bool, kPlanUnknowns> free{};

  double At(const Unknowns& step) const {
    return (miss + ChangeBy(step)).squaredNorm() + CostOf(departure + step);
  }
  /// J s
  Misses ChangeBy(const Unknowns& step) const;
  /// The departures' part of the sum.
  double CostOf(const Unknowns& departures) const {
    return departures.squaredNorm() + dearer.dot(departures.cwiseMax(0.0).cwiseAbs2());
  }
};

/// The step s within the bounds with the least sum of the model and s' (W - 1) s. W is the diagonal
/// `weight`, 1 or more. The sum is not larger than without a step, if the sides are found. By an active set
/// (J. Nocedal and S. J. Wright, Numerical Optimization, 2006, section 16.5). The sides on which departures
/// are dear are sought by trying, a few times: the sum is convex and has no kinks.
Unknowns BoundedStep(const StepModel& model, const Unknowns& weight);

}  // namespace dispersa
