// Pieces that the pages of the web application share.
#pragma once

#include <string>

#include "services/web/campaign_row.h"

namespace dispersa {

/// A whole page. `search`: what stands in its field. `head`: more elements of its head.
std::string Frame(const std::string& title, const std::string& main, const std::string& search = "",
                  const std::string& head = "");

/// "/campaign/ID", the permanent link.
std::string LinkTo(const CampaignRow& row);
/// The name as a link, with the first digits of the id.
std::string NameOf(const CampaignRow& row);
/// The verdict as a badge, or the state in words.
std::string StandingOfRow(const CampaignRow& row);
std::string LabelsOf(const CampaignRow& row);
/// "2026-01-31 12:00"; a dash for 0.
std::string TimeText(std::int64_t unix_s);
/// "1.2 GB".
std::string BytesText(std::uint64_t bytes);
/// Where a login goes on: `next` if it is a path of this server in printable ASCII, else "/". A browser drops
/// tabs and line ends and takes '\' for '/', so that what follows them could be another host.
std::string LocalPath(const std::string& next);
/// A part of a query.
std::string UrlText(const std::string& text);

}  // namespace dispersa
