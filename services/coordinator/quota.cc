#include "services/coordinator/quota.h"

#include <charconv>
#include <sstream>

#include "services/coordinator/retention.h"

namespace dispersa {
namespace {

std::optional<std::uint64_t> ReadCount(const std::string& text) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stopped == end && number > 0 ? std::optional(number) : std::nullopt;
}

}  // namespace

bool ReadQuota(const std::string& text, Quota* quota) {
  std::istringstream limits(text + ",");
  for (std::string limit; std::getline(limits, limit, ',');) {
    const std::size_t equals = limit.find('=');
    if (equals == std::string::npos) return false;
    const std::string name = limit.substr(0, equals), value = limit.substr(equals + 1);
    std::optional<std::uint64_t>* const member = name == "cases"       ? &quota->cases
                                                 : name == "campaigns" ? &quota->campaigns
                                                 : name == "places"    ? &quota->places
                                                 : name == "disk"      ? &quota->disk
                                                                       : nullptr;
    if (member == nullptr) return false;
    *member = member == &quota->disk ? ReadSize(value) : ReadCount(value);
    if (!*member) return false;
  }
  return true;
}

}  // namespace dispersa
