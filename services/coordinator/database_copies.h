// Copies of the databases of result folders, for clients that fetch them. They are consistent even if the
// database is being read on this machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <optional>
#include <string>

namespace dispersa {

/// While any process has a database open, its last transactions are in a write-ahead log beside it, and the
/// file alone lacks them. Then this hands out a copy by SQLite's backup. Used by one thread; copies are made
/// on another one.
class DatabaseCopies {
 public:
  /// The file to hand out as results.sqlite of `results`: itself, or a copy beside the folder. None: it is
  /// being copied. Throws ResultError when that fails, and when the copy has fewer than `promised` cases.
  std::optional<std::filesystem::path> Whole(const std::filesystem::path& results, std::uint64_t promised,
                                             double now_s);
  /// The same of a folder that Whole was asked about before: nothing is copied.
  std::filesystem::path Known(const std::filesystem::path& results, double now_s);
  /// A copy, for a backup, of a database that may be written at the same time. The backup's `name` tells
  /// whether the present copy belongs to it. None: it is being copied.
  std::optional<std::filesystem::path> Snapshot(const std::filesystem::path& results, const std::string& name,
                                                double now_s);
  /// The same copy, if it still exists. Empty: another backup replaced it, or it was not used for too long.
  std::optional<std::filesystem::path> KnownSnapshot(const std::filesystem::path& results,
                                                     const std::string& name, double now_s);
  /// The campaign goes on, so the copy for clients is outdated.
  void Forget(const std::filesystem::path& results);
  /// Removes copies that were not used lately.
  void ForgetUnused(double now_s);

 private:
  struct Copy {
    std::string of;  ///< the copied state of database and log, or a backup's name
    std::future<void> making;
    bool is_made = false;
    double used_s = 0.0;
  };
  bool Made(const std::filesystem::path& file, double now_s);
  void Remove(const std::filesystem::path& file);

  std::map<std::filesystem::path, Copy> copies_;  ///< by the copy's file
};

/// Removes copies left by a coordinator that was killed.
void RemoveDatabaseCopies(const std::filesystem::path& results);

}  // namespace dispersa
