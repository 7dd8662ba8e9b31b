// Whether a message makes sense, from any sender. Sizes are bounded, so that no message makes this process
// allocate or compute without limit.
#pragma once

#include <string>

#include "core/input/printable.h"
#include "services/transport/messages.h"

namespace dispersa {

/// The fault of a message; empty if it has none.
std::string WhyInvalid(const WorkerStatus& status);
std::string WhyInvalid(const Orders& orders);
std::string WhyInvalid(const Report& report);
std::string WhyInvalid(const TextRequest& request);
std::string WhyInvalid(const TextPart& part);
std::string WhyInvalid(const CampaignRefusal& refusal);
std::string WhyInvalid(const CampaignProgress& progress);
std::string WhyInvalid(const Request& request);
std::string WhyInvalid(const Reply& reply);

/// Largest text of a campaign.
inline constexpr std::uint64_t kMaxTextBytes = std::uint64_t{64} << 20;
inline constexpr std::size_t kMaxSlots = 1024;

}  // namespace dispersa
