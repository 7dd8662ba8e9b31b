// One result folder of the shares of a campaign.
#pragma once

#include <string>
#include <vector>

#include "services/ledger/prepare_run.h"

namespace dispersa {

/// A new folder with the results of `folders`, in any order: shares, and what was merged of earlier rounds.
/// InputError with every reason why they are not one campaign, each case once and none left out; then there
/// is no new folder. The campaign enters the ledger of attempts beside it; `fresh` as in RunRequest. Throws
/// ResultError.
PreparedRun MergedRun(const std::vector<std::string>& folders, const std::string& out,
                      const std::string& fresh);

}  // namespace dispersa
