// The map of a campaign: where it flies, and where what it drops comes down.
#pragma once

#include <string>
#include <vector>

#include "core/analysis/footprints.h"
#include "core/campaign/campaign.h"
#include "core/pages/histories.h"

namespace dispersa {

/// A figure with coast lines, the ground track of the nominal flight, the envelope of all flights, impact
/// points and their ellipses. Below it is a table of the footprints. Empty without a nominal history.
///
/// Projection: azimuthal equidistant about the middle of what is shown, on a sphere of the Earth's mean
/// radius with geodetic latitudes. Distances and directions from the middle are right to 0.6 %; those between
/// other places are right near it. It has no edge at 180 degrees, and the poles are places like others.
std::string MapFigure(const Campaign& campaign, const FlightHistories& histories,
                      const std::vector<Footprint>& footprints);

}  // namespace dispersa
