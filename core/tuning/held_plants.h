// The plants that every design of a tuning must hold if it has dispersed ones: the nominal plant and those of
// some draws of the campaign. Each is checked at the instants of its own flight, against the gates of
// dispersed flights.
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
  /// `draws` plants. `instants` are the nominal plant's; `rigid` flies the draws' own.
  HeldPlants(const TunedPlant& plant, const std::vector<MarginInstant>& instants,
             const CampaignFlights& rigid, int draws);

  /// The least surplus of all held plants in a stage, or in the part of it that is nearest to one of its
  /// times. Below `enough` the search for a smaller one ends. `last` is the plant that was least before: it
  /// is checked first.
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

  void Hold(LauncherPlant plant, const std::string& name, const TickSample& sample, double frequency_band,
            const LoopGates& gates);
  /// The share of each sensor's rates in an autopilot's rate of a stage.
  std::vector<double> SharesOf(const AutopilotConfig& autopilot, int stage) const;

  TunedPlant plant_;
  std::vector<std::vector<Held>> held_;  ///< by stage
};

}  // namespace dispersa
