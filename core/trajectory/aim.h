// The energy of a trajectory's target, for an engine that is cut off when it is reached.
#pragma once

#include "core/trajectory/reference.h"

namespace dispersa {

/// Gives the target's energy to the last burn, if that has cut_off: {at: target}. Of a target without a
/// velocity nothing is known.
void AimAt(const TrajectoryProblem& problem, Vehicle& vehicle);

/// The orbit of an ellipse with the target's apsides.
struct AimedEllipse {
  double semi_major_axis_m = 0.0;
  double eccentricity = 0.0;
};
/// Precondition: the target has an apogee.
AimedEllipse EllipseOf(const TrajectoryProblem& problem);

/// Where an orbit has its place, about a point mass: distance and direction of the eccentricity vector.
struct PlaceInOrbit {
  double semi_major_axis_m = 0.0;  ///< negative for a hyperbola
  double eccentricity = 0.0;
  double true_anomaly_rad = 0.0;
};
PlaceInOrbit PlaceOf(const Orbit& orbit);

}  // namespace dispersa
