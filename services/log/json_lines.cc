#include "services/log/json_lines.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <spdlog/formatter.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <thread>

#include "services/log/log.h"

namespace dispersa {
namespace {

constexpr std::size_t kLongestLine = 4096;  // longer ones come in parts

std::string UtcText(std::chrono::system_clock::time_point time) {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch()).count();
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(static_cast<std::time_t>(ms / 1000)),
                     ms % 1000);
}

class JsonFormatter : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& line, spdlog::memory_buf_t& to) override {
    const auto text = [](spdlog::string_view_t view) { return std::string(view.data(), view.size()); };
    nlohmann::ordered_json object = {{"time", UtcText(line.time)},
                                     {"level", text(spdlog::level::to_string_view(line.level))},
                                     {"program", text(line.logger_name)},
                                     {"message", text(line.payload)}};
    if (!SubjectOfLines().campaign.empty()) object["campaign"] = SubjectOfLines().campaign;
    if (!SubjectOfLines().request.empty()) object["request"] = SubjectOfLines().request;
    const std::string bytes = object.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
    to.append(bytes.data(), bytes.data() + bytes.size());
  }
  std::unique_ptr<spdlog::formatter> clone() const override { return std::make_unique<JsonFormatter>(); }
};

void LogLinesOf(int file) {
  std::string line;
  std::array<char, kLongestLine> part{};
  for (;;) {
    const ssize_t size = read(file, part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return;
    for (const char c : std::string_view(part.data(), static_cast<std::size_t>(size))) {
      if (c != '\n') line += c;
      if (c != '\n' && line.size() < kLongestLine) continue;
      LogInfo("a control law prints: {}", line);
      line.clear();
    }
  }
}

}  // namespace

std::unique_ptr<spdlog::formatter> JsonLines() { return std::make_unique<JsonFormatter>(); }

LogSubject& SubjectOfLines() {
  thread_local LogSubject subject;
  return subject;
}

int OpenLoggedPipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  std::thread(LogLinesOf, ends[0]).detach();
  return ends[1];
}

}  // namespace dispersa
