#include "core/optimization/genetic_algorithm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

#include "core/math/functions.h"
#include "core/optimization/feasibility_rules.h"
#include "core/optimization/parallel_for.h"
#include "core/optimization/variation.h"
#include "core/random/draws.h"

namespace dispersa {

namespace {

struct Individual {
  std::vector<double> variables;
  Evaluation evaluation;
  Merit merit;
};
using Population = std::vector<Individual>;

void Validate(const BoundedProblem& problem) {
  if (problem.lower.empty())
    throw std::invalid_argument("BoundedProblem.lower is empty; allowed is at least 1 variable");
  if (problem.upper.size() != problem.lower.size()) {
    throw std::invalid_argument(
        fmt::format("BoundedProblem.upper has {} values; allowed is {}, as many as lower",
                    problem.upper.size(), problem.lower.size()));
  }
  for (std::size_t i = 0; i < problem.lower.size(); ++i) {
    const double lower = problem.lower[i];
    const double upper = problem.upper[i];
    if (!std::isfinite(lower)) {
      throw std::invalid_argument(
          fmt::format("BoundedProblem.lower[{}] is {}; allowed is a finite number", i, lower));
    }
    if (!std::isfinite(upper) || upper < lower) {
      throw std::invalid_argument(
          fmt::format("BoundedProblem.upper[{}] is {}; allowed is a finite number of at least lower[{}] = {}",
                      i, upper, i, lower));
    }
  }
  for (std::size_t p = 0; p < problem.known_points.size(); ++p) {
    const std::vector<double>& point = problem.known_points[p];
    bool inside = point.size() == problem.lower.size();
    for (std::size_t i = 0; inside && i < point.size(); ++i)
      inside = point[i] >= problem.lower[i] && point[i] <= problem.upper[i];
    if (!inside) {
      throw std::invalid_argument(
          fmt::format("BoundedProblem.known_points[{}] is outside; allowed is a point of {} variables within "
                      "lower and upper",
                      p, problem.lower.size()));
    }
  }
  if (!problem.evaluate)
    throw std::invalid_argument("BoundedProblem.evaluate is empty; allowed is a function");
  if (problem.together < 1)
    throw std::invalid_argument("BoundedProblem.together is 0; allowed is at least 1");
}

// A stream's index is below 2^32: the options' ranges give the generation and the item 16 bits each.
std::uint64_t StreamIndex(int generation, std::size_t item) {
  return (static_cast<std::uint64_t>(generation) << 16) | static_cast<std::uint64_t>(item);
}

std::size_t RandomIndex(std::size_t count, Stream* stream) {
  return std::min(count - 1, static_cast<std::size_t>(stream->Uniform() * static_cast<double>(count)));
}

GenerationRecord RecordOf(int generation, const Population& sorted) {
  const Individual& best = sorted.front();
  GenerationRecord record;
  record.generation = generation;
  record.best_violation = best.merit.violation;
  int feasible = 0;
  double sum = 0.0;
  for (const Individual& individual : sorted) {
    if (!individual.merit.IsFeasible()) continue;
    ++feasible;
    sum += individual.merit.objective;
  }
  if (feasible == 0) return record;
  record.feasible_fraction = feasible / static_cast<double>(sorted.size());
  record.best_objective = best.merit.objective;
  record.mean_objective = sum / feasible;
  record.best_tie_breaker = best.merit.tie_breaker;
  return record;
}

// Counts generations without progress, as the options define it.
class StallCounter {
 public:
  explicit StallCounter(const GeneticAlgorithmOptions& options) : options_(options) {}

