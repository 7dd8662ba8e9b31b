// How long a coordinator keeps campaigns that have ended.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace dispersa {

struct Retention {
  std::optional<double> days = {};          ///< campaigns are deleted this long after their end
  std::optional<std::uint64_t> bytes = {};  ///< those that ended first are deleted while all take more
};

/// A campaign of a coordinator, as its retention sees it.
struct Stored {
  std::string id;
  std::int64_t ended_unix_s = 0;
  std::uint64_t bytes = 0;
  bool may_be_deleted = false;  ///< it has ended, and nobody reads it
};

/// Deletes what is kept too long, and those that ended first while all together take too much. `remove` says
/// whether the campaign is gone: one that stays frees nothing.
void DeleteBeyond(const Retention& retention, std::vector<Stored> campaigns, std::int64_t now_unix_s,
                  const std::function<bool(const std::string& id, bool is_old)>& remove);

/// Adds a limit as a user writes it: days ("90d") or a size ("200GB", "0.5TB"). False: it is none.
bool ReadRetention(const std::string& text, Retention* retention);

/// Bytes as a user writes them: "30MB", "200GB", "0.5TB".
std::optional<std::uint64_t> ReadSize(const std::string& text);

}  // namespace dispersa
