// One stored case flown again, and every difference from the stored result.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/campaign/case_result.h"
#include "core/flight/history.h"
#include "core/results/result_differences.h"
#include "services/client/stored_campaign.h"

namespace dispersa {

struct CaseReplay {
  CaseResult stored;
  CaseResult replayed;
  std::vector<ResultDifference> differences;  ///< none: reproduced to the last bit
};

/// `history`, if given, receives the flight's. A folder of another engine is warned about. Errors as
/// ResultFolder::Load.
CaseReplay ReplayCase(const StoredCampaign& stored, std::uint64_t case_index, History* history = nullptr);

/// Schema "dispersa/replay/1".
nlohmann::ordered_json ReplayJson(const CaseReplay& replay);

}  // namespace dispersa
