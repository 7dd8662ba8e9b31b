// What the cases of a campaign draw, as text for a terminal.
#pragma once

#include <cstddef>
#include <string>

#include "core/campaign/campaign.h"

namespace dispersa {

/// Two tables with a row for each dispersed input: what all cases drew of it under the law that was declared,
/// and its value in the first cases. No line is longer than `width` (at least 80) but for laws that are.
/// Without `all` the tables are cut after so many inputs as a screen holds and the cases that fit beside each
/// other; an input whose draws do not agree with its law is never cut, and what is missing is said.
std::string PlanText(const Campaign& campaign, bool all, std::size_t width);

}  // namespace dispersa
