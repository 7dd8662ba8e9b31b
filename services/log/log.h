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
/// For a daemon's journal: with time and name.
void LogForDaemon(const std::string& name);
/// Messages below `least` are dropped.
void SetLogLevel(LogLevel least);

void Log(LogLevel level, std::string_view text);
/// Prints the text unchanged. Text that stderr does not take is lost, which is no reason to end a program.
void TellText(std::string_view text);

template <class... Values>
void Tell(fmt::format_string<Values...> format, Values&&... values) {
  TellText(fmt::vformat(format, fmt::make_format_args(values...)));
}
template <class... Values>
void LogInfo(fmt::format_string<Values...> format, Values&&... values) {
  Log(LogLevel::kInfo, fmt::vformat(format, fmt::make_format_args(values...)));
}
template <class... Values>
void LogWarning(fmt::format_string<Values...> format, Values&&... values) {
  Log(LogLevel::kWarning, fmt::vformat(format, fmt::make_format_args(values...)));
}
template <class... Values>
void LogError(fmt::format_string<Values...> format, Values&&... values) {
  Log(LogLevel::kError, fmt::vformat(format, fmt::make_format_args(values...)));
}

}  // namespace dispersa
