// Where the spent stages and the failed flights of a campaign come down.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/campaign/case_result.h"
#include "core/cases/campaign_flights.h"
#include "core/impact/fall.h"

namespace dispersa {

struct ImpactPoint {
  std::uint64_t case_index = 0;
  int stage = 0;             ///< 1-based: the spent one, or the lowest of the stack that was lost
  bool lost = false;         ///< the whole stack of a flight that was lost; else a spent stage
  double from_time_s = 0.0;  ///< separation, or loss
  double from_altitude_m = 0.0;
  std::optional<Impact> impact = {};  ///< none: it stays up
};

/// The impact points of a case, from a flight whose history has a row at every event: each spent stage from
/// its separation, at its own centre of gravity, empty; and of a lost flight the stack with what propellant
/// it holds, its thrust ended and in one piece. All fall as tumbling cylinders of the stage's length and
/// diameter in the case's own air and wind. A completed flight's last stage is in orbit. A flight whose state
/// is not finite has no point for its stack.
std::vector<ImpactPoint> ImpactPoints(const CampaignFlights& flights, const CaseResult& result,
                                      const History& history, const FallSteps& steps = {});

/// Flies the cases of a list again, on up to `threads` threads, and lets fall what falls: the points in the
/// order of the list, whatever the threads. `flown` sees each result as its flight ends, one at a time; it
/// may throw to stop.
std::vector<ImpactPoint> FlyToImpact(const CampaignFlights& flights, const std::vector<std::uint64_t>& cases,
                                     int threads, const std::function<void(const CaseResult&)>& flown);

}  // namespace dispersa
