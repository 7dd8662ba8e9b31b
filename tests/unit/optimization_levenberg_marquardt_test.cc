// Least squares: known solutions, each status at the end, bounds, sides of differencing, scales and errors.
#include "core/optimization/levenberg_marquardt.h"
#include "tests/test.h"

namespace dispersa::optimization_levenberg_marquardt_test {
namespace {

using Vector = std::vector<double>;
using Status = LeastSquaresStatus;

LeastSquaresProblem Problem(std::size_t unknowns, std::size_t residuals,
                            std::function<Vector(const Vector&)> function) {
  return {std::vector<Unknown>(unknowns), Vector(residuals, 1.0), std::move(function)};
}

LeastSquaresProblem Rosenbrock() {
  return Problem(2, 2, [](const Vector& x) { return Vector{10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]}; });
}

LeastSquaresResult Solve(const LeastSquaresProblem& problem, const Vector& start,
                         const LevenbergMarquardtOptions& options = {}) {
  return LevenbergMarquardt(options).Solve(problem, start);
}

// J. J. More, B. S. Garbow and K. E. Hillstrom, "Testing unconstrained optimization software", ACM TOMS 7
// (1981) 17-41, problem 1, from its standard start.
TEST(LevenbergMarquardt, SolvesRosenbrock) {
  const LeastSquaresResult result = Solve(Rosenbrock(), {-1.2, 1.0});
  EXPECT_EQ(result.status, Status::kConverged);
  EXPECT_LE(result.largest_scaled_residual, 1e-9);  // the tolerance asked for
  EXPECT_NEAR(result.unknowns[0], 1.0, 1e-9);       // residual 2 is 1 - x[0]
  EXPECT_NEAR(result.unknowns[1], 1.0, 3e-9);       // residual 1 adds 1e-10 to twice that
  EXPECT_LE(result.evaluations, 200);
}

// The same collection, problem 13: the Jacobian is singular at the solution, the origin, where Newton's
// method converges only linearly. Residuals of 1e-9 that are squares leave 1e-9^(1/2) in the unknowns.
TEST(LevenbergMarquardt, SolvesPowellsSingularFunction) {
  const LeastSquaresProblem problem = Problem(4, 4, [](const Vector& x) {
    return Vector{x[0] + 10.0 * x[1], std::sqrt(5.0) * (x[2] - x[3]),
                  (x[1] - 2.0 * x[2]) * (x[1] - 2.0 * x[2]), std::sqrt(10.0) * (x[0] - x[3]) * (x[0] - x[3])};
  });
  const LeastSquaresResult result = Solve(problem, {3.0, -1.0, 0.0, 1.0});
  EXPECT_EQ(result.status, Status::kConverged);
  for (const double x : result.unknowns) EXPECT_NEAR(x, 0.0, 5e-5);
}

TEST(LevenbergMarquardt, ConvergesLikeNewtonNearTheSolution) {
  // From 1e-2 away Newton's errors are 1e-2, 1e-4, 1e-8, 1e-16 times constants of order one.
  const LeastSquaresProblem problem = Problem(2, 2, [](const Vector& x) {
    return Vector{x[0] * x[0] + x[1] - 3.0, x[0] - x[1] * x[1] + 3.0};
  });
  LevenbergMarquardtOptions options;
  options.residual_tolerance = 1e-12;
  const LeastSquaresResult result = Solve(problem, {1.01, 1.99}, options);
  EXPECT_EQ(result.status, Status::kConverged);
  EXPECT_LE(result.iterations, 4);
  EXPECT_NEAR(result.unknowns[0], 1.0, 1e-12);
  EXPECT_NEAR(result.unknowns[1], 2.0, 1e-12);
}

TEST(LevenbergMarquardt, StopsAtABoundAndMovesTheOtherUnknowns) {
  LeastSquaresProblem problem = Problem(2, 2, [](const Vector& x) {
    return Vector{x[0] - 3.0, x[0] + x[1] - 1.0};
  });
  problem.unknowns[0].upper = 2.0;
  const LeastSquaresResult result = Solve(problem, {0.0, 0.0});
  EXPECT_EQ(result.status, Status::kAtBound);
  EXPECT_EQ(result.held_at_bound, std::vector<std::size_t>{0});
  EXPECT_EQ(result.unknowns[0], 2.0);
  EXPECT_NEAR(result.unknowns[1], -1.0, 1e-9);  // linear: exact but for rounding and the differences
  EXPECT_EQ(result.residuals[0], -1.0);
  EXPECT_EQ(result.largest_scaled_residual, 1.0);
}

// With x[0] <= 1/2 the least sum of Rosenbrock's squares is 1/4 at (1/2, 1/4).
TEST(LevenbergMarquardt, FollowsABentValleyToTheBound) {
  LeastSquaresProblem problem = Rosenbrock();
  problem.unknowns[0].upper = 0.5;
  const LeastSquaresResult result = Solve(problem, {-1.2, 1.0});
  EXPECT_EQ(result.status, Status::kAtBound);
  EXPECT_EQ(result.unknowns[0], 0.5);
  EXPECT_NEAR(result.unknowns[1], 0.25, 1e-9);
}

TEST(LevenbergMarquardt, LeavesABoundBehindWhichNothingIsGained) {
  LeastSquaresProblem problem = Rosenbrock();
  problem.unknowns[0].lower = -1.2;
  problem.unknowns[1].upper = 1.5;
  const LeastSquaresResult result = Solve(problem, {-1.2, 1.5});
  EXPECT_EQ(result.status, Status::kConverged);
  EXPECT_TRUE(result.held_at_bound.empty());
}

TEST(LevenbergMarquardt, SaysThatTheJacobianIsSingular) {
  // Both residuals see the sum s alone; (s-1)² + (2s-3)² is least at s = 7/5.
  const LeastSquaresProblem problem = Problem(2, 2, [](const Vector& x) {
    return Vector{x[0] + x[1] - 1.0, 2.0 * (x[0] + x[1]) - 3.0};
  });
  const LeastSquaresResult result = Solve(problem, {0.0, 0.0});
  EXPECT_EQ(result.status, Status::kSingularJacobian);
  EXPECT_NEAR(result.unknowns[0] + result.unknowns[1], 1.4,
              1e-7);  // steps along the gradient end at its noise
}

TEST(LevenbergMarquardt, SolvesConsistentEquationsWithASingularJacobian) {
  const LeastSquaresProblem problem = Problem(2, 2, [](const Vector& x) {
    return Vector{x[0] + x[1] - 2.0, 2.0 * (x[0] + x[1]) - 4.0};
  });
  const LeastSquaresResult result = Solve(problem, {0.0, 0.5});
  EXPECT_EQ(result.status, Status::kConverged);
}

TEST(LevenbergMarquardt, StallsInALocalMinimum) {
  const LeastSquaresProblem problem = Problem(1, 2, [](const Vector& x) { return Vector{x[0], x[0] - 1.0}; });
  const LeastSquaresResult result = Solve(problem, {5.0});
  EXPECT_EQ(result.status, Status::kStalled);
  EXPECT_NEAR(result.unknowns[0], 0.5, 1e-7);
}

TEST(LevenbergMarquardt, StopsAfterItsIterations) {
  LevenbergMarquardtOptions options;
  options.max_iterations = 3;
  const LeastSquaresResult result = Solve(Rosenbrock(), {-1.2, 1.0}, options);
  EXPECT_EQ(result.status, Status::kMaxIterations);
  EXPECT_EQ(result.iterations, 3);
}

TEST(LevenbergMarquardt, RejectsStepsWhereResidualsAreNotFinite) {
  // Newton's first step from 4 goes to -3.6, where the square root is not a number.
  const LeastSquaresProblem problem =
      Problem(1, 1, [](const Vector& x) { return Vector{std::sqrt(x[0]) - 0.1}; });
  const LeastSquaresResult result = Solve(problem, {4.0});
  EXPECT_EQ(result.status, Status::kConverged);
  EXPECT_NEAR(result.unknowns[0], 0.01, 1e-9);
}

TEST(LevenbergMarquardt, SaysThatResidualsAreNotFinite) {
  const LeastSquaresProblem problem =
      Problem(1, 1, [](const Vector& x) { return Vector{std::sqrt(x[0]) + 1.0}; });
  EXPECT_EQ(Solve(problem, {-1.0}).status, Status::kNotFinite);
  EXPECT_EQ(Solve(problem, {0.0}).status, Status::kNotFinite);  // the central difference goes below 0
}

TEST(LevenbergMarquardt, DifferencesOnTheSideAskedForAndTurnsAtABound) {
  struct Case {
    Difference difference;
    double start;
    Vector points;  // visited for the Jacobian, in units of the step of 2^-10
  };
  const double step = 1.0 / 1024.0;
  for (const Case& c :
       {Case{Difference::kForward, 0.0, {1.0}}, Case{Difference::kBackward, 0.0, {-1.0}},
        Case{Difference::kCentral, 0.0, {-1.0, 1.0}}, Case{Difference::kForward, 1.0, {1023.0}},
        Case{Difference::kCentral, 1.0, {1023.0}}, Case{Difference::kBackward, -1.0, {-1023.0}}}) {
    Vector visited;
    LeastSquaresProblem problem = Problem(1, 1, [&](const Vector& x) {
      visited.push_back(x[0] / step);
      return Vector{x[0] - 0.5};
    });
    problem.unknowns[0] = {
        .lower = -1.0, .upper = 1.0, .scale = 1.0, .difference_step = step, .difference = c.difference};
    const LeastSquaresResult result = Solve(problem, {c.start});
    EXPECT_EQ(result.status, Status::kConverged);
    ASSERT_GT(visited.size(), c.points.size());
    EXPECT_EQ(Vector(visited.begin() + 1, visited.begin() + 1 + c.points.size()), c.points);
    EXPECT_EQ(result.evaluations, static_cast<int>(visited.size()));
  }
}

// A kink where a one-sided search starts: the other side's slope must not enter.
TEST(LevenbergMarquardt, OneSidedDifferencesSeeOneSideOfAKink) {
  LeastSquaresProblem problem =
      Problem(1, 1, [](const Vector& x) { return Vector{(x[0] > 1.0 ? 100.0 : 1.0) * (x[0] - 1.0) + 0.5}; });
  problem.unknowns[0].difference = Difference::kBackward;
  LevenbergMarquardtOptions options;
  options.max_iterations = 2;
  const LeastSquaresResult result = Solve(problem, {1.0}, options);
  EXPECT_EQ(result.status, Status::kConverged);
  EXPECT_NEAR(result.unknowns[0], 0.5, 1e-9);
}

// The same problem in other units, powers of two so that scaling is exact, takes the same way to the last
// bit.
TEST(LevenbergMarquardt, ScalesMakeUnitsIrrelevant) {
  const LeastSquaresResult plain = Solve(Rosenbrock(), {-1.2, 1.0});
  const double a = std::ldexp(1.0, 20);
  const double b = std::ldexp(1.0, -30);
  LeastSquaresProblem problem = Rosenbrock();
  problem.residuals = [&](const Vector& x) {
    const Vector r = Rosenbrock().residuals({x[0] / a, x[1] / b});
    return Vector{r[0] * b, r[1] * a};
  };
  problem.residual_scales = {b, a};
  problem.unknowns[0].scale = a;
  problem.unknowns[0].difference_step *= a;
  problem.unknowns[1].scale = b;
  problem.unknowns[1].difference_step *= b;
  const LeastSquaresResult scaled = Solve(problem, {-1.2 * a, 1.0 * b});
  EXPECT_EQ(scaled.status, Status::kConverged);
  EXPECT_EQ(scaled.unknowns, (Vector{plain.unknowns[0] * a, plain.unknowns[1] * b}));
  EXPECT_EQ(scaled.residuals, (Vector{plain.residuals[0] * b, plain.residuals[1] * a}));
  EXPECT_EQ(scaled.largest_scaled_residual, plain.largest_scaled_residual);
  EXPECT_EQ(scaled.evaluations, plain.evaluations);
}

// Near a bound too, where the side of the differences turns.
TEST(LevenbergMarquardt, ResidualsFoundTogetherGiveTheSameResult) {
  for (const double bound : {10.0, 0.9}) {
    LeastSquaresProblem problem = Rosenbrock();
    problem.unknowns[0].upper = bound;
    problem.unknowns[1].difference = Difference::kForward;
    LeastSquaresResult alone = Solve(problem, {-1.2, 1.0});
    std::vector<std::size_t> counts;
    problem.residuals_together = [&](std::span<const Vector> points) {
      counts.push_back(points.size());
      std::vector<Vector> all;
      for (const Vector& x : points) all.push_back(problem.residuals(x));
      return all;
    };
    LeastSquaresResult together = Solve(problem, {-1.2, 1.0});
    // Every point comes with those of its Jacobian: two of the first unknown, or one at its bound, and one.
    EXPECT_GE(*std::min_element(counts.begin(), counts.end()), 3u);
    EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), 4u);
    EXPECT_EQ(static_cast<std::size_t>(together.evaluations),
              std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
    together.evaluations = alone.evaluations;
    EXPECT_EQ(together, alone);
  }
}

