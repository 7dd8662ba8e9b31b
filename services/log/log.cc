#include "services/log/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

namespace dispersa {
namespace {

spdlog::color_mode ModeOf(LogColor color) {
  if (color == LogColor::kAlways) return spdlog::color_mode::always;
  const char* no_color = std::getenv("NO_COLOR");
  const bool none = no_color != nullptr && *no_color != '\0';
  return color == LogColor::kNever || none ? spdlog::color_mode::never : spdlog::color_mode::automatic;
}

spdlog::level::level_enum LevelOf(LogLevel level) {
  switch (level) {
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
    case LogLevel::kNothing:
      break;
  }
  return spdlog::level::off;
}

}  // namespace

void LogForPeople(LogColor color, std::string_view before) {
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>(ModeOf(color));
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("dispersa", std::move(sink)));
  spdlog::set_pattern(std::string(before) + "%^%l%$: %v");
}

void LogForDaemon(const std::string& name) {
  auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(name, std::move(sink)));
}

void SetLogLevel(LogLevel least) { spdlog::set_level(LevelOf(least)); }

void Log(LogLevel level, std::string_view text) { spdlog::log(LevelOf(level), text); }

void TellText(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); }

}  // namespace dispersa
