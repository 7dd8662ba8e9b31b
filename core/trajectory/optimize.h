// Finds the flight program that reaches a target orbit: a genetic algorithm on objective (8) of the paper,
// then a refinement in the unknowns in which the trajectory problem is well posed.
#pragma once

#include <string>
#include <vector>

#include "core/optimization/genetic_algorithm.h"
#include "core/optimization/levenberg_marquardt.h"
#include "core/trajectory/ascent.h"
#include "core/trajectory/program_variables.h"
#include "core/trajectory/reference.h"

namespace dispersa {

/// Errors of an orbit against the target with its reserve: reached less desired.
struct OrbitErrors {
  double altitude_m = 0.0;
  double velocity_m_s = 0.0;
  double flight_path_angle_rad = 0.0;
  double inclination_rad = 0.0;  ///< 0 where the target does not name it, as
  double argument_of_perigee_rad = 0.0;
};
OrbitErrors ErrorsOf(const TrajectoryProblem& problem, const Orbit& orbit);
/// Whether no error is larger than its tolerance.
bool IsWithin(const OrbitErrors& errors, const OrbitErrors& tolerance);

/// Every setting of the search but the problem's own (bounds, weights, limits, population, generations,
/// seed), which comes from the user's file.
struct TrajectoryOptions {
  /// Of the autopilot that will fly the reference: burnout is detected on its ticks. Positive.
  double tick_s = 0.01;
  /// Threads that fly individuals, 1 to 1024. The result does not depend on it.
  int threads = 1;
  /// Of the search. On the shipped vehicle within 0.02 km, 0.04 m/s and 0.0004 deg of the converged
  /// injection: less than `tie_tolerance` tells apart.
  AscentSteps search_steps = {0.5, 2.0, 20.0};
  /// Of the refinement and the reference. Halving them moves the shipped reference's injection by less than
  /// 0.1 m, 0.1 mm/s and 1e-7 deg.
  AscentSteps steps = {0.02, 0.1, 5.0};
  /// Objectives (8) that differ from the best by at most this count as equal; the least peak of q·alpha
  /// decides between them. Not negative. With the shipped weights 1 is a kilometre, 10 m/s or a degree. The
  /// refinement removes such misses without moving the program visibly.
  double tie_tolerance = 1.0;
  /// Probability that a variable of a child is mutated, 0 to 1. Measured on the shipped trajectory problem
  /// over 6 seeds and 60 x 60 evaluations: the worst objective is 10 with one half, and 34 with one variable
  /// a child.
  double mutation_probability = 0.5;
  /// Fraction of each limit that the search keeps in reserve, 0 to 1, since the refinement moves the program
  /// a little. Removing a miss of `tie_tolerance` changes alpha_max by less than 0.5 %.
  double limit_reserve = 0.01;
  /// Shortest time from t1 to t3 and from t3 to t2, positive. It keeps the times apart. The turn rate has its
  /// own limit.
  double shortest_ramp_s = 1.0;
  /// Individuals and generations of the search among programs that reach the target (selection.h), in the
  /// ranges of GeneticAlgorithmOptions. On the shipped problem twice as many lower the peak of q·alpha by
  /// less than 1 %.
  int selection_population = 24;
  int selection_generations = 20;
  /// A target is reached if the refinement ends within these and every constraint holds. Positive.
  OrbitErrors tolerance = {1.0, 1e-3, 1.7453292519943296e-8, 1.7453292519943296e-8, 1.7453292519943296e-6};
  /// Steps that the refinement tries, 1 to 100,000.
  int refinement_iterations = 60;
};

/// The search's log and the refinement's end beside what they found.
struct OptimizationResult {
  bool reached = false;            ///< within the tolerance of the target, constraints met
  std::string statement;           ///< how near it came and what stopped it (empty: reached)
  Reference reference;             ///< the best found, with attitude program and margins
  OrbitErrors errors;              ///< of the reference
  OrbitErrors halved_step_errors;  ///< of the same program flown with half the steps
  std::vector<AscentSample> history;
  GeneticAlgorithmResult genetic;
  /// The search among programs that reach the target (selection.h). Its log is empty if no such program was
  /// found.
  GeneticAlgorithmResult selection;
  LeastSquaresResult refinement;
  FlightProgram refined;  ///< where the refinement ended: the reference's, unless the search's best is better
};

/// How far, s, a program's times are from order: t1, a ramp, t3, a ramp, t2. 0: in order.
double DisorderOf(const FlightProgram& program, const TrajectoryOptions& options);

/// `observer`, if given, sees each generation. A target that cannot be reached is a result, not an error.
/// Throws std::invalid_argument for options out of range.
OptimizationResult OptimizeTrajectory(const Vehicle& vehicle, const TrajectoryProblem& problem,
                                      const TrajectoryOptions& options,
                                      const GeneticAlgorithm::Observer& observer = nullptr);

/// Flies a program with `options.steps`: orbit, margins, attitude program, history.
Reference BuildReference(const AscentModel& model, const TrajectoryProblem& problem,
                         const FlightProgram& program, const TrajectoryOptions& options,
                         std::vector<AscentSample>* history = nullptr);

}  // namespace dispersa
