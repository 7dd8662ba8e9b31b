#include "services/cli/log_color.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <memory>

namespace dispersa {
namespace {

spdlog::color_mode ModeOf(const std::string& color) {
  if (color == "always") return spdlog::color_mode::always;
  const char* no_color = std::getenv("NO_COLOR");
  const bool none = no_color != nullptr && *no_color != '\0';
  return color == "never" || none ? spdlog::color_mode::never : spdlog::color_mode::automatic;
}

}  // namespace

void StartLog() { SetLogColor("auto"); }

void SetLogColor(const std::string& color) {
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>(ModeOf(color));
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("dispersa", std::move(sink)));
  spdlog::set_pattern("%^%l%$: %v");
}

}  // namespace dispersa
