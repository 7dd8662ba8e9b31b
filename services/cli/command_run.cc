// dispersa run: a campaign from the file to the report.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "core/results/text.h"
#include "services/cli/campaign_output.h"
#include "services/cli/command.h"
#include "services/cli/terminal_observer.h"
#include "services/log/log.h"
#include "services/program/error_json.h"
#include "services/program/option_values.h"
#include "services/program/stop_signal.h"

namespace dispersa {
namespace {

struct RunCommand {
  RunRequest request;
  RunOptions run;
  std::string shard_text;
  bool open = false;
};

std::string ResumeCommand(const RunCommand& options, const std::filesystem::path& directory) {
  std::string command = "dispersa run " + ShellWord(options.request.campaign.name);
  const CampaignOverrides& overrides = options.request.overrides;
  if (overrides.cases) command += fmt::format(" --cases {}", *overrides.cases);
  if (overrides.seed) command += fmt::format(" --seed {}", *overrides.seed);
  if (overrides.autopilot) command += " --autopilot " + ShellWord(*overrides.autopilot);
  if (options.run.workers >= 0) command += fmt::format(" --workers {}", options.run.workers);
  if (options.run.threads > 0) command += fmt::format(" --threads {}", options.run.threads);
  if (const auto& shard = options.request.shard)
    command += fmt::format(" --shard {}/{}", shard->index, shard->count);
  if (!options.request.after.empty()) command += " --after " + ShellWord(options.request.after);
  if (!options.request.fresh.empty()) command += " --fresh " + ShellWord(options.request.fresh);
  if (options.run.gate) command += " --gate";
  return command + " --out " + ShellWord(directory.string()) + " --resume";
}

/// No verdict: it is the merged campaign's.
void PrintShare(const RunResult& result, const std::filesystem::path& directory,
                const GlobalOptions& global) {
  Answer(global,
         {{"schema", "dispersa/share/1"},
          {"cases", result.cases},
          {"flown", result.flown},
          {"directory", directory.string()}},
         fmt::format("share: {} of {} cases flown, next: {}\nresult: {}\n", result.flown, result.cases,
                     result.flown < result.cases ? "the same command with --resume"
                                                 : "'dispersa merge' when all shares are flown",
                     directory.string()));
}

/// A share is flown in this process and judged when it is merged: options of both are refused.
void CheckShare(const RunCommand& options) {
  if (!options.request.shard) {
    if (!options.request.after.empty())
      throw InputError("--after: only shards are flown in rounds", "--after with --shard");
    return;
  }
  if (options.run.workers > 0)
    throw InputError("--workers: a share is flown in this process, without workers",
                     "--threads N, or --workers 0");
  const ReflownFlights usual;
  const std::pair<const char*, bool> of_reports[] = {
      {"--gate", options.run.gate},
      {"--open", options.open},
      {"--fresh", !options.request.fresh.empty()},
      {"--no-histories", options.run.reflown.none},
      {"--envelope", options.run.reflown.envelope != usual.envelope}};
  for (const auto& [option, is_given] : of_reports)
    if (is_given)
      throw InputError(fmt::format("{}: a share has no verdict and no report", option),
                       fmt::format("`dispersa merge` with {}", option));
}

/// "2/7".
CLI::Validator ShardText(std::optional<Shard>& shard) {
  return CLI::Validator(
      [&shard](std::string& text) -> std::string {
        const char* const end = text.data() + text.size();
        Shard read;
        const auto index = std::from_chars(text.data(), end, read.index);
        const bool is_divided = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
        const auto count = is_divided ? std::from_chars(index.ptr + 1, end, read.count) : index;
        if (!is_divided || count.ec != std::errc() || count.ptr != end || read.index >= read.count ||
            read.count > kMostCases)
          return fmt::format("'{}', allowed: i/N with 0 <= i < N <= {}", text, kMostCases);
        shard = read;
        return "";
      },
      "");
}

ExitCode Fly(const RunCommand& options, const RunOptions& run, PreparedRun prepared,
             const GlobalOptions& global) {
  const std::filesystem::path directory = prepared.folder.directory();
  TerminalObserver observer(global.quiet);
  try {
    const RunResult result = RunCampaign(std::move(prepared), run, observer);
    if (!result.summary) {
      PrintShare(result, directory, global);
      return result.code;
    }
    PrintSummary(*result.summary, directory, global.json);
    if (options.open) OpenInBrowser(std::filesystem::absolute(directory / "report.html").string());
    return result.code;
  } catch (const Interrupted&) {
    observer.EndPhase();
    Tell("interrupted; to continue: {}\n", ResumeCommand(options, directory));
    if (global.json) PrintErrorJson(kExitInterrupted, "interrupted");
    return kExitInterrupted;
  } catch (const ResultError& error) {
    observer.EndPhase();
    if (error.kind() != ResultError::Kind::kDiskFull) throw;
    LogError("{}", error.what());
    Tell("to continue when the disk has space: {}\n", ResumeCommand(options, directory));
    if (global.json) PrintErrorJson(kExitIncomplete, error.what());
    return kExitIncomplete;
  }
}

ExitCode Run(const RunCommand& options, const GlobalOptions& global) {
  CheckShare(options);
  RunOptions run = options.run;
  if (options.request.shard) run.workers = 0;
  if (global.service != nullptr) run.fly_with_workers = global.service->fly_with_workers;
  WorkersOf(run);
  CatchStopSignals();
  try {
    return Fly(options, run, PrepareRun(options.request, StopRequested), global);
  } catch (const Interrupted&) {
    Tell("interrupted before the first case\n");
    if (global.json) PrintErrorJson(kExitInterrupted, "interrupted");
    return kExitInterrupted;
  }
}

}  // namespace

void AddRunCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<RunCommand>();
  CLI::App* command =
      app.add_subcommand("run", "fly a campaign on local workers and write its result folder");
  RunRequest& request = options->request;
  command->add_option("campaign", request.campaign.name, "campaign file")->required()->type_name(kYamlType);
  command
      ->add_option("--workers", options->run.workers,
                   "worker processes; default: the usable cores; 0 flies in this process without DDS")
      ->transform(WholeNumber(0, 1024));
  command
      ->add_option("--threads", options->run.threads,
                   "threads that fly in this process with --workers 0; default: the usable cores")
      ->transform(WholeNumber(1, 1024));
  command->add_option("--out", request.out, "result folder; default: results/<name>-<first 8 of id>")
      ->type_name(kFolderType);
  command->add_option("--cases", request.overrides.cases, "number of cases, instead of the file's")
      ->transform(WholeNumber(1, kMostCases));
  command->add_option("--seed", request.overrides.seed, "seed, instead of the file's");
  command->add_option("--autopilot", request.overrides.autopilot, "autopilot file, instead of the campaign's")
      ->type_name(kYamlType);
  AddReflownOptions(*command, options->run.reflown);
  command->add_flag("--resume", request.resume, "continue in a result folder of the same flight id");
  AddGateOption(*command, options->run.gate);
  AddOpenOption(*command, options->open);
  AddFreshOption(*command, request.fresh);
  command
      ->add_option(
          "--shard", options->shard_text,
          "fly one of N blocks of the cases, counted from 0, in this process, and judge nothing; 'merge' "
          "makes one folder of all")
      ->type_name("i/N")
      ->check(ShardText(request.shard));
  command
      ->add_option(
          "--after", request.after,
          "of a shard: merged folder of the rounds before, in a campaign that stops when it is decided")
      ->type_name(kFolderType);
  command->footer(
      "Example: dispersa run campaigns/table3.yaml --cases 200 --out results/trial\n"
      "         dispersa run campaigns/table3.yaml --cases 500 --out results/trial --resume\n"
      "         dispersa run campaigns/table3.yaml --shard 2/7 --out shares/2");
  Bind(command, invocation, options, Run);
}

}  // namespace dispersa
