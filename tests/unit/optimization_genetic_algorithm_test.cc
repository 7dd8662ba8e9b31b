// The genetic algorithm as a whole: known optima, reproducibility, threads, tie-breaker, ends and failures.
#include "core/optimization/genetic_algorithm.h"
#include "tests/test.h"

namespace dispersa::optimization_genetic_algorithm_test {
namespace {

double Squared(double x) { return x * x; }

double Sphere(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double value : x) sum += value * value;
  return sum;
}

BoundedProblem SphereProblem() {
  return {std::vector<double>(10, -5.12), std::vector<double>(10, 5.0), [](const auto& x) {
            return Evaluation{Sphere(x), {}, 0.0};
          }};
}

// H. H. Rosenbrock, Computer Journal 3 (1960) 175-184: minimum 0 at (1, 1), in a bent valley.
BoundedProblem RosenbrockProblem() {
  return {{-5.0, -5.0}, {5.0, 5.0}, [](const auto& x) {
            return Evaluation{100.0 * Squared(x[1] - x[0] * x[0]) + Squared(1.0 - x[0]), {}, 0.0};
          }};
}

GeneticAlgorithmOptions ShortRun() {
  GeneticAlgorithmOptions options;
  options.population = 60;
  options.generations = 40;
  return options;
}

// The mutation ends at steps of about range / final_mutation_eta = 1e-5, so each variable should come at
// least that close: objectives of 10 * (1e-5)² = 1e-9 and, along Rosenbrock's valley, of the same order.
TEST(GeneticAlgorithm, FindsTheMinimumOfSphereAndRosenbrock) {
  for (const BoundedProblem& problem : {SphereProblem(), RosenbrockProblem()}) {
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
      GeneticAlgorithmOptions options;
      options.seed = seed;
      const GeneticAlgorithmResult result = GeneticAlgorithm(options).Minimize(problem);
      EXPECT_LT(result.evaluation.objective, 1e-9) << "seed " << seed;
      EXPECT_EQ(result.evaluation, problem.evaluate(result.variables));
    }
  }
}

TEST(GeneticAlgorithm, SameSeedGivesTheSameLogAndAnotherSeedAnother) {
  GeneticAlgorithmOptions options = ShortRun();
  const GeneticAlgorithmResult first = GeneticAlgorithm(options).Minimize(RosenbrockProblem());
  EXPECT_EQ(first, GeneticAlgorithm(options).Minimize(RosenbrockProblem()));
  options.seed = 2;
  EXPECT_NE(first.log, GeneticAlgorithm(options).Minimize(RosenbrockProblem()).log);
}

TEST(GeneticAlgorithm, ResultDoesNotDependOnTheNumberOfThreads) {
  BoundedProblem problem = RosenbrockProblem();
  // Uneven work, so that the threads finish in another order than they start.
  problem.evaluate = [evaluate = problem.evaluate](const std::vector<double>& x) {
    for (double i = 0.0; i < 40.0 * Squared(x[0]); i += 1.0) std::this_thread::yield();
    return evaluate(x);
  };
  GeneticAlgorithmOptions options = ShortRun();
  const GeneticAlgorithmResult serial = GeneticAlgorithm(options).Minimize(problem);
  for (const int threads : {2, 3, 64}) {
    options.threads = threads;
    EXPECT_EQ(serial, GeneticAlgorithm(options).Minimize(problem)) << threads << " threads";
  }
}

TEST(GeneticAlgorithm, ResultDoesNotDependOnHowManyAreEvaluatedTogether) {
  BoundedProblem problem = RosenbrockProblem();
  GeneticAlgorithmOptions options = ShortRun();
  const GeneticAlgorithmResult alone = GeneticAlgorithm(options).Minimize(problem);
  std::atomic<std::size_t> largest = 0;
  problem.evaluate_together = [&](std::span<const std::vector<double>> points) {
    if (points.size() > largest) largest = points.size();
    std::vector<Evaluation> evaluations;
    for (const std::vector<double>& x : points) evaluations.push_back(problem.evaluate(x));
    return evaluations;
  };
  for (const std::size_t together : {1, 7, 1000}) {
    problem.together = together;
    options.threads = 2;
    largest = 0;
    EXPECT_EQ(alone, GeneticAlgorithm(options).Minimize(problem)) << together << " together";
    EXPECT_EQ(largest, std::min<std::size_t>(together, 60));
  }
}

TEST(GeneticAlgorithm, EvaluatesOnSeveralThreads) {
  // Two evaluations wait for each other: with one thread at work this would not end.
  std::atomic<int> waiting = 0;
  BoundedProblem problem{{0.0}, {1.0}, [&](const auto& x) {
                           ++waiting;
                           while (waiting < 2) std::this_thread::yield();
                           return Evaluation{x[0], {}, 0.0};
                         }};
  GeneticAlgorithmOptions options;
  options.threads = 2;
  options.generations = 0;
  EXPECT_EQ(GeneticAlgorithm(options).Minimize(problem).evaluations, 100u);
}

