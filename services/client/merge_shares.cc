#include "services/client/merge_shares.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/flight/engine_version.h"
#include "core/input/input_error.h"
#include "services/ledger/campaign_attempt.h"
#include "services/ledger/take_over.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

struct Part {
  ResultFolder folder;
  std::string name;
  CaseShare share;
  std::uint64_t settled;  ///< cases with a result, or quarantined

  explicit Part(const std::string& directory)
      : folder(ResultFolder::Open(directory)),
        name(directory),
        settled(folder.CaseCount() + folder.QuarantinedCases().size()) {
    const auto last = folder.LastCase();
    const std::uint64_t end = last ? std::max(*last + 1, settled) : settled;
    share = folder.ItsShare().value_or(CaseShare{{0, end}, end});
  }
};

std::string CasesText(std::uint64_t first, std::uint64_t end) {
  return end - first == 1 ? fmt::format("case {}", first) : fmt::format("cases {} to {}", first, end - 1);
}

/// Why they are not one campaign whose every case is in one of them. `parts` ascend by case.
std::vector<InputProblem> ProblemsOf(const std::vector<Part>& parts) {
  std::vector<InputProblem> problems;
  const auto report = [&](const std::string& folder, std::string message, std::string allowed) {
    problems.push_back({folder, 0, 0, "", std::move(message), std::move(allowed)});
  };
  const std::string id = parts.front().folder.Provenance("campaign_id");
  std::uint64_t next = 0, round_end = 0;
  for (const Part& part : parts) {
    if (const std::string engine = part.folder.Provenance("engine"); engine != EngineVersion())
      report(part.name, fmt::format("flown by engine {}, this one is {}", engine, EngineVersion()),
             "the dispersa that flew it, or all shares flown again");
    if (const std::string its = part.folder.Provenance("campaign_id"); its != id) {
      report(part.name, fmt::format("holds campaign {}, {} holds {}", its, parts.front().name, id),
             "shares of one campaign with the same --cases and --seed");
      continue;
    }
    const CaseRange& cases = part.share.cases;
    if (part.settled < cases.size())
      report(part.name, fmt::format("holds {} of its {} cases", part.settled, cases.size()),
             "the share after its own command with --resume");
    if (cases.size() == 0) continue;
    if (cases.first > next)
      report("", CasesText(next, cases.first) + ": in none of the folders", "every share of the campaign");
    if (cases.first < next)
      report(part.name, CasesText(cases.first, std::min(next, cases.end)) + ": in another folder too",
             "each case in one folder");
    next = std::max(next, cases.end);
    round_end = std::max(round_end, part.share.round_end);
  }
  if (next < round_end && problems.empty())
    report("", CasesText(next, round_end) + ": in none of the folders", "every share of the campaign");
  return problems;
}

/// Removes what a merge began to write, unless it is kept.
class Unfinished {
 public:
  explicit Unfinished(fs::path directory) : directory_(std::move(directory)) {}
  ~Unfinished() {
    if (!directory_.empty()) {
      std::error_code error;
      for (const fs::directory_entry& entry : fs::directory_iterator(directory_, error))
        fs::remove(entry.path(), error);
    }
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  void Keep() { directory_.clear(); }

 private:
  fs::path directory_;
};

}  // namespace

PreparedRun MergedRun(const std::vector<std::string>& folders, const std::string& out,
                      const std::string& fresh) {
  std::vector<Part> parts(folders.begin(), folders.end());
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.share.cases.first < b.share.cases.first; });
  if (std::vector<InputProblem> problems = ProblemsOf(parts); !problems.empty())
    throw InputError(std::move(problems));
  Campaign campaign = ReadFlownCampaign((parts.front().folder.directory() / "campaign.yaml").string());
  ResultFolder merged = ResultFolder::Create(out, campaign);
  Unfinished begun(merged.directory());
  for (const Part& part : parts) {
    const std::uint64_t flown = part.folder.CaseCount();
    const std::uint64_t taken = TakeOver(part.folder, campaign, {}, merged).results;
    if (taken != flown)
      throw InputError(fmt::format("{}: {} of its {} results are not those of the campaign that it holds",
                                   part.name, flown - taken, flown),
                       "the share flown again");
    for (const QuarantinedCase& one : part.folder.QuarantinedCases()) merged.Quarantine(one);
  }
  BeginAttemptIn(ResultRoot(merged.directory()), merged.directory(), campaign, fresh);
  begun.Keep();
  return {std::move(campaign), std::move(merged), {}};
}

}  // namespace dispersa
