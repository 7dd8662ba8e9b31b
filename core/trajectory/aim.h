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

/// The place at which an ellipse is entered, about a point mass. Its altitude is above the equator's radius.
struct AimedPlace {
  double altitude_m = 0.0;
  double velocity_m_s = 0.0;
  double flight_path_angle_rad = 0.0;
};
/// At the target's true anomaly. Precondition: the target has an apogee, and a true anomaly or a perigee at
/// which it is entered.
AimedPlace PlaceAimedAt(const TrajectoryProblem& problem);
/// The altitude of a target's injection: geodetic, of an ellipse above the equator's radius. Of an ellipse
/// that is entered anywhere: its perigee's.
double AimedAltitude(const TrajectoryProblem& problem);

/// Where an orbit has its place, about a point mass: distance and direction of the eccentricity vector.
struct PlaceInOrbit {
  double semi_major_axis_m = 0.0;  ///< negative for a hyperbola
  double eccentricity = 0.0;
  double true_anomaly_rad = 0.0;
};
PlaceInOrbit PlaceOf(const Orbit& orbit);

}  // namespace dispersa
