// Standard output is either a file's or a command's.
#pragma once

#include <cstdio>
#include <string>

#include "services/cli/command.h"

namespace dispersa {

/// The stream for what a command tells besides the file that an option names: stderr if that is "-", standard
/// output. Throws InputError, which begins with the option's name, if standard output is to be the --json
/// object too.
std::FILE* StreamBeside(const std::string& option, const std::string& path, const GlobalOptions& global);

}  // namespace dispersa
