// dispersa fsck: whether a result folder or a data folder is as it was written.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "services/cli/command.h"

namespace dispersa {
namespace {

struct FsckOptions {
  std::string directory;
  bool repair = false;
};

ExitCode Fsck(const FsckOptions& options, const GlobalOptions& global) {
  const std::vector<FolderProblem> problems = CheckFolder(
      options.directory, options.repair, global.service == nullptr ? nullptr : global.service->check_data);
  const auto mended =
      std::count_if(problems.begin(), problems.end(), [](const auto& one) { return one.is_mended; });
  if (global.json) {
    nlohmann::ordered_json object = {{"schema", "dispersa/fsck/1"},
                                     {"directory", options.directory},
                                     {"problems", nlohmann::ordered_json::array()}};
    for (const FolderProblem& one : problems)
      object["problems"].push_back(
          {{"file", one.file}, {"what", one.what}, {"mend", one.mend}, {"mended", one.is_mended}});
    fmt::print("{}\n", object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else {
    for (const FolderProblem& one : problems)
      fmt::print("{}: {}, {}{}\n", one.file, one.what, one.is_mended ? "mended: " : "", one.mend);
    if (problems.empty()) fmt::print("{}: sound\n", options.directory);
  }
  return mended == std::ssize(problems) ? kExitDone : kExitInternalError;
}

}  // namespace

void AddFsckCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<FsckOptions>();
  CLI::App* command = app.add_subcommand("fsck", "check that the files of a folder are as they were written");
  command
      ->add_option("directory", options->directory,
                   "result folder, or data folder of a coordinator that does not run")
      ->required()
      ->type_name(kFolderType);
  command->add_flag("--repair", options->repair, "make anew what the other files of the folder allow");
  command->footer(
      "Examples: dispersa fsck results/table3-1a2b3c4d\n"
      "          dispersa fsck /var/lib/dispersa --repair\n"
      "Exit code 0: sound, or all is mended. 1: damage is left. 2: the folder is neither, or in use.");
  Bind(command, invocation, options, Fsck);
}

}  // namespace dispersa
