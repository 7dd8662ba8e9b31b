// dispersa watch: follow a campaign of a coordinator until it ends.

#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "core/input/input_error.h"
#include "services/cli/campaign_output.h"
#include "services/cli/progress.h"
#include "services/fleet_cli/campaign_text.h"
#include "services/fleet_cli/session_options.h"
#include "services/log/log.h"
#include "services/program/stop_signal.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds kPeriod(500);
constexpr std::chrono::seconds kPatience(3);  // of one attempt
constexpr std::chrono::seconds kSayAgain(15);

/// Opens the campaign's page in the coordinator's web application.
void OpenCampaignPage(const std::string& id, Session& session) {
  const Json status = Json::parse(session.Ask("status", {{"id", id}}).text);
  const Json& web = status.at("web");
  if (web.is_null())
    throw InputError("--web: this coordinator serves no pages", "a coordinator that was started with --web");
  const std::string path = "/campaign/" + status.at("campaigns").at(0).at("id").get<std::string>();
  const std::string address = web.at("address");
  if (web.at("behind_tls").get<bool>()) {
    Tell("watch: {} below the address of the proxy before {}\n", path, address);
    return;
  }
  const std::string page = "http://" + address + path;
  Tell("watch: {} on the coordinator's machine\n", page);
  OpenInBrowser(page);
}

/// Shows a campaign in the terminal.
class Watcher {
 public:
  explicit Watcher(bool quiet) : quiet_(quiet) {}

  void Away(const Session& session) {
    silent_ += kPatience;
    if (silent_ % kSayAgain == std::chrono::seconds(0))
      LogWarning("{}; watch tries again", session.Silence(silent_));
  }
  void Show(const Json& campaign) {
    silent_ = std::chrono::seconds(0);
    if (!campaign.at("code").is_null()) return progress_.reset();
    if (!progress_) progress_.emplace(campaign.at("name").get<std::string>(), quiet_);
    const std::string before = std::exchange(state_, campaign.at("state").get<std::string>());
    std::string note = state_;
    if (!campaign.at("problem").is_null()) note += "; " + campaign.at("problem").get<std::string>();
    for (const Json& standing : campaign.at("requirements")) note += "; " + StandingText(standing);
    // A state that does not change is printed once.
    if (state_ != before || state_ == "flying")
      progress_->Show(campaign.at("done"), campaign.at("total"), note);
  }

 private:
  bool quiet_;
  std::optional<Progress> progress_;
  std::string state_;
  std::chrono::seconds silent_{0};
};

ExitCode PrintEnd(const Json& campaign, const GlobalOptions& global) {
  Json object = {{"schema", "dispersa/watch/1"}};
  object.update(campaign);
  Answer(global, object, CampaignStatusText(campaign));
  return static_cast<ExitCode>(campaign.at("code").get<int>());
}

// Waits for a coordinator that is away: a launched campaign goes on when the coordinator is back.
ExitCode Watch(const std::string& id, bool web, Session& session, const GlobalOptions& global) {
  CatchStopSignals();
  if (web) OpenCampaignPage(id, session);
  Watcher watcher(global.quiet);
  while (!StopRequested()) {
    const auto reply = session.Try("list", {{"id", id}}, "", kPatience);
    if (!reply) {
      watcher.Away(session);
      continue;
    }
    const Json campaign = Json::parse(reply->text).at("campaigns").at(0);
    watcher.Show(campaign);
    if (!campaign.at("code").is_null()) return PrintEnd(campaign, global);
    std::this_thread::sleep_for(kPeriod);
  }
  return kExitInterrupted;
}

}  // namespace

void AddWatchCommand(CLI::App& app, Invocation& invocation) {
  CLI::App* watch =
      app.add_subcommand("watch", "follow a campaign until it ends, and end with its exit code");
  auto web = std::make_shared<bool>(false);
  watch->add_flag(
      "--web", *web,
      "also open the campaign's page of a coordinator with --web, and print its address on stderr");
  watch->footer("Example: dispersa watch 3f2a --web");
  BindSession(watch, invocation,
              [id = AddIdOption(watch), web](Session& session, const GlobalOptions& global) {
                return Watch(*id, *web, session, global);
              });
}

}  // namespace dispersa
