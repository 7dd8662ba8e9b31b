// dispersa fetch, backup: the result folder of a campaign that a coordinator has flown, and all that it has.
#include <fmt/format.h>

#include <memory>

#include "services/fleet/remote_campaign.h"
#include "services/fleet_cli/session_options.h"

namespace dispersa {
namespace {

ExitCode Fetch(const std::string& id, const std::string& target, Session& session,
               const GlobalOptions& global) {
  const FetchedCampaign fetched = FetchCampaign(session, id, target);
  const std::string directory = fetched.directory.string();
  return Answer(global, {{"schema", "dispersa/fetch/1"}, {"id", fetched.id}, {"directory", directory}},
                "result: " + directory + "\n");
}

ExitCode Backup(const std::string& target, Session& session, const GlobalOptions& global) {
  const std::uint64_t campaigns = BackUp(session, target);
  return Answer(global, {{"schema", "dispersa/backup/1"}, {"directory", target}, {"campaigns", campaigns}},
                fmt::format("backup of {} campaign{}: {}\n", campaigns, campaigns == 1 ? "" : "s", target));
}

}  // namespace

void AddFetchCommand(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("fetch", "copy the result folder of a campaign that has ended");
  const auto id = AddIdOption(command), out = std::make_shared<std::string>();
  command->add_option("--out", *out, "folder, new or empty")->required()->type_name(kFolderType);
  command->footer("Example: dispersa fetch 1a2b3c4d --out results/table3 --peer coordinator-host");
  BindSession(command, invocation, [id, out](Session& session, const GlobalOptions& global) {
    return Fetch(*id, *out, session, global);
  });

  CLI::App* backup = app.add_subcommand("backup", "copy all campaigns of a coordinator while it flies them");
  const auto folder = std::make_shared<std::string>();
  backup->add_option("folder", *folder, "folder, new or empty")->required()->type_name(kFolderType);
  backup->footer(
      "Example: dispersa backup /backup/monday --peer coordinator-host\n"
      "`dispersa-coordinator --data /backup/monday` goes on from there.");
  BindSession(backup, invocation, [folder](Session& session, const GlobalOptions& global) {
    return Backup(*folder, session, global);
  });
}

}  // namespace dispersa
