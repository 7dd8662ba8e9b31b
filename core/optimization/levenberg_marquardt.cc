#include "core/optimization/levenberg_marquardt.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/math/functions.h"
#include "core/math/matrices.h"

namespace dispersa {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void Require(bool holds, std::string_view field, double value, std::string_view allowed) {
  if (!holds) throw std::invalid_argument(fmt::format("{} is {}; allowed is {}", field, value, allowed));
}

bool IsPositive(double x) { return x > 0.0 && std::isfinite(x); }
bool IsNotNegative(double x) { return x >= 0.0 && std::isfinite(x); }

void Validate(const LevenbergMarquardtOptions& options) {
  const auto require = [](bool holds, std::string_view field, double value, std::string_view allowed) {
    Require(holds, fmt::format("LevenbergMarquardtOptions.{}", field), value, allowed);
  };
  require(options.max_iterations >= 1 && options.max_iterations <= 100'000, "max_iterations",
          options.max_iterations, "1 to 100000");
  require(IsNotNegative(options.residual_tolerance), "residual_tolerance", options.residual_tolerance,
          "a finite number of at least 0");
  require(options.gradient_tolerance >= 0.0 && options.gradient_tolerance <= 1.0, "gradient_tolerance",
          options.gradient_tolerance, "0 to 1");
  require(IsNotNegative(options.step_tolerance), "step_tolerance", options.step_tolerance,
          "a finite number of at least 0");
  require(options.initial_damping > 0.0 && options.initial_damping <= 1.0, "initial_damping",
          options.initial_damping, "above 0, at most 1");
  require(options.rank_tolerance >= 0.0 && options.rank_tolerance <= 1.0, "rank_tolerance",
          options.rank_tolerance, "0 to 1");
}

void Validate(const LeastSquaresProblem& problem, const std::vector<double>& start) {
  const auto count = [](const auto& values) { return static_cast<double>(values.size()); };
  Require(!problem.unknowns.empty(), "LeastSquaresProblem.unknowns.size()", 0.0, "at least 1");
  Require(problem.residual_scales.size() >= problem.unknowns.size(),
          "LeastSquaresProblem.residual_scales.size()", count(problem.residual_scales),
          fmt::format("at least {}, the number of unknowns", problem.unknowns.size()));
  for (std::size_t i = 0; i < problem.residual_scales.size(); ++i) {
    Require(IsPositive(problem.residual_scales[i]), fmt::format("LeastSquaresProblem.residual_scales[{}]", i),
            problem.residual_scales[i], "a finite number above 0");
  }
  if (!problem.residuals)
    throw std::invalid_argument("LeastSquaresProblem.residuals is empty; allowed is a function");
  Require(start.size() == problem.unknowns.size(), "start.size()", count(start),
          fmt::format("{}, the number of unknowns", problem.unknowns.size()));
  for (std::size_t i = 0; i < problem.unknowns.size(); ++i) {
    const Unknown& unknown = problem.unknowns[i];
    const std::string name = fmt::format("LeastSquaresProblem.unknowns[{}]", i);
    Require(unknown.lower < unknown.upper, name + ".upper", unknown.upper,
            fmt::format("above lower = {}", unknown.lower));
    Require(IsPositive(unknown.scale), name + ".scale", unknown.scale, "a finite number above 0");
    Require(IsPositive(unknown.difference_step) &&
                unknown.difference_step <= 0.5 * (unknown.upper - unknown.lower),
            name + ".difference_step", unknown.difference_step, "above 0, at most half of upper - lower");
    Require(std::isfinite(start[i]) && start[i] >= unknown.lower && start[i] <= unknown.upper,
            fmt::format("start[{}]", i), start[i], fmt::format("{} to {}", unknown.lower, unknown.upper));
  }
}

// One search. Residuals and the Jacobian are scaled throughout; unknowns are not.
class Search {
 public:
  Search(const LevenbergMarquardtOptions& options, const LeastSquaresProblem& problem,
         const std::vector<double>& start)
      : options_(options), problem_(problem), x_(start) {}

  LeastSquaresResult Execute() {
    const LeastSquaresStatus status = Iterate();
    LeastSquaresResult result{.status = status,
                              .unknowns = x_,
                              .residuals = {},
                              .largest_scaled_residual = residuals_.cwiseAbs().maxCoeff(),
                              .held_at_bound = {},
                              .iterations = iterations_,
                              .evaluations = evaluations_};
    for (std::size_t i = 0; i < problem_.residual_scales.size(); ++i) {
      result.residuals.push_back(residuals_[i] * problem_.residual_scales[i]);
    }
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (held_[i]) result.held_at_bound.push_back(i);
    }
    return result;
  }

 private:
  struct Step {
    std::vector<double> target;
    double predicted_cost;  // of the linear model
    double length;          // largest move of an unknown, in its scale
  };

