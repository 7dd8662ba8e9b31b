// How long a coordinator keeps campaigns that have ended.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace dispersa {

struct Retention {
  std::optional<double> days = {};          ///< campaigns are deleted this long after their end
  std::optional<std::uint64_t> bytes = {};  ///< those that ended first are deleted while all take more
};

/// Adds a limit as a user writes it: days ("90d") or a size ("200GB", "0.5TB"). False: it is none.
bool ReadRetention(const std::string& text, Retention* retention);

/// Bytes as a user writes them: "30MB", "200GB", "0.5TB".
std::optional<std::uint64_t> ReadSize(const std::string& text);

}  // namespace dispersa
