// A result folder and the campaign that it holds.
#pragma once

#include <cstdint>
#include <string>

#include "core/campaign/campaign.h"
#include "core/results/result_folder.h"

namespace dispersa {

struct StoredCampaign {
  ResultFolder folder;
  Campaign campaign;        ///< of campaign.yaml
  std::uint64_t cases = 0;  ///< CasesToFly()
  std::string incomplete;   ///< "incomplete: 160 of 3000 cases have a result"; empty: none is missing
};

/// InputError if the directory is no result folder, or its campaign.yaml cannot be read. ResultError (kFewer)
/// if no case has a result, unless the folder `may_be_empty`: for a caller that says so by its exit code.
StoredCampaign OpenStored(const std::string& directory, bool may_be_empty = false);

}  // namespace dispersa