  LeastSquaresStatus Iterate() {
    residuals_ = Try(x_);
    beside_ = tried_beside_;
    if (!residuals_.allFinite()) return LeastSquaresStatus::kNotFinite;
    bool moved = true;
    double damping_growth = 2.0;
    for (;; ++iterations_) {
      if (moved) {
        if (residuals_.cwiseAbs().maxCoeff() <= options_.residual_tolerance)
          return LeastSquaresStatus::kConverged;
        if (iterations_ == options_.max_iterations) return LeastSquaresStatus::kMaxIterations;
        if (!Linearise()) return LeastSquaresStatus::kNotFinite;
        if (IsStationary()) return ReasonToStop();
      }
      if (iterations_ == options_.max_iterations) return LeastSquaresStatus::kMaxIterations;
      const Step step = DampedStep();
      if (step.length <= options_.step_tolerance) return ReasonToStop();

      const VectorXd trial = Try(step.target);
      const double cost = 0.5 * residuals_.squaredNorm();
      const double trial_cost = 0.5 * trial.squaredNorm();
      moved = trial.allFinite() && trial_cost < cost && step.predicted_cost < cost;
      if (moved) {
        const double gain = (cost - trial_cost) / (cost - step.predicted_cost);
        const double poorness = 2.0 * gain - 1.0;
        damping_ *= std::max(1.0 / 3.0, 1.0 - poorness * poorness * poorness);
        damping_growth = 2.0;
        x_ = step.target;
        residuals_ = trial;
        beside_ = tried_beside_;
      } else {
        damping_ *= damping_growth;
        damping_growth *= 2.0;
      }
    }
  }

  VectorXd Residuals(const std::vector<double>& x) {
    ++evaluations_;
    return Scaled(problem_.residuals(x));
  }

  VectorXd Scaled(const std::vector<double>& values) const {
    const std::size_t count = problem_.residual_scales.size();
    if (values.size() != count) {
      throw std::invalid_argument(
          fmt::format("LeastSquaresProblem.residuals returned {} values; allowed is {}, as many "
                      "as residual_scales",
                      values.size(), count));
    }
    VectorXd scaled(count);
    for (std::size_t i = 0; i < count; ++i) scaled[i] = values[i] / problem_.residual_scales[i];
    return scaled;
  }

