// Constrained problems from the literature: the genetic algorithm finds their published optimum.
#include "core/optimization/genetic_algorithm.h"
#include "core/optimization/levenberg_marquardt.h"
#include "tests/test.h"

namespace dispersa::optimization_benchmarks_test {
namespace {

constexpr int kSeeds = 20;

double Squared(double x) { return x * x; }
double Cubed(double x) { return x * x * x; }

GeneticAlgorithmOptions Options(int seed) {
  GeneticAlgorithmOptions options;
  options.population = 200;
  options.generations = 1000;
  options.tournament_size = 4;
  options.variable_crossover_probability = 1.0;
  options.final_mutation_eta = 1e8;
  options.seed = static_cast<std::uint64_t>(seed);
  return options;
}

// G06 of J. J. Liang et al., "Problem definitions and evaluation criteria for the CEC 2006 special session on
// constrained real-parameter optimization": a crescent between two circles that fills 0.0066 % of the box.
// Published: f = -6961.81387558015 at (14.09500000000000064, 0.8429607892154795668), where both bind.
TEST(Benchmark, G06) {
  const BoundedProblem problem{
      {13.0, 0.0}, {100.0, 100.0}, [](const std::vector<double>& x) {
        const double g1 = 100.0 - Squared(x[0] - 5.0) - Squared(x[1] - 5.0);
        const double g2 = Squared(x[0] - 6.0) + Squared(x[1] - 5.0) - 82.81;
        return Evaluation{Cubed(x[0] - 10.0) + Cubed(x[1] - 20.0), {g1 / 100.0, g2 / 82.81}, 0.0};
      }};
  const double optimum = -6961.81387558015;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const GeneticAlgorithmResult result = GeneticAlgorithm(Options(seed)).Minimize(problem);
    EXPECT_EQ(result.log.back().best_violation, 0.0);
    // The last mutations are of 9e-7 and 1e-6, and the objective falls by 1100 per unit of x[1]: 1e-3 is
    // what one such step is worth. Nothing feasible is below the optimum, but for the rounding of its digits.
    EXPECT_NEAR(result.evaluation.objective, optimum, 1e-3) << "seed " << seed;
    EXPECT_GT(result.evaluation.objective, optimum - 1e-9) << "seed " << seed;
    EXPECT_NEAR(result.variables[0], 14.095, 1e-6);
    EXPECT_NEAR(result.variables[1], 0.8429607892154796, 1e-6);
  }
}

// The welded beam of K. M. Ragsdell and D. T. Phillips (ASME J. Eng. Ind. 98 (1976) 1021-1025) in the form of
// L. C. Cagnina, S. C. Esquivel and C. A. Coello Coello, "Solving engineering optimization problems with the
// simple constrained particle swarm optimizer", Informatica 32 (2008) 319-326: x = (h, l, t, b) in inches,
// cost to be least. Published there: 1.724852 at (0.205730, 3.470489, 9.036624, 0.205730). Other forms of the
// problem, with another polar moment or buckling load, have optima of 1.67 to 2.38.
Evaluation WeldedBeam(const std::vector<double>& x) {
  const double h = x[0];
  const double l = x[1];
  const double t = x[2];
  const double b = x[3];
  const double load_lb = 6000.0;
  const double length_in = 14.0;
  const double young_psi = 30e6;
  const double shear_psi = 12e6;

  const double cost = 1.10471 * h * h * l + 0.04811 * t * b * (14.0 + l);
  const double moment = load_lb * (length_in + 0.5 * l);
  const double arm = std::sqrt(0.25 * l * l + Squared(0.5 * (h + t)));
  const double polar = 2.0 * std::sqrt(2.0) * h * l * (l * l / 12.0 + Squared(0.5 * (h + t)));
  const double primary = load_lb / (std::sqrt(2.0) * h * l);
  const double secondary = moment * arm / polar;
  const double stress = std::sqrt(primary * primary + primary * secondary * l / arm + secondary * secondary);
  const double bending = 6.0 * load_lb * length_in / (b * t * t);
  const double deflection = 4.0 * load_lb * Cubed(length_in) / (young_psi * Cubed(t) * b);
  const double buckling = 4.013 * young_psi * t * Cubed(b) / (6.0 * length_in * length_in) *
                          (1.0 - t / (2.0 * length_in) * std::sqrt(young_psi / (4.0 * shear_psi)));
  return {cost,
          {stress / 13600.0 - 1.0, bending / 30000.0 - 1.0, h - b,
           (0.10471 * h * h + 0.04811 * t * b * (14.0 + l)) / 5.0 - 1.0, 0.125 / h - 1.0,
           deflection / 0.25 - 1.0, load_lb / buckling - 1.0},
          0.0};
}

TEST(Benchmark, WeldedBeam) {
  const BoundedProblem problem{{0.1, 0.1, 0.1, 0.1}, {2.0, 10.0, 10.0, 2.0}, WeldedBeam};
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const GeneticAlgorithmResult result = GeneticAlgorithm(Options(seed)).Minimize(problem);
    EXPECT_EQ(result.log.back().best_violation, 0.0);
    // Half a unit of the last published digit, and of those of the variables.
    EXPECT_NEAR(result.evaluation.objective, 1.724852, 5e-7) << "seed " << seed;
    const std::vector<double> published = {0.205730, 3.470489, 9.036624, 0.205730};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(result.variables[i], published[i], 1e-6) << "seed " << seed;
  }
}

// At the welded beam's optimum shear stress, bending stress, weld width and buckling load bind: four
// equations in four unknowns, which give the optimum to rounding, independently of the genetic algorithm.
TEST(Benchmark, WeldedBeamAgreesWithItsBindingConstraints) {
  LeastSquaresProblem binding{std::vector<Unknown>(4), std::vector<double>(4, 1.0), [](const auto& x) {
                                const std::vector<double> g = WeldedBeam(x).constraint_violations;
                                return std::vector<double>{g[0], g[1], g[2], g[6]};
                              }};
  LevenbergMarquardtOptions options;
  options.residual_tolerance = 1e-13;
  const LeastSquaresResult vertex = LevenbergMarquardt(options).Solve(binding, {0.2, 3.5, 9.0, 0.2});
  ASSERT_EQ(vertex.status, LeastSquaresStatus::kConverged);
  const double optimum = WeldedBeam(vertex.unknowns).objective;
  EXPECT_NEAR(optimum, 1.724852, 5e-7);  // half a unit of the published digits

  const BoundedProblem problem{{0.1, 0.1, 0.1, 0.1}, {2.0, 10.0, 10.0, 2.0}, WeldedBeam};
  const double found = GeneticAlgorithm(Options(1)).Minimize(problem).evaluation.objective;
  EXPECT_GE(found, optimum - 1e-12);  // 1e-13 of each constraint, times multipliers of order one
  EXPECT_LE(found, optimum + 1e-7);   // the last mutations are of 1e-8 of the ranges, slopes of order one
}

}  // namespace
}  // namespace dispersa::optimization_benchmarks_test
