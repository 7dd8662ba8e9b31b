// The command line as every program reads it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "services/program/exit_code.h"

namespace dispersa {

/// Help, --version and --json (into `json`). Before anything else is added, so that commands look the same.
void BeginCommandLine(CLI::App& app, bool& json, const char* json_help);

/// `--log text|json` of a daemon, into `log`.
void AddLogOption(CLI::App& app, std::string& log);

/// Parses the command line. Returns an exit code if the program ends at once: after help or a version, or
/// kExitBadInput after words that it does not understand. That error goes to stderr, and with --json anywhere
/// on the line also to standard output as an object.
std::optional<ExitCode> ParseCommandLine(CLI::App& app, int argc, char** argv);

/// True if --json is among the words, parsed or not.
bool AsksForJson(int argc, char** argv);

}  // namespace dispersa
