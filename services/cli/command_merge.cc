// dispersa merge: one result folder of the shares that schedulers flew apart.

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "core/results/text.h"
#include "services/cli/campaign_output.h"
#include "services/cli/command.h"
#include "services/cli/terminal_observer.h"
#include "services/client/campaign_run.h"
#include "services/client/merge_shares.h"
#include "services/program/error_json.h"
#include "services/program/stop_signal.h"

namespace dispersa {
namespace {

struct MergeCommand {
  MergeRequest request;
  RunOptions run;
  bool open = false;
};

/// Of a campaign that is not complete yet.
std::string NextCommands(const CampaignSummary& summary, const std::string& out) {
  const std::uint64_t settled = summary.flown + summary.quarantined.size();
  if (settled == summary.cases)
    return fmt::format("'dispersa run CAMPAIGN --out {} --resume' flies the quarantined cases again",
                       ShellWord(out));
  return fmt::format(
      "fly {} with 'dispersa run CAMPAIGN --shard i/N --after {}', then 'dispersa merge SHARES --out {} "
      "--resume'",
      CasesText({settled, summary.cases}), ShellWord(out), ShellWord(out));
}

ExitCode Merge(const MergeCommand& options, const GlobalOptions& global) {
  CatchStopSignals();
  TerminalObserver observer(global.quiet);
  try {
    const PreparedRun prepared = MergedRun(options.request, StopRequested);
    const RunResult result = ReportFlown(prepared, options.run, observer);
    PrintSummary(*result.summary, prepared.folder.directory(), global.json,
                 NextCommands(*result.summary, options.request.out));
    if (options.open)
      OpenInBrowser(std::filesystem::absolute(prepared.folder.directory() / "report.html").string());
    return result.code;
  } catch (const Interrupted&) {
    observer.EndPhase();
    Tell("interrupted; to continue: the same command with --resume\n");
    if (global.json) PrintErrorJson(kExitInterrupted, "interrupted");
    return kExitInterrupted;
  } catch (const ResultError& error) {
    observer.EndPhase();
    if (error.kind() == ResultError::Kind::kDiskFull)
      Tell("to continue when the disk has space: the same command with --resume\n");
    throw;
  }
}

}  // namespace

void AddMergeCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<MergeCommand>();
  CLI::App* command = app.add_subcommand(
      "merge",
      "make one result folder of the shares of a campaign, with the reports and exit code of one run");
  command->add_option("folders", options->request.folders, "folders of 'run --shard', in any order")
      ->required()
      ->type_name(kFolderType);
  command->add_option("--out", options->request.out, "result folder to make")
      ->required()
      ->type_name(kFolderType);
  command->add_flag(
      "--resume", options->request.resume,
      "continue in a folder of the same flight id: after an interruption, or with the next round");
  AddReflownOptions(*command, options->run.reflown);
  AddGateOption(*command, options->run.gate);
  AddOpenOption(*command, options->open);
  AddFreshOption(*command, options->request.fresh);
  command->footer("Example: dispersa merge shares/* --out results/table3");
  Bind(command, invocation, options, Merge);
}

}  // namespace dispersa
