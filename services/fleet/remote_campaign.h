// A campaign that a coordinator flies: launch, watch, fetch.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "services/client/observer.h"
#include "services/fleet/session.h"

namespace dispersa {

/// Uploads the parts that the coordinator lacks. Launching again changes only the priority, if one is given,
/// and adds labels ("KEY=VALUE"). Returns the campaign's state ("waiting", "flying", ...). Throws Failure.
std::string LaunchCampaign(Session& session, const Campaign& campaign, std::optional<int> priority,
                           const std::vector<std::string>& labels = {});

/// Waits until a worker has checked the control law of a campaign that was launched, a plug-in. False: none
/// has for `patience`, or the campaign's problem keeps it from that. Throws Failure if it is refused.
bool AwaitCheck(Session& session, const std::string& id, std::chrono::seconds patience);

/// Waits until the campaign has ended and returns its exit code. Waits for an absent coordinator. Throws
/// Failure, and Interrupted: then the campaign goes on.
ExitCode FollowCampaign(Session& session, const std::string& id, Observer& observer);

struct FetchedCampaign {
  std::string id;
  std::filesystem::path directory;
};
/// The result folder of a campaign that has ended, into `target`, new or empty. Throws Failure, InputError,
/// ResultError.
FetchedCampaign FetchCampaign(Session& session, const std::string& id, const std::string& target);

/// Copies the present data directory of a coordinator into `target`, new or empty, including campaigns that
/// fly. Another coordinator can go on with the copy. Returns the number of campaigns. Throws as
/// FetchCampaign.
std::uint64_t BackUp(Session& session, const std::string& target);

}  // namespace dispersa
