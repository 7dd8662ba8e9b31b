// Loads the campaign file of a run and opens its result folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/case_result.h"
#include "core/campaign_yaml/load.h"
#include "core/containment/contained.h"
#include "core/results/result_folder.h"

namespace dispersa {

/// One of `count` blocks of the cases, which schedulers fly apart.
struct Shard {
  std::uint64_t index = 0;
  std::uint64_t count = 1;
};

struct RunRequest {
  InputSource campaign = "";
  CampaignOverrides overrides;
  std::string out;  ///< empty: results/<name>-<first 8 of id>, then -2, -3, ...
  bool resume = false;
  std::string fresh;  ///< reason why earlier attempts at the design do not count; empty: they count
  std::optional<Shard> shard = {};
  std::string after = {};  ///< of a shard: merged folder of the rounds before; empty: none
};

struct PreparedRun {
  Campaign campaign;
  ResultFolder folder;
  std::vector<CaseResult> flown;  ///< flown beforehand to check that a plug-in is deterministic
};

/// The parent of a result folder. Its campaigns share a ledger of attempts.
std::filesystem::path ResultRoot(const std::filesystem::path& directory);

/// What a folder that is continued holds besides: the campaign with so many cases.
using WithCases = std::function<Campaign(std::uint64_t cases)>;

/// The folder of a run, or of a share of one, opened as PrepareRun says. Without `with_cases` a folder with
/// more cases is refused.
ResultFolder OpenFolder(const std::filesystem::path& directory, bool resume,
                        const std::optional<CaseShare>& share, Campaign& campaign,
                        const WithCases& with_cases = nullptr);

/// Without `resume` the folder must be new or empty. With `resume` a folder of the same flight id is
/// continued, and a new or empty folder is started. Without `out` the last of the default folders is used.
/// Results are never deleted: a folder with more cases than requested keeps them, and the campaign is
/// extended to them. A shard is in no ledger of attempts: its campaign is when its shards are merged. A
/// campaign that stops when it is decided is flown in rounds: the shards of the cases up to its first look,
/// and after each merge those up to the next one. Throws InputError and ResultError, and Interrupted while a
/// plug-in is checked.
PreparedRun PrepareRun(const RunRequest& request, const StopCheck& should_stop = nullptr);

}  // namespace dispersa
