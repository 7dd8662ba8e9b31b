// Least squares in a few unknowns within bounds, where residuals are expensive and have no derivatives.
//
// Levenberg-Marquardt with the damping rule of H. B. Nielsen, "Damping parameter in Marquardt's method",
// IMM-REP-1999-05, Technical University of Denmark (also K. Madsen, H. B. Nielsen, O. Tingleff, "Methods for
// non-linear least squares problems", 2nd ed., 2004, algorithm 3.16). A small initial damping makes it a
// damped Newton method where there are as many residuals as unknowns. Bounds are an active set: an unknown on
// its bound that the descent would push out is held there, and the others move. Steps come from a QR
// factorisation of the Jacobian, which does not square its condition number. Sequential and deterministic.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace dispersa {

/// The side on which a column of the Jacobian is differenced. At a bound the other side is taken.
enum class Difference { kForward, kBackward, kCentral };

struct Unknown {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();  ///< above `lower`
  /// A typical change, positive: unknowns are divided by it, so that steps in different units compare.
  double scale = 1.0;
  /// Finite-difference step, positive, at most half of upper - lower, in the unit of the unknown. For
  /// residuals that are exact to rounding: about 1e-8 of the unknown's size for one-sided differences and
  /// 6e-6 for central ones. Larger for less exact residuals.
  double difference_step = 1e-6;
  Difference difference = Difference::kCentral;
};

struct LeastSquaresProblem {
  std::vector<Unknown> unknowns;  ///< shape (n), at least 1
  /// Shape (m), m >= n, positive: residuals are divided by it before they are squared, added and compared
  /// with `residual_tolerance`.
  std::vector<double> residual_scales;
  /// Residuals, shape (m), of unknowns, shape (n). Residuals that are not finite reject a step.
  std::function<std::vector<double>(const std::vector<double>&)> residuals;
  /// Optional: `residuals` of several points at once, for a problem that computes them faster side by side.
  /// Each tried point is then computed together with the points of its Jacobian, in case it is accepted. The
  /// result is the same, except for the number of evaluations.
  std::function<std::vector<std::vector<double>>(std::span<const std::vector<double>>)> residuals_together =
      nullptr;
};

struct LevenbergMarquardtOptions {
  /// Steps tried, accepted or not, 1 to 100,000.
  int max_iterations = 100;
  /// Converged if every scaled residual is at most this. Not negative.
  double residual_tolerance = 1e-9;
  /// Stop if every column of the Jacobian of a free unknown is nearly orthogonal to the residuals. The limit
  /// of the cosine of their angle is this (the `gtol` of MINPACK's LMDER), 0 to 1.
  double gradient_tolerance = 1e-12;
  /// Stop if no unknown would move by more than this many of its scales. Not negative.
  double step_tolerance = 1e-13;
  /// Initial damping as a fraction of the largest squared column norm of the scaled Jacobian, in (0, 1]. 1e-6
  /// suits a start near the solution, 1e-3 or more a remote one (Madsen et al., section 3.2).
  double initial_damping = 1e-6;
  /// At the end the Jacobian counts as singular if some direction hardly changes the residuals: by less than
  /// this fraction of the strongest direction, 0 to 1. Central differences are good to about 1e-10.
  double rank_tolerance = 1e-9;
};

enum class LeastSquaresStatus {
  kConverged,         ///< every scaled residual is within the tolerance
  kStalled,           ///< a local minimum of the sum of squares, or the noise of the residuals
  kAtBound,           ///< no step within the bounds helps, though one beyond a bound would
  kSingularJacobian,  ///< stalled where the residuals do not respond to some combination of the free unknowns
  kMaxIterations,     ///< still improving when the iterations ran out
  kNotFinite,         ///< residuals are not finite at the start or beside an accepted point
};

/// One sentence for a reader of a report.
std::string_view Describe(LeastSquaresStatus status);

struct LeastSquaresResult {
  LeastSquaresStatus status = LeastSquaresStatus::kConverged;
  std::vector<double> unknowns;            ///< shape (n), the best found, within the bounds
  std::vector<double> residuals;           ///< shape (m), at `unknowns`, unscaled
  double largest_scaled_residual = 0.0;    ///< absolute
  std::vector<std::size_t> held_at_bound;  ///< unknowns on a bound beyond which the residuals would fall
  int iterations = 0;
  int evaluations = 0;  ///< calls of the residuals, those for the Jacobian included

  bool operator==(const LeastSquaresResult&) const = default;
};

class LevenbergMarquardt {
 public:
  /// Throws std::invalid_argument that names the field which is out of range and what is allowed.
  explicit LevenbergMarquardt(const LevenbergMarquardtOptions& options);

  /// Minimises the sum of squared scaled residuals from `start`, shape (n), within the bounds. If the
  /// residuals cannot reach zero, the status says so; this is no error. Throws std::invalid_argument for an
  /// ill-formed problem or start.
  LeastSquaresResult Solve(const LeastSquaresProblem& problem, const std::vector<double>& start) const;

 private:
  LevenbergMarquardtOptions options_;
};

}  // namespace dispersa
