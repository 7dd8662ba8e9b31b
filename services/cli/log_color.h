// The log of the program: to stderr, with colours where they are wanted.
#pragma once

#include <string>
#include <vector>

namespace dispersa {

/// What --color may be.
inline const std::vector<std::string> kLogColors = {"auto", "always", "never"};

/// The default logger, as "auto".
void StartLog();
/// auto: on a terminal that has colours, unless NO_COLOR is there and not empty (no-color.org).
void SetLogColor(const std::string& color);

}  // namespace dispersa
