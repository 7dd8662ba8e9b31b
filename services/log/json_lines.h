// Lines of a log as JSON objects, for programs that collect them.
#pragma once

#include <memory>
#include <string>

namespace spdlog {
class formatter;
}

namespace dispersa {

/// What the lines of a thread are about: the innermost LogAbout.
struct LogSubject {
  std::string campaign;  ///< its id
  std::string request;   ///< "cancel 3 of CLIENT"
};

/// One object a line with `time`, `level`, `program`, `message`, and `campaign` and `request` where they are
/// known. All but printable ASCII is escaped, so a text from elsewhere is one line and no control sequence.
std::unique_ptr<spdlog::formatter> JsonLines();

/// Of this thread.
LogSubject& SubjectOfLines();

}  // namespace dispersa
