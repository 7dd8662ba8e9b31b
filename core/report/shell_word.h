// Commands that a reader copies into a shell.
#pragma once

#include <string>

namespace dispersa {

/// One word of a POSIX shell: as it is, or in single quotes where it must be.
std::string ShellWord(const std::string& text);

}  // namespace dispersa
