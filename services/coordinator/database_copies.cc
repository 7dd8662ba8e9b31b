#include "services/coordinator/database_copies.h"

#include <fmt/format.h>

#include <chrono>

#include "core/results/folder_state.h"
#include "core/results/result_error.h"

namespace dispersa {
namespace {

namespace fs = std::filesystem;

constexpr double kCopyPatience_s = 60.0;
constexpr std::chrono::milliseconds kCopyWait(20);

fs::path DatabaseOf(const fs::path& results) { return results / "results.sqlite"; }
fs::path LogOf(const fs::path& results) { return results / "results.sqlite-wal"; }
fs::path CopyOf(const fs::path& results) { return results.parent_path() / "fetched.sqlite"; }
// A separate copy: a client that fetches must not change the copy that a backup reads.
fs::path SnapshotOf(const fs::path& results) { return results.parent_path() / "backup.sqlite"; }

void RemoveCopy(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  fs::remove(file.string() + ".tmp", error);
}

bool HasLog(const fs::path& results) {
  std::error_code error;
  const auto size = fs::file_size(LogOf(results), error);
  return !error && size > 0;
}

/// Another text when anything was written.
std::string StateOf(const fs::path& results) {
  std::string state;
  for (const fs::path& file : {DatabaseOf(results), LogOf(results)}) {
    std::error_code error;
    state += fmt::format("{} {} ", fs::file_size(file, error),
                         fs::last_write_time(file, error).time_since_epoch().count());
  }
  return state;
}

void MakeCopy(const fs::path& results, std::uint64_t promised) {
  // The last process to close the database merges the log. This completes the work of a coordinator that was
  // killed.
  const std::uint64_t cases = ReadFolderState(results).cases;
  if (!HasLog(results)) return;
  CopyResults(results, CopyOf(results));
  if (cases < promised) {
    throw ResultError(ResultError::Kind::kFewer,
                      fmt::format("{}: it has {} of the {} cases that the campaign's state promises",
                                  DatabaseOf(results).string(), cases, promised));
  }
}

}  // namespace

std::optional<fs::path> DatabaseCopies::Whole(const fs::path& results, std::uint64_t promised, double now_s) {
  const fs::path file = CopyOf(results);
  const auto known = copies_.find(file);
  if (known == copies_.end() && !HasLog(results)) return DatabaseOf(results);
  if (known == copies_.end() ||
      (known->second.is_made && HasLog(results) && known->second.of != StateOf(results))) {
    Remove(file);
    Copy& copy = copies_[file];
    copy.of = StateOf(results);
    copy.making = std::async(std::launch::async, MakeCopy, results, promised);
  }
  return Made(file, now_s) ? std::optional(Known(results, now_s)) : std::nullopt;
}

std::optional<fs::path> DatabaseCopies::Snapshot(const fs::path& results, const std::string& name,
                                                 double now_s) {
  const fs::path file = SnapshotOf(results);
  if (const auto known = copies_.find(file); known == copies_.end() || known->second.of != name) {
    Remove(file);
    Copy& copy = copies_[file];
    copy.of = name;
    copy.making = std::async(std::launch::async, [results, file] { CopyResults(results, file); });
  }
  return Made(file, now_s) ? std::optional(file) : std::nullopt;
}

std::optional<fs::path> DatabaseCopies::KnownSnapshot(const fs::path& results, const std::string& name,
                                                      double now_s) {
  const auto known = copies_.find(SnapshotOf(results));
  if (known == copies_.end() || known->second.of != name || !known->second.is_made) return std::nullopt;
  known->second.used_s = now_s;
  return known->first;
}

// Throws what the copying threw.
bool DatabaseCopies::Made(const fs::path& file, double now_s) {
  Copy& copy = copies_.at(file);
  copy.used_s = now_s;
  if (copy.is_made) return true;
  if (copy.making.wait_for(kCopyWait) != std::future_status::ready) return false;
  try {
    copy.making.get();
  } catch (...) {
    Remove(file);
    throw;
  }
  return copy.is_made = true;
}

fs::path DatabaseCopies::Known(const fs::path& results, double now_s) {
  const auto known = copies_.find(CopyOf(results));
  if (known == copies_.end() || !known->second.is_made) return DatabaseOf(results);
  known->second.used_s = now_s;
  std::error_code error;
  return fs::exists(CopyOf(results), error) ? CopyOf(results) : DatabaseOf(results);
}

void DatabaseCopies::Forget(const fs::path& results) { Remove(CopyOf(results)); }

void DatabaseCopies::Remove(const fs::path& file) {
  if (copies_.erase(file) > 0) RemoveCopy(file);  // a copy that is being made is waited for
}

void DatabaseCopies::ForgetUnused(double now_s) {
  std::erase_if(copies_, [&](const auto& each) {
    const bool is_unused = each.second.is_made && now_s - each.second.used_s > kCopyPatience_s;
    if (is_unused) RemoveCopy(each.first);
    return is_unused;
  });
}

void RemoveDatabaseCopies(const fs::path& results) {
  for (const fs::path& file : {CopyOf(results), SnapshotOf(results)}) RemoveCopy(file);
}

}  // namespace dispersa
