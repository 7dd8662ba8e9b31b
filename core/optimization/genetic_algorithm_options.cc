#include "core/optimization/genetic_algorithm_options.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>
#include <string_view>

namespace dispersa {

namespace {

template <typename T>
void RequireRange(std::string_view field, T value, T low, T high) {
  if (value >= low && value <= high) return;  // false for NaN
  throw std::invalid_argument(
      fmt::format("GeneticAlgorithmOptions.{} is {}; allowed is {} to {}", field, value, low, high));
}

void RequireNotNegative(std::string_view field, double value) {
  if (value >= 0.0 && value <= std::numeric_limits<double>::max()) return;
  throw std::invalid_argument(fmt::format(
      "GeneticAlgorithmOptions.{} is {}; allowed is a finite number of at least 0", field, value));
}

}  // namespace

void Validate(const GeneticAlgorithmOptions& options) {
  RequireRange("population", options.population, 4, 65'535);
  RequireRange("generations", options.generations, 0, 65'535);
  RequireRange("tournament_size", options.tournament_size, 1, 1000);
  RequireRange("elites", options.elites, 1, options.population - 1);
  RequireRange("crossover_probability", options.crossover_probability, 0.0, 1.0);
  RequireRange("line_crossover_probability", options.line_crossover_probability, 0.0, 1.0);
  RequireRange("variable_crossover_probability", options.variable_crossover_probability, 0.0, 1.0);
  RequireRange("crossover_eta", options.crossover_eta, 0.0, 1000.0);
  if (options.mutation_probability) {
    RequireRange("mutation_probability", *options.mutation_probability, 0.0, 1.0);
  }
  RequireRange("mutation_eta", options.mutation_eta, 0.0, 1e9);
  RequireRange("final_mutation_eta", options.final_mutation_eta, options.mutation_eta, 1e9);
  RequireNotNegative("objective_tolerance", options.objective_tolerance);
  RequireNotNegative("tie_breaker_tolerance", options.tie_breaker_tolerance);
  RequireRange("stall_generations", options.stall_generations, 0, 65'535);
  RequireRange("threads", options.threads, 1, 1024);
}

}  // namespace dispersa
