// dispersa watch: follow a campaign of a coordinator until it ends.
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "services/cli/campaign_text.h"
#include "services/cli/live_page.h"
#include "services/cli/progress.h"
#include "services/cli/session_options.h"
#include "services/log/log.h"
#include "services/program/option_values.h"
#include "services/program/stop_signal.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds kPeriod(500);
constexpr std::chrono::seconds kPatience(3);  // of one attempt
constexpr std::chrono::seconds kSayAgain(15);

struct WatchOptions {
  bool web = false;
  std::uint16_t port = 0;
};

std::unique_ptr<LiveServer> OpenPage(const std::string& id, const WatchOptions& options) {
  if (!options.web) return nullptr;
  try {
    auto page = std::make_unique<LiveServer>(options.port, LivePage(id));
    Tell("watch: {}\n", page->Url());
    std::fflush(stderr);
    return page;
  } catch (const std::runtime_error& error) {
    throw Failure{kExitBadInput, fmt::format("--port: {}", error.what())};
  }
}

/// Shows a campaign wherever it is watched.
class Watcher {
 public:
  Watcher(LiveServer* page, bool quiet) : page_(page), quiet_(quiet) {}

  void Away(const Session& session) {
    silent_ += kPatience;
    const std::string silence = session.Silence(silent_);
    if (silent_ % kSayAgain == std::chrono::seconds(0)) LogWarning("{}; watch tries again", silence);
    if (page_ != nullptr)
      page_->Show(NoticeParts(silence + "; this page shows the state before. watch tries again."));
  }
  void Show(const Json& status, const std::optional<Json>& tally) {
    silent_ = std::chrono::seconds(0);
    ShowText(status.at("campaigns").at(0));
    if (page_ == nullptr) return;
    LiveParts parts = StatusParts(status);
    parts.merge(NoticeParts(""));
    if (tally) parts.merge(TallyParts(*tally));
    page_->Show(parts);
  }

 private:
  void ShowText(const Json& campaign) {
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

  LiveServer* page_;
  bool quiet_;
  std::optional<Progress> progress_;
  std::string state_;
  std::chrono::seconds silent_{0};
};

ExitCode PrintEnd(const Json& campaign, const GlobalOptions& global) {
  if (global.json) {
    Json object = {{"schema", "dispersa/watch/1"}};
    object.update(campaign);
    fmt::print("{}\n", object.dump(2));
  } else {
    fmt::print("{}", CampaignStatusText(campaign));
  }
  return static_cast<ExitCode>(campaign.at("code").get<int>());
}

// Waits for a coordinator that is away: a launched campaign goes on when the coordinator is back.
ExitCode Watch(const std::string& id, const WatchOptions& options, Session& session,
               const GlobalOptions& global) {
  CatchStopSignals();
  const std::unique_ptr<LiveServer> page = OpenPage(id, options);
  Watcher watcher(page.get(), global.quiet);
  while (!StopRequested()) {
    const auto reply = session.Try(page ? "status" : "list", {{"id", id}}, "", kPatience);
    if (!reply) {
      watcher.Away(session);
      continue;
    }
    const Json status = Json::parse(reply->text);
    const Json& campaign = status.at("campaigns").at(0);
    std::optional<Json> tally;
    // After the status: at the end it has all that the campaign came to.
    if (page) {
      if (const auto answer = session.Try("tally", {{"id", id}}, "", kPatience))
        tally = Json::parse(answer->text);
    }
    watcher.Show(status, tally);
    if (!campaign.at("code").is_null()) {
      if (page) page->End();
      return PrintEnd(campaign, global);
    }
    std::this_thread::sleep_for(kPeriod);
  }
  return kExitInterrupted;
}

}  // namespace

void AddWatchCommand(CLI::App& app, Invocation& invocation) {
  CLI::App* watch =
      app.add_subcommand("watch", "follow a campaign until it ends, and end with its exit code");
  auto options = std::make_shared<WatchOptions>();
  CLI::Option* web =
      watch->add_flag("--web", options->web,
                      "also serve a page for the browsers of this machine, and print its address on stderr");
  watch->add_option("--port", options->port, "port of the page on 127.0.0.1; default: any free port")
      ->needs(web)
      ->transform(WholeNumber(1, 65535));
  watch->footer("Example: dispersa watch 3f2a --web --port 8080");
  BindSession(watch, invocation,
              [id = AddIdOption(watch), options](Session& session, const GlobalOptions& global) {
                return Watch(*id, *options, session, global);
              });
}

}  // namespace dispersa
