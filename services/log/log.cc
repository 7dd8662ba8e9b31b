#include "services/log/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "services/log/json_lines.h"
#include "services/log/log_limits.h"

namespace dispersa {
namespace {

std::mutex limits_mutex;
std::optional<LogLimits> limits;  // of a daemon
bool is_json = false;             // set before other threads start

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

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
  const std::lock_guard lock(limits_mutex);
  limits.emplace();
}

void LogAsJson() {
  is_json = true;
  spdlog::set_formatter(JsonLines());
}

LogAbout::LogAbout(const std::string& campaign_id, const std::string& request)
    : campaign_(SubjectOfLines().campaign), request_(SubjectOfLines().request) {
  if (!campaign_id.empty()) SubjectOfLines().campaign = campaign_id;
  if (!request.empty()) SubjectOfLines().request = request;
}

LogAbout::~LogAbout() { SubjectOfLines() = {std::move(campaign_), std::move(request_)}; }

void SetLogLevel(LogLevel least) { spdlog::set_level(LevelOf(least)); }

void Log(LogLevel level, std::string_view kind, std::string_view text) {
  {
    const std::lock_guard lock(limits_mutex);
    if (limits && !limits->Take(kind, text, Now_s())) return;
  }
  spdlog::log(LevelOf(level), text);
}

void LogCounts() {
  std::vector<std::string> lines;
  {
    const std::lock_guard lock(limits_mutex);
    if (limits) lines = limits->TakeCounts(Now_s());
  }
  for (const std::string& line : lines) spdlog::info(line);
}

void TellText(std::string_view text) {
  if (is_json) return spdlog::error(text.substr(0, text.find_last_not_of('\n') + 1));
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace dispersa
