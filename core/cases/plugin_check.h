// Whether a plug-in's flights depend on nothing but their inputs.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cases/campaign_flights.h"
#include "core/containment/contained.h"

namespace dispersa {

/// Flies the nominal flight and the first two cases twice, side by side and each alone, in child processes,
/// and compares them tick by tick. Returns the results of those cases: every later result of one of them must
/// agree. Returns nothing for a campaign without plug-in. Throws InputError with the first instant at which
/// they differ, InputError if the nominal flight ends its process, and Interrupted. A case that ends its
/// process is left to the flights of the campaign.
std::vector<CaseResult> CheckPluginIsDeterministic(const CampaignFlights& flights, std::uint64_t cases,
                                                   const StopCheck& should_stop = nullptr);

}  // namespace dispersa
