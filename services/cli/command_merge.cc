// dispersa merge: one result folder of the shares that schedulers flew apart.

#include <memory>
#include <string>
#include <vector>

#include "services/cli/campaign_output.h"
#include "services/cli/command.h"
#include "services/cli/terminal_observer.h"
#include "services/client/campaign_run.h"
#include "services/client/merge_shares.h"
#include "services/log/log.h"
#include "services/program/stop_signal.h"

namespace dispersa {
namespace {

struct MergeCommand {
  std::vector<std::string> folders;
  std::string out;
  std::string fresh;
  RunOptions run;
};

ExitCode Merge(const MergeCommand& options, const GlobalOptions& global) {
  CatchStopSignals();
  TerminalObserver observer(global.quiet);
  const PreparedRun prepared = MergedRun(options.folders, options.out, options.fresh);
  const RunResult result = ReportFlown(prepared, options.run, observer);
  const CampaignSummary& summary = *result.summary;
  if (summary.flown + summary.quarantined.size() < summary.cases)
    LogInfo("{}: the plan asks for cases {} to {}: fly their shares with --after {}, and merge it with them",
            options.out, result.flown, summary.cases - 1, options.out);
  PrintSummary(summary, prepared.folder.directory(), global.json);
  return result.code;
}

}  // namespace

void AddMergeCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<MergeCommand>();
  CLI::App* command = app.add_subcommand(
      "merge",
      "make one result folder of the shares of a campaign, with the reports and exit code of one run");
  command->add_option("folders", options->folders, "result folders of 'run --shard', in any order")
      ->required()
      ->type_name(kFolderType);
  command->add_option("--out", options->out, "result folder to make")->required()->type_name(kFolderType);
  AddReflownOptions(*command, options->run.reflown);
  AddGateOption(*command, options->run.gate);
  AddFreshOption(*command, options->fresh);
  command->footer("Example: dispersa merge shares/* --out results/table3");
  Bind(command, invocation, options, Merge);
}

}  // namespace dispersa
