// The part that all flights of a campaign share, for the engine: the campaign's vehicle, law and air, and its
// reference.
#pragma once

#include "core/campaign/campaign.h"
#include "core/flight/flight_model.h"

namespace dispersa {

FlightDefinition DefinitionOf(const Campaign& campaign);

/// Geodetic altitude at which the reference, as a point mass in still air, has its greatest dynamic pressure.
/// Precondition: the campaign has a reference.
double AltitudeOfMaxQ(const Campaign& campaign);

}  // namespace dispersa
