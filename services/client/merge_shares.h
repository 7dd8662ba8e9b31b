// One result folder of the shares of a campaign.
#pragma once

#include <string>
#include <vector>

#include "core/containment/contained.h"
#include "services/ledger/prepare_run.h"

namespace dispersa {

struct MergeRequest {
  std::vector<std::string> folders;  ///< shares, and what was merged of earlier rounds, in any order
  std::string out;
  bool resume = false;  ///< as in RunRequest; cases that `out` holds may be in none of the folders
  std::string fresh = {};
};

/// A folder with the results of all folders. InputError with every reason why they are not one campaign, each
/// case once and none left out; then nothing is made. The campaign enters the ledger of attempts beside it.
/// Throws ResultError if `out` cannot be written, and Interrupted.
PreparedRun MergedRun(const MergeRequest& request, const StopCheck& should_stop);

}  // namespace dispersa
