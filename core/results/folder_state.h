// What every engine reads of a result folder. Inputs and metrics differ between engines, these tables do not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace dispersa {

class Database;

/// Of the file in a result folder.
inline constexpr char kDatabaseName[] = "results.sqlite", kTextFile[] = "campaign.yaml";

struct FolderState {
  std::string campaign_id, flight_id, engine, name, seed;
  std::uint64_t planned = 0;  ///< cases of the campaign
  std::uint64_t cases = 0;    ///< that have a result
  std::uint64_t quarantined = 0;
};

/// Throws InputError if it is no result folder, ResultError if its database is damaged.
FolderState ReadFolderState(const std::filesystem::path& directory);

/// What SQLite finds wrong with the pages of the database; empty: nothing. Throws as ReadFolderState.
std::string DamagedPages(const std::filesystem::path& directory);

/// Replaces `file` by a complete copy of the folder's database. Other processes may write it meanwhile.
void CopyResults(const std::filesystem::path& directory, const std::filesystem::path& file);

/// For core/results: results.sqlite, if it is a database. InputError if not.
std::unique_ptr<Database> OpenResultDatabase(const std::filesystem::path& directory);

}  // namespace dispersa
