// A real-coded genetic algorithm for constrained problems over a box.
//
// Tournament selection, simulated binary crossover, polynomial mutation, elitism, Deb's feasibility rules and
// a declared tie-breaker. The headers of the parts name the sources. Each pair of children draws from its own
// random stream, keyed by (seed, generation, pair), and individuals are evaluated independently. So the
// result has the same bits for any number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/optimization/bounded_problem.h"
#include "core/optimization/genetic_algorithm_options.h"

namespace dispersa {

/// One line of the log. The objective's values are absent while no individual is feasible.
struct GenerationRecord {
  int generation = 0;  ///< 0 is the initial, random one
  double feasible_fraction = 0.0;
  /// The violation of the best individual: 0 once one is feasible. +infinity if no evaluation was finite yet.
  double best_violation = 0.0;
  std::optional<double> best_objective;
  std::optional<double> mean_objective;  ///< over the feasible individuals
  std::optional<double> best_tie_breaker;

  bool operator==(const GenerationRecord&) const = default;
};

enum class GeneticAlgorithmEnd {
  kGenerations,  ///< ran all generations that were asked for
  kStalled,      ///< no progress over `stall_generations`
};

struct GeneticAlgorithmResult {
  std::vector<double> variables;  ///< shape (n), the best individual
  Evaluation evaluation;          ///< of `variables`
  std::uint64_t evaluations = 0;  ///< calls of the problem
  GeneticAlgorithmEnd end = GeneticAlgorithmEnd::kGenerations;
  std::vector<GenerationRecord> log;

  bool operator==(const GeneticAlgorithmResult&) const = default;
};

class GeneticAlgorithm {
 public:
  /// Throws std::invalid_argument that names the field which is out of range and what is allowed.
  explicit GeneticAlgorithm(const GeneticAlgorithmOptions& options);

  /// Called on the calling thread after each generation. It may throw to end the search.
  using Observer = std::function<void(const GenerationRecord&)>;

  /// The best point found. It is infeasible only if no feasible one was met. Throws std::invalid_argument for
  /// a problem without a box, and whatever `evaluate` throws.
  GeneticAlgorithmResult Minimize(const BoundedProblem& problem, const Observer& observer = nullptr) const;

 private:
  GeneticAlgorithmOptions options_;
};

}  // namespace dispersa
