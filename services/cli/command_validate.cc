// dispersa validate: errors and unusual numbers in input files, and a summary of a vehicle.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/standard_input.h"
#include "core/pages/vehicle_drawing.h"
#include "core/results/output_file.h"
#include "services/cli/command.h"
#include "services/cli/stream_beside.h"
#include "services/cli/vehicle_text.h"
#include "services/client/writable.h"
#include "services/program/error_json.h"

namespace dispersa {
namespace {

struct ValidateOptions {
  std::vector<std::string> files;
  bool strict = false;
  std::string picture;
};

void Draw(const FileCheck& check, const ValidateOptions& options) {
  if (!check.errors.empty()) return;
  if (!check.vehicle)
    throw InputError("--picture: " + options.files[0] + " has no vehicle to draw", "a vehicle or a campaign");
  WriteFile(options.picture, VehicleDrawing(*check.vehicle));
}

ExitCode Validate(const ValidateOptions& options, const GlobalOptions& global) {
  if (!options.picture.empty() && options.files.size() != 1)
    throw InputError("--picture: only one file can be drawn", "one vehicle or campaign file");
  RequireWritableFile("--picture", options.picture);
  std::FILE* const stream = StreamBeside("--picture", options.picture, global);
  auto errors = nlohmann::ordered_json::array();
  auto warnings = nlohmann::ordered_json::array();
  auto vehicles = nlohmann::ordered_json::array();
  std::set<std::string> told;  // several campaigns may name a file with a problem
  for (const std::string& file : options.files) {
    const FileCheck check = CheckFile(file);
    const auto tell = [&](const std::vector<InputProblem>& problems, const char* kind,
                          nlohmann::ordered_json& all) {
      for (const InputProblem& problem : problems) {
        if (!told.insert(kind + problem.Text()).second) continue;
        all.push_back(ProblemJson(problem));
        if (!global.json) fmt::print(stream, "{}{}\n", kind, problem.Text());
      }
    };
    const std::size_t told_before = errors.size();
    tell(check.errors, "", errors);
    if (!check.errors.empty() && errors.size() == told_before && !global.json)
      fmt::print(stream, "{}: not valid, for the reasons above\n", file);
    tell(check.warnings, "warning: ", warnings);
    const bool valid = check.errors.empty() && !(options.strict && !check.warnings.empty());
    if (valid && !global.json && !global.quiet)
      fmt::print(stream, "{}: valid\n", file == kStandardInput ? kStandardInputName : file);
    if (check.is_vehicle && check.vehicle) {
      vehicles.push_back(VehicleJson(*check.vehicle));
      if (!global.json && !global.quiet) fmt::print(stream, "{}", VehicleText(*check.vehicle));
    }
    if (!options.picture.empty()) Draw(check, options);
  }
  const bool valid = errors.empty() && !(options.strict && !warnings.empty());
  if (global.json) {
    const nlohmann::ordered_json report = {{"schema", "dispersa/validate/1"},
                                           {"valid", valid},
                                           {"errors", std::move(errors)},
                                           {"warnings", std::move(warnings)},
                                           {"vehicles", std::move(vehicles)}};
    fmt::print("{}\n", report.dump(2));
  } else if (valid && !options.picture.empty() && stream == stdout && !global.quiet) {
    fmt::print("picture: {}\n", options.picture);
  }
  return valid ? kExitDone : kExitBadInput;
}

}  // namespace

void AddValidateCommand(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ValidateOptions>();
  CLI::App* command =
      app.add_subcommand("validate", "check campaign, vehicle, reference and autopilot files");
  command->add_option("files", options->files, "files of any kind")->required()->type_name(kYamlType);
  command->add_flag("--strict", options->strict, "warnings are errors");
  command
      ->add_option("--picture", options->picture,
                   "file for a drawing of the vehicle to scale, SVG; -: standard output")
      ->type_name(kFileType);
  command->footer(
      "A warning names a number outside the range of known launchers. For a valid vehicle file the command "
      "prints\n"
      "masses, Isp, ideal delta-v and thrust-to-weight ratio.\n"
      "Example: dispersa validate campaigns/*.yaml campaigns/vehicles/slv4.yaml\n"
      "         dispersa validate --strict --picture slv4.svg campaigns/vehicles/slv4.yaml");
  Bind(command, invocation, options, Validate);
}

}  // namespace dispersa
