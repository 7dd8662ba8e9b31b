// dispersa export: the results of a folder for other tools.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "core/report/cases_csv.h"
#include "core/report/export.h"
#include "core/report/output_file.h"
#include "services/cli/command.h"
#include "services/cli/stored_campaign.h"

namespace dispersa {
namespace {

enum class ExportFormat { kCsv, kJsonLines, kJUnit };

struct ExportOptions {
  std::string directory;
  ExportFormat format = ExportFormat::kCsv;
  std::string out;
};

ExitCode Export(const ExportOptions& options) {
  const StoredCampaign stored = OpenStored(options.directory);
  switch (options.format) {
    case ExportFormat::kCsv:
      WriteCasesCsv(stored.folder, options.out);
      break;
    case ExportFormat::kJsonLines:
      ExportJsonLines(stored.folder, options.out);
      break;
    case ExportFormat::kJUnit:
      WriteFile(options.out, JUnitXml(BuildSummary(stored.folder, stored.campaign)));
      break;
  }
  fmt::print("export: {}\n", options.out);
  return kExitDone;
}

}  // namespace

void AddExportCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand("export", "write the results of a folder for other tools");
  command->add_option("directory", options->directory, "result folder")->required();
  command
      ->add_option("--format", options->format,
                   "csv or jsonl: one line a case; junit: a test case a requirement")
      ->required()
      ->transform(CLI::CheckedTransformer(std::map<std::string, ExportFormat>{
          {"csv", ExportFormat::kCsv}, {"jsonl", ExportFormat::kJsonLines}, {"junit", ExportFormat::kJUnit}}));
  command->add_option("--out", options->out, "file to write")->required();
  command->footer("Example: dispersa export results/table3-1a2b3c4d --format junit --out requirements.xml");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions&) { return Export(*options); };
  });
}

}  // namespace dispersa
