// dispersa report: the reports of a result folder, made again from what is stored.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "core/input/input_error.h"
#include "core/results/output_file.h"
#include "services/cli/campaign_output.h"
#include "services/cli/command.h"
#include "services/cli/render_template.h"
#include "services/cli/terminal_observer.h"
#include "services/client/stored_campaign.h"
#include "services/client/writable.h"
#include "services/ledger/campaign_book.h"
#include "services/log/log.h"
#include "services/program/threads.h"

namespace dispersa {
namespace {

struct ReportCommand {
  std::string directory;
  ReflownFlights reflown;
  std::string template_file;
  std::string out;
  bool gate = false;
  bool open = false;
};

/// Nothing is flown and nothing in the folder changes: the template reads summary.json as it stands.
ExitCode Fill(const ReportCommand& options) {
  const StoredCampaign stored = OpenStored(options.directory);
  RequireWritableFile("--out", options.out);
  const std::string text = RenderTemplate(stored.folder.directory() / "summary.json", options.template_file);
  if (options.out.empty()) {
    fmt::print("{}", text);
  } else {
    WriteFile(options.out, text);
  }
  if (!stored.incomplete.empty()) LogWarning("{}: {}", options.directory, stored.incomplete);
  return CampaignExitCode(BuildSummary(stored.folder, stored.campaign).standing.verdict, 0, options.gate);
}

ExitCode ReportAgain(const ReportCommand& options, const GlobalOptions& global) {
  if (!options.template_file.empty()) {
    if (global.json) throw InputError("--template and --json cannot be used together", "one of them");
    return Fill(options);
  }
  if (!options.out.empty())
    throw InputError("--out: the reports are written into the result folder", "--out with --template");
  StoredCampaign stored = OpenStored(options.directory);
  RequireWritableFile("the report", stored.folder.directory() / "report.html");
  stored.folder.Lock();
  TerminalObserver observer(global.quiet);
  const CampaignSummary summary =
      MakeReports(stored.folder, stored.campaign, UsableCores(), options.reflown, observer);
  PrintSummary(summary, stored.folder.directory(), global.json);
  if (options.open) OpenPage(stored.folder.directory() / "report.html");
  return CampaignExitCode(summary.standing.verdict, 0, options.gate);
}

}  // namespace

void AddReportCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ReportCommand>();
  CLI::App* command = app.add_subcommand("report", "write the reports of a result folder again");
  command->add_option("directory", options->directory, "result folder")->required()->type_name(kFolderType);
  AddReflownOptions(*command, options->reflown);
  AddGateOption(*command, options->gate);
  AddOpenOption(*command, options->open);
  command
      ->add_option("--template", options->template_file,
                   "Jinja template to fill from summary.json, instead of writing the reports")
      ->type_name(kFileType);
  command->add_option("--out", options->out, "file for the filled template; default: standard output")
      ->type_name(kFileType);
  command->footer(
      "Examples: dispersa report results/table3-1a2b3c4d\n"
      "          dispersa report results/table3-1a2b3c4d --template campaigns/templates/report.md --out "
      "report.md");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return ReportAgain(*options, global); };
  });
}

}  // namespace dispersa
