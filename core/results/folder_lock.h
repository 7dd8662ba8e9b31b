// A lock with which only one process at a time writes a result folder.
#pragma once

#include <filesystem>

namespace dispersa {

/// Held from construction to destruction. The kernel releases it if the process ends in any way. It is a lock
/// on the folder itself and leaves no file.
class FolderLock {
 public:
  /// The folder must exist. Throws InputError if it cannot be opened, or another process or another lock of
  /// this process holds it. Throws ResultError if its file system has no locks.
  explicit FolderLock(const std::filesystem::path& directory);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;

 private:
  int directory_ = -1;  ///< file descriptor
};

}  // namespace dispersa
