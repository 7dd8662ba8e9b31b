// What the owners of campaigns may take of a coordinator.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>

namespace dispersa {

/// Each for one owner of campaigns. Without a value there is no limit.
struct Quota {
  /// A value that limits nothing: it lifts the limit of all owners for one of them.
  static constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

  std::optional<std::uint64_t> cases = {};      ///< of all its campaigns that have not ended
  std::optional<std::uint64_t> campaigns = {};  ///< that have not ended
  std::optional<std::uint64_t> places = {};     ///< campaigns that fly at once; its others wait
  std::optional<std::uint64_t> disk = {};       ///< bytes of all its campaigns, also of those that have ended
};

class Quotas {
 public:
  /// Adds the limits of "cases=1000000,campaigns=20,places=4,disk=200GB", for all owners, or of
  /// "ann:cases=5000000,disk=none", for one of them. Returns what is wrong with the text; empty: nothing.
  std::string Add(const std::string& text);

  /// Its own limits, and where it has none those of all owners.
  Quota Of(const std::string& owner) const;

 private:
  Quota of_all_;
  std::map<std::string, Quota> of_one_;  ///< by owner
};

}  // namespace dispersa
