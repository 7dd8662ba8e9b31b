// dispersa init: a folder with a campaign that flies, every key with its comment.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/read_value.h"
#include "core/results/output_file.h"
#include "services/cli/command.h"
#include "services/cli/starter_files.h"
#include "services/schema/schema_text.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
  std::string directory;
  std::string from = "slv4";
};

std::vector<std::string> StarterNames() {
  std::vector<std::string> names;
  for (const StarterFile& file : kStarterFiles)
    if (names.empty() || names.back() != file.from) names.push_back(file.from);
  return names;
}

void RequireNewFolder(const std::string& directory) {
  std::error_code error;
  const fs::file_status status = fs::status(directory, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status))
    throw InputError("'" + directory + "' is a file", "a folder that is new or empty");
  if (!fs::is_empty(directory, error) || error)
    throw InputError("'" + directory + "' is not empty" + (error ? ": " + error.message() : ""),
                     "a folder that is new or empty");
}

// Editors find the schema by a file's first line.
std::string WithSchema(const std::string& text) {
  for (const FileKind kind : kFileKinds)
    if (text.find("schema: " + SchemaOf(kind) + "\n") != std::string::npos ||
        text.find("schema: " + SchemaOf(kind) + " ") != std::string::npos)
      return "# yaml-language-server: $schema=schemas/" + NameOf(kind) + ".json\n" + text;
  return text;
}

ExitCode Init(const InitOptions& options, const GlobalOptions& global) {
  RequireNewFolder(options.directory);
  const fs::path directory = options.directory;
  std::error_code error;
  fs::create_directories(directory / "schemas", error);
  if (error)
    throw InputError("'" + options.directory + "' cannot be made: " + error.message(),
                     "a folder to write to");
  std::vector<std::string> written;
  for (const StarterFile& file : kStarterFiles) {
    if (options.from != file.from) continue;
    WriteFile((directory / file.name).string(), WithSchema(file.text));
    written.push_back(file.name);
  }
  for (const FileKind kind : kFileKinds) {
    written.push_back("schemas/" + NameOf(kind) + ".json");
    WriteFile((directory / written.back()).string(), SchemaText(kind, SchemaSet::kSplit));
  }
  const std::string text = fmt::format(
      "{0}: {1}\nNext: cd {0}; dispersa validate --strict campaign.yaml; dispersa run campaign.yaml --cases "
      "20\n",
      options.directory, JoinWords(written));
  return Answer(global,
                {{"schema", "dispersa/init/1"},
                 {"directory", options.directory},
                 {"from", options.from},
                 {"files", written}},
                global.quiet ? "" : text);
}

}  // namespace

void AddInitCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<InitOptions>();
  CLI::App* command = app.add_subcommand("init", "write a folder with a commented campaign that flies");
  command->add_option("directory", options->directory, "folder, new or empty")
      ->required()
      ->type_name(kFolderType);
  command
      ->add_option("--from", options->from,
                   "slv4, with every key explained; or vega, electron, scout from public data")
      ->type_name(fmt::format("{{{}}}", fmt::join(StarterNames(), ",")))
      ->capture_default_str();
  command->footer(
      "Writes campaign, vehicle, autopilot, reference, trajectory problem, and the schemas with which\n"
      "editors complete and check these files.\n"
      "Example: dispersa init first\n"
      "         dispersa init launcher --from vega");
  Bind(command, invocation, options, Init);
}

}  // namespace dispersa
