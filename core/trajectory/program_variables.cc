#include "core/trajectory/program_variables.h"

#include "core/math/constants.h"

namespace dispersa {

double& ProgramVariable::Of(FlightProgram& program) const {
  switch (kind) {
    case Kind::kAlphaMax:
      return program.alpha_max_rad;
    case Kind::kT1:
      return program.t1_s;
    case Kind::kT3:
      return program.t3_s;
    case Kind::kT2:
      return program.t2_s;
    case Kind::kCoast:
      return program.coast_s;
    case Kind::kAzimuth:
      return program.launch_azimuth_rad;
    case Kind::kEarlierCoast:
      return program.earlier_coast_s[stage];
    case Kind::kSteeringBegin:
      return program.steering[stage].begin_rad;
    case Kind::kSteeringEnd:
      break;
  }
  return program.steering[stage].end_rad;
}

double ProgramVariable::Of(const FlightProgram& program) const {
  FlightProgram copy = program;
  return Of(copy);
}

const Bounds& ProgramVariable::BoundsOf(const TrajectoryProblem& problem) const {
  switch (kind) {
    case Kind::kAlphaMax:
      return problem.alpha_max_rad;
    case Kind::kT1:
      return problem.t1_s;
    case Kind::kT3:
      return problem.t3_s;
    case Kind::kT2:
      return problem.t2_s;
    case Kind::kCoast:
      return problem.coast_s;
    case Kind::kAzimuth:
      return problem.launch_azimuth_rad;
    case Kind::kEarlierCoast:
      return problem.earlier_coast_s[stage];
    case Kind::kSteeringBegin:
      return problem.steering[stage].begin_rad;
    case Kind::kSteeringEnd:
      break;
  }
  return problem.steering[stage].end_rad;
}

std::string ProgramVariable::Name() const {
  const std::string of_stage = "stage" + std::to_string(stage + 1) + "_";
  switch (kind) {
    case Kind::kAlphaMax:
      return "alpha_max";
    case Kind::kT1:
      return "t1";
    case Kind::kT3:
      return "t3";
    case Kind::kT2:
      return "t2";
    case Kind::kCoast:
      return "coast";
    case Kind::kAzimuth:
      return "launch_azimuth";
    case Kind::kEarlierCoast:
      return of_stage + "coast";
    case Kind::kSteeringBegin:
      return of_stage + "incidence_begin";
    case Kind::kSteeringEnd:
      break;
  }
  return of_stage + "incidence_end";
}

double ProgramVariable::unit() const {
  switch (kind) {
    case Kind::kAlphaMax:
    case Kind::kAzimuth:
    case Kind::kSteeringBegin:
    case Kind::kSteeringEnd:
      return kRadPerDeg;
    default:
      return 1.0;
  }
}

const char* ProgramVariable::unit_name() const { return unit() == 1.0 ? "s" : "deg"; }

double ProgramVariable::scale() const { return unit() == 1.0 ? 1.0 : 0.1 * kRadPerDeg; }

std::vector<std::size_t> EarlierCoasts(const Vehicle& vehicle) {
  std::vector<std::size_t> stages;
  for (std::size_t i = 1; i + 1 < vehicle.stages.size(); ++i)
    if (vehicle.stages[i].ignition == IgnitionTrigger::kTimer) stages.push_back(i);
  return stages;
}

std::vector<ProgramVariable> SteeringVariables(const Vehicle& vehicle, const TrajectoryProblem& problem) {
  using Kind = ProgramVariable::Kind;
  std::vector<ProgramVariable> variables;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) {
    if (problem.steering[i].empty()) continue;
    variables.push_back({Kind::kSteeringBegin, i});
    variables.push_back({Kind::kSteeringEnd, i});
  }
  return variables;
}

std::vector<ProgramVariable> VariablesOf(const Vehicle& vehicle, const TrajectoryProblem& problem) {
  using Kind = ProgramVariable::Kind;
  std::vector<ProgramVariable> variables;
  for (const Kind kind : {Kind::kAlphaMax, Kind::kT1, Kind::kT3, Kind::kT2, Kind::kCoast, Kind::kAzimuth})
    variables.push_back({kind});
  for (const std::size_t stage : EarlierCoasts(vehicle)) variables.push_back({Kind::kEarlierCoast, stage});
  const std::vector<ProgramVariable> steering = SteeringVariables(vehicle, problem);
  variables.insert(variables.end(), steering.begin(), steering.end());
  return variables;
}

FlightProgram ProgramOf(const std::vector<double>& values, const std::vector<ProgramVariable>& variables) {
  FlightProgram program;
  for (std::size_t i = 0; i < variables.size(); ++i) variables[i].Of(program) = values[i];
  return program;
}

}  // namespace dispersa
