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

/// Errors of an orbit: reached minus desired. The desired velocity is the target's plus its reserve.
struct OrbitErrors {
  double altitude_m = 0.0;
  double velocity_m_s = 0.0;
  double flight_path_angle_rad = 0.0;
  double inclination_rad = 0.0;  ///< this and the next: 0 if the target does not name it
  double argument_of_perigee_rad = 0.0;
};
OrbitErrors ErrorsOf(const TrajectoryProblem& problem, const Orbit& orbit);
/// Whether no error is larger than its tolerance.
bool IsWithin(const OrbitErrors& errors, const OrbitErrors& tolerance);

/// Tolerance for an engine with a cut-off velocity: the vehicle's file gives that velocity with few digits.
/// 0.1 m/s moves the other apsis by 0.4 km.
inline constexpr double kCutOffTolerance_m_s = 0.1;

/// Settings of the search. Bounds, weights, limits, population, generations and seed belong to the trajectory
/// problem and come from the user's file.
struct TrajectoryOptions {
  /// Tick of the autopilot that will fly the reference: burnout is detected on it. Positive.
  double tick_s = 0.01;
  /// Threads that fly individuals, 1 to 1024. The result does not depend on it.
  int threads = 1;
  /// Steps of the search. On the shipped vehicle they give the injection within 0.02 km, 0.04 m/s and 0.0004
  /// deg of the converged one. This is less than `tie_tolerance` resolves.
  AscentSteps search_steps = {0.5, 2.0, 20.0};
  /// Steps of the refinement and of the reference. Halving them moves the shipped reference's injection by
  /// less than 0.1 m, 0.1 mm/s and 1e-7 deg.
  AscentSteps steps = {0.02, 0.1, 5.0};
  /// Values of objective (8) within this of the best count as equal. The least peak of q·alpha decides
  /// between them. Not negative. With the shipped weights, 1 is 1 km, 10 m/s or 1 deg. The refinement removes
  /// such misses without moving the program visibly.
  double tie_tolerance = 1.0;
  /// Probability that a variable of a child is mutated, 0 to 1. Measured on the shipped trajectory problem
  /// over 6 seeds and 60 x 60 evaluations: the worst objective is 10 with 0.5, and 34 with one variable for
  /// each child.
  double mutation_probability = 0.5;
  /// Fraction of each limit that the search keeps in reserve, 0 to 1, because the refinement moves the
  /// program a little. Removing a miss of `tie_tolerance` changes alpha_max by less than 0.5 %.
  double limit_reserve = 0.01;
  /// Shortest time from t1 to t3 and from t3 to t2, positive. It keeps the times apart. The turn rate has its
  /// own limit.
  double shortest_ramp_s = 1.0;
  /// Individuals and generations of the search among programs that reach the target (selection.h), with the
  /// ranges of GeneticAlgorithmOptions. On the shipped problem, twice the number lowers the peak of q·alpha
  /// by less than 1 %.
  int selection_population = 24;
  int selection_generations = 20;
  /// A target is reached if the refinement ends within this and every constraint is satisfied. Positive.
  OrbitErrors tolerance = {1.0, 1e-3, 1.7453292519943296e-8, 1.7453292519943296e-8, 1.7453292519943296e-6};
  /// Steps that the refinement tries, 1 to 100,000.
  int refinement_iterations = 60;
};

/// The reference found, the log of the search and the end of the refinement.
struct OptimizationResult {
  bool reached = false;            ///< within the tolerance of the target, constraints met
  std::string statement;           ///< how near the search came and what limited it (empty: target reached)
  Reference reference;             ///< the best found, with attitude program and margins
  OrbitErrors errors;              ///< of the reference
  OrbitErrors tolerance;           ///< of the target, for `reached`
  OrbitErrors halved_step_errors;  ///< of the same program flown with half the steps
  std::vector<AscentSample> history;
  GeneticAlgorithmResult genetic;
  /// The search among programs that reach the target (selection.h). Its log is empty if no such program was
  /// found.
  GeneticAlgorithmResult selection;
  LeastSquaresResult refinement;
  FlightProgram refined;  ///< end of the refinement; the reference has this program unless the best of the
                          ///< search is better
};

/// Time (s) by which a program's times violate the order t1, ramp, t3, ramp, t2. 0: in order.
double DisorderOf(const FlightProgram& program, const TrajectoryOptions& options);

/// `observer`, if given, gets each generation. If the target cannot be reached, the result says so; this is
/// no error. Throws std::invalid_argument for options out of range.
OptimizationResult OptimizeTrajectory(const Vehicle& vehicle, const TrajectoryProblem& problem,
                                      const TrajectoryOptions& options,
                                      const GeneticAlgorithm::Observer& observer = nullptr);

/// Flies a program with `options.steps`. Gives orbit, margins, attitude program and history.
Reference BuildReference(const AscentModel& model, const TrajectoryProblem& problem,
                         const FlightProgram& program, const TrajectoryOptions& options,
                         std::vector<AscentSample>* history = nullptr);

}  // namespace dispersa
