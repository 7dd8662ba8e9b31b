// The variables of a flight program that a search moves, with their bounds in a trajectory problem. The
// genetic algorithm, the refinement and the messages share this list.
#pragma once

#include <string>
#include <vector>

#include "core/trajectory/reference.h"

namespace dispersa {

struct ProgramVariable {
  enum class Kind {
    kAlphaMax,
    kT1,
    kT3,
    kT2,
    kCoast,
    kAzimuth,
    kEarlierCoast,  ///< this and the next two: of a stage
    kSteeringBegin,
    kSteeringEnd,
  };
  Kind kind;
  std::size_t stage = 0;

  double& Of(FlightProgram& program) const;
  double Of(const FlightProgram& program) const;
  const Bounds& BoundsOf(const TrajectoryProblem& problem) const;
  /// Key in the file, without the unit: "stage3_coast".
  std::string Name() const;
  /// SI value of the unit in the file, and the name of that unit.
  double unit() const;
  const char* unit_name() const;
  /// A small step of the variable, SI.
  double scale() const;
};

/// In the order alpha_max, t1, t3, t2, coast, launch azimuth, earlier coasts, steering by stage.
std::vector<ProgramVariable> VariablesOf(const Vehicle& vehicle, const TrajectoryProblem& problem);
/// The variables of Steering that the problem lets move: a part of VariablesOf.
std::vector<ProgramVariable> SteeringVariables(const Vehicle& vehicle, const TrajectoryProblem& problem);

/// The stages before the last with an ignition timer. Each has a coast of its own.
std::vector<std::size_t> EarlierCoasts(const Vehicle& vehicle);

/// The program with these values of the variables.
FlightProgram ProgramOf(const std::vector<double>& values, const std::vector<ProgramVariable>& variables);

}  // namespace dispersa
