// The refinement moves a flight program onto the target orbit, to the last metre. Its variables are
// alpha_max, coast and launch azimuth; t1, t3 and t2 are frozen. In these three the injection is well posed:
// two or three Newton steps suffice. All six variables together leave a manifold of programs with the same
// orbit.
#pragma once

#include "core/optimization/levenberg_marquardt.h"
#include "core/trajectory/ascent.h"
#include "core/trajectory/optimize.h"

namespace dispersa {

/// alpha_max, coast, launch azimuth and the steering of upper stages: as many as there are conditions. If the
/// target has both speed and inclination, also the earlier coasts, or else t2.
std::vector<ProgramVariable> RefinedVariables(const Vehicle& vehicle, const TrajectoryProblem& problem);
/// alpha_max, coast and the steering of upper stages.
std::vector<ProgramVariable> AltitudeAndAngleVariables(const Vehicle& vehicle,
                                                       const TrajectoryProblem& problem);

/// Changes `program` to the best one in RefinedVariables within the bounds. Variables with equal bounds stay.
/// `held_at_bound` of the result holds positions in that list. `ascent`, if given, is set to the program's
/// ascent, with the steps of the refinement.
LeastSquaresResult RefineProgram(const AscentModel& model, const TrajectoryProblem& problem,
                                 const TrajectoryOptions& options, FlightProgram* program,
                                 AscentResult* ascent = nullptr);

/// Refines altitude and flight path angle only, by AltitudeAndAngleVariables, at the program's azimuth. The
/// remaining speed then shows the vehicle's energy.
LeastSquaresResult RefineAltitudeAndAngle(const AscentModel& model, const TrajectoryProblem& problem,
                                          const TrajectoryOptions& options, FlightProgram* program);

/// Options of one ascent of a problem.
AscentOptions AscentOptionsOf(const TrajectoryProblem& problem, const AscentSteps& steps);

/// Whether the last engine was cut off at the velocity in its file.
bool EndsByVelocity(const AscentModel& model, const AscentResult& ascent);

}  // namespace dispersa
