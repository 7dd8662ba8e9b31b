// Warnings about dispersions that are far larger than any known vehicle's. Examples: a sigma in per cent
// typed for a fraction, metres for centimetres, an error that no part uses. They are flown, with a warning.
#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace dispersa {

struct UnusualDispersion {
  std::string key;      ///< under the campaign's `dispersions`
  std::string message;  ///< the range that it draws
  std::string allowed;  ///< the usual range, and the reason
};

/// At most one finding for each key: its first column with an unusual value between the 0.135 and the 99.865
/// per cent points. Also errors of navigation in a campaign without guidance.
std::vector<UnusualDispersion> UnusualDispersions(const Campaign& campaign);

}  // namespace dispersa
