// One process at a time writes a result folder.
#pragma once

#include <filesystem>

namespace dispersa {

/// Held from construction to destruction, and released with the process however it ends: a kernel lock on the
/// folder itself, which leaves no file. File systems without locks (some network ones) give no protection.
class FolderLock {
 public:
  /// The folder must exist. InputError if another process (or another lock of this one) holds it.
  explicit FolderLock(const std::filesystem::path& directory);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;

 private:
  int directory_ = -1;  ///< file descriptor
};

}  // namespace dispersa
