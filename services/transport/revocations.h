// Keys that are not to be believed any more, though they are valid: a list that the authority signs.
#pragma once

#include <chrono>
#include <compare>
#include <ctime>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "services/transport/key_folder.h"

namespace dispersa {

/// The serial of keys that have none, of an earlier version.
inline constexpr char kNoSerial[] = "-";

struct RevokedKeys {
  Role role;
  std::string name;
  std::string serial;

  auto operator<=>(const RevokedKeys&) const = default;
};
using Revoked = std::set<RevokedKeys>;

/// "dispersa revoked keys 2", then a line "ROLE NAME SERIAL" for each.
std::string RevocationText(const Revoked& revoked);
/// Reads version 1 too, which has no serials. Throws std::runtime_error when it is no such text.
Revoked ParseRevocations(const std::string& text);

/// The list `revoked.p7s` beside the keys of its reader. It is read at the start of the program and whenever
/// it is replaced. A list that is damaged, or signed by another authority, is logged, and the last good list
/// stays valid.
class Revocations {
 public:
  explicit Revocations(const KeyFolder& keys) : directory_(keys.directory) {}

  /// Whether the list has become another one.
  bool Refresh();
  /// The same every few seconds: a new list counts soon, and no message waits for the disk.
  void RefreshIfDue();
  /// Whether a participant has revoked keys: its name follows from the subject of its certificate, which has
  /// the serial.
  bool IsOf(const std::string& participant) const;

 private:
  std::filesystem::path directory_;
  std::optional<std::filesystem::file_time_type> read_;
  std::chrono::steady_clock::time_point due_ = {};
  std::set<std::string> participants_;  ///< the first digits of their names
};

}  // namespace dispersa