TEST(GeneticAlgorithm, CountsItsEvaluationsAndLogsEachGeneration) {
  std::atomic<std::uint64_t> calls = 0;
  BoundedProblem problem = SphereProblem();
  problem.evaluate = [&](const std::vector<double>& x) {
    ++calls;
    return Evaluation{Sphere(x), {x[0] > 0.0 ? x[0] : 0.0}, 0.5};
  };
  GeneticAlgorithmOptions options = ShortRun();
  options.elites = 3;
  std::vector<GenerationRecord> observed;
  const auto result =
      GeneticAlgorithm(options).Minimize(problem, [&](const auto& r) { observed.push_back(r); });
  EXPECT_EQ(result.evaluations, 60u + 40u * 57u);
  EXPECT_EQ(result.evaluations, calls);
  EXPECT_EQ(result.end, GeneticAlgorithmEnd::kGenerations);
  EXPECT_EQ(result.log, observed);
  ASSERT_EQ(result.log.size(), 41u);
  for (int i = 0; i <= 40; ++i) {
    const GenerationRecord& record = result.log[i];
    EXPECT_EQ(record.generation, i);
    EXPECT_EQ(record.best_violation, 0.0);
    EXPECT_GT(record.feasible_fraction, 0.0);
    EXPECT_LE(record.feasible_fraction, 1.0);
    EXPECT_GE(record.mean_objective, record.best_objective);
    EXPECT_EQ(record.best_tie_breaker, 0.5);
    if (i > 0) {
      EXPECT_LE(record.best_objective, result.log[i - 1].best_objective);
    }
  }
  EXPECT_EQ(result.log.back().best_objective, result.evaluation.objective);
  // Half of the box is feasible: 30 of 60, give or take four standard deviations of sqrt(60) / 2.
  EXPECT_NEAR(result.log.front().feasible_fraction, 0.5, 4.0 * 0.5 / std::sqrt(60.0));
}

// The objective leaves x[1] free, and x[0] within sqrt(tolerance); the tie-breaker wants both as large as
// possible. Without it x[1] is any number.
TEST(GeneticAlgorithm, TieBreakerDecidesAmongEqualObjectives) {
  BoundedProblem problem{{-1.0, -1.0}, {1.0, 1.0}, [](const auto& x) {
                           return Evaluation{Squared(x[0]), {}, -x[0] - x[1]};
                         }};
  GeneticAlgorithmOptions options;
  options.objective_tolerance = 0.04;
  const GeneticAlgorithmResult result = GeneticAlgorithm(options).Minimize(problem);
  // The last mutations are of 2e-6; a hundred times that is far below what no tie-breaker would give.
  EXPECT_NEAR(result.variables[0], 0.2, 2e-4);
  EXPECT_NEAR(result.variables[1], 1.0, 2e-4);
  // However many generations pick equals, the objective stays within one tolerance of the lowest ever seen.
  EXPECT_LE(result.evaluation.objective, 0.04 + 1e-9);
}

TEST(GeneticAlgorithm, StopsWhenItStalls) {
  BoundedProblem flat{{0.0}, {1.0}, [](const auto&) { return Evaluation{1.0, {}, 2.0}; }};
  GeneticAlgorithmOptions options = ShortRun();
  options.stall_generations = 7;
  const GeneticAlgorithmResult result = GeneticAlgorithm(options).Minimize(flat);
  EXPECT_EQ(result.end, GeneticAlgorithmEnd::kStalled);
  EXPECT_EQ(result.log.size(), 8u);  // generation 0 is progress, then seven without
}

TEST(GeneticAlgorithm, ProgressWithinTheTolerancesIsAStall) {
  GeneticAlgorithmOptions options = ShortRun();
  options.stall_generations = 10;
  EXPECT_EQ(GeneticAlgorithm(options).Minimize(SphereProblem()).end, GeneticAlgorithmEnd::kGenerations);
  options.objective_tolerance = 1e3;  // above every objective in the box
  EXPECT_EQ(GeneticAlgorithm(options).Minimize(SphereProblem()).log.size(), 11u);

  BoundedProblem ties{{0.0}, {1.0}, [](const auto& x) { return Evaluation{0.0, {}, x[0]}; }};
  EXPECT_GT(GeneticAlgorithm(options).Minimize(ties).log.size(), 11u);
  options.tie_breaker_tolerance = 1.0;
  EXPECT_EQ(GeneticAlgorithm(options).Minimize(ties).log.size(), 11u);
}

