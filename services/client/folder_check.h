// dispersa fsck: whether a folder is as it was written, and what mends it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/results/folder_state.h"

namespace dispersa {

struct FolderProblem {
  std::string file;
  std::string what;  ///< "does not fit its checksum"
  std::string mend;  ///< what to do, or what was done
  bool is_mended = false;
};

/// What to do with a file that nothing here can make anew.
inline constexpr char kFromBackup[] = "copy it from a backup";

/// The problems found so far.
class FolderCheck {
 public:
  explicit FolderCheck(bool repair) : repair_(repair) {}

  /// `mend` returns whether the file is whole now; without one nothing here can mend it.
  void Found(const std::filesystem::path& file, const std::string& what, const std::string& to_do,
             const std::function<bool()>& mend = nullptr);
  std::vector<FolderProblem> Take();

 private:
  bool repair_;
  std::vector<FolderProblem> problems_;
};

/// The parts of a check, for folders that hold result folders. None: its state cannot be read.
std::optional<FolderState> StateOf(const std::filesystem::path& results);
/// Whether `file` is the campaign with this id. `copy`: a file that may have the same text.
void CheckText(FolderCheck& check, const std::filesystem::path& file, const std::string& id,
               const std::filesystem::path& copy = "");
/// `fly_again`: what the owner of these results does with rows that are lost.
void CheckResults(FolderCheck& check, const std::filesystem::path& results, const std::filesystem::path& text,
                  const std::string& fly_again, const std::function<bool()>& queue);

/// Checks a folder that is no result folder. False: nor is it of a kind that this function knows.
using OtherFolder = bool (*)(FolderCheck& check, const std::filesystem::path& folder);

/// Of a result folder, or of another kind (`other`: services/fleet/data_check.h). `repair` mends what its
/// other files can make anew. Rows of another engine with other columns are not read. Throws InputError if it
/// is neither, or another process writes it; ResultError if a file cannot be written.
std::vector<FolderProblem> CheckFolder(const std::filesystem::path& folder, bool repair,
                                       OtherFolder other = nullptr);

/// The part of it that reads no row: campaign.yaml and the files of the report.
std::vector<FolderProblem> CheckFiles(const std::filesystem::path& results);

}  // namespace dispersa
