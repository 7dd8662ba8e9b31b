#include "services/coordinator/retention.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace dispersa {
namespace {

constexpr std::pair<std::string_view, double> kSizes[] = {{"MB", 1e6}, {"GB", 1e9}, {"TB", 1e12}};
constexpr double kSecondsOfDay = 86400.0;
constexpr double kMost = 1e6;  // days, or units of size

/// A number above zero and its unit.
std::optional<std::pair<double, std::string_view>> ReadAmount(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  if (error != std::errc() || !std::isfinite(number) || number <= 0.0 || number > kMost) return std::nullopt;
  return std::pair(number, std::string_view(stopped, static_cast<std::size_t>(end - stopped)));
}

}  // namespace

void DeleteBeyond(const Retention& retention, std::vector<Stored> campaigns, std::int64_t now_unix_s,
                  const std::function<bool(const std::string& id, bool is_old)>& remove) {
  std::uint64_t total = 0;
  for (const Stored& campaign : campaigns) total += campaign.bytes;
  std::stable_sort(campaigns.begin(), campaigns.end(),
                   [](const Stored& a, const Stored& b) { return a.ended_unix_s < b.ended_unix_s; });
  for (const Stored& campaign : campaigns) {
    if (!campaign.may_be_deleted) continue;
    const bool is_old = retention.days && static_cast<double>(now_unix_s - campaign.ended_unix_s) >
                                              kSecondsOfDay * *retention.days;
    if (!is_old && !(retention.bytes && total > *retention.bytes)) break;
    if (remove(campaign.id, is_old)) total -= campaign.bytes;
  }
}

bool ReadRetention(const std::string& text, Retention* retention) {
  if (const auto amount = ReadAmount(text); amount && amount->second == "d") {
    retention->days = amount->first;
    return true;
  }
  const auto bytes = ReadSize(text);
  if (bytes) retention->bytes = bytes;
  return bytes.has_value();
}

std::optional<std::uint64_t> ReadSize(const std::string& text) {
  const auto amount = ReadAmount(text);
  if (!amount) return std::nullopt;
  for (const auto& [name, bytes] : kSizes) {
    if (amount->second == name) return static_cast<std::uint64_t>(amount->first * bytes);
  }
  return std::nullopt;
}

}  // namespace dispersa
