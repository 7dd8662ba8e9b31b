// What a campaign's page shows only while it flies.
#pragma once

#include <string>

#include "services/web/campaign_row.h"

namespace dispersa {

/// Histograms of the key metrics so far, and the workers.
std::string FlyingSection(const CampaignIndex& index, const CampaignRow& row);

}  // namespace dispersa
