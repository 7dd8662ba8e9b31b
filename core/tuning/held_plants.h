// The plants that every design must hold where a tuning has dispersed ones: the nominal plant and those of
// some draws of the campaign, at the instants of their own flights, to the gates of dispersed flights.
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
  /// Of so many draws; `instants` are the nominal plant's, and `rigid` flies the draws' own.
  HeldPlants(const TunedPlant& plant, const std::vector<MarginInstant>& instants,
             const CampaignFlights& rigid, int draws);

  /// The least surplus of all held plants of a stage, or of those nearer to one of its times than to others.
  /// Once it is below `enough` the rest does not matter; `last`, which was least before, is looked at first.
  double SurplusOf(const AutopilotConfig& autopilot, int stage, std::size_t* last, double enough,
                   std::optional<std::size_t> about = {}) const;
  /// Of the campaign's autopilot: what is missed by most, and where.
  std::string Missed(int stage) const;

 private:
  // A plant at an instant, about one axis, that designs must hold.
  struct Held {
    std::string plant;  ///< which it is, in words
    double since_ignition_s = 0.0;
    Axis axis = kPitch;
    LoopGates gates;
    LoopTable table;
  };

  void Hold(LauncherPlant plant, const std::string& name, const TickSample& sample,
            const std::vector<double>& frequency_factors, const LoopGates& gates);
  /// What an autopilot makes of the rates of each sensor in a stage.
  std::vector<double> SharesOf(const AutopilotConfig& autopilot, int stage) const;

  TunedPlant plant_;
  std::vector<std::vector<Held>> held_;  ///< by stage
};

}  // namespace dispersa
