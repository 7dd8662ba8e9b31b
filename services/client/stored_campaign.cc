#include "services/client/stored_campaign.h"

#include <utility>

#include "core/campaign_yaml/load.h"

namespace dispersa {

StoredCampaign OpenStored(const std::string& directory) {
  ResultFolder folder = ResultFolder::Open(directory);
  Campaign campaign = ReadFlownCampaign((folder.directory() / "campaign.yaml").string());
  return {std::move(folder), std::move(campaign)};
}

}  // namespace dispersa
