// The least sum of squares of a linear model within bounds: one step of the corrector.
#pragma once

#include <Eigen/Core>

#include <array>

#include "core/guidance/plan.h"

namespace dispersa {

inline constexpr int kMisses = 4;
using Misses = Eigen::Matrix<double, kMisses, 1>;
using Unknowns = Eigen::Matrix<double, kPlanUnknowns, 1>;
using MissJacobian = Eigen::Matrix<double, kMisses, kPlanUnknowns>;

/// Model of the sum of squares |miss + J s|² + |y + s|², all without units. `low` is not above 0, `high` not
/// below.
struct StepModel {
  MissJacobian jacobian = MissJacobian::Zero();
  Misses miss = Misses::Zero();
  Unknowns departure = Unknowns::Zero();  ///< y
  Unknowns low = Unknowns::Zero(), high = Unknowns::Zero();
  std::array<bool, kPlanUnknowns> free{};

  double At(const Unknowns& step) const {
    return (miss + jacobian * step).squaredNorm() + (departure + step).squaredNorm();
  }
};

/// The step s within the bounds with the least |miss + J s|² + |y + s|² + s' (W - 1) s. W is the diagonal
/// `weight`, 1 or more. The sum is never larger than without a step. By an active set (J. Nocedal and S. J.
/// Wright, Numerical Optimization, 2006, section 16.5).
Unknowns BoundedStep(const StepModel& model, const Unknowns& weight);

}  // namespace dispersa
