// A made-up campaign whose flights define every metric.
#pragma once

#include "core/campaign/campaign.h"

namespace dispersa {

/// From a rail, under an autopilot and then without it, to the ground; the target names all angles, and the
/// structure has sections. What is counted against limits is left to tests that give them.
inline void MeasureEverything(Campaign& campaign) {
  campaign.autopilot.pitch.law = ControlLaw::kAdaptiveFuzzy;
  TrajectoryProblem& problem = campaign.reference.problem;
  problem.target_apogee_m = 600e3;
  problem.target_node_rad = problem.target_argument_of_perigee_rad = problem.target_true_anomaly_rad = 0.1;
  campaign.course.ends = FlightEnd::kImpact;
  campaign.vehicle.profile = {{ProfileShape::kCylinder, 1.0, 1.0}};
  campaign.vehicle.rail = Rail{1.0, 0.0, 0.0, 0.0};
  Stage free;
  free.gimbal = FixedNozzle(1.0);
  free.motor.cut_off = CutOff::kAtTime;
  campaign.vehicle.stages.push_back(free);
}

}  // namespace dispersa
