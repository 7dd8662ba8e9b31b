// Each option, and each part of a problem, that is out of range is named, with its value and what is allowed.
#include "core/optimization/genetic_algorithm.h"
#include "tests/test.h"

namespace dispersa::optimization_genetic_algorithm_options_test {
namespace {

std::string ErrorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

std::string OptionError(const std::function<void(GeneticAlgorithmOptions&)>& change) {
  GeneticAlgorithmOptions options;
  change(options);
  return ErrorOf([&] { GeneticAlgorithm{options}; });
}

std::string ProblemError(const std::function<void(BoundedProblem&)>& change) {
  BoundedProblem problem{{0.0, 0.0}, {1.0, 1.0}, [](const auto&) { return Evaluation{}; }};
  change(problem);
  GeneticAlgorithmOptions options;
  options.generations = 1;
  return ErrorOf([&] { GeneticAlgorithm(options).Minimize(problem); });
}

using Options = GeneticAlgorithmOptions;
const double kNan = std::nan("");

TEST(GeneticAlgorithmOptions, DefaultsAreValid) {
  EXPECT_EQ(OptionError([](Options&) {}), "no error");
}

TEST(GeneticAlgorithmOptions, EachFieldIsNamed) {
  const std::string prefix = "GeneticAlgorithmOptions.";
  EXPECT_EQ(OptionError([](Options& o) { o.population = 3; }),
            prefix + "population is 3; allowed is 4 to 65535");
  EXPECT_EQ(OptionError([](Options& o) { o.generations = -1; }),
            prefix + "generations is -1; allowed is 0 to 65535");
  EXPECT_EQ(OptionError([](Options& o) { o.tournament_size = 0; }),
            prefix + "tournament_size is 0; allowed is 1 to 1000");
  EXPECT_EQ(OptionError([](Options& o) { o.elites = 0; }), prefix + "elites is 0; allowed is 1 to 99");
  EXPECT_EQ(OptionError([](Options& o) { o.elites = o.population = 50; }),
            prefix + "elites is 50; allowed is 1 to 49");
  EXPECT_EQ(OptionError([](Options& o) { o.crossover_probability = 1.5; }),
            prefix + "crossover_probability is 1.5; allowed is 0 to 1");
  EXPECT_EQ(OptionError([](Options& o) { o.line_crossover_probability = -0.5; }),
            prefix + "line_crossover_probability is -0.5; allowed is 0 to 1");
  EXPECT_EQ(OptionError([](Options& o) { o.variable_crossover_probability = kNan; }),
            prefix + "variable_crossover_probability is nan; allowed is 0 to 1");
  EXPECT_EQ(OptionError([](Options& o) { o.crossover_eta = -1.0; }),
            prefix + "crossover_eta is -1; allowed is 0 to 1000");
  EXPECT_EQ(OptionError([](Options& o) { o.mutation_probability = 2.0; }),
            prefix + "mutation_probability is 2; allowed is 0 to 1");
  EXPECT_EQ(OptionError([](Options& o) { o.mutation_eta = 1e10; }),
            prefix + "mutation_eta is 10000000000; allowed is 0 to 1000000000");
  EXPECT_EQ(OptionError([](Options& o) { o.final_mutation_eta = 19.0; }),
            prefix + "final_mutation_eta is 19; allowed is 20 to 1000000000");
  EXPECT_EQ(OptionError([](Options& o) { o.objective_tolerance = -1e-3; }),
            prefix + "objective_tolerance is -0.001; allowed is a finite number of at least 0");
  EXPECT_EQ(OptionError([](Options& o) { o.tie_breaker_tolerance = INFINITY; }),
            prefix + "tie_breaker_tolerance is inf; allowed is a finite number of at least 0");
  EXPECT_EQ(OptionError([](Options& o) { o.stall_generations = -2; }),
            prefix + "stall_generations is -2; allowed is 0 to 65535");
  EXPECT_EQ(OptionError([](Options& o) { o.threads = 0; }), prefix + "threads is 0; allowed is 1 to 1024");
}

TEST(BoundedProblem, EachPartIsNamed) {
  const std::string prefix = "BoundedProblem.";
  EXPECT_EQ(ProblemError([](BoundedProblem&) {}), "no error");
  EXPECT_EQ(ProblemError([](BoundedProblem& p) { p.lower.clear(); }),
            prefix + "lower is empty; allowed is at least 1 variable");
  EXPECT_EQ(ProblemError([](BoundedProblem& p) { p.upper.push_back(1.0); }),
            prefix + "upper has 3 values; allowed is 2, as many as lower");
  EXPECT_EQ(ProblemError([](BoundedProblem& p) { p.lower[1] = -INFINITY; }),
            prefix + "lower[1] is -inf; allowed is a finite number");
  EXPECT_EQ(ProblemError([](BoundedProblem& p) { p.upper[0] = -0.5; }),
            prefix + "upper[0] is -0.5; allowed is a finite number of at least lower[0] = 0");
  EXPECT_EQ(ProblemError([](BoundedProblem& p) { p.together = 0; }),
            prefix + "together is 0; allowed is at least 1");
  EXPECT_EQ(ProblemError([](BoundedProblem& p) { p.evaluate = nullptr; }),
            prefix + "evaluate is empty; allowed is a function");
}

}  // namespace
}  // namespace dispersa::optimization_genetic_algorithm_options_test