TEST(LevenbergMarquardt, IsDeterministic) {
  EXPECT_EQ(Solve(Rosenbrock(), {-1.2, 1.0}), Solve(Rosenbrock(), {-1.2, 1.0}));
}

TEST(LevenbergMarquardt, DescribesEachStatus) {
  EXPECT_EQ(Describe(Status::kConverged), "converged: every residual is within its tolerance");
  EXPECT_EQ(Describe(Status::kStalled), "stalled: no small step reduces the residuals");
  EXPECT_EQ(Describe(Status::kAtBound),
            "at a bound: the residuals fall only beyond the bounds of the unknowns");
  EXPECT_EQ(Describe(Status::kSingularJacobian),
            "singular: the residuals do not respond to some combination of the unknowns");
  EXPECT_EQ(Describe(Status::kMaxIterations), "out of iterations: the residuals were still falling");
  EXPECT_EQ(Describe(Status::kNotFinite),
            "not finite: the residuals cannot be evaluated at the start or beside a point of the search");
}

std::string ErrorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

std::string OptionError(const std::function<void(LevenbergMarquardtOptions&)>& change) {
  LevenbergMarquardtOptions options;
  change(options);
  return ErrorOf([&] { LevenbergMarquardt{options}; });
}

std::string ProblemError(const std::function<void(LeastSquaresProblem&, Vector&)>& change) {
  LeastSquaresProblem problem = Rosenbrock();
  Vector start = {0.0, 0.0};
  change(problem, start);
  return ErrorOf([&] { Solve(problem, start); });
}

