// dispersa margins: how much gain, phase and delay a campaign's autopilot can lose along the nominal flight.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include "services/cli/command.h"
#include "services/cli/margins_text.h"
#include "services/cli/warn.h"
#include "services/client/margins_of.h"
#include "services/program/option_values.h"

namespace dispersa {
namespace {

struct MarginsCommand {
  std::string campaign;
  std::optional<std::string> autopilot;
  MarginsOptions margins;
};

ExitCode Margins(const MarginsCommand& options, const GlobalOptions& global) {
  CampaignOverrides overrides;
  overrides.autopilot = options.autopilot;
  overrides.cases = options.margins.cases;
  const Campaign campaign = LoadAndWarn(options.campaign, overrides);
  const MarginsResult result = MarginsOf(campaign, options.margins);
  fmt::print("{}", global.json ? MarginsJson(result).dump(2) + "\n" : MarginsText(result));
  return result.passed ? kExitDone : kExitRequirementFailed;
}

}  // namespace

void AddMarginsCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<MarginsCommand>();
  CLI::App* command =
      app.add_subcommand("margins", "compute and measure gain, phase and delay margins of the autopilot");
  command->add_option("campaign", options->campaign, "campaign file")->required()->type_name(kYamlType);
  command->add_option("--autopilot", options->autopilot, "autopilot file, instead of the campaign's")
      ->type_name(kYamlType);
  command
      ->add_option("--cases", options->margins.cases,
                   "number of dispersed cases of the campaign whose margins are computed too")
      ->transform(WholeNumber(1, kMostCases));
  command
      ->add_option("--frequency-band", options->margins.frequency_band_percent,
                   "bending: each margin is the least with nominal frequencies of the modes, and lowered and "
                   "raised by this percentage (default 15), together and each mode alone")
      ->check(CLI::Range(0.0, 50.0));
  command->add_flag(
      "--drift", options->margins.drift,
      "linearise pitch and yaw with the lateral velocity; its incidence reduces the margin to a lower gain");
  command->footer(
      "The margins are computed from a linearisation at lift-off, max q, ignitions and burnouts. They are "
      "also measured: the gain or\n"
      "delay of the loop is changed in flight until control is lost. Exit code 3: a gate is not met.\n"
      "Example: dispersa margins campaigns/nominal.yaml\n"
      "         dispersa margins campaigns/aero20.yaml --cases 32");
  Bind(command, invocation, options, Margins);
}

}  // namespace dispersa
