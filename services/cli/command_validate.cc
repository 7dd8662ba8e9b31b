// dispersa validate: what is wrong with input files.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "services/cli/command.h"

namespace dispersa {
namespace {

nlohmann::ordered_json Json(const InputProblem& problem) {
  return {{"file", problem.file}, {"line", problem.line},       {"column", problem.column},
          {"path", problem.path}, {"message", problem.message}, {"allowed", problem.allowed}};
}

ExitCode Validate(const std::vector<std::string>& files, const GlobalOptions& global) {
  auto errors = nlohmann::ordered_json::array();
  for (const std::string& file : files) {
    const std::vector<InputProblem> problems = ValidateFile(file);
    for (const InputProblem& problem : problems) {
      errors.push_back(Json(problem));
      if (!global.json) fmt::print("{}\n", problem.Text());
    }
    if (problems.empty() && !global.json && !global.quiet) fmt::print("{}: valid\n", file);
  }
  const bool valid = errors.empty();
  if (global.json) {
    const nlohmann::ordered_json report = {
        {"schema", "dispersa/validate/1"}, {"valid", valid}, {"errors", std::move(errors)}};
    fmt::print("{}\n", report.dump(2));
  }
  return valid ? kExitDone : kExitBadInput;
}

}  // namespace

void AddValidateCommand(CLI::App& app, Invocation& invocation) {
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* command =
      app.add_subcommand("validate", "check campaign, vehicle, reference and autopilot files");
  command->add_option("files", *files, "files of any kind")->required();
  command->footer("Example: dispersa validate campaigns/*.yaml campaigns/vehicles/slv4.yaml");
  command->callback([files, &invocation] {
    invocation.command = [files](const GlobalOptions& global) { return Validate(*files, global); };
  });
}

}  // namespace dispersa
