// dispersa report: the reports of a result folder, made again from what is stored.

#include <memory>
#include <string>

#include "core/flight/engine_version.h"
#include "services/cli/campaign_output.h"
#include "services/cli/command.h"
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
  bool gate = false;
  bool open = false;
};

ExitCode ReportAgain(const ReportCommand& options, const GlobalOptions& global) {
  StoredCampaign stored = OpenStored(options.directory);
  RequireWritableFile("the report", stored.folder.directory() / "report.html");
  stored.folder.Lock();
  const std::string engine = stored.folder.Provenance("engine");
  const bool is_ours = engine == EngineVersion();
  TerminalObserver observer(global.quiet);
  const CampaignSummary summary =
      MakeReports(stored.folder, stored.campaign, UsableCores(), options.reflown, observer);
  if (!is_ours && !options.reflown.none) {
    LogWarning(
        "{}: flown by engine {}, and this one, {}, flew nothing: {}", options.directory, engine,
        EngineVersion(),
        summary.envelope ? "the stored histories are drawn" : "it has no stored histories that are whole");
  }
  PrintSummary(summary, stored.folder.directory(), global.json);
  if (options.open)
    OpenInBrowser(std::filesystem::absolute(stored.folder.directory() / "report.html").string());
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
  command->footer("Example: dispersa report results/table3-1a2b3c4d");
  Bind(command, invocation, options, ReportAgain);
}

}  // namespace dispersa
