// A result folder and the campaign that it holds.
#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/results/result_folder.h"

namespace dispersa {

struct StoredCampaign {
  ResultFolder folder;
  Campaign campaign;  ///< of campaign.yaml
};

/// InputError if the directory is no result folder, or its campaign.yaml cannot be read.
StoredCampaign OpenStored(const std::string& directory);

}  // namespace dispersa