TEST(LevenbergMarquardt, InvalidOptionsAreNamed) {
  using Options = LevenbergMarquardtOptions;
  const std::string prefix = "LevenbergMarquardtOptions.";
  EXPECT_EQ(OptionError([](Options&) {}), "no error");
  EXPECT_EQ(OptionError([](Options& o) { o.max_iterations = 0; }),
            prefix + "max_iterations is 0; allowed is 1 to 100000");
  EXPECT_EQ(OptionError([](Options& o) { o.residual_tolerance = -1.0; }),
            prefix + "residual_tolerance is -1; allowed is a finite number of at least 0");
  EXPECT_EQ(OptionError([](Options& o) { o.gradient_tolerance = 2.0; }),
            prefix + "gradient_tolerance is 2; allowed is 0 to 1");
  EXPECT_EQ(OptionError([](Options& o) { o.step_tolerance = std::nan(""); }),
            prefix + "step_tolerance is nan; allowed is a finite number of at least 0");
  EXPECT_EQ(OptionError([](Options& o) { o.initial_damping = 0.0; }),
            prefix + "initial_damping is 0; allowed is above 0, at most 1");
  EXPECT_EQ(OptionError([](Options& o) { o.rank_tolerance = -0.5; }),
            prefix + "rank_tolerance is -0.5; allowed is 0 to 1");
}

