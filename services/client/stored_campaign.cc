#include "services/client/stored_campaign.h"

#include <utility>

#include "core/campaign_yaml/load.h"
#include "core/input/input_error.h"

namespace dispersa {

StoredCampaign OpenStored(const std::string& directory) {
  ResultFolder folder = ResultFolder::Open(directory);
  Campaign campaign = ReadFlownCampaign((folder.directory() / "campaign.yaml").string());
  // The text was changed after the flights.
  if (campaign.own_metrics.size() != folder.own_metrics().size() ||
      !FindOwn(campaign.own_metrics, folder.own_metrics()))
    throw InputError(directory + ": the metrics of its campaign.yaml are not those that were measured",
                     "`dispersa run CAMPAIGN --out " + directory + " --resume`, which flies the cases again");
  return {std::move(folder), std::move(campaign)};
}

}  // namespace dispersa
