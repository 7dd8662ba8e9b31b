// From a campaign file and an output folder to both of them opened.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/campaign/case_result.h"
#include "core/campaign_yaml/load.h"
#include "core/containment/contained.h"
#include "core/results/result_folder.h"

namespace dispersa {

struct CampaignRequest {
  InputSource campaign = "";
  CampaignOverrides overrides;
  std::string out;  ///< empty: results/<name>-<first 8 of id>, then -2, -3, ...
  bool resume = false;
};

struct OpenedCampaign {
  Campaign campaign;
  ResultFolder folder;
  std::vector<CaseResult> flown;  ///< of a control law from a plug-in, to see whether it is deterministic
};

/// Without `resume` the folder must be new or empty. With it, a folder of the same flight id is continued,
/// and one that is new or empty is started; without `out` it is the last of the default folders. Results are
/// never thrown away: a folder that holds more cases than asked for keeps them, and the campaign is extended
/// to them. Throws InputError, ResultError; NotWanted, while a plug-in is checked.
OpenedCampaign OpenCampaign(const CampaignRequest& request, const Unwanted& unwanted = nullptr);

}  // namespace dispersa