TEST(LevenbergMarquardt, InvalidProblemsAreNamed) {
  using P = LeastSquaresProblem;
  const std::string prefix = "LeastSquaresProblem.";
  EXPECT_EQ(ProblemError([](P& p, Vector&) { p.unknowns.clear(); }),
            prefix + "unknowns.size() is 0; allowed is at least 1");
  EXPECT_EQ(ProblemError([](P& p, Vector&) { p.residual_scales.pop_back(); }),
            prefix + "residual_scales.size() is 1; allowed is at least 2, the number of unknowns");
  EXPECT_EQ(ProblemError([](P& p, Vector&) { p.residual_scales[1] = 0.0; }),
            prefix + "residual_scales[1] is 0; allowed is a finite number above 0");
  EXPECT_EQ(ProblemError([](P& p, Vector&) { p.residuals = nullptr; }),
            prefix + "residuals is empty; allowed is a function");
  EXPECT_EQ(ProblemError([](P& p, Vector&) { p.residuals = [](const Vector&) { return Vector{1.0}; }; }),
            prefix + "residuals returned 1 values; allowed is 2, as many as residual_scales");
  EXPECT_EQ(ProblemError([](P& p, Vector&) { p.unknowns[1].upper = p.unknowns[1].lower = 0.0; }),
            prefix + "unknowns[1].upper is 0; allowed is above lower = 0");
  EXPECT_EQ(ProblemError([](P& p, Vector&) { p.unknowns[0].scale = -1.0; }),
            prefix + "unknowns[0].scale is -1; allowed is a finite number above 0");
  EXPECT_EQ(ProblemError([](P& p, Vector&) { p.unknowns[0].difference_step = 0.0; }),
            prefix + "unknowns[0].difference_step is 0; allowed is above 0, at most half of upper - lower");
  EXPECT_EQ(ProblemError([](P&, Vector& start) { start.push_back(0.0); }),
            "start.size() is 3; allowed is 2, the number of unknowns");
  EXPECT_EQ(ProblemError([](P& p, Vector& start) {
              p.unknowns[1].lower = -1.0;
              p.unknowns[1].upper = 1.0;
              start[1] = 1.5;
            }),
            "start[1] is 1.5; allowed is -1 to 1");
}

}  // namespace
}  // namespace dispersa::optimization_levenberg_marquardt_test
