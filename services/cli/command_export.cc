// dispersa export: the results of a folder for other tools.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/analysis/footprints.h"
#include "core/analysis/junit.h"
#include "core/analysis/markdown.h"
#include "core/math/constants.h"
#include "core/results/cases_csv.h"
#include "core/results/export.h"
#include "core/results/output_file.h"
#include "core/results/text.h"
#include "services/cli/command.h"
#include "services/cli/progress.h"
#include "services/cli/stream_beside.h"
#include "services/client/stored_campaign.h"
#include "services/client/writable.h"
#include "services/log/log.h"
#include "services/program/threads.h"

namespace dispersa {
namespace {

enum class ExportFormat { kCsv, kJsonLines, kHdf5, kJUnit, kMarkdown, kGeoJson, kKml };

struct ExportOptions {
  std::string directory;
  ExportFormat format = ExportFormat::kCsv;
  std::string out;
  bool only_varying = false;
};

/// Flies the cases again: their rows do not say where stages separated.
void ExportImpacts(const StoredCampaign& stored, const ExportOptions& options, std::FILE* stream,
                   bool quiet) {
  Progress progress("flights", quiet);
  const std::vector<Footprint> footprints =
      FootprintsOf(stored.folder, stored.campaign, UsableCores(),
                   [&](std::size_t done, std::size_t total) { progress.Show(done, total); });
  const auto text = options.format == ExportFormat::kKml ? Kml : GeoJson;
  WriteFile(options.out, text(stored.campaign, footprints, stored.incomplete));
  for (const Footprint& footprint : footprints) {
    fmt::print(stream, "{}: {} down{}", FootprintTitle(footprint), footprint.points.size(),
               footprint.aloft > 0 ? fmt::format(", {} aloft", footprint.aloft) : "");
    for (std::size_t i = 0; i < footprint.containment.size(); ++i) {
      if (footprint.containment[i].stated != 0.95) continue;
      fmt::print(stream, ", mean {:.4f}° N {:.4f}° E, 95 % ellipse {:.2f} km by {:.2f} km holds {}",
                 footprint.mean.latitude_rad * kDegPerRad, footprint.mean.longitude_rad * kDegPerRad,
                 footprint.ellipses[i].semi_major * 1e-3, footprint.ellipses[i].semi_minor * 1e-3,
                 PercentText(footprint.containment[i].empirical));
    }
    fmt::print(stream, "\n");
  }
}

ExitCode Export(const ExportOptions& options, const GlobalOptions& global) {
  std::FILE* const stream = StreamBeside("--out", options.out, global);
  if (stream == stderr && options.format == ExportFormat::kHdf5)
    throw InputError("--out: HDF5 cannot be written to standard output", "a file");
  if (options.only_varying && options.format != ExportFormat::kCsv)
    throw InputError("--columns: only a CSV file can leave columns out", "--format csv");
  const StoredCampaign stored = OpenStored(options.directory);
  RequireWritableFile("--out", options.out);
  switch (options.format) {
    case ExportFormat::kCsv:
      WriteCasesCsv(stored.folder,
                    options.only_varying ? VaryingColumns(stored.folder, stored.campaign.soundings)
                                         : StoredColumns(stored.folder, stored.campaign.soundings),
                    options.out);
      break;
    case ExportFormat::kJsonLines:
      ExportJsonLines(stored.folder, options.out);
      break;
    case ExportFormat::kHdf5:
      ExportHdf5(stored.folder, options.out, stored.incomplete);
      break;
    case ExportFormat::kGeoJson:
    case ExportFormat::kKml:
      ExportImpacts(stored, options, global.json ? stderr : stream, global.quiet);
      break;
    case ExportFormat::kJUnit:
      WriteFile(options.out, JUnitXml(BuildSummary(stored.folder, stored.campaign)));
      break;
    case ExportFormat::kMarkdown:
      WriteFile(options.out, MarkdownReport(BuildSummary(stored.folder, stored.campaign)));
      break;
  }
  if (global.json) {
    nlohmann::ordered_json object = {{"schema", "dispersa/export/1"}, {"file", options.out}};
    if (!stored.incomplete.empty()) object["incomplete"] = stored.incomplete;
    fmt::print("{}\n", object.dump(2));
  } else if (stream == stdout) {
    fmt::print("export: {}\n", options.out);
  }
  if (stored.incomplete.empty()) return kExitDone;
  LogWarning("{}: {}", options.directory, stored.incomplete);
  return kExitIncomplete;
}

}  // namespace

void AddExportCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand("export", "write the results of a folder for other tools");
  command->add_option("directory", options->directory, "result folder")->required()->type_name(kFolderType);
  const std::map<std::string, ExportFormat> formats = {
      {"csv", ExportFormat::kCsv},          {"geojson", ExportFormat::kGeoJson},
      {"hdf5", ExportFormat::kHdf5},        {"jsonl", ExportFormat::kJsonLines},
      {"junit", ExportFormat::kJUnit},      {"kml", ExportFormat::kKml},
      {"markdown", ExportFormat::kMarkdown}};
  command
      ->add_option(
          "--format", options->format,
          "csv or jsonl: one line for each case; hdf5: one dataset for each column, also of histories; "
          "junit: a test case for each requirement; markdown: verdict, requirements and worst cases for a "
          "merge "
          "request; geojson or kml: impact points of spent stages and lost "
          "flights, whose cases are flown again, and footprints")
      ->required()
      ->transform(CLI::CheckedTransformer(formats).description(CLI::detail::generate_map(formats, true)));
  const std::map<std::string, bool> columns = {{"all", false}, {"varying", true}};
  command
      ->add_option("--columns", options->only_varying,
                   "of a CSV file: varying leaves out inputs and metrics that are the same in all cases")
      ->transform(CLI::CheckedTransformer(columns).description("{all,varying}"))
      ->default_str("all");
  command->add_option("--out", options->out, "file to write; -: standard output")
      ->required()
      ->type_name(kFileType);
  command->footer(
      "Examples: dispersa export results/table3-1a2b3c4d --format junit --out requirements.xml\n"
      "          dispersa export results/table3-1a2b3c4d --format csv --columns varying --out cases.csv");
  Bind(command, invocation, options, Export);
}

}  // namespace dispersa
