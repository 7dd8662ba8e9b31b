// A coordinator's campaign in words, for users who watch it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dispersa {

/// The first digits of the id of a campaign or worker, as people use it.
std::string ShortId(const nlohmann::ordered_json& what);
/// "2 of 140 fail pitch_error_peak_deg (fail so far)"
std::string StandingText(const nlohmann::ordered_json& standing);
/// An element of `campaigns` in the answer to `list`, in lines of 80 columns: id, state, cases, launch (UTC),
/// name, verdict, owner, labels; and a line for each requirement.
std::string CampaignStatusText(const nlohmann::ordered_json& campaign);

}  // namespace dispersa
