// dispersa launch: gives a campaign to a coordinator.
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "services/cli/session.h"
#include "services/cli/warn.h"
#include "services/coordinator/whole_number.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kPart = 256 << 10;
constexpr std::chrono::milliseconds kAskAgain(200);

struct LaunchOptions {
  std::string campaign;
  CampaignOverrides overrides;
  int priority = 0;
};

void Upload(Session& session, const Campaign& campaign) {
  const std::string& text = campaign.canonical_yaml;
  std::uint64_t received = 0;
  do {
    const Json part = {{"id", campaign.id}, {"size", text.size()}, {"offset", received}};
    received = Json::parse(session.Ask("upload", part, text.substr(received, kPart)).text).at("received");
  } while (received < text.size());
}

ExitCode Launch(const LaunchOptions& options, Session& session, const GlobalOptions& global) {
  const Campaign campaign = LoadAndWarn(options.campaign, options.overrides);
  const Json launch = {
      {"id", campaign.id}, {"flight_id", campaign.flight_id}, {"priority", options.priority}};
  std::string state;
  for (;;) {
    state = Json::parse(session.Ask("launch", launch).text).at("state");
    if (state == "unknown") {
      Upload(session, campaign);  // again if the coordinator is started again meanwhile
    } else if (state == "checked") {
      std::this_thread::sleep_for(kAskAgain);
    } else {
      break;
    }
  }
  if (global.json) {
    const Json object = {{"schema", "dispersa/launch/1"},
                         {"id", campaign.id},
                         {"flight_id", campaign.flight_id},
                         {"state", state}};
    fmt::print("{}\n", object.dump(2));
  } else {
    fmt::print("{}\n", campaign.id);
  }
  return kExitDone;
}

}  // namespace

void AddLaunchCommand(CLI::App& app, Invocation& invocation) {
  const auto options = std::make_shared<LaunchOptions>();
  CLI::App* command = app.add_subcommand("launch", "give a campaign to a coordinator and print its id");
  command->add_option("campaign", options->campaign, "campaign file")->required()->type_name(kFileType);
  command->add_option("--cases", options->overrides.cases, "number of cases, instead of the file's")
      ->check(CaseCountProblem);
  command->add_option("--seed", options->overrides.seed, "seed, instead of the file's");
  command->add_option("--priority", options->priority, "campaigns of a higher one fly first; default 0")
      ->check(CLI::Range(-1000, 1000));
  command->footer("Example: dispersa launch campaigns/table3.yaml --cases 5000 --peer coordinator-host");
  BindSession(command, invocation, [options](Session& session, const GlobalOptions& global) {
    return Launch(*options, session, global);
  });
}

}  // namespace dispersa
