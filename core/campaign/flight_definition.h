// What a campaign's flights have in common, as the engine wants it: the campaign's vehicle, law and air, and
// what its reference flies.
#pragma once

#include "core/campaign/campaign.h"
#include "core/flight/flight_model.h"

namespace dispersa {

FlightDefinition DefinitionOf(const Campaign& campaign);

}  // namespace dispersa
