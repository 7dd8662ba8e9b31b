// Keys that are not to be believed any more, though they are valid: a list that the authority signs.
#pragma once

#include <ctime>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "services/transport/key_folder.h"

namespace dispersa {

/// Names of revoked keys, by role.
using Revoked = std::map<Role, std::set<std::string>>;

/// "dispersa revoked keys 1", then a line "ROLE NAME" for each.
std::string RevocationText(const Revoked& revoked);
/// Throws std::runtime_error when it is no such text.
Revoked ParseRevocations(const std::string& text);

/// The list `revoked.p7s` beside the keys of its reader. It is read at the start of the program and whenever
/// it is replaced. A list that is damaged, or signed by another authority, is logged, and the last good list
/// stays valid.
class Revocations {
 public:
  explicit Revocations(const KeyFolder& keys) : directory_(keys.directory) {}

  /// Whether the list has become another one.
  bool Refresh();
  const Revoked& revoked() const { return revoked_; }
  bool Contains(Role role, const std::string& name) const;
  /// Whether a participant has revoked keys of this role, which is no client's.
  bool IsOf(Role role, const std::string& participant) const;

 private:
  std::filesystem::path directory_;
  std::optional<std::filesystem::file_time_type> read_;
  Revoked revoked_;
};

}  // namespace dispersa
