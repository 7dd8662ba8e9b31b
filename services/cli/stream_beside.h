// The stream for text beside an output file, which may be standard output.
#pragma once

#include <cstdio>
#include <string>

#include "services/cli/command.h"

namespace dispersa {

/// The stream for the text of a command that also writes a file. It is stderr if the file is "-", standard
/// output. Throws InputError, which begins with the option's name, if --json needs standard output too.
std::FILE* StreamBeside(const std::string& option, const std::string& path, const GlobalOptions& global);

}  // namespace dispersa
