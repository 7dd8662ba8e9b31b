// dispersa schema: JSON Schemas of the input files, for editors.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "core/input/input_error.h"
#include "core/input/read_value.h"
#include "core/results/output_file.h"
#include "services/cli/command.h"
#include "services/client/writable.h"
#include "services/schema/schema_text.h"

namespace dispersa {
namespace {

struct SchemaOptions {
  std::string kind;
  std::string out;
  std::string all;
};

std::vector<std::string> KindNames() {
  std::vector<std::string> names;
  for (const FileKind kind : kFileKinds) names.push_back(NameOf(kind));
  return names;
}

FileKind KindOf(const std::string& name) {
  return *std::find_if(std::begin(kFileKinds), std::end(kFileKinds),
                       [&](FileKind kind) { return NameOf(kind) == name; });
}

ExitCode TellWritten(const std::vector<std::string>& files, const GlobalOptions& global) {
  std::string text;
  for (const std::string& file : files) text += "schema: " + file + "\n";
  return Answer(global, {{"schema", "dispersa/schema/1"}, {"files", files}}, global.quiet ? "" : text);
}

std::vector<std::string> WriteAll(const std::filesystem::path& folder) {
  RequireWritableFolder("--all", folder);
  std::filesystem::create_directories(folder);
  std::vector<std::string> files;
  for (const FileKind kind : kFileKinds) {
    files.push_back((folder / (NameOf(kind) + ".json")).string());
    WriteFile(files.back(), SchemaText(kind, SchemaSet::kSplit));
  }
  return files;
}

ExitCode Schema(const SchemaOptions& options, const GlobalOptions& global) {
  if (options.kind.empty() == options.all.empty())
    throw InputError("give either a kind of file or --all",
                     "one of " + JoinWords(KindNames()) + ", or --all DIR");
  if (!options.all.empty()) {
    if (!options.out.empty()) throw InputError("--out and --all cannot be used together", "one of them");
    return TellWritten(WriteAll(options.all), global);
  }
  const FileKind kind = KindOf(options.kind);
  RequireWritableFile("--out", options.out);
  const std::string text = SchemaText(kind, SchemaSet::kWhole);
  if (options.out.empty()) {
    fmt::print("{}", text);
    return kExitDone;
  }
  WriteFile(options.out, text);
  return TellWritten({options.out}, global);
}

}  // namespace

void AddSchemaCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<SchemaOptions>();
  CLI::App* command =
      app.add_subcommand("schema", "write the JSON Schema of a kind of input file, for editors");
  command->add_option("kind", options->kind, "kind of input file")
      ->type_name(fmt::format("{{{}}}", fmt::join(KindNames(), ",")));
  command->add_option("--out", options->out, "file to write, else standard output")->type_name(kFileType);
  command
      ->add_option("--all", options->all, "folder for the schemas of all kinds, which refer to one another")
      ->type_name(kFolderType);
  command->footer(
      "An editor with a YAML language server completes and checks a file whose first line is\n"
      "`# yaml-language-server: $schema=campaign.json`. `dispersa validate` checks more.\n"
      "Example: dispersa schema campaign --out campaign.json\n"
      "         dispersa schema --all schemas");
  Bind(command, invocation, options, Schema);
}

}  // namespace dispersa
