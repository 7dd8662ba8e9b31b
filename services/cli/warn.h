// Loading for a command: warnings about allowed but unusual values go to the log, each once.
#pragma once

#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "services/log/log.h"

namespace dispersa {

inline void Warn(const std::vector<InputProblem>& warnings) {
  for (const InputProblem& warning : warnings) LogWarning("{}", warning.Text());
}

/// Loads a campaign (LoadCampaign) and logs its warnings.
inline Campaign LoadAndWarn(const std::string& path, const CampaignOverrides& overrides = {}) {
  std::vector<InputProblem> warnings;
  Campaign campaign = LoadCampaign(path, overrides, &warnings);
  Warn(warnings);
  return campaign;
}

}  // namespace dispersa
