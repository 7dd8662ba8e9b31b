// Whether a plug-in's flights depend on nothing but their inputs.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "core/cases/campaign_flights.h"
#include "core/containment/interrupted.h"

namespace dispersa {

/// Of the flights of a check together. A flight with a law of usual cost takes some 10 ms.
inline constexpr std::chrono::seconds kPluginCheckLimit{120};

/// Whether a refusal of a campaign is that of its check: it begins as the InputError of one.
bool IsOfTheLaw(const std::string& reason);

/// Flies the nominal flight and the first two cases twice, side by side and each alone, and
/// compares them tick by tick. Returns the results of those cases: every later result of one of them must
/// agree. Returns nothing for a campaign without plug-in. Throws InputError with the first instant at which
/// they differ, InputError if the nominal flight ends its process or all take longer than `limit`, and
/// Interrupted. A case that ends its process is left to the flights of the campaign.
std::vector<CaseResult> CheckPluginIsDeterministic(const CampaignFlights& flights, std::uint64_t cases,
                                                   const StopCheck& should_stop = nullptr,
                                                   std::chrono::seconds limit = kPluginCheckLimit);

}  // namespace dispersa