  /// Whether the run has stalled, after a generation with this best individual and this lowest objective.
  bool HasStalled(const Merit& best, double lowest_objective) {
    const bool progress =
        best.violation < violation_ || lowest_objective < lowest_objective_ - options_.objective_tolerance ||
        (best.IsFeasible() && best.tie_breaker < tie_breaker_ - options_.tie_breaker_tolerance);
    idle_generations_ = progress ? 0 : idle_generations_ + 1;
    if (progress) {
      violation_ = best.violation;
      lowest_objective_ = lowest_objective;
      if (best.IsFeasible()) tie_breaker_ = best.tie_breaker;
    }
    return options_.stall_generations > 0 && idle_generations_ >= options_.stall_generations;
  }

 private:
  const GeneticAlgorithmOptions& options_;
  double violation_ = std::numeric_limits<double>::infinity();
  double lowest_objective_ = std::numeric_limits<double>::infinity();
  double tie_breaker_ = std::numeric_limits<double>::infinity();
  int idle_generations_ = 0;
};

// One run: the options and the problem with everything that they decide.
class Run {
 public:
  Run(const GeneticAlgorithmOptions& options, const BoundedProblem& problem)
      : options_(options),
        problem_(problem),
        size_(static_cast<std::size_t>(options.population)),
        mutation_probability_(
            options.mutation_probability.value_or(1.0 / static_cast<double>(problem.lower.size()))) {}

  GeneticAlgorithmResult Execute(const GeneticAlgorithm::Observer& observer) {
    GeneticAlgorithmResult result;
    StallCounter stall(options_);
    Population population = RandomPopulation();
    Evaluate(population);
    for (int generation = 0;; ++generation) {
      Sort(&population);
      result.log.push_back(RecordOf(generation, population));
      if (observer) observer(result.log.back());
      if (stall.HasStalled(population.front().merit, lowest_objective_)) {
        result.end = GeneticAlgorithmEnd::kStalled;
        break;
      }
      if (generation == options_.generations) break;
      population = NextGeneration(generation + 1, population);
    }
    result.variables = std::move(population.front().variables);
    result.evaluation = std::move(population.front().evaluation);
    result.evaluations = evaluations_;
    return result;
  }

 private:
  std::size_t VariableCount() const { return problem_.lower.size(); }

  Population RandomPopulation() const {
    Population population(size_);
    const std::size_t known = std::min(size_, problem_.known_points.size());
    for (std::size_t i = 0; i < known; ++i) population[i].variables = problem_.known_points[i];
    for (std::size_t i = known; i < size_; ++i) {
      Stream stream(options_.seed, StreamIndex(0, i), "genetic_algorithm.initial");
      for (std::size_t k = 0; k < VariableCount(); ++k) {
        const double lower = problem_.lower[k];
        const double upper = problem_.upper[k];
        population[i].variables.push_back(Clamp(lower + stream.Uniform() * (upper - lower), lower, upper));
      }
    }
    return population;
  }

  void Evaluate(std::span<Individual> individuals) {
    const std::size_t threads = static_cast<std::size_t>(options_.threads);
    if (problem_.evaluate_together) {
      const std::size_t together = problem_.together;
      ParallelFor((individuals.size() + together - 1) / together, threads, [&](std::size_t i) {
        EvaluateTogether(
            individuals.subspan(i * together, std::min(together, individuals.size() - i * together)));
      });
    } else {
      ParallelFor(individuals.size(), threads, [&](std::size_t i) {
        individuals[i].evaluation = problem_.evaluate(individuals[i].variables);
      });
    }
    for (Individual& individual : individuals) individual.merit = MeritOf(individual.evaluation);
    evaluations_ += individuals.size();
  }

  void EvaluateTogether(std::span<Individual> individuals) const {
    std::vector<std::vector<double>> points;
    for (const Individual& individual : individuals) points.push_back(individual.variables);
    std::vector<Evaluation> evaluations = problem_.evaluate_together(points);
    if (evaluations.size() != points.size()) {
      throw std::invalid_argument(
          fmt::format("BoundedProblem.evaluate_together returned {} values; allowed is {}",
                      evaluations.size(), points.size()));
    }
    for (std::size_t i = 0; i < points.size(); ++i) individuals[i].evaluation = std::move(evaluations[i]);
  }

