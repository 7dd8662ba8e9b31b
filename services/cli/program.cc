#include "services/cli/program.h"

#include <exception>
#include <stdexcept>
#include <string>
#include <system_error>

#include "core/containment/contained.h"
#include "core/flight/lane_engine.h"
#include "core/input/input_error.h"
#include "core/results/result_error.h"
#include "services/cli/command.h"
#include "services/cli/commands.h"
#include "services/ledger/result_exit_code.h"
#include "services/log/log.h"
#include "services/program/command_line.h"
#include "services/program/failure.h"
#include "services/program/standard_output.h"

namespace dispersa {
namespace {

LogColor ColorNamed(const std::string& name) {
  return name == "always" ? LogColor::kAlways : name == "never" ? LogColor::kNever : LogColor::kAuto;
}

ExitCode Execute(const Invocation& invocation) {
  const GlobalOptions& global = invocation.global;
  try {
    return EndOutput(invocation.command(global));
  } catch (const InputError& error) {
    return EndFor(error, global.json);
  } catch (const PluginError& error) {
    return EndFor(InputError(std::string("the control law ") + error.what()), global.json);
  } catch (const ContainedEnd& end) {
    return EndFor(InputError(std::string("the control law ") + end.what()), global.json, kExitIncomplete);
  } catch (const ResultError& error) {
    return EndFor(InputError(error.what()), global.json,
                  IsOutputLost() ? kExitIncomplete : ExitCodeOf(error));
  } catch (const std::system_error& error) {
    if (IsOutputLost()) return EndLostOutput(error.code().value());
    return EndFor(FailureOf(error), global.json);
  } catch (const std::exception& error) {
    return EndFor(FailureOf(error), global.json);
  }
}

// Commands of the service: known, so that a script learns why they fail, and not listed.
void AddAbsentCommands(CLI::App& app, Invocation& invocation) {
  for (const char* name : {"launch", "list", "status", "watch", "cancel", "delete", "give", "repair",
                           "readmit", "fetch", "backup", "keys"}) {
    CLI::App* command = app.add_subcommand(name, kNoService)->group("");
    command->fallthrough(false)->allow_extras()->prefix_command()->set_help_flag();
    command->callback([&invocation, name] {
      invocation.command = [name](const GlobalOptions&) -> ExitCode {
        throw InputError(std::string(name) + ": " + kNoService,
                         "the package dispersa-cluster beside it, or a build with DISPERSA_SERVICE=ON");
      };
    });
  }
}

}  // namespace

int RunProgram(int argc, char** argv, const Service* service) {
  PrepareFiles();
  LogForPeople(LogColor::kAuto);
  try {
    ChosenEngine();
  } catch (const std::invalid_argument& error) {
    return EndFor(InputError(error.what()), AsksForJson(argc, argv));
  }

  Invocation invocation;
  std::string color = "auto";
  CLI::App app("Monte Carlo dispersion campaigns of launch vehicles.", "dispersa");
  BeginCommandLine(app, invocation.global.json, "print one JSON object instead of text, also for an error");
  app.add_flag("--quiet", invocation.global.quiet, "print no progress, only warnings and errors");
  app.add_option("--color", color, "colours on stderr; auto: on a terminal, unless NO_COLOR is set")
      ->check(CLI::IsMember({"auto", "always", "never"}));
  app.require_subcommand(1);
  app.fallthrough();
  app.footer(
      "Examples: dispersa validate campaigns/table3.yaml\n"
      "          dispersa fly campaigns/table3.yaml --case 17 --history case17.csv\n"
      "          dispersa run campaigns/table3.yaml --cases 200\n"
      "`dispersa COMMAND --help` describes a command. An input FILE may be -, standard input.");
  AddCommands(app, invocation);
  invocation.global.service = service;
  service == nullptr ? AddAbsentCommands(app, invocation) : service->add_commands(app, invocation);
  if (const auto code = ParseCommandLine(app, argc, argv)) return *code;
  LogForPeople(ColorNamed(color));
  if (invocation.global.quiet) SetLogLevel(LogLevel::kWarning);
  return Execute(invocation);
}

}  // namespace dispersa
