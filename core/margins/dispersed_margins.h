// Margins of an autopilot with the vehicle and the air dispersed as in a campaign.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cases/campaign_flights.h"
#include "core/margins/flight_margins.h"

namespace dispersa {

/// The least value of one margin, and where: of equal ones the first case's.
struct LeastMargin {
  double value = 0.0;
  std::uint64_t case_index = 0;
  double time_s = 0.0;
};

/// One axis of one powered phase over all cases and instants, and all of frozen, adapting and learnt.
struct LeastLoopMargins {
  int stage = 0;  ///< 0-based
  Axis axis = kPitch;
  LeastMargin gain_up_db, gain_down_db, phase_deg, delay_s;  ///< 0 where the loop is unstable
};

struct CampaignMargins {
  std::uint64_t cases = 0;
  std::uint64_t ended_early = 0;        ///< flights that failed: their margins end with them
  std::vector<std::uint64_t> missed;    ///< cases that miss a gate, ascending
  std::vector<LeastLoopMargins> loops;  ///< by stage, each with pitch, yaw, roll
  bool Passed() const { return ended_early == 0 && missed.empty(); }
};

/// ComputeDispersedMargins of all cases of a campaign. The same on any number of threads.
CampaignMargins ComputeCampaignMargins(const CampaignFlights& flights, std::uint64_t cases, int threads,
                                       LateralPath path = LateralPath::kHeld);

}  // namespace dispersa
