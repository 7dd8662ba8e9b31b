// dispersa report: the reports of a result folder, made again from what is stored.
#include <memory>
#include <string>
#include <thread>

#include "services/cli/campaign_output.h"
#include "services/cli/command.h"
#include "services/cli/stored_campaign.h"

namespace dispersa {
namespace {

ExitCode Report(const std::string& directory, const GlobalOptions& global) {
  StoredCampaign stored = OpenStored(directory);
  stored.folder.Lock();
  const int threads = static_cast<int>(std::thread::hardware_concurrency());
  const CampaignSummary summary = MakeReports(stored.folder, stored.campaign, threads, global.quiet);
  PrintSummary(summary, stored.folder.directory(), global.json);
  return static_cast<ExitCode>(VerdictExitCode(summary.verdict));
}

}  // namespace

void AddReportCommand(CLI::App& app, Invocation& invocation) {
  auto directory = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("report", "make the reports of a result folder again");
  command->add_option("directory", *directory, "result folder")->required();
  command->footer("Example: dispersa report results/table3-1a2b3c4d");
  command->callback([directory, &invocation] {
    invocation.command = [directory](const GlobalOptions& global) { return Report(*directory, global); };
  });
}

}  // namespace dispersa
