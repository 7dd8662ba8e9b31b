// Limits that the vehicle brings and the campaign's file does not require. A flight beyond one of them is a
// fact that fails the campaign. A flight within them shows no probability, so they stand apart from the
// requirements and delay no verdict.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/results/case_columns.h"

namespace dispersa {

struct LoadCheck {
  std::string metric;  ///< "structural_limit_exceeded"
  std::int64_t n = 0;  ///< flights that were checked, lost ones with their loads until the loss
  std::int64_t failures = 0;
  std::int64_t not_measured =
      0;  ///< completed flights among the failures, within all limits whose load they define
};

/// For each row whether the flight fails: it went beyond a checked limit, or completed without the load that
/// the limit is of. Empty if the campaign has none to check. A requirement takes the place of a check:
/// `structural_limit_exceeded` below 1 that of all limits, a load below its limit that of this one.
std::vector<bool> BeyondCheckedLimits(const Campaign& campaign, const CaseColumns& cases);

/// None or one: all the checked limits together.
std::vector<LoadCheck> CheckLoads(const Campaign& campaign, const CaseColumns& cases);

/// "Load check: 0 of 100 flights went beyond a limit of the vehicle. ..."
std::string LoadCheckSentence(const LoadCheck& check);

}  // namespace dispersa