  // Best first. Objectives are equal within the tolerance of the lowest objective of the whole run, even if
  // its individual is gone.
  void Sort(Population* population) {
    for (const Individual& individual : *population) {
      if (individual.merit.IsFeasible())
        lowest_objective_ = std::min(lowest_objective_, individual.merit.objective);
    }
    const double tie_threshold = lowest_objective_ + options_.objective_tolerance;
    std::stable_sort(population->begin(), population->end(), [&](const Individual& a, const Individual& b) {
      return IsBetter(a.merit, b.merit, tie_threshold);
    });
  }

  Population NextGeneration(int generation, const Population& sorted) {
    const std::size_t elites = static_cast<std::size_t>(options_.elites);
    const double mutation_eta = MutationEta(generation);
    Population next(sorted.begin(), sorted.begin() + options_.elites);
    for (std::size_t pair = 0; next.size() < size_; ++pair) {
      Stream stream(options_.seed, StreamIndex(generation, pair), "genetic_algorithm.offspring");
      std::vector<double> a = sorted[SelectedIndex(&stream)].variables;
      std::vector<double> b = sorted[SelectedIndex(&stream)].variables;
      CrossOverAll(&a, &b, &stream);
      for (std::vector<double>* child : {&a, &b}) {
        MutateAll(child, mutation_eta, &stream);
        if (next.size() < size_)
          next.push_back({.variables = std::move(*child), .evaluation = {}, .merit = {}});
      }
    }
    Evaluate(std::span(next).subspan(elites));
    return next;
  }

  // The winner of a tournament; in a sorted population that is the lowest index.
  std::size_t SelectedIndex(Stream* stream) const {
    std::size_t winner = RandomIndex(size_, stream);
    for (int i = 1; i < options_.tournament_size; ++i) winner = std::min(winner, RandomIndex(size_, stream));
    return winner;
  }

  void CrossOverAll(std::vector<double>* a, std::vector<double>* b, Stream* stream) const {
    if (stream->Uniform() >= options_.crossover_probability) return;
    if (stream->Uniform() < options_.line_crossover_probability) {
      CrossOverOnLine(a, b, problem_.lower, problem_.upper, options_.crossover_eta, stream);
      return;
    }
    for (std::size_t k = 0; k < VariableCount(); ++k) {
      if (stream->Uniform() >= options_.variable_crossover_probability) continue;
      CrossOver(&(*a)[k], &(*b)[k], problem_.lower[k], problem_.upper[k], options_.crossover_eta, stream);
    }
  }

  // Geometric between the first and the last generation, in the index + 1 since an index may be 0.
  double MutationEta(int generation) const {
    const double first = options_.mutation_eta + 1.0;
    const double last = options_.final_mutation_eta + 1.0;
    return first * Pow(last / first, generation / static_cast<double>(options_.generations)) - 1.0;
  }

  void MutateAll(std::vector<double>* x, double eta, Stream* stream) const {
    for (std::size_t k = 0; k < VariableCount(); ++k) {
      if (stream->Uniform() >= mutation_probability_) continue;
      (*x)[k] = Mutated((*x)[k], problem_.lower[k], problem_.upper[k], eta, stream);
    }
  }

  const GeneticAlgorithmOptions& options_;
  const BoundedProblem& problem_;
  std::size_t size_;
  double mutation_probability_;
  double lowest_objective_ = std::numeric_limits<double>::infinity();
  std::uint64_t evaluations_ = 0;
};

}  // namespace

GeneticAlgorithm::GeneticAlgorithm(const GeneticAlgorithmOptions& options) : options_(options) {
  dispersa::Validate(options_);
}

GeneticAlgorithmResult GeneticAlgorithm::Minimize(const BoundedProblem& problem,
                                                  const Observer& observer) const {
  Validate(problem);
  return Run(options_, problem).Execute(observer);
}

}  // namespace dispersa
