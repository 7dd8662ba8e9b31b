// The least sum of squares of a linear model within bounds: one step of the corrector.
#pragma once

#include <Eigen/Core>

#include <array>

#include "core/guidance/plan.h"

namespace dispersa {

/// Energy, path (two) and plane; and of targets that name a node or a place. Of ways through the air one more
/// of either, the last.
inline constexpr int kMisses = 4, kAllMisses = 6, kMissesAndAir = kMisses + 1,
                     kAllMissesAndAir = kAllMisses + 1;
template <int misses>
using Misses = Eigen::Matrix<double, misses, 1>;
/// Of the first `count` unknowns of a plan. The order in which sums are taken depends on it.
template <int count>
using Unknowns = Eigen::Matrix<double, count, 1>;

/// Model of the sum of squares |miss + J s|² + |y + s|² + max(y + s, 0)' D max(y + s, 0), all without units.
/// `low` is not above 0, `high` not below.
template <int count, int misses = kMisses>
struct StepModel {
  Eigen::Matrix<double, misses, count> jacobian = Eigen::Matrix<double, misses, count>::Zero();
  Misses<misses> miss = Misses<misses>::Zero();
  Unknowns<count> departure = Unknowns<count>::Zero();  ///< y
  Unknowns<count> low = Unknowns<count>::Zero(), high = Unknowns<count>::Zero();
  Unknowns<count> dearer = Unknowns<count>::Zero();  ///< the diagonal D, not below 0
  std::array<bool, kPlanUnknowns> free{};

  double At(const Unknowns<count>& step) const {
    return (miss + jacobian * step).squaredNorm() + CostOf(departure + step);
  }
  /// The departures' part of the sum.
  double CostOf(const Unknowns<count>& departures) const {
    return departures.squaredNorm() + dearer.dot(departures.cwiseMax(0.0).cwiseAbs2());
  }
};

/// The step s within the bounds with the least sum of the model and s' (W - 1) s. W is the diagonal
/// `weight`, 1 or more. The sum is not larger than without a step, if the sides are found. By an active set
/// (J. Nocedal and S. J. Wright, Numerical Optimization, 2006, section 16.5). The sides on which departures
/// are dear are sought by trying, a few times: the sum is convex and has no kinks.
template <int count, int misses>
Unknowns<count> BoundedStep(const StepModel<count, misses>& model, const Unknowns<count>& weight);

}  // namespace dispersa
