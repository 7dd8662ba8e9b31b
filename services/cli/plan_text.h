// The draws of a campaign's cases as text for a terminal.
#pragma once

#include <cstddef>
#include <string>

#include "core/campaign/campaign.h"

namespace dispersa {

/// Two tables with a row for each dispersed input: statistics of all draws beside the declared distribution,
/// and the values of the first cases. No line is longer than `width` (at least 80), except for long
/// distributions. Without `all` the tables show one screen of inputs, and as many cases as fit. An input
/// whose draws do not agree with its distribution is never left out. A note names the number of missing rows.
std::string PlanText(const Campaign& campaign, bool all, std::size_t width);

}  // namespace dispersa
