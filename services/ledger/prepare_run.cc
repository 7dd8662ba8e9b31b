#include "services/ledger/prepare_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "core/analysis/campaign_summary.h"
#include "core/analysis/stopping_rule.h"
#include "core/cases/plugin_check.h"
#include "core/results/case_columns.h"
#include "services/ledger/campaign_attempt.h"
#include "services/log/log.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

bool HasContent(const fs::path& directory) {
  std::error_code error;
  return fs::exists(directory, error) && !fs::is_empty(directory, error);
}

fs::path DefaultFolder(const Campaign& campaign, bool resume, const std::optional<Shard>& shard) {
  std::string stem = campaign.name + "-" + campaign.id.substr(0, 8);
  if (shard) stem += fmt::format("-shard-{}-of-{}", shard->index, shard->count);
  fs::path last = fs::path("results") / stem;
  for (int i = 2;; ++i) {
    const fs::path next = fs::path("results") / (stem + "-" + std::to_string(i));
    const bool stop = resume ? !HasContent(next) : !HasContent(last);
    if (stop) return last;
    last = next;
  }
}

// What a start that is killed before the folder has its database leaves behind. Nothing in it to resume.
bool IsOfAStillbornStart(const fs::path& file) {
  const std::string name = file.filename().string();
  return name == "campaign.yaml" || name.starts_with("campaign.yaml.tmp") ||
         name.starts_with("results.sqlite.tmp");
}
bool IsStillborn(const fs::path& directory) {
  return std::all_of(fs::directory_iterator(directory), fs::directory_iterator(), IsOfAStillbornStart);
}

// After that it is said what takes so long.
constexpr double kPatience_s = 2.0;

std::vector<CaseResult> Check(const Campaign& campaign, const StopCheck& should_stop) {
  if (!campaign.autopilot.plugin) return {};
  const auto start = std::chrono::steady_clock::now();
  bool is_said = false;
  const auto wait = [&] {
    if (!is_said &&
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > kPatience_s) {
      LogInfo(
          "the control law {} is checked before the campaign: each of three flights is flown twice, to see "
          "whether it is deterministic",
          campaign.autopilot.plugin->name);
      is_said = true;
    }
    return should_stop && should_stop();
  };
  return CheckPluginIsDeterministic(CampaignFlights(campaign), campaign.sampling.cases, wait);
}

/// The cases up to the first look, or after a merged folder those up to the next one.
CaseRange RoundOf(const Campaign& campaign, const std::string& after) {
  if (after.empty())
    return {0, StoppingRule(campaign, static_cast<std::int64_t>(campaign.sampling.cases), {}).target()};
  const ResultFolder folder = ResultFolder::Open(after);
  if (const std::string id = folder.Provenance("campaign_id"); id != campaign.id)
    throw InputError(fmt::format("--after {}: holds campaign {}, this one is {}", after, id, campaign.id),
                     "a merged folder of this campaign");
  const CaseColumns cases = ReadColumns(folder, {});
  const CaseRange round{cases.rows() + folder.QuarantinedCases().size(), CasesToFly(folder, campaign, cases)};
  if (folder.ItsShare() || (cases.rows() > 0 && cases.index.back() >= round.first))
    throw InputError(fmt::format("--after {}: cases are missing in it", after), "a folder that merge wrote");
  if (round.first < round.end) return round;
  throw InputError(fmt::format("--after {}: its campaign needs no further cases", after),
                   "the verdict in its report");
}

std::string RangeText(const std::optional<CaseShare>& share) {
  return share ? CasesText(share->cases) : "all cases";
}

PreparedRun PrepareUnrecorded(const RunRequest& request, const StopCheck& should_stop) {
  std::vector<InputProblem> warnings;
  Campaign campaign = LoadCampaign(request.campaign, request.overrides, &warnings);
  for (const InputProblem& warning : warnings) LogWarning("{}", warning.Text());
  std::vector<CaseResult> flown = Check(campaign, should_stop);
  const fs::path directory =
      request.out.empty() ? DefaultFolder(campaign, request.resume, request.shard) : fs::path(request.out);
  std::optional<CaseShare> share;
  if (request.shard) {
    const CaseRange round = RoundOf(campaign, request.after);
    share = {BlockOf(round, request.shard->index, request.shard->count), round.end};
  }
  ResultFolder folder = OpenFolder(directory, request.resume, share, campaign, [&](std::uint64_t cases) {
    CampaignOverrides extended = request.overrides;
    extended.cases = cases;
    return LoadCampaign(request.campaign, extended);
  });
  return {std::move(campaign), std::move(folder), std::move(flown)};
}

}  // namespace

ResultFolder OpenFolder(const fs::path& directory, bool resume, const std::optional<CaseShare>& share,
                        Campaign& campaign, const WithCases& with_cases) {
  // Before looking into it: of several that start at once, one finds the folder as it is.
  std::error_code error;
  fs::create_directories(directory, error);
  std::optional<FolderLock> lock;
  if (!error) lock.emplace(directory);
  if (resume && HasContent(directory) && IsStillborn(directory)) {
    const std::vector<fs::path> leftovers(fs::directory_iterator{directory}, fs::directory_iterator{});
    for (const fs::path& leftover : leftovers) fs::remove(leftover);
  }
  if (!resume || !HasContent(directory))
    return ResultFolder::Create(directory, campaign, std::move(lock), share);
  std::optional<std::uint64_t> last;
  {
    const ResultFolder present = ResultFolder::Open(directory);
    if (const auto kept = present.ItsShare(); kept != share)
      throw InputError(fmt::format("{}: is for {}, this run for {}", directory.string(), RangeText(kept),
                                   RangeText(share)),
                       "a folder of its own");
    last = present.LastCase();
  }
  if (with_cases && last && *last >= campaign.sampling.cases) {
    Campaign larger = with_cases(*last + 1);
    if (larger.flight_id == campaign.flight_id) {
      LogWarning("{} holds more cases than the {} asked for: the campaign is extended to {}",
                 directory.string(), campaign.sampling.cases, larger.sampling.cases);
      campaign = std::move(larger);
    }
  }
  ResultFolder folder = ResultFolder::Resume(directory, campaign, std::move(lock));
  for (const std::uint64_t damaged : folder.damaged()) {
    LogWarning("{}: the row of case {} is damaged; it is flown again", directory.string(), damaged);
  }
  if (const std::uint64_t unmeasured = folder.UnmeasuredCount(); unmeasured > 0)
    LogInfo("{}: {} cases are flown again for the campaign's own metrics", directory.string(), unmeasured);
  return folder;
}

PreparedRun PrepareRun(const RunRequest& request, const StopCheck& should_stop) {
  PreparedRun prepared = PrepareUnrecorded(request, should_stop);
  const fs::path& directory = prepared.folder.directory();
  if (!request.shard) BeginAttemptIn(ResultRoot(directory), directory, prepared.campaign, request.fresh);
  return prepared;
}

fs::path ResultRoot(const fs::path& directory) {
  std::error_code error;
  const fs::path whole = fs::absolute(directory, error).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).parent_path();
}

}  // namespace dispersa
