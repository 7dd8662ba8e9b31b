// dispersa report: the reports of a result folder, made again from what is stored.
#include <memory>
#include <string>

#include "services/cli/campaign_output.h"
#include "services/cli/command.h"
#include "services/cli/stored_campaign.h"
#include "services/coordinator/threads.h"

namespace dispersa {
namespace {

struct ReportCommand {
  std::string directory;
  bool no_histories = false;
};

ExitCode Report(const ReportCommand& options, const GlobalOptions& global) {
  StoredCampaign stored = OpenStored(options.directory);
  stored.folder.Lock();
  const CampaignSummary summary =
      MakeReports(stored.folder, stored.campaign, UsableCores(), global.quiet, !options.no_histories);
  PrintSummary(summary, stored.folder.directory(), global.json);
  return static_cast<ExitCode>(VerdictExitCode(summary.verdict));
}

}  // namespace

void AddReportCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ReportCommand>();
  CLI::App* command = app.add_subcommand("report", "make the reports of a result folder again");
  command->add_option("directory", options->directory, "result folder")->required();
  command->add_flag("--no-histories", options->no_histories, "fly no case again for the report");
  command->footer("Example: dispersa report results/table3-1a2b3c4d");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return Report(*options, global); };
  });
}

}  // namespace dispersa
