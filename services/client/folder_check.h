// dispersa fsck: whether a folder is as it was written, and what mends it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dispersa {

struct FolderProblem {
  std::string file;
  std::string what;  ///< "does not fit its checksum"
  std::string mend;  ///< what to do, or what was done
  bool is_mended = false;
};

/// Of a result folder, or of the data folder of a coordinator that does not run. `repair` mends what its
/// other files can make anew. Rows of another engine with other columns are not read. Throws InputError if it
/// is neither, or another process writes it; ResultError if a file cannot be written.
std::vector<FolderProblem> CheckFolder(const std::filesystem::path& folder, bool repair);

/// The part of it that reads no row: campaign.yaml and the files of the report.
std::vector<FolderProblem> CheckFiles(const std::filesystem::path& results);

}  // namespace dispersa