// Nothing is feasible here: a violation that falls is all the progress that there is.
TEST(GeneticAlgorithm, AViolationThatFallsIsProgress) {
  BoundedProblem problem{std::vector<double>(10, -5.0), std::vector<double>(10, 4.0), [](const auto& x) {
                           return Evaluation{0.0, {1.0 + Sphere(x)}, 0.0};
                         }};
  GeneticAlgorithmOptions options = ShortRun();
  options.stall_generations = 5;
  const GeneticAlgorithmResult result = GeneticAlgorithm(options).Minimize(problem);
  EXPECT_EQ(result.end, GeneticAlgorithmEnd::kGenerations);
  EXPECT_LT(result.log.back().best_violation, 0.5 * result.log.front().best_violation);
  // One that cannot fall stalls.
  problem.evaluate = [](const auto&) { return Evaluation{0.0, {1.0}, 0.0}; };
  EXPECT_EQ(GeneticAlgorithm(options).Minimize(problem).log.size(), 6u);
}

// Every individual has a value of its own in all its variables, so a variable that was not crossed is one of
// these values.
TEST(GeneticAlgorithm, CrossesAVariableWithItsProbability) {
  constexpr int kPopulation = 60, kVariables = 400;
  BoundedProblem problem{std::vector<double>(kVariables, 0.0), std::vector<double>(kVariables, 1.0), {}};
  std::vector<double> values;
  for (int i = 0; i < kPopulation; ++i) {
    values.push_back((i + 0.5) / kPopulation);
    problem.known_points.emplace_back(kVariables, values.back());
  }
  int children = 0, crossed = 0;
  problem.evaluate = [&](const std::vector<double>& x) {
    int changed = 0;
    for (const double value : x) changed += std::find(values.begin(), values.end(), value) == values.end();
    children += changed > 0;  // two different parents, of which the children were made variable by variable
    crossed += changed;
    return Evaluation{x[0], {}, 0.0};
  };
  GeneticAlgorithmOptions options;
  options.population = kPopulation;
  options.generations = 1;
  options.crossover_probability = 1.0;
  options.line_crossover_probability = 0.0;
  options.mutation_probability = 0.0;
  for (const double probability : {0.2, 0.7}) {
    options.variable_crossover_probability = probability;
    children = crossed = 0;
    GeneticAlgorithm(options).Minimize(problem);
    ASSERT_GT(children, 40);
    // Two children share their draws: five standard deviations of a fraction of half as many are below 0.027.
    EXPECT_NEAR(crossed / (double{kVariables} * children), probability, 0.027);
  }
}

TEST(GeneticAlgorithm, WithoutAFeasiblePointReturnsTheLeastViolation) {
  BoundedProblem problem{{0.0}, {1.0}, [](const auto& x) { return Evaluation{-x[0], {1.0 + x[0]}, 0.0}; }};
  const GeneticAlgorithmResult result = GeneticAlgorithm(ShortRun()).Minimize(problem);
  EXPECT_LT(result.variables[0], 1e-4);  // the last mutations are of 1e-6
  EXPECT_EQ(result.log.back().feasible_fraction, 0.0);
  EXPECT_EQ(result.log.back().best_violation, 1.0 + result.variables[0]);
  EXPECT_EQ(result.log.back().best_objective, std::nullopt);
  EXPECT_EQ(result.log.back().mean_objective, std::nullopt);
  EXPECT_EQ(result.log.back().best_tie_breaker, std::nullopt);
}

TEST(GeneticAlgorithm, KeepsOutOfRegionsThatCannotBeEvaluated) {
  BoundedProblem problem{{-1.0}, {1.0}, [](const auto& x) {
                           return Evaluation{x[0] < 0.25 ? std::nan("") : x[0], {}, 0.0};
                         }};
  const GeneticAlgorithmResult result = GeneticAlgorithm(ShortRun()).Minimize(problem);
  EXPECT_NEAR(result.variables[0], 0.25, 2e-4);  // the last mutations are of 2e-6
  EXPECT_GE(result.variables[0], 0.25);
}

TEST(GeneticAlgorithm, LeavesFixedVariablesAlone) {
  BoundedProblem problem{{0.7, -1.0}, {0.7, 1.0}, [](const auto& x) {
                           return Evaluation{Squared(x[0]) + Squared(x[1]), {}, 0.0};
                         }};
  EXPECT_EQ(GeneticAlgorithm(ShortRun()).Minimize(problem).variables[0], 0.7);
}

TEST(GeneticAlgorithm, PassesOnTheFirstExceptionForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3}) {
    std::atomic<int> calls = 0;
    BoundedProblem problem{{0.0}, {1.0}, [&](const auto&) -> Evaluation {
                             ++calls;
                             throw std::runtime_error("no table for this point");
                           }};
    GeneticAlgorithmOptions options = ShortRun();
    options.threads = threads;
    EXPECT_THAT([&] { GeneticAlgorithm(options).Minimize(problem); },
                testing::ThrowsMessage<std::runtime_error>("no table for this point"));
    EXPECT_EQ(calls, 60);
  }
}

}  // namespace
}  // namespace dispersa::optimization_genetic_algorithm_test
