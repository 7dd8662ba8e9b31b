// What the cases of a campaign draw, as text for a terminal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/campaign/campaign.h"

namespace dispersa {

/// The dispersed inputs of the first `shown` cases in blocks of numbered columns, then every dispersed input
/// by number with what all cases drew of it, the law that it was declared to follow, and whether the draws
/// agree. No line is longer than `width` (at least 80) but for names and laws that are.
std::string PlanText(const Campaign& campaign, std::uint64_t shown, std::size_t width);

}  // namespace dispersa
