// Whether a plug-in's flights depend on nothing but their inputs.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cases/campaign_flights.h"
#include "core/containment/contained.h"

namespace dispersa {

/// Flies the nominal flight and the first two cases twice, side by side and each alone, in children of their
/// own, and compares them tick by tick. Returns the results of those cases, with which every later one of
/// them must agree; nothing for a campaign without plug-in. Throws InputError when they differ, with the
/// first instant at which they do, and when the nominal flight ends its process; Interrupted. Cases that end
/// theirs are left to whoever flies the campaign.
std::vector<CaseResult> CheckPluginIsDeterministic(const CampaignFlights& flights, std::uint64_t cases,
                                                   const StopCheck& should_stop = nullptr);

}  // namespace dispersa
