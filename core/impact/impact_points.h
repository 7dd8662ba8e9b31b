// Impact points of the spent stages, boosters and lost flights of a campaign.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/campaign/case_result.h"
#include "core/cases/campaign_flights.h"
#include "core/dynamics/fall.h"

namespace dispersa {

struct ImpactPoint {
  std::uint64_t case_index = 0;
  int stage = 0;      ///< 1-based: the spent stage, or the lowest stage of the lost stack; 0: a booster
  bool lost = false;  ///< true: the whole stack of a lost flight; false: a spent stage or booster
  double from_time_s = 0.0;  ///< at separation, or at the loss
  double from_altitude_m = 0.0;
  std::optional<Impact> impact = {};  ///< none: the body stays up
};

/// The impact points of a case, from a flight whose history has a row at every event. A spent stage falls
/// from its separation, empty, starting at its own centre of gravity. The stack of a lost flight falls in one
/// piece, without thrust, with the propellant that is left. All fall as tumbling cylinders of the stage's
/// length and diameter, in the air and wind of the case.
///
/// Boosters fall in the same way from their separation, each from its place.
///
/// The last stage of a completed flight that ends at injection or apogee has no point; one that ends at
/// impact has that of its metrics. Neither has a stack whose state is not finite.
std::vector<ImpactPoint> ImpactPoints(const CampaignFlights& flights, const CaseResult& result,
                                      const History& history, const FallSteps& steps = {});

/// Flies the listed cases again, on up to `threads` threads, and computes their impact points. The points are
/// in the order of the list for any number of threads. `flown` gets each result when its flight ends, one at
/// a time. It may throw to stop.
std::vector<ImpactPoint> FlyToImpact(const CampaignFlights& flights, const std::vector<std::uint64_t>& cases,
                                     int threads, const std::function<void(const CaseResult&)>& flown);

}  // namespace dispersa
