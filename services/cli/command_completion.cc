// dispersa completion: what makes a shell complete dispersa's commands, options and values.

#include <map>
#include <memory>
#include <string>

#include "services/cli/command.h"
#include "services/cli/completion_scripts.h"

namespace dispersa {

void AddCompletionCommand(CLI::App& app, Invocation& invocation) {
  static const std::map<std::string, const char*> scripts = {
      {"bash", kBashCompletion}, {"fish", kFishCompletion}, {"zsh", kZshCompletion}};
  auto shell = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("completion", "print a script that completes dispersa's command lines");
  command->add_option("shell", *shell, "shell that reads the script")
      ->required()
      ->check(CLI::IsMember(scripts));
  command->footer(
      "An installation puts these scripts where shells find them. Without one:\n"
      "Examples: source <(dispersa completion bash)\n"
      "          dispersa completion fish > ~/.config/fish/completions/dispersa.fish");
  command->callback([shell, &invocation] {
    invocation.command = [shell](const GlobalOptions& global) {
      const std::string script = scripts.at(*shell);
      return Answer(global, {{"schema", "dispersa/completion/1"}, {"shell", *shell}, {"script", script}},
                    script);
    };
  });
}

}  // namespace dispersa
