#include "core/results/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/input/input_error.h"
#include "core/results/file_system.h"

namespace dispersa {

FolderLock::FolderLock(const std::filesystem::path& directory)
    : directory_(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (directory_ < 0) {
    throw InputError(fmt::format("{}: cannot be opened: {}", directory.string(), std::strerror(errno)),
                     "a folder that can be read and written");
  }
  try {
    if (!LockFile(directory_, false, directory)) {
      throw InputError(fmt::format("{}: another dispersa process is writing this folder", directory.string()),
                       "another folder, or to wait for that process to end");
    }
  } catch (...) {
    close(directory_);
    throw;
  }
}

FolderLock::~FolderLock() {
  if (directory_ >= 0) close(directory_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept : directory_(std::exchange(other.directory_, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(directory_, other.directory_);
  return *this;
}

}  // namespace dispersa
