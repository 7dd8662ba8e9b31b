// dispersa convert: weather as services give it, as a table of our own.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/campaign_yaml/parse_sounding.h"
#include "core/results/output_file.h"
#include "services/cli/command.h"
#include "services/client/writable.h"

namespace dispersa {
namespace {

struct ConvertOptions {
  std::string file, out, date;
};

ExitCode Convert(const ConvertOptions& options, const GlobalOptions& global) {
  RequireWritableFile("--out", options.out);
  WriteFile(options.out, ConvertSounding(options.file, options.date));
  if (options.out == "-") return kExitDone;
  if (global.json)
    fmt::print("{}\n",
               nlohmann::ordered_json{{"schema", "dispersa/convert/1"}, {"file", options.out}}.dump(2));
  else
    fmt::print("table: {}\n", options.out);
  return kExitDone;
}

}  // namespace

void AddConvertCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command =
      app.add_subcommand("convert", "write a sounding's wind and air as a table that campaigns read");
  command
      ->add_option("file", options->file,
                   "text of the University of Wyoming, IGRA 2, or CSV with a unit in each column's name")
      ->required()
      ->type_name(kFileType);
  command->add_option("--out", options->out, "CSV file to write; -: standard output")
      ->required()
      ->type_name(kFileType);
  command->add_option("--date", options->date,
                      "of an IGRA 2 file with several soundings: YYYY-MM-DDTHH, or its begin");
  command->footer(
      "A campaign may also name the file itself: dispersions: {wind_profile: {table: sounding.txt}}.\n"
      "Example: dispersa convert sounding.txt --out wind.csv");
  command->callback([options, &invocation] {
    invocation.command = [options](const GlobalOptions& global) { return Convert(*options, global); };
  });
}

}  // namespace dispersa
