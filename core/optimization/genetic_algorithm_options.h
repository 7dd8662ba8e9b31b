// Every setting of the genetic algorithm, with its range and where its value comes from.
#pragma once

#include <cstdint>
#include <optional>

namespace dispersa {

struct GeneticAlgorithmOptions {
  /// Individuals in a generation, 4 to 65,535. Deb (2000) takes ten per variable; take more if the feasible
  /// region is small.
  int population = 100;
  /// Generations after the initial one, 0 to 65,535.
  int generations = 200;
  /// Individuals drawn with replacement for each parent; the best of them is taken. 1 (no selection) to 1000.
  /// Deb (2000) has two.
  int tournament_size = 2;
  /// Best individuals that pass unchanged into the next generation, 1 to population - 1. With one the best
  /// never gets worse.
  int elites = 2;
  /// Probability that two parents are crossed, 0 to 1. Deb (2000) has 0.9.
  double crossover_probability = 0.9;
  /// Probability that a crossover places the children on the line through the parents (CrossOverOnLine)
  /// instead of crossing variable by variable, 0 to 1. Measured on the welded beam of the tests: the worst of
  /// 20 seeds ends 6e-7 from the optimum with one half, and 0.09 with none.
  double line_crossover_probability = 0.5;
  /// Probability that a variable takes part in a crossover variable by variable, 0 to 1. Deb and Agrawal
  /// (1995) take 0.5, which suits objectives that are a sum over the variables.
  double variable_crossover_probability = 0.5;
  /// Distribution index of the crossover, 0 to 1000: the larger, the closer children stay to their parents.
  /// Deb and Agrawal (1995) recommend 2 to 5 for a single objective.
  double crossover_eta = 2.0;
  /// Probability that a variable of a child is mutated, 0 to 1. Absent: 1/n, one variable per child on
  /// average, with which Deb (2000) starts.
  std::optional<double> mutation_probability;
  /// Distribution index of the mutation in the first generation, 0 to 1e9. A change is of the order of 1/eta
  /// of the variable's range (Deb and Goyal, 1996): 20 gives a few percent.
  double mutation_eta = 20.0;
  /// The same in generation `generations`, from mutation_eta to 1e9. In between it grows geometrically, so
  /// the search is first wide and then fine. (In Deb, 2000, it grows by one per generation.) Its reciprocal
  /// is about the relative accuracy that a full run can reach.
  double final_mutation_eta = 1e6;
  /// Feasible objectives within this much of the lowest one ever found are equal, and the tie-breaker
  /// decides. Not negative, in the unit of the objective.
  double objective_tolerance = 0.0;
  /// A tie-breaker that falls by no more than this is no progress for `stall_generations`. Not negative, in
  /// the unit of the tie-breaker.
  double tie_breaker_tolerance = 0.0;
  /// Stop after this many generations without progress, 0 (never) to 65,535. Progress is one of these: the
  /// least violation has fallen (while nothing is feasible), the objective has fallen by more than
  /// `objective_tolerance`, the tie-breaker by more than `tie_breaker_tolerance`.
  int stall_generations = 0;
  /// Seed of all draws.
  std::uint64_t seed = 1;
  /// Threads that evaluate individuals, 1 to 1024. The result does not depend on it.
  int threads = 1;
};

/// Throws std::invalid_argument that names the first field out of its range, its value and what is allowed.
void Validate(const GeneticAlgorithmOptions& options);

}  // namespace dispersa
