// dispersa: command line to command to exit code.
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "core/campaign/contained.h"
#include "core/campaign/input_error.h"
#include "core/campaign_yaml/yaml_reader.h"
#include "core/flight/engine_version.h"
#include "core/flight/lane_engine.h"
#include "core/report/result_error.h"
#include "services/cli/command.h"

namespace dispersa {
namespace {

void AddCommands(CLI::App& app, Invocation& invocation) {
  AddValidateCommand(app, invocation);
  AddOptimizeCommand(app, invocation);
  AddPlanCommand(app, invocation);
  AddFlyCommand(app, invocation);
  AddRunCommand(app, invocation);
  AddReplayCommand(app, invocation);
  AddReportCommand(app, invocation);
  AddMarginsCommand(app, invocation);
  AddModesCommand(app, invocation);
  AddTuneCommand(app, invocation);
  AddExportCommand(app, invocation);
  AddCompareCommand(app, invocation);
  AddSearchCommand(app, invocation);
  AddPaperCommand(app, invocation);
  AddLaunchCommand(app, invocation);
  AddStatusCommands(app, invocation);
  AddWatchCommand(app, invocation);
  AddFetchCommand(app, invocation);
  AddKeysCommand(app, invocation);
}

ExitCode Say(const std::exception& error, ExitCode code) {
  fmt::print(stderr, "{}\n", error.what());
  return code;
}

ExitCode Execute(const Invocation& invocation) {
  try {
    const ExitCode code = invocation.command(invocation.global);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      spdlog::error("the results cannot be written to standard output");
      return WorseOf(code, kExitInternalError);
    }
    return code;
  } catch (const InputError& error) {
    return Say(error, kExitBadInput);
  } catch (const PluginError& error) {
    fmt::print(stderr, "the control law {}\n", error.what());
    return kExitBadInput;
  } catch (const ContainedEnd& end) {
    fmt::print(stderr, "the control law {}\n", end.what());
    return kExitIncomplete;
  } catch (const ResultError& error) {
    return Say(error, error.kind() == ResultError::Kind::kDiskFull ? kExitIncomplete : kExitInternalError);
  } catch (const std::exception& error) {
    spdlog::error("internal error: {}", error.what());
    return kExitInternalError;
  }
}

// Help and version are errors to CLI11, of code 0.
ExitCode Usage(const CLI::App& app, const CLI::ParseError& error) {
  return app.exit(error) == 0 ? kExitDone : kExitBadInput;
}

InputError UnknownCommand(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  const std::string word = app.remaining().front();
  return InputError("unknown command '" + word + "'" + DidYouMean(word, names), JoinWords(names));
}

// CLI11 ends at --version, whatever else is asked for.
bool AsksForVersionAsJson(int argc, char** argv) {
  const auto has = [&](const char* flag) {
    return std::any_of(argv + 1, argv + argc, [&](const char* word) { return std::string(word) == flag; });
  };
  return has("--version") && has("--json");
}

void PrintVersionJson() {
  const nlohmann::ordered_json json = {{"schema", "dispersa/version/1"},
                                       {"version", EngineVersion().substr(0, EngineVersion().find('+'))},
                                       {"engine", EngineVersion()},
                                       {"isa", ChosenEngine().isa},
                                       {"lanes", ChosenEngine().lanes}};
  fmt::print("{}\n", json.dump(2));
}

int Main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("dispersa"));
  spdlog::set_pattern("%^%l%$: %v");
  try {
    ChosenEngine();
  } catch (const std::invalid_argument& error) {
    return Say(error, kExitBadInput);
  }
  if (AsksForVersionAsJson(argc, argv)) {
    PrintVersionJson();
    return kExitDone;
  }

  Invocation invocation;
  CLI::App app("Monte Carlo dispersion campaigns of launch vehicles.", "dispersa");
  app.set_version_flag("--version", "dispersa " + EngineVersion());
  app.add_flag("--json", invocation.global.json, "print one JSON object instead of text");
  app.add_flag("--quiet", invocation.global.quiet, "no progress, only warnings and errors");
  app.require_subcommand(1);
  app.fallthrough();
  app.footer(
      "Examples: dispersa validate campaigns/table3.yaml\n"
      "          dispersa fly campaigns/table3.yaml --case 17 --history case17.csv\n"
      "          dispersa run campaigns/table3.yaml --cases 200\n"
      "`dispersa COMMAND --help` tells more.");
  AddCommands(app, invocation);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // CLI11 says of an unknown command only that one is required.
    if (!app.get_subcommands().empty() || app.remaining().empty()) return Usage(app, error);
    fmt::print(stderr, "{}\n", UnknownCommand(app).what());
    return kExitBadInput;
  } catch (const CLI::ParseError& error) {
    return Usage(app, error);
  }
  if (invocation.global.quiet) spdlog::set_level(spdlog::level::warn);
  return Execute(invocation);
}

}  // namespace
}  // namespace dispersa

int main(int argc, char** argv) { return dispersa::Main(argc, argv); }
