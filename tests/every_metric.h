// A made-up campaign whose flights define every metric of a controlled flight.
#pragma once

#include "core/campaign/campaign.h"

namespace dispersa {

inline void MeasureEverything(Campaign& campaign) {
  campaign.autopilot.pitch.law = ControlLaw::kAdaptiveFuzzy;
  TrajectoryProblem& problem = campaign.reference.problem;
  problem.target_apogee_m = 600e3;
  problem.target_node_rad = problem.target_argument_of_perigee_rad = problem.target_true_anomaly_rad = 0.1;
}

}  // namespace dispersa
