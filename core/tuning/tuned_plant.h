// The vehicle's part of a tuning. It does not depend on the autopilot's design.
#pragma once

#include <vector>

#include "core/campaign/campaign.h"
#include "core/flight/flight_model.h"

namespace dispersa {

struct TunedPlant {
  const Campaign& campaign;
  const FlightModel& untuned;  ///< model of the campaign with all stages untuned

  int StageCount() const { return static_cast<int>(campaign.vehicle.stages.size()); }
  double ActuatorOf(int stage) const {
    return campaign.vehicle.stages[static_cast<std::size_t>(stage)].gimbal.bandwidth_rad_s;
  }
  AutopilotModel ModelOf(const AutopilotConfig& autopilot) const;
  std::vector<double> TimesOf(int stage) const;
  /// Frequency (rad/s) of the first mode of a stage at a time of its schedule. A stage without times: in the
  /// middle of its burn. 0 for a stage that does not bend.
  double FirstMode(int stage, double at_s = 0.0) const;
};

}  // namespace dispersa
