#include "services/coordinator/retention.h"

#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace dispersa {
namespace {

constexpr std::pair<std::string_view, double> kSizes[] = {{"MB", 1e6}, {"GB", 1e9}, {"TB", 1e12}};
constexpr double kMost = 1e6;  // days, or units of size

}  // namespace

bool ReadRetention(const std::string& text, Retention* retention) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  if (error != std::errc() || !std::isfinite(number) || number <= 0.0 || number > kMost) return false;
  const std::string_view unit(stopped, static_cast<std::size_t>(end - stopped));
  if (unit == "d") {
    retention->days = number;
    return true;
  }
  for (const auto& [name, bytes] : kSizes) {
    if (unit != name) continue;
    retention->bytes = static_cast<std::uint64_t>(number * bytes);
    return true;
  }
  return false;
}

}  // namespace dispersa
