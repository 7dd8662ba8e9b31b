// Flights whose control law is a plug-in: flown in child processes, so that nothing that the plug-in does
// ends this one.
#pragma once

#include "core/campaign/campaign_flights.h"
#include "core/campaign/contained.h"

namespace dispersa {

/// CampaignFlights::Fly in a child. Throws PluginError, ContainedEnd.
CaseResult FlyContained(const CampaignFlights& flights, const FlightInputs& inputs, std::uint64_t case_index,
                        History* history, Scheme scheme);
/// CampaignFlights::FlyCases in children that fly some cases each. What such a child did not fly before it
/// ended is flown again, each case in a child of its own; one that ends it again is given up.
void FlyContained(const CampaignFlights& flights, CaseQueue& queue);

/// Flies the nominal flight and the first two cases twice, side by side and each alone, in children of their
/// own, and compares them tick by tick. Returns the results of those cases, with which every later one of
/// them must agree; nothing for a campaign without plug-in. Throws InputError when they differ, with the
/// first instant at which they do, and when the nominal flight ends its process; NotWanted. Cases that end
/// theirs are left to whoever flies the campaign.
std::vector<CaseResult> CheckPluginIsDeterministic(const CampaignFlights& flights, std::uint64_t cases,
                                                   const Unwanted& unwanted = nullptr);

}  // namespace dispersa
