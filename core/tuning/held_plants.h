// The plants at which every design of a tuning must meet its gates: the nominal plant and those of some draws
// of the campaign. Each plant is checked at the instants of its own flight. Draws are checked against the
// gates of dispersed flights.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/cases/campaign_flights.h"
#include "core/margins/flight_margins.h"
#include "core/margins/loop_table.h"
#include "core/tuning/tuned_plant.h"

namespace dispersa {

class HeldPlants {
 public:
  /// `draws` is the number of drawn plants. `instants` are those of the nominal plant; flights of `rigid`
  /// give those of the drawn plants.
  HeldPlants(const TunedPlant& plant, const std::vector<MarginInstant>& instants,
             const CampaignFlights& rigid, int draws);

  /// The least surplus of all held plants in a stage. With `about`, only plants nearest to that time of the
  /// stage's schedule count. The search ends at a surplus of at most `enough`. `last` is the plant that ended
  /// an earlier search; it is checked first.
  double SurplusOf(const AutopilotConfig& autopilot, int stage, std::size_t* last, double enough,
                   std::optional<std::size_t> about = {}) const;
  /// For the campaign's autopilot: the gate that is missed by most, the plant and the time, in words.
  std::string Missed(int stage) const;

 private:
  // A plant at an instant, about one axis, that designs must hold.
  struct Held {
    std::string plant;  ///< the plant, in words
    double since_ignition_s = 0.0;
    Axis axis = kPitch;
    LoopGates gates;
    LoopTable table;
  };

  void Hold(LauncherPlant plant, const std::string& name, const TickSample& sample, double frequency_band,
            const LoopGates& gates);
  /// The share of each sensor's rates in the rate that an autopilot uses in a stage.
  std::vector<double> SharesOf(const AutopilotConfig& autopilot, int stage) const;

  TunedPlant plant_;
  std::vector<std::vector<Held>> held_;  ///< by stage
};

}  // namespace dispersa
