// Loading a campaign for a command: what looks wrong but is legal goes to the log.
#pragma once

#include <spdlog/spdlog.h>

#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"

namespace dispersa {

/// As LoadCampaign.
inline Campaign LoadAndWarn(const std::string& path, const CampaignOverrides& overrides = {}) {
  std::vector<InputProblem> warnings;
  Campaign campaign = LoadCampaign(path, overrides, &warnings);
  for (const InputProblem& warning : warnings) spdlog::warn("{}", warning.Text());
  return campaign;
}

}  // namespace dispersa
