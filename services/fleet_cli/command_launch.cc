// dispersa launch: gives a campaign to a coordinator.

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/cli/warn.h"
#include "services/fleet/remote_campaign.h"
#include "services/fleet_cli/session_options.h"
#include "services/log/log.h"
#include "services/program/option_values.h"

namespace dispersa {
namespace {

// A worker checks a control law from a shared object before it flies.
constexpr std::chrono::seconds kCheckPatience(30);

struct LaunchOptions {
  std::string campaign;
  CampaignOverrides overrides;
  std::optional<int> priority;
  std::vector<std::string> labels;
};

ExitCode Launch(const LaunchOptions& options, Session& session, const GlobalOptions& global) {
  const Campaign campaign = LoadAndWarn(options.campaign, options.overrides);
  const std::string state = LaunchCampaign(session, campaign, options.priority, options.labels);
  const bool is_checked = !campaign.autopilot.plugin || AwaitCheck(session, campaign.id, kCheckPatience);
  if (!is_checked && !global.json) Tell("waiting for a check\n");
  return Answer(global,
                {{"schema", "dispersa/launch/1"},
                 {"id", campaign.id},
                 {"flight_id", campaign.flight_id},
                 {"state", state},
                 {"checked", is_checked}},
                campaign.id + "\n");
}

}  // namespace

void AddLaunchCommand(CLI::App& app, Invocation& invocation) {
  const auto options = std::make_shared<LaunchOptions>();
  CLI::App* command = app.add_subcommand("launch", "give a campaign to a coordinator and print its id");
  command->add_option("campaign", options->campaign, "campaign file")->required()->type_name(kYamlType);
  command->add_option("--cases", options->overrides.cases, "number of cases, instead of the file's")
      ->transform(WholeNumber(1, kMostCases));
  command->add_option("--seed", options->overrides.seed, "seed, instead of the file's");
  command
      ->add_option("--priority", options->priority,
                   "campaigns of higher priority fly first; default 0; launched again: as before")
      ->transform(WholeNumber(-1000, 1000));
  command
      ->add_option("--label", options->labels,
                   "KEY=VALUE to find the campaign by, as commit=1a2b3c4; may be given several times")
      ->type_name("TEXT");
  command->footer("Example: dispersa launch campaigns/table3.yaml --cases 5000 --peer coordinator-host");
  BindSession(command, invocation, [options](Session& session, const GlobalOptions& global) {
    return Launch(*options, session, global);
  });
}

}  // namespace dispersa
