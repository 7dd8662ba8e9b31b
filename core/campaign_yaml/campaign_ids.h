// Identities of a campaign: digests of parts of its canonical tree.
#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/input/input_node.h"

namespace dispersa {

/// SHA-256 of the canonical vehicle of a campaign's or a vehicle file's tree, without its beam and its
/// limits: they do not change the trajectory, which is that of the rigid vehicle.
std::string VehicleSha256(const InputNode& vehicle);
/// SHA-256 of the requirements, in any order and without the words about them, of the own metrics that they
/// limit, and of how they are judged.
std::string RequirementsId(const InputNode& campaign);
/// SHA-256 of what is flown, without seed, number of cases and engine: campaigns that share it are attempts
/// at one design.
std::string DesignId(const InputNode& campaign);
/// SHA-256 of what decides a case.
std::string FlightId(const InputNode& campaign, SamplingMethod method);

/// Of a campaign with metrics of its own: SHA-256 of its flight id and of what they measure. Else empty.
std::string OwnMetricsId(const std::string& flight_id, const std::vector<OwnMetric>& metrics);

}  // namespace dispersa
