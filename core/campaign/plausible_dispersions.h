// Warnings about dispersions that are far larger than any known vehicle's, or that nothing reads. Examples: a
// sigma in per cent typed for a fraction, metres for centimetres, fins' cant of a vehicle without fins. They
// are flown, with a warning.
#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace dispersa {

struct UnusualDispersion {
  std::string key;      ///< path in the campaign: "dispersions.thrust", "sampling.table.density_factor"
  std::string message;  ///< the range that it draws
  std::string allowed;  ///< the usual range, and the reason
};

/// At most one finding for each key: its first column with an unusual value between the 0.135 and the 99.865
/// per cent points. Also keys of which no input is read.
std::vector<UnusualDispersion> UnusualDispersions(const Campaign& campaign);

/// An input that the campaign sets to something else than the nominal flight's value.
struct SetInput {
  std::string key;      ///< as UnusualDispersion's
  int column = -1;      ///< FindInput
  bool varies = false;  ///< from case to case; also the deviation of a noise, and turbulence
  std::string unread;   ///< why no part of the flight reads it; empty: one does
  std::string allowed;  ///< what would read it
};
std::vector<SetInput> SetInputs(const Campaign& campaign);

}  // namespace dispersa
