// Identities of a campaign: digests of parts of its canonical tree.
#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/input/input_node.h"

namespace dispersa {

/// SHA-256 of the canonical vehicle of a campaign's or a vehicle file's tree, without its beam and its
/// limits: they do not change the trajectory, which is that of the rigid vehicle.
std::string VehicleSha256(const InputNode& vehicle);
/// SHA-256 of the requirements and of how they are judged.
std::string RequirementsId(const InputNode& campaign);
/// SHA-256 of what decides a case.
std::string FlightId(const InputNode& campaign, SamplingMethod method);

}  // namespace dispersa
