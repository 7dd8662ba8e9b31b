// Dispersions of a size that no vehicle and no day has: a sigma in per cent typed for a fraction, metres for
// centimetres, an error that nothing uses. They are flown, with a warning.
#pragma once

#include <string>
#include <vector>

#include "core/campaign/campaign.h"

namespace dispersa {

struct UnusualDispersion {
  std::string key;      ///< under the campaign's `dispersions`
  std::string message;  ///< what it draws
  std::string allowed;  ///< what is usual, and why
};

/// One finding a key, the first of its columns that is beyond what is usual between the 0.135 and the 99.865
/// per cent points; and errors of navigation in a campaign that has no guidance.
std::vector<UnusualDispersion> UnusualDispersions(const Campaign& campaign);

}  // namespace dispersa
