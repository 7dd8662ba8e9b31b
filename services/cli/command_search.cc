// dispersa search: the smallest dispersion of a campaign that fails a requirement.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "core/results/output_file.h"
#include "services/cli/command.h"
#include "services/cli/stream_beside.h"
#include "services/cli/terminal_observer.h"
#include "services/cli/warn.h"
#include "services/client/failure_search.h"
#include "services/client/writable.h"
#include "services/program/option_values.h"

namespace dispersa {
namespace {

struct SearchCommand {
  std::string campaign;
  FailureSearchRequest request;
  std::string out;
};

ExitCode SearchFor(const SearchCommand& command, const GlobalOptions& global) {
  const Campaign campaign = LoadAndWarn(command.campaign);
  std::FILE* const stream = StreamBeside("--out", command.out, global);
  RequireWritableFile("--out", command.out);
  TerminalObserver observer(global.quiet);
  const FailureSearch found = SearchForFailure(campaign, command.request, observer);
  const std::string written = found.json.dump(2) + "\n";
  if (!command.out.empty()) WriteFile(command.out, written);
  fmt::print(stream, "{}", global.json ? written : found.text);
  return kExitDone;
}

}  // namespace

void AddSearchCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<SearchCommand>();
  CLI::App* command = app.add_subcommand(
      "search", "find the smallest dispersion that fails a requirement, by a bounded local search");
  command->add_option("campaign", options->campaign, "campaign file")->required()->type_name(kYamlType);
  command
      ->add_option("--metric", options->request.metric,
                   "metric of the requirement; default: the first requirement")
      ->type_name(kMetricType);
  auto* below = command->add_option("--below", options->request.below,
                                    "limit instead of the campaign's; a flight above it fails");
  command
      ->add_option("--above", options->request.above,
                   "limit instead of the campaign's; a flight below it fails")
      ->excludes(below);
  command
      ->add_option("--flights", options->request.options.max_flights,
                   "largest number of flights, default 1000")
      ->transform(WholeNumber(20, 1000000));
  command->add_option("--starts", options->request.options.starts, "number of starting points, default 4")
      ->transform(WholeNumber(1, 100));
  command
      ->add_option("--reach", options->request.options.reach,
                   "farthest distance in standard deviations, default 6")
      ->check(CLI::Range(0.1, 8.0));
  command->add_option("--seed", options->request.seed,
                      "seed of the random flights and of the starting points; default: the campaign's");
  command->add_option("--out", options->out, "file for the object that --json prints")->type_name(kFileType);
  command->footer(
      "Example: dispersa search campaigns/full.yaml --metric pitch_error_peak_deg --below 0.5 --flights "
      "2000");
  Bind(command, invocation, options, SearchFor);
}

}  // namespace dispersa
