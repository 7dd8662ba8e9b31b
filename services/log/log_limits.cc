#include "services/log/log_limits.h"

#include <fmt/core.h>

namespace dispersa {

bool LogLimits::Take(std::string_view kind, std::string_view text, double now_s) {
  if (kind.empty()) return true;
  auto found = kinds_.find(kind);
  if (found == kinds_.end()) found = kinds_.emplace(std::string(kind), Kind{now_s, 0, 0, ""}).first;
  Kind& known = found->second;
  if (known.written < kMost) {
    ++known.written;
    return true;
  }
  ++known.unsaid;
  known.last = text;
  return false;
}

std::vector<std::string> LogLimits::TakeCounts(double now_s) {
  std::vector<std::string> lines;
  std::erase_if(kinds_, [&](const auto& each) {
    const Kind& kind = each.second;
    if (now_s - kind.since_s < kWindow_s) return false;
    if (kind.unsaid > 0)
      lines.push_back(fmt::format("… and {} more like it in the last minute: {}", kind.unsaid, kind.last));
    return true;
  });
  return lines;
}

}  // namespace dispersa
