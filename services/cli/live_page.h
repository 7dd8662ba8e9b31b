// The page of `watch --web` for a campaign, with the report's style and words. It loads nothing from outside.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "services/cli/live_server.h"

namespace dispersa {

/// The page before anything is known of the campaign, for a LiveServer.
std::string LivePage(const std::string& id);
/// The header that lets a page use its own style and script, its own server, and nothing else.
std::string ContentSecurityPolicy(const std::string& page);

/// The parts of the page, from a coordinator's answers to `status` and `tally`.
LiveParts StatusParts(const nlohmann::ordered_json& status);
LiveParts TallyParts(const nlohmann::ordered_json& tally);
/// A notice about trouble with the coordinator; empty if there is none.
LiveParts NoticeParts(const std::string& notice);

}  // namespace dispersa
