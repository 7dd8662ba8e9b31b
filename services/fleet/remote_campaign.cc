#include "services/fleet/remote_campaign.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include "core/results/folder_state.h"
#include "core/results/output_file.h"
#include "services/client/folder_check.h"
#include "services/client/writable.h"
#include "services/transport/network.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kPart = 256 << 10;
constexpr int kMostAttempts = 3;  // to copy a campaign that changes meanwhile
constexpr std::chrono::milliseconds kAskAgain(200);
constexpr std::chrono::milliseconds kPeriod(500);
constexpr std::chrono::milliseconds kPatience(1000);  // of one question of those that follow

void Upload(Session& session, const Campaign& campaign) {
  const std::string& text = campaign.canonical_yaml;
  std::uint64_t received = 0;
  do {
    const Json part = {{"id", campaign.id}, {"size", text.size()}, {"offset", received}};
    received = Json::parse(session.Ask("upload", part, text.substr(received, kPart)).text).at("received");
  } while (received < text.size());
}

/// `which`: the campaign's id and, of a backup, the snapshot's name.
void FetchFile(Session& session, Json which, const std::string& path, std::uint64_t size,
               const fs::path& target) {
  fs::create_directories(target.parent_path());
  OutputFile file(target);
  which["path"] = path;
  for (std::uint64_t offset = 0; offset < size;) {
    which["offset"] = offset;
    const Reply part = session.Ask("read", which);
    if (part.data.empty())
      throw Failure{kExitInternalError, path + ": it became shorter while it was fetched"};
    file.Write(part.data);
    offset += part.data.size();
  }
  file.Commit();
}

/// The files to fetch, once the coordinator has copied the database.
Json AskForFiles(Session& session, const Json& which) {
  for (;;) {
    Json answer = Json::parse(session.Ask("files", which).text);
    if (!answer.contains("state")) return answer;
    std::this_thread::sleep_for(kAskAgain);
  }
}

/// A folder without all results must not be taken for the campaign.
void RequireAllCases(const fs::path& directory, const Json& answer) {
  const auto promised = answer.value("done", std::uint64_t{0});
  const bool has_database = fs::exists(directory / "results.sqlite");
  const std::uint64_t arrived = has_database ? ReadFolderState(directory).cases : 0;
  if (arrived >= promised) return;
  throw Failure{kExitIncomplete,
                fmt::format("campaign {} has {} cases and {} of them arrived: nothing was written; "
                            "fetch it again",
                            answer.at("id").get<std::string>().substr(0, 8), promised, arrived)};
}

/// A report that a disk has cut must not be taken for the campaign's.
void RequireWhole(const fs::path& directory, const Json& answer) {
  if (!fs::exists(directory / "results.sqlite")) return;
  const std::vector<FolderProblem> problems = CheckFiles(directory);
  if (problems.empty()) return;
  throw Failure{
      kExitInternalError,
      fmt::format("campaign {}: {} {} at the coordinator: nothing was written; stop it, and let `dispersa "
                  "fsck DATA --repair` mend it",
                  answer.at("id").get<std::string>().substr(0, 8),
                  fs::path(problems[0].file).lexically_relative(directory).string(), problems[0].what)};
}

/// Whether it names a file below the folder that it is relative to, without a detour.
bool IsFileBelow(const fs::path& path) {
  return path.has_filename() && path != "." && !path.is_absolute() && path.lexically_normal() == path &&
         *path.begin() != "..";
}

}  // namespace

std::string LaunchCampaign(Session& session, const Campaign& campaign, std::optional<int> priority,
                           const std::vector<std::string>& labels) {
  Json launch = {{"id", campaign.id}, {"flight_id", campaign.flight_id}};
  if (priority) launch["priority"] = *priority;
  if (!labels.empty()) launch["labels"] = labels;
  for (;;) {
    const std::string state = Json::parse(session.Ask("launch", launch).text).at("state");
    if (state == "unknown") {
      Upload(session, campaign);  // again if the coordinator is started again meanwhile
    } else if (state == "checked") {
      std::this_thread::sleep_for(kAskAgain);
    } else {
      return state;
    }
  }
}

bool AwaitCheck(Session& session, const std::string& id, std::chrono::seconds patience) {
  const auto latest = std::chrono::steady_clock::now() + patience;
  do {
    const Json campaign = Json::parse(session.Ask("list", {{"id", id}}).text).at("campaigns").at(0);
    if (campaign.at("state") == "refused") throw Failure{kExitBadInput, campaign.at("problem")};
    if (campaign.at("checked") || !campaign.at("code").is_null()) return true;
    if (!campaign.at("problem").is_null()) return false;
    std::this_thread::sleep_for(kAskAgain);
  } while (std::chrono::steady_clock::now() < latest);
  return false;
}

