#include "services/client/remote_campaign.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <thread>

#include "core/results/output_file.h"
#include "core/results/result_folder.h"
#include "services/client/writable.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kPart = 256 << 10;
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

void FetchFile(Session& session, const std::string& id, const std::string& path, std::uint64_t size,
               const fs::path& target) {
  fs::create_directories(target.parent_path());
  OutputFile file(target);
  for (std::uint64_t offset = 0; offset < size;) {
    const Reply part = session.Ask("read", {{"id", id}, {"path", path}, {"offset", offset}});
    if (part.data.empty())
      throw Failure{kExitInternalError, path + ": it became shorter while it was fetched"};
    file.Write(part.data);
    offset += part.data.size();
  }
  file.Commit();
}

/// The files to fetch, once the coordinator has copied the database.
Json AskForFiles(Session& session, const std::string& id) {
  for (;;) {
    Json answer = Json::parse(session.Ask("files", {{"id", id}}).text);
    if (!answer.contains("state")) return answer;
    std::this_thread::sleep_for(kAskAgain);
  }
}

/// Nobody takes a folder that lacks results for the campaign.
void RequireAllCases(const fs::path& directory, const Json& answer) {
  const auto promised = answer.value("done", std::uint64_t{0});
  const bool has_database = fs::exists(directory / "results.sqlite");
  const std::uint64_t arrived = has_database ? ResultFolder::Open(directory).CaseCount() : 0;
  if (arrived >= promised) return;
  throw Failure{kExitIncomplete,
                fmt::format("campaign {} has {} cases and {} of them arrived: nothing was written; "
                            "fetch it again",
                            answer.at("id").get<std::string>().substr(0, 8), promised, arrived)};
}

/// Whether it names a file below the folder that it is relative to, without a detour.
bool IsFileBelow(const fs::path& path) {
  return path.has_filename() && path != "." && !path.is_absolute() && path.lexically_normal() == path &&
         *path.begin() != "..";
}

}  // namespace

std::string LaunchCampaign(Session& session, const Campaign& campaign, int priority) {
  const Json launch = {{"id", campaign.id}, {"flight_id", campaign.flight_id}, {"priority", priority}};
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

// Into a folder beside the one that is asked for, which appears as a whole.
FetchedCampaign FetchCampaign(Session& session, const std::string& id, const std::string& target) {
  const fs::path out = fs::path(target).has_filename() ? fs::path(target) : fs::path(target).parent_path();
  if (fs::exists(out) && !(fs::is_directory(out) && fs::is_empty(out))) {
    throw Failure{kExitBadInput, out.string() + ": not an empty folder, allowed: a new or an empty folder"};
  }
  RequireWritableFolder("--out", out);
  const fs::path incomplete = out.string() + ".dispersa-fetch";
  const Json answer = AskForFiles(session, id);
  fs::remove_all(incomplete);  // of a fetch that was killed
  fs::create_directories(incomplete);
  for (const Json& file : answer.at("files")) {
    const fs::path path = file.at("path").get<std::string>();
    // Nothing is written outside of the folder, also if a stranger answers.
    if (!IsFileBelow(path)) {
      throw Failure{kExitInternalError, "the coordinator names a file outside of the result folder"};
    }
    FetchFile(session, answer.at("id"), path.generic_string(), file.at("size"), incomplete / path);
  }
  try {
    RequireAllCases(incomplete, answer);
  } catch (...) {
    fs::remove_all(incomplete);
    throw;
  }
  fs::rename(incomplete, out);
  return {answer.at("id"), out};
}

}  // namespace dispersa
