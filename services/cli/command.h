// How to add a command to the program.
//
// Each command is one file, command_<name>.cc, with one function
//
//   void AddRunCommand(CLI::App& app, Invocation& invocation) {
//     auto options = std::make_shared<RunOptions>();
//     CLI::App* command = app.add_subcommand("run", "fly a campaign");
//     command->add_option("campaign", options->campaign, "campaign file")->required();
//     Bind(command, invocation, options, Run);
//   }
//
// CMakeLists.txt lists the names of the commands, and makes the source's name, the declaration and the call
// from them. The function that it binds returns an ExitCode. Results go to stdout, everything else to stderr
// (the log writes there). Commands need not handle exceptions: InputError ends the program with its text and
// 2, any other with its message and 1. With --json both are also printed as an object. The type names below
// appear in help texts, and completion works by them.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "services/client/campaign_run.h"
#include "services/client/folder_check.h"
#include "services/program/completion_words.h"
#include "services/program/exit_code.h"

namespace dispersa {

struct Invocation;

/// What a build with the service adds to the program (services/fleet_cli/main.cc).
struct Service {
  void (*add_commands)(CLI::App& app, Invocation& invocation);
  FlyWithWorkers fly_with_workers;
  OtherFolder check_data;
};

struct GlobalOptions {
  bool json = false;                 ///< one JSON object on stdout instead of text
  bool quiet = false;                ///< no progress, only warnings and errors on stderr
  const Service* service = nullptr;  ///< none: a build without the service
};

/// The parsed command, which program.cc runs.
struct Invocation {
  GlobalOptions global;
  std::function<ExitCode(const GlobalOptions&)> command;
};

/// What a command does: `run` with the options of its command line.
template <typename Options>
void Bind(CLI::App* command, Invocation& invocation, const std::shared_ptr<Options>& options,
          ExitCode (*run)(const Options&, const GlobalOptions&)) {
  command->callback([options, &invocation, run] {
    invocation.command = [options, run](const GlobalOptions& global) { return run(*options, global); };
  });
}

/// Prints the answer of a command: with --json the object, else the text.
inline ExitCode Answer(const GlobalOptions& global, const nlohmann::ordered_json& object,
                       const std::string& text) {
  fmt::print("{}", global.json ? object.dump(2) + "\n" : text);
  return kExitDone;
}

}  // namespace dispersa
