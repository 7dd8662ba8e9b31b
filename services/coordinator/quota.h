// What one client may take of a coordinator.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace dispersa {

/// Each for one owner of campaigns. Without a value there is no limit.
struct Quota {
  std::optional<std::uint64_t> cases = {};      ///< of all its campaigns that have not ended
  std::optional<std::uint64_t> campaigns = {};  ///< that have not ended
  std::optional<std::uint64_t> places = {};     ///< campaigns that fly at once; its others wait
  std::optional<std::uint64_t> disk = {};       ///< bytes of all its campaigns, also of those that have ended
};

/// Adds the limits of "cases=1000000,campaigns=20,places=4,disk=200GB". False: it is no such text.
bool ReadQuota(const std::string& text, Quota* quota);

}  // namespace dispersa
