// One process at a time writes a result folder.
#pragma once

#include <filesystem>

namespace dispersa {

/// Held from construction to destruction, and gone with the process however it ends: a lock of the kernel on
/// the folder itself, which leaves no file. On file systems that know no locks (some network ones) it holds
/// nothing.
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
