// Messages of the programs on stderr while they work. The library behind it stays in log.cc: with its
// templates in every source that logs, the services took a tenth longer to compile.
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>

namespace dispersa {

enum class LogLevel { kInfo, kWarning, kError, kNothing };
enum class LogColor { kAuto, kAlways, kNever };

/// For people at a terminal: "level: text", each time after `before`. kAuto: coloured on a terminal that has
/// colours, unless NO_COLOR is there and not empty (no-color.org).
void LogForPeople(LogColor color, std::string_view before = {});
/// For a daemon's journal: with time and name. Of one kind (one format) 60 lines a minute are written, and
/// then how many more there were (log_limits.h).
void LogForDaemon(const std::string& name);
/// From now on the lines of a daemon are JSON objects (json_lines.h), those of TellText too.
void LogAsJson();
/// A descriptor for the output of foreign code: each line written to it becomes a line of this log, on a
/// thread of its own. It stays open. Throws std::system_error.
int OpenLoggedPipe();
/// As long as it lives, lines of this thread name this campaign and request as JSON members. An empty one
/// leaves what an outer one has set.
class LogAbout {
 public:
  explicit LogAbout(const std::string& campaign_id, const std::string& request = "");
  ~LogAbout();
  LogAbout(const LogAbout&) = delete;
  LogAbout& operator=(const LogAbout&) = delete;

 private:
  std::string campaign_, request_;  ///< of the outer one
};
/// Messages below `least` are dropped.
void SetLogLevel(LogLevel least);

/// `kind`: the format, or empty for a line that is always written.
void Log(LogLevel level, std::string_view kind, std::string_view text);
/// Writes the counts of lines that were not written, of minutes that are over. A daemon calls it now and
/// then.
void LogCounts();
/// Prints the text unchanged, unless LogAsJson() was called. Text that stderr does not take is lost, which is
/// no reason to end a program.
void TellText(std::string_view text);

template <class... Values>
void Tell(fmt::format_string<Values...> format, Values&&... values) {
  TellText(fmt::vformat(format, fmt::make_format_args(values...)));
}
template <class... Values>
void LogInfo(fmt::format_string<Values...> format, Values&&... values) {
  const fmt::string_view text = format;
  Log(LogLevel::kInfo, {text.data(), text.size()}, fmt::vformat(format, fmt::make_format_args(values...)));
}
template <class... Values>
void LogWarning(fmt::format_string<Values...> format, Values&&... values) {
  const fmt::string_view text = format;
  Log(LogLevel::kWarning, {text.data(), text.size()}, fmt::vformat(format, fmt::make_format_args(values...)));
}
template <class... Values>
void LogError(fmt::format_string<Values...> format, Values&&... values) {
  const fmt::string_view text = format;
  Log(LogLevel::kError, {text.data(), text.size()}, fmt::vformat(format, fmt::make_format_args(values...)));
}

}  // namespace dispersa