ExitCode FollowCampaign(Session& session, const std::string& id, Observer& observer) {
  for (;;) {
    if (observer.ShouldStop()) throw Interrupted();
    const auto reply = session.Try("list", {{"id", id}}, "", kPatience);
    if (reply) {
      const Json answer = Json::parse(reply->text);
      const Json& campaign = answer.at("campaigns").at(0);
      observer.Show(campaign.at("name"), campaign.at("done"), campaign.at("total"), campaign.at("state"));
      if (!campaign.at("code").is_null()) {
        observer.EndPhase();
        return static_cast<ExitCode>(campaign.at("code").get<int>());
      }
    }
    std::this_thread::sleep_for(kPeriod);
  }
}

namespace {

/// A new or an empty folder that can be written.
fs::path EmptyFolder(const std::string& target, const std::string& option) {
  const fs::path out = fs::path(target).has_filename() ? fs::path(target) : fs::path(target).parent_path();
  if (fs::exists(out) && !(fs::is_directory(out) && fs::is_empty(out))) {
    throw Failure{kExitBadInput, out.string() + ": not an empty folder, allowed: a new or an empty folder"};
  }
  RequireWritableFolder(option, out);
  return out;
}

/// The files of an answer below `folder`.
void FetchFiles(Session& session, const Json& which, const Json& answer, const fs::path& folder) {
  for (const Json& file : answer.at("files")) {
    const fs::path path = file.at("path").get<std::string>();
    // Nothing is written outside of the folder, also if a stranger answers.
    if (!IsFileBelow(path)) {
      throw Failure{kExitInternalError, "the coordinator names a file outside of the result folder"};
    }
    FetchFile(session, which, path.generic_string(), file.at("size"), folder / path);
  }
}

bool IsThere(Session& session, const std::string& id) {
  try {
    session.Ask("list", {{"id", id}});
    return true;
  } catch (const Failure& failure) {
    if (failure.code != kExitBadInput) throw;
    return false;
  }
}

std::vector<std::string> AllIds(Session& session) {
  std::vector<std::string> ids;
  for (bool more = true; more;) {
    const Json page = Json::parse(session.Ask("ids", {{"after", ids.empty() ? "" : ids.back()}}).text);
    for (const Json& id : page.at("ids")) ids.push_back(id.get<std::string>());
    more = page.at("more").get<bool>() && !page.at("ids").empty();
  }
  return ids;
}

void CopyCampaign(Session& session, const std::string& id, const fs::path& folder) {
  const Json which = {{"id", id}, {"snapshot", MakeUuid()}};
  const Json answer = AskForFiles(session, which);
  FetchFile(session, which, "../campaign.yaml", answer.at("text_size"), folder / "campaign.yaml");
  FetchFiles(session, which, answer, folder / "results");
  WriteFile(folder / "state.json", answer.at("state_json").get<std::string>());
}

/// False: the campaign was deleted meanwhile. Files that are written or replaced while they are copied are
/// copied again.
bool BackUpCampaign(Session& session, const std::string& id, const fs::path& folder) {
  for (int attempt = 1;; ++attempt) {
    try {
      CopyCampaign(session, id, folder);
      return true;
    } catch (const Failure&) {
      fs::remove_all(folder);
      if (!IsThere(session, id)) return false;
      if (attempt == kMostAttempts) throw;
    }
  }
}

}  // namespace

// Into a folder beside the one that is asked for, which appears as a whole.
FetchedCampaign FetchCampaign(Session& session, const std::string& id, const std::string& target) {
  const fs::path out = EmptyFolder(target, "--out");
  const fs::path incomplete = out.string() + ".dispersa-fetch";
  const Json answer = AskForFiles(session, {{"id", id}});
  fs::remove_all(incomplete);  // of a fetch that was killed
  fs::create_directories(incomplete);
  FetchFiles(session, {{"id", answer.at("id")}}, answer, incomplete);
  try {
    RequireAllCases(incomplete, answer);
    RequireWhole(incomplete, answer);
  } catch (...) {
    fs::remove_all(incomplete);
    throw;
  }
  fs::rename(incomplete, out);
  return {answer.at("id"), out};
}

std::uint64_t BackUp(Session& session, const std::string& target) {
  const fs::path out = EmptyFolder(target, "the folder");
  const fs::path incomplete = out.string() + ".dispersa-backup";
  fs::remove_all(incomplete);  // of a backup that was killed
  fs::create_directories(incomplete);
  std::uint64_t campaigns = 0;
  for (const std::string& id : AllIds(session)) {
    if (!IsFileBelow(id))
      throw Failure{kExitInternalError, "the coordinator names a campaign that cannot be a folder"};
    campaigns += BackUpCampaign(session, id, incomplete / id);
  }
  // After the campaigns: what was deleted meanwhile has its line.
  FetchFiles(session, {{"id", ""}}, AskForFiles(session, {{"id", ""}}), incomplete);
  fs::rename(incomplete, out);
  return campaigns;
}

}  // namespace dispersa