  // The residuals at x. With residuals_together also those of the points beside x, for its Jacobian.
  VectorXd Try(const std::vector<double>& x) {
    tried_beside_.clear();
    if (!problem_.residuals_together) return Residuals(x);
    std::vector<std::vector<double>> points = {x};
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Sides sides = SidesOf(x, i);
      for (const std::optional<double>& side : {sides.low, sides.high}) {
        if (!side) continue;
        points.push_back(x);
        points.back()[i] = *side;
      }
    }
    const std::vector<std::vector<double>> all = problem_.residuals_together(points);
    if (all.size() != points.size()) {
      throw std::invalid_argument(
          fmt::format("LeastSquaresProblem.residuals_together returned {} values; allowed is {}", all.size(),
                      points.size()));
    }
    evaluations_ += static_cast<int>(points.size());
    for (std::size_t i = 1; i < all.size(); ++i) tried_beside_.push_back(Scaled(all[i]));
    return Scaled(all[0]);
  }

  // Computes the Jacobian at x_, the unknowns held by their bounds, and the first damping. False: a value is
  // not finite.
  bool Linearise() {
    jacobian_.resize(residuals_.size(), x_.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < x_.size(); ++i) jacobian_.col(i) = Column(i, &next);
    if (!jacobian_.allFinite()) return false;
    const VectorXd gradient = jacobian_.transpose() * residuals_;
    held_.assign(x_.size(), false);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      held_[i] = (x_[i] == problem_.unknowns[i].lower && gradient[i] > 0.0) ||
                 (x_[i] == problem_.unknowns[i].upper && gradient[i] < 0.0);
    }
    if (damping_ == 0.0) damping_ = options_.initial_damping * jacobian_.colwise().squaredNorm().maxCoeff();
    return true;
  }

  // The two points between which a column of the Jacobian is differenced. An unused side is empty.
  struct Sides {
    std::optional<double> low, high;
  };
  Sides SidesOf(const std::vector<double>& x, std::size_t i) const {
    const Unknown& unknown = problem_.unknowns[i];
    const double low = x[i] - unknown.difference_step;
    const double high = x[i] + unknown.difference_step;
    Sides sides;
    if (high > unknown.upper || (unknown.difference != Difference::kForward && low >= unknown.lower))
      sides.low = low;
    if (low < unknown.lower || (unknown.difference != Difference::kBackward && high <= unknown.upper))
      sides.high = high;
    return sides;
  }

  // The column of unknown i. `next` is the position in beside_.
  VectorXd Column(std::size_t i, std::size_t* next) {
    const Sides sides = SidesOf(x_, i);
    const auto at = [&](const std::optional<double>& side) -> VectorXd {
      if (!side) return residuals_;
      if (problem_.residuals_together) return beside_[(*next)++];
      std::vector<double> x = x_;
      x[i] = *side;
      return Residuals(x);
    };
    const VectorXd from = at(sides.low);
    const VectorXd to = at(sides.high);
    // The step between the points as rounded, not as intended.
    const double distance = sides.high.value_or(x_[i]) - sides.low.value_or(x_[i]);
    return (to - from) * (problem_.unknowns[i].scale / distance);
  }

  bool IsStationary() const {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double norms = jacobian_.col(i).norm() * residuals_.norm();
      if (!held_[i] && std::fabs(jacobian_.col(i).dot(residuals_)) > options_.gradient_tolerance * norms)
        return false;
    }
    return true;
  }

  // Minimises |r + J d|² + damping |d|² over the free unknowns. An unknown that would cross a bound stops on
  // it, and the rest is solved again.
  Step DampedStep() const {
    const Eigen::Index rows = residuals_.size();
    Step step{.target = x_, .predicted_cost = 0.0, .length = 0.0};
    VectorXd model = residuals_;
    std::vector<Eigen::Index> free = FreeUnknowns();
    while (!free.empty()) {
      const Eigen::Index columns = static_cast<Eigen::Index>(free.size());
      MatrixXd matrix = MatrixXd::Zero(rows + columns, columns);
      matrix.topRows(rows) = jacobian_(Eigen::all, free);
      matrix.bottomRows(columns).diagonal().setConstant(Sqrt(damping_));
      VectorXd right = VectorXd::Zero(rows + columns);
      right.head(rows) = -model;
      const VectorXd move = LeastSquaresOf(matrix, right);

      std::vector<Eigen::Index> inside;
      for (Eigen::Index k = 0; k < columns; ++k) {
        const Unknown& unknown = problem_.unknowns[free[k]];
        const double target = x_[free[k]] + unknown.scale * move[k];
        step.target[free[k]] = Clamp(target, unknown.lower, unknown.upper);
        if (target >= unknown.lower && target <= unknown.upper) {
          inside.push_back(free[k]);
        } else {
          model += jacobian_.col(free[k]) * MoveOf(step, free[k]);
        }
      }
      if (inside.size() == free.size()) break;
      free = inside;
    }
    for (const Eigen::Index i : free) model += jacobian_.col(i) * MoveOf(step, i);
    step.predicted_cost = 0.5 * model.squaredNorm();
    for (std::size_t i = 0; i < x_.size(); ++i)
      step.length = std::max(step.length, std::fabs(MoveOf(step, i)));
    return step;
  }

  double MoveOf(const Step& step, std::size_t i) const {
    return (step.target[i] - x_[i]) / problem_.unknowns[i].scale;
  }

  std::vector<Eigen::Index> FreeUnknowns() const {
    std::vector<Eigen::Index> free;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (!held_[i]) free.push_back(static_cast<Eigen::Index>(i));
    }
    return free;
  }

  LeastSquaresStatus ReasonToStop() const {
    const std::vector<Eigen::Index> free = FreeUnknowns();
    if (free.size() < x_.size()) return LeastSquaresStatus::kAtBound;
    return RankOf(jacobian_, options_.rank_tolerance) < jacobian_.cols()
               ? LeastSquaresStatus::kSingularJacobian
               : LeastSquaresStatus::kStalled;
  }

  const LevenbergMarquardtOptions& options_;
  const LeastSquaresProblem& problem_;
  std::vector<double> x_;
  VectorXd residuals_;
  std::vector<VectorXd> beside_,
      tried_beside_;  // residuals for the Jacobian at x_ and at the last point tried
  MatrixXd jacobian_;
  std::vector<bool> held_;
  double damping_ = 0.0;  // 0: not chosen yet
  int iterations_ = 0;
  int evaluations_ = 0;
};

}  // namespace

std::string_view Describe(LeastSquaresStatus status) {
  switch (status) {
    case LeastSquaresStatus::kConverged:
      return "converged: every residual is within its tolerance";
    case LeastSquaresStatus::kStalled:
      return "stalled: no small step reduces the residuals";
    case LeastSquaresStatus::kAtBound:
      return "at a bound: the residuals fall only beyond the bounds of the unknowns";
    case LeastSquaresStatus::kSingularJacobian:
      return "singular: the residuals do not respond to some combination of the unknowns";
    case LeastSquaresStatus::kMaxIterations:
      return "out of iterations: the residuals were still falling";
    case LeastSquaresStatus::kNotFinite:
      return "not finite: the residuals cannot be evaluated at the start or beside a point of the search";
  }
  return "unknown status";
}

LevenbergMarquardt::LevenbergMarquardt(const LevenbergMarquardtOptions& options) : options_(options) {
  Validate(options_);
}

LeastSquaresResult LevenbergMarquardt::Solve(const LeastSquaresProblem& problem,
                                             const std::vector<double>& start) const {
  Validate(problem, start);
  return Search(options_, problem, start).Execute();
}

}  // namespace dispersa
