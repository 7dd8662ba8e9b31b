#include "services/client/merge_shares.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/flight/engine_version.h"
#include "core/input/input_error.h"
#include "core/results/folder_state.h"
#include "services/ledger/campaign_attempt.h"
#include "services/ledger/take_over.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

/// What a folder holds. It is not kept open: there may be more of them than a process may have open files.
struct Part {
  std::string name, engine, campaign_id;
  CaseShare share;
  std::uint64_t settled;  ///< cases with a result, or quarantined

  explicit Part(const std::string& directory) : name(directory) {
    const ResultFolder folder = ResultFolder::Open(directory);
    engine = folder.Provenance("engine");
    campaign_id = folder.Provenance("campaign_id");
    settled = folder.CaseCount() + folder.QuarantinedCases().size();
    const auto last = folder.LastCase();
    const std::uint64_t end = last ? std::max(*last + 1, settled) : settled;
    share = folder.ItsShare().value_or(CaseShare{{0, end}, end});
  }
};

/// Of the merged folder, when it is there already. Ascending.
std::vector<std::uint64_t> SettledCases(const fs::path& out) {
  if (!fs::exists(out / kDatabaseName)) return {};
  const ResultFolder folder = ResultFolder::Open(out);
  std::vector<std::uint64_t> cases = folder.PresentCases();
  for (const QuarantinedCase& one : folder.QuarantinedCases()) cases.push_back(one.case_index);
  std::sort(cases.begin(), cases.end());
  return cases;
}

/// Why they are not one campaign whose every case is in one of them, or among `held`. `parts` ascend by case.
std::vector<InputProblem> ProblemsOf(const std::vector<Part>& parts, const std::vector<std::uint64_t>& held) {
  std::vector<InputProblem> problems;
  const auto report = [&](const std::string& folder, std::string message, std::string allowed) {
    problems.push_back({folder, 0, 0, "", std::move(message), std::move(allowed)});
  };
  const auto require = [&](const CaseRange& cases) {
    const auto begin = std::lower_bound(held.begin(), held.end(), cases.first);
    if (std::lower_bound(begin, held.end(), cases.end) - begin < static_cast<std::ptrdiff_t>(cases.size()))
      report("", CasesText(cases) + ": in none of the folders", "every share of the campaign");
  };
  const Part& first = parts.front();
  std::uint64_t next = 0, round_end = 0;
  for (const Part& part : parts) {
    if (part.engine != EngineVersion())
      report(part.name, fmt::format("flown by engine {}, this one is {}", part.engine, EngineVersion()),
             "the dispersa that flew it, or all shares flown again");
    if (part.campaign_id != first.campaign_id) {
      report(part.name,
             fmt::format("holds campaign {}, {} holds {}", part.campaign_id, first.name, first.campaign_id),
             "shares of one campaign with the same --cases and --seed");
      continue;
    }
    const CaseRange& cases = part.share.cases;
    if (part.settled < cases.size())
      report(part.name, fmt::format("holds {} of its {} cases", part.settled, cases.size()),
             "the share after its own command with --resume");
    round_end = std::max(round_end, part.share.round_end);
    if (cases.size() == 0) continue;
    if (cases.first > next) require({next, cases.first});
    if (cases.first < next)
      report(part.name, CasesText({cases.first, std::min(next, cases.end)}) + ": in another folder too",
             "each case in one folder");
    next = std::max(next, cases.end);
  }
  if (next < round_end) require({next, round_end});
  return problems;
}

/// Its results, and what was required and read before they were flown.
void Take(const Part& part, const Campaign& campaign, ResultFolder& merged) {
  const ResultFolder folder = ResultFolder::Open(part.name);
  if (const std::uint64_t others = TakeOver(folder, campaign, {}, merged).others; others > 0)
    throw InputError(fmt::format("{}: {} of its {} results are not those of the campaign that it holds",
                                 part.name, others, folder.CaseCount()),
                     "the share flown again, into a new folder");
  for (const QuarantinedCase& one : folder.QuarantinedCases())
    if (!merged.Contains(one.case_index)) merged.Quarantine(one);
  merged.TakePlanOf(folder, campaign);
}

template <typename Reading>
auto OfSoundFolders(const Reading& reading) {
  try {
    return reading();
  } catch (const ResultError& error) {
    if (error.kind() != ResultError::Kind::kFile) throw;
    throw InputError(
        error.what(),
        "shares as they were flown: of this one by its own command with --resume, or into a new folder");
  }
}

}  // namespace

PreparedRun MergedRun(const MergeRequest& request, const StopCheck& should_stop) {
  std::vector<Part> parts;
  std::error_code none;
  for (const std::string& folder : request.folders)
    if (!request.resume || !fs::equivalent(folder, request.out, none))
      parts.push_back(OfSoundFolders([&] { return Part(folder); }));
  if (parts.empty()) throw InputError(request.out + ": nothing to merge with it", "shares beside it");
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.share.cases.first < b.share.cases.first; });
  const std::vector<std::uint64_t> held =
      request.resume ? SettledCases(request.out) : std::vector<std::uint64_t>();
  if (std::vector<InputProblem> problems = ProblemsOf(parts, held); !problems.empty())
    throw InputError(std::move(problems));
  const std::string text = (fs::path(parts.front().name) / kTextFile).string();
  Campaign campaign = ReadFlownCampaign(text);
  if (campaign.id != parts.front().campaign_id)
    throw InputError(text + ": is not the campaign that was flown",
                     "the file as the share's command wrote it");
  ResultFolder merged = OpenFolder(request.out, request.resume, {}, campaign);
  try {
    for (const Part& part : parts) {
      if (should_stop()) throw Interrupted();
      OfSoundFolders([&] { Take(part, campaign, merged); });
    }
  } catch (const InputError&) {
    if (held.empty())
      for (const fs::directory_entry& entry : fs::directory_iterator(merged.directory(), none))
        fs::remove(entry.path(), none);
    throw;
  }
  BeginAttemptIn(ResultRoot(merged.directory()), merged.directory(), campaign, request.fresh);
  return {std::move(campaign), std::move(merged), {}};
}

}  // namespace dispersa
