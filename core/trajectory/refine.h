// The refinement: moves a flight program to the orbit's last metre, in (alpha_max, coast, launch azimuth)
// with t1, t3 and t2 frozen. In these three the injection is well posed: two or three Newton steps suffice.
// All six together leave a manifold of programs with the same orbit.
#pragma once

#include "core/optimization/levenberg_marquardt.h"
#include "core/trajectory/ascent.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

/// alpha_max, coast, launch azimuth and the steering of upper stages: as many as there are conditions. A
/// target with both speed and inclination also takes the earlier coasts, or else t2.
std::vector<ProgramVariable> RefinedVariables(const Vehicle& vehicle, const TrajectoryProblem& problem);
/// alpha_max, coast and what steers upper stages.
std::vector<ProgramVariable> AltitudeAndAngleVariables(const Vehicle& vehicle,
                                                       const TrajectoryProblem& problem);

/// Changes `program` to the best found in RefinedVariables within the bounds. Variables with equal bounds
/// stay. `held_at_bound` of the result holds positions in that list. `ascent`, if given, becomes the
/// program's ascent, with the steps of the refinement.
LeastSquaresResult RefineProgram(const AscentModel& model, const TrajectoryProblem& problem,
                                 const TrajectoryOptions& options, FlightProgram* program,
                                 AscentResult* ascent = nullptr);

/// Altitude and flight path angle only, by AltitudeAndAngleVariables at the program's azimuth: the speed that
/// is left then tells the vehicle's energy.
LeastSquaresResult RefineAltitudeAndAngle(const AscentModel& model, const TrajectoryProblem& problem,
                                          const TrajectoryOptions& options, FlightProgram* program);

/// Options of one ascent of a problem.
AscentOptions AscentOptionsOf(const TrajectoryProblem& problem, const AscentSteps& steps);

/// Whether the last engine was cut off at the speed that its file says.
bool EndsByVelocity(const AscentModel& model, const AscentResult& ascent);

}  // namespace dispersa
