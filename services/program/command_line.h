// The command line as every program reads it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "services/program/exit_code.h"

namespace dispersa {

/// Help, --version and --json (into `json`). Before anything else is added, so that commands look the same.
void BeginCommandLine(CLI::App& app, bool& json, const char* json_help);

/// Parses. The code with which the program ends at once, if it does: after help or a version, and with
/// kExitBadInput after words that it does not understand, which goes to stderr, and with --json anywhere on
/// the line to standard output as an object too.
std::optional<ExitCode> ParseCommandLine(CLI::App& app, int argc, char** argv);

/// True if --json is among the words, parsed or not.
bool AsksForJson(int argc, char** argv);

}  // namespace dispersa
