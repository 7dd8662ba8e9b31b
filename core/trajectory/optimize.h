// Finds the flight program that reaches a target orbit: a genetic algorithm on objective (8), then
// refinement in the unknowns in which the problem is well posed.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/optimization/genetic_algorithm.h"
#include "core/optimization/levenberg_marquardt.h"
#include "core/trajectory/ascent.h"
#include "core/trajectory/reference.h"

namespace dispersa {

/// Errors of an orbit against the target: reached less desired.
struct OrbitErrors {
  double altitude_m = 0.0;
  double velocity_m_s = 0.0;
  double flight_path_angle_rad = 0.0;
};
OrbitErrors ErrorsOf(const TrajectoryProblem& problem, const Orbit& orbit);

struct OptimizationResult {
  bool reached = false;          ///< within kReached of the target, constraints met
  std::string statement;         ///< how far it got and what stopped it; empty when reached
  Reference reference;           ///< the best found, with attitude program and margins
  OrbitErrors errors;            ///< of the reference
  OrbitErrors halved_step_errors;  ///< the same program flown with half the steps
  std::vector<AscentSample> history;
  GeneticAlgorithmResult genetic;
  LeastSquaresResult refinement;
};

/// A target counts as reached within these, which the refinement beats by far unless the vehicle cannot.
inline constexpr double kReachedAltitude_m = 1000.0;
inline constexpr double kReachedVelocity_m_s = 5.0;
inline constexpr double kReachedAngle_rad = 0.05 * 3.14159265358979323846 / 180.0;

/// Variables in the order alpha_max, t1, t3, t2, coast, launch azimuth.
FlightProgram ProgramOf(const std::vector<double>& variables);

/// `threads` changes the time it takes, never the result. `observer`, if given, sees each generation.
OptimizationResult OptimizeTrajectory(const Vehicle& vehicle, const TrajectoryProblem& problem, double tick_s,
                                      int threads,
                                      const GeneticAlgorithm::Observer& observer = nullptr);

/// Flies a program as the refinement does: orbit, margins, attitude program, history.
Reference BuildReference(const AscentModel& model, const TrajectoryProblem& problem,
                         const FlightProgram& program, std::vector<AscentSample>* history = nullptr);

}  // namespace dispersa
