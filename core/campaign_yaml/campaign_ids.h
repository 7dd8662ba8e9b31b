// Identities of a campaign: digests of parts of its canonical tree.
#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/input/input_node.h"

namespace dispersa {

// The tree was read: the declaration of each key says what it decides (Fields::Deciding).

/// SHA-256 of what decides the trajectory of a point mass, in the vehicle's tree.
std::string VehicleSha256(const InputNode& vehicle);
/// SHA-256 of the requirements, of their own metrics, and of the rules by which they are judged. Order, id,
/// rationale and source of requirements have no effect.
std::string RequirementsId(const InputNode& campaign);
/// SHA-256 of the design: of everything that is flown, without seed, number of cases and engine. Campaigns
/// with the same one are attempts at one design.
std::string DesignId(const InputNode& campaign);
/// SHA-256 of what decides a case.
std::string FlightId(const InputNode& campaign, SamplingMethod method);

/// SHA-256 of the flight id and the own metrics. Empty for a campaign without own metrics.
std::string OwnMetricsId(const std::string& flight_id, const std::vector<OwnMetric>& metrics);

}  // namespace dispersa
