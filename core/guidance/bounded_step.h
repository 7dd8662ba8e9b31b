// The least sum of squares of a linear model within bounds: one step of the corrector.
#pragma once

#include <Eigen/Core>

#include <array>

#include "core/guidance/plan.h"

namespace dispersa {

inline constexpr int kMisses = 4;
using Misses = Eigen::Matrix<double, kMisses, 1>;
/// Of the first `count` unknowns of a plan. The order in which sums are taken depends on it.
template <int count>
using Unknowns = Eigen::Matrix<double, count, 1>;

/// Model of the sum of squares |miss + J s|² + |y + s|², all without units. `low` is not above 0, `high` not
/// below.
template <int count>
struct StepModel {
  Eigen::Matrix<double, kMisses, count> jacobian = Eigen::Matrix<double, kMisses, count>::Zero();
  Misses miss = Misses::Zero();
  Unknowns<count> departure = Unknowns<count>::Zero();  ///< y
  Unknowns<count> low = Unknowns<count>::Zero(), high = Unknowns<count>::Zero();
  std::array<bool, kPlanUnknowns> free{};

  double At(const Unknowns<count>& step) const {
    return (miss + jacobian * step).squaredNorm() + (departure + step).squaredNorm();
  }
};

/// The step s within the bounds with the least |miss + J s|² + |y + s|² + s' (W - 1) s. W is the diagonal
/// `weight`, 1 or more. The sum is never larger than without a step. By an active set (J. Nocedal and S. J.
/// Wright, Numerical Optimization, 2006, section 16.5).
template <int count>
Unknowns<count> BoundedStep(const StepModel<count>& model, const Unknowns<count>& weight);
extern template Unknowns<kUncutUnknowns> BoundedStep(const StepModel<kUncutUnknowns>&,
                                                     const Unknowns<kUncutUnknowns>&);
extern template Unknowns<kPlanUnknowns> BoundedStep(const StepModel<kPlanUnknowns>&,
                                                    const Unknowns<kPlanUnknowns>&);

}  // namespace dispersa
