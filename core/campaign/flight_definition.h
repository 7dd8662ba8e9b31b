// The part that all flights of a campaign share, for the engine: the campaign's vehicle, law and air, and its
// reference.
#pragma once

#include "core/campaign/campaign.h"
#include "core/flight/flight_model.h"

namespace dispersa {

FlightDefinition DefinitionOf(const Campaign& campaign);

}  // namespace dispersa
